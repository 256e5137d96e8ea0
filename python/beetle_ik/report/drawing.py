"""Common parts of figures in reports, in the style of the package."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from ..figures.style import FORBIDDEN, VERMILION, line, style
from .log_axes import label_log_axes
from .numbers import number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from .._core import Robot, TrackResult

WIDTH = 9.0  # inches: the width of the page
_NEAR = 0.4  # fraction of the limit from which it is worth drawing
_ROD, _SHINE, _JOINT = "#7F8C99", "#C3CBD3", "#3B4650"  # colours of a steel arm
_SAME = 1e-6  # m


@contextmanager
def drawing(height: float, width: float = WIDTH) -> Iterator[Figure]:
    """Makes a figure of this size (inches) to draw on, in the style of the package.

    with drawing(3.0) as figure:
        axes = figure.subplots()
    """
    from matplotlib.figure import Figure

    with style():
        figure = Figure(figsize=(width, height), layout="constrained")
        yield figure
        label_log_axes(figure)


def draw_error(axes: Axes, time: ArrayLike, error: ArrayLike, *, band: float | None = None, **line: Any) -> None:
    """Draws an error (m) over time (s) on a logarithmic scale, with its tolerance as a dashed line."""
    axes.semilogy(time, error, **line)
    if band is not None:
        axes.axhline(band, color=VERMILION, linestyle="--", linewidth=1.0, label="error band")
    axes.set_ylabel("position error [m]")


def draw_velocities(
    axes: Axes, time: NDArray[np.float64], velocity: NDArray[np.float64], limit: ArrayLike, *, linewidth: float = 0.9
) -> None:
    """Draws joint velocities (k, n) in rad/s over time, and their `limit`: a number, or (k,).

    Values beyond the limit are shaded. A limit far above the joints is written instead of drawn.
    """
    for j, joint in enumerate(velocity.T):
        axes.plot(time, joint, label=f"joint {j + 1}", linewidth=linewidth, **line(j))
    bound = np.broadcast_to(np.asarray(limit, dtype=float), time.shape)
    peak, top = float(np.abs(velocity).max()), 1.15 * float(bound.max())
    if np.isfinite(top) and peak >= _NEAR * top:
        axes.fill_between(time, bound, top, color=FORBIDDEN, linewidth=0)
        axes.fill_between(time, -bound, -top, color=FORBIDDEN, linewidth=0)
        axes.set_ylim(-top, top)
    elif np.isfinite(top):
        axes.set_ylim(-1.3 * peak, 1.3 * peak)
        told = f"limit ±{number(float(bound.max()), 2)} rad/s"
        axes.text(0.99, 0.97, told, transform=axes.transAxes, ha="right", va="top", fontsize="small")
    axes.set_ylabel("joint velocity [rad/s]")


def draw_velocities_by_joint(strips: Sequence[Axes], result: TrackResult) -> None:
    """Draws the velocity of each joint (rad/s) in axes of its own, on one scale, and shades values beyond its limit.

    The second half of the motion sets the scale: an approach from afar may leave the axes.
    """
    time, bound = result.time[1:], result.velocity_limit[1:]
    settled, limit = float(np.abs(result.qd[len(result.qd) // 2 :]).max()), float(bound.max())
    near = settled >= _NEAR * limit
    top = 1.15 * limit if near else 1.5 * settled
    for j, axes in enumerate(strips):
        axes.plot(time, result.qd[1:, j], linewidth=0.8, **line(j))
        if near:
            axes.fill_between(time, bound[:, j], top, color=FORBIDDEN, linewidth=0)
            axes.fill_between(time, -bound[:, j], -top, color=FORBIDDEN, linewidth=0)
        axes.set(xlim=(0.0, time[-1]), ylim=(-top, top))
        named: dict[str, Any] = {"transform": axes.transAxes, "va": "top", "fontsize": "small"}
        axes.text(0.02, 0.93, f"joint {j + 1}", color=line(j)["color"], **named)
        if j == 0 and not near and np.isfinite(limit):
            axes.text(0.98, 0.93, f"limit ±{number(limit, 2)} rad/s", ha="right", **named)


def draw_arm_in_space(axes: Any, robot: Robot, q: NDArray[np.float64], *, alpha: float = 1.0) -> None:
    """Draws the arm at `q` as a body of rods and joints in 3-D axes, on one scale."""
    corners = _corners(robot.link_poses(q)[:, :3, 3])
    for i, (a, b) in enumerate(itertools.pairwise(corners)):
        width = 13.0 - 7.0 * i / len(corners)
        axes.plot(*np.array([a, b]).T, color=_ROD, linewidth=width, solid_capstyle="round", alpha=alpha, zorder=2)
        axes.plot(*np.array([a, b]).T, color=_SHINE, linewidth=0.35 * width, alpha=alpha, zorder=2.1)
    axes.plot(*corners.T, color=_JOINT, marker="o", markersize=6.0, linestyle="none", alpha=alpha, zorder=3)
    axes.computed_zorder = False
    axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    axes.locator_params(nbins=5)


def scale_alike(axes: Any, *, zoom: float = 0.95) -> None:
    """Scales all three axes alike, so that a circle looks like one."""
    spans = [np.ptp(limits) for limits in (axes.get_xlim(), axes.get_ylim(), axes.get_zlim())]
    axes.set_box_aspect(spans, zoom=zoom)


def _corners(origins: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the points where the arm bends, each once."""
    apart = np.linalg.norm(np.diff(origins, axis=0), axis=1) > _SAME
    bends: NDArray[np.float64] = origins[np.concatenate([[True], apart])]
    return bends
