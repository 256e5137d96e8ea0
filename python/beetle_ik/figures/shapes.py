"""Draws obstacles and bodies of robots."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .style import ORANGE, SKY
from .surface import Surface, draw_surfaces

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .._core import Obstacle, Robot

_FROM_ABOVE = "#F3D58C"  # orange on white, opaque
_TOOL = 1e-9  # m: a shorter tool is not drawn
_SEEN_BEYOND = 0.5  # margin around the arm, as a fraction of its extent


def draw_from_above(axes: Any, obstacles: Iterable[Obstacle]) -> None:
    """Shades the outlines of `obstacles`, seen from above, in 2-D axes."""
    from matplotlib.collections import PolyCollection

    for obstacle in obstacles:
        outlines = list(obstacle.triangles[:, :, :2])
        axes.add_collection(PolyCollection(outlines, facecolor=_FROM_ABOVE, linewidth=0, zorder=0))


def draw_in_space(axes: Any, points: NDArray[np.float64], obstacles: Sequence[Obstacle] = ()) -> None:
    """Scales 3-D axes equally to `points` (k, 3), and draws the parts of `obstacles` inside them."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # type: ignore[import-untyped, unused-ignore]

    low, high = _surroundings(points, obstacles)
    middle, reach = (low + high) / 2, 0.55 * max(float((high - low).max()), 1e-9)
    for name, center in zip("xyz", middle, strict=True):
        axes.set(**{f"{name}lim": (center - reach, center + reach), f"{name}label": f"{name} [m]"})
    axes.set_box_aspect((1, 1, 1), zoom=0.9)  # room for the labels, which the layout overlooks
    axes.locator_params(nbins=5)
    for obstacle in obstacles:
        # matplotlib does not clip surfaces to 3-D axes.
        surface = [inside(triangle, middle - reach, middle + reach) for triangle in obstacle.triangles]
        seen = [polygon for polygon in surface if len(polygon)]
        if seen:
            axes.add_collection3d(Poly3DCollection(seen, facecolors=ORANGE, alpha=0.45, linewidth=0, shade=True))


def _surroundings(points: NDArray[np.float64], obstacles: Sequence[Obstacle]) -> NDArray[np.float64]:
    """Returns the corners (2, 3) of a box around `points` and nearby obstacles: a whole floor would dwarf the arm."""
    low, high = points.min(axis=0), points.max(axis=0)
    beyond = _SEEN_BEYOND * float((high - low).max())
    everything = np.vstack((points, *(obstacle.triangles.reshape(-1, 3) for obstacle in obstacles)))
    return np.array(
        (np.maximum(everything.min(axis=0), low - beyond), np.minimum(everything.max(axis=0), high + beyond))
    )


def inside(polygon: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """Clips a convex polygon (k, 3) to a box by the Sutherland-Hodgman algorithm; (0, 3) if nothing is left."""
    for axis in range(3):
        for inward, wall in ((1.0, low[axis]), (-1.0, high[axis])):
            depth = inward * (polygon[:, axis] - wall)
            if (depth >= 0).all():
                continue
            kept = []
            for i, here in enumerate(polygon):
                before, outside = polygon[i - 1], depth[i] < 0
                if outside != (depth[i - 1] < 0):
                    kept.append(before + depth[i - 1] / (depth[i - 1] - depth[i]) * (here - before))
                if not outside:
                    kept.append(here)
            if len(kept) < 3:
                return np.empty((0, 3))
            polygon = np.array(kept)
    return polygon


def joints_to_tip(robot: Robot, q: ArrayLike) -> NDArray[np.float64]:
    """Returns the origins of the link frames at `q` (n,), base first, and the tip if a tool moves it: (k, 3).

    With several tips, the line runs to each tip and back to the branch towards the next.
    """
    if len(robot.tips) > 1:
        poses = link_poses(robot, q)
        return np.array([poses[link][:3, 3] for link in _there_and_back(robot._links_to_tips())])
    origins, tip = robot.link_poses(q)[:, :3, 3], robot.fk(q)[:3, 3]
    has_tool = float(np.linalg.norm(tip - origins[-1])) > _TOOL
    return np.vstack((origins, tip)) if has_tool else origins


def _there_and_back(ways: Sequence[Sequence[str]]) -> list[str]:
    """Returns the links passed on a walk to each tip in turn; all `ways` begin at the same link."""
    passed = list(ways[0])
    for before, way in itertools.pairwise(ways):
        shared = sum(1 for _ in itertools.takewhile(lambda pair: pair[0] == pair[1], zip(before, way, strict=False)))
        passed += [*reversed(before[shared - 1 : -1]), *way[shared:]]
    return passed


def placed_bodies(robot: Robot, q: ArrayLike) -> list[NDArray[np.float64]]:
    """Returns the triangles (t, 3, 3) of each body at `q` (n,); none for a rod without thickness."""
    poses = link_poses(robot, q)
    return [
        moved(body.shape.triangles, poses[body.link]) for body in robot.bodies if getattr(body.shape, "radius", 1.0)
    ]


def link_poses(robot: Robot, q: ArrayLike) -> dict[str, NDArray[np.float64]]:
    """Returns the poses (4, 4) of all links at `q` (n,) by name."""
    return dict(zip(robot.all_link_names, robot.all_link_poses(q), strict=True))


def moved(triangles: NDArray[np.float64], pose: NDArray[np.float64]) -> NDArray[np.float64]:
    """Transforms triangles (t, 3, 3) from a frame to the base."""
    return triangles @ pose[:3, :3].T + pose[:3, 3]


def draw_bodies(axes: Any, bodies: Iterable[NDArray[np.float64]]) -> None:
    """Draws bodies, translucent, in 3-D axes."""
    for triangles in bodies:
        draw_surfaces(axes, [Surface(triangles, SKY, alpha=0.14)])
