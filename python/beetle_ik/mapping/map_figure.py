"""Figures of maps: slices and clouds of reached voxels, and placements of a base."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from .._core import InvalidInputError, Robot
from ..calls.arguments import require_text
from ..figures.style import BLACK, VERMILION, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

KINDS = ("slices", "cloud")
_COLOURS = "viridis"
_MOST_POINTS = 20_000  # points of a cloud; matplotlib draws more slowly
_WIDTH = 180.0  # points, width of all voxels
_NAMES = "xyz"


class MappedVoxels(Protocol):
    """The voxels of a `ReachabilityMap`."""

    robot: Robot
    origin: NDArray[np.float64]
    voxel: float
    orientations: int
    index: NDArray[np.float32]


def drawn(map: MappedVoxels, kind: str) -> Figure:  # noqa: A002
    """Draws a map as "slices" or as a "cloud"."""
    require_text("kind", kind)
    if kind not in KINDS:
        raise InvalidInputError(f"kind must be one of {', '.join(repr(known) for known in KINDS)}, got {kind!r:.60}")
    title = f"{map.robot.name}: share of {map.orientations} orientations reached"
    with style():
        figure = new_figure(11.0 if kind == "slices" else 7.0, 4.4 if kind == "slices" else 6.0)
        figure.suptitle(title)
        cells = _slices(figure, map) if kind == "slices" else _cloud(figure, map)
        figure.colorbar(cells, ax=figure.axes, label="reached [%] (white: none)", shrink=0.85)
    return figure


def drawn_on_floor(title: str, at: NDArray[Any], x: NDArray[Any], y: NDArray[Any], share: NDArray[Any]) -> Figure:
    """Draws the fraction of yaws (i, j) at which a base at `x` (i,) and `y` (j,) reaches a target `at` (2,)."""
    with style():
        figure = new_figure(6.5, 5.5)
        axes = figure.add_subplot()
        cells = _shown(axes, x, y, share)
        axes.plot(*at, marker="x", markersize=9, markeredgewidth=2, color=VERMILION, linestyle="none", label="target")
        axes.set(xlabel="x of the base [m]", ylabel="y of the base [m]")
        axes.set_title(title)
        axes.legend(loc="upper right")
        figure.colorbar(cells, ax=axes, label="yaws [%] (white: none)")
    return figure


def _slices(figure: Figure, map: MappedVoxels) -> Any:  # noqa: A002
    """Draws the planes through the middle, and the layer with the largest reach."""
    best = [map.index.shape[0] // 2, map.index.shape[1] // 2, int(np.argmax(map.index.mean(axis=(0, 1))))]
    centres = [origin + map.voxel * (np.arange(n) + 0.5) for origin, n in zip(map.origin, map.index.shape, strict=True)]
    planes = [kept for kept in ((0, 2), (1, 2), (0, 1)) if min(map.index.shape[axis] for axis in kept) > 1]
    cells = None
    for panel, (across, up) in enumerate(planes, start=1):
        (fixed,) = {0, 1, 2} - {across, up}
        axes = figure.add_subplot(1, len(planes), panel)
        share = np.take(map.index, best[fixed], axis=fixed)
        cells = _shown(axes, centres[across], centres[up], share)
        axes.set(xlabel=f"{_NAMES[across]} [m]", ylabel=f"{_NAMES[up]} [m]")
        axes.set_title(f"{_NAMES[fixed]} = {centres[fixed][best[fixed]]:.3g} m")
        axes.plot(0, 0, marker="+", markersize=8, color=BLACK)
    return cells


def _shown(axes: Axes, x: NDArray[Any], y: NDArray[Any], share: NDArray[Any]) -> Any:
    """Draws fractions (x, y) in per cent; empty where none is reached."""
    axes.set_aspect("equal")
    axes.grid(visible=False)
    percent = np.where(share > 0, 100.0 * share, np.nan).T
    return axes.pcolormesh(x, y, percent, cmap=_COLOURS, vmin=0.0, vmax=100.0, rasterized=True)


def _cloud(figure: Figure, map: MappedVoxels) -> Any:  # noqa: A002
    """Draws the voxels behind the middle, so that the inside is in sight."""
    axes: Any = figure.add_subplot(projection="3d")
    points, share = cloud(map)
    middle = map.origin[1] + 0.5 * map.voxel * map.index.shape[1]
    behind = points[:, 1] > middle - 0.25 * map.voxel if map.index.shape[2] > 1 else np.ones(len(points), bool)
    points, share = points[behind], share[behind]
    kept = np.linspace(0, len(points) - 1, min(len(points), _MOST_POINTS)).astype(int)
    size = (_WIDTH / max(map.index.shape)) ** 2
    cells = axes.scatter(
        *points[kept].T, c=100.0 * share[kept], cmap=_COLOURS, vmin=0.0, vmax=100.0, s=size, marker="s", linewidths=0
    )
    axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", aspect="equal")
    axes.view_init(elev=18, azim=-75)
    return cells


def cloud(map: MappedVoxels) -> tuple[NDArray[np.float64], NDArray[np.float32]]:  # noqa: A002
    """Returns the centres (k, 3) (m) of the reached voxels, and the fraction of orientations of each (k,)."""
    voxels = np.argwhere(map.index > 0)
    return map.origin + map.voxel * (voxels + 0.5), map.index[tuple(voxels.T)]
