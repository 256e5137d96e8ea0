"""One arm on its circle in four panels, like Figures 2 and 3."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import beetle_ik as bik

from ...report import (
    BLUE,
    SKY,
    VERMILION,
    draw_arm_in_space,
    draw_error,
    draw_velocities_by_joint,
    drawing,
    line,
    scale_alike,
)
from .settings import FIVE_LINK, Task

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

_POSTURES = 6


def draw_motion(task: Task, result: bik.TrackResult) -> Drawing:
    """Draws arm and circle, joint positions and error beside them, and joint velocities in their limits below."""
    planar = task is FIVE_LINK
    count = result.q.shape[1]
    with drawing(8.2) as figure:
        parts: Any = figure.subfigures(2, 1, height_ratios=[1.7, 1.0])
        above, below = parts
        grid = above.add_gridspec(2, 2, width_ratios=[1.3, 1.0])
        space = above.add_subplot(grid[:, 0], projection=None if planar else "3d")
        (_draw_planar_arm if planar else _draw_arm)(space, result)
        joints, error = (above.add_subplot(grid[row, 1]) for row in range(2))
        for j, q in enumerate(result.q.T):
            joints.plot(result.time, q, label=f"joint {j + 1}", **line(j))
        joints.set_ylabel("joint position [rad]")
        draw_error(error, result.time, result.position_error, band=result.position_tolerance, color=BLUE)
        error.legend(loc="upper right")
        error.set_xlabel("time [s]")
        for axes in (joints, error):
            axes.set_xlim(0.0, result.time[-1])
        strips = below.subplots(2, (count + 1) // 2, sharex=True, sharey=True)
        draw_velocities_by_joint(strips.ravel()[:count], result)
        for axes in strips.ravel()[count:]:
            axes.axis("off")
        below.supylabel("joint velocity [rad/s]", fontsize="medium")
        below.supxlabel("time [s]", fontsize="medium")
    return figure


def _postures(result: bik.TrackResult) -> list[Any]:
    """Returns the positions of the joints (links, 3) at a few moments, evenly spread."""
    rows = np.linspace(0, len(result.q) - 1, _POSTURES, endpoint=False).astype(int)
    return [result.robot.link_poses(result.q[row])[:, :3, 3] for row in rows]


def _draw_planar_arm(axes: Axes, result: bik.TrackResult) -> None:
    for i, origins in enumerate(_postures(result)):
        axes.plot(*origins[:, :2].T, color=SKY, marker="o", markersize=3, linewidth=1.0, label=None if i else "arm")
    axes.plot(*result.reference[:, :2].T, color=VERMILION, linewidth=4.0, alpha=0.45, label="circle")
    axes.plot(*result.position[:, :2].T, color=BLUE, label="tip")
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)


def _draw_arm(axes: Any, result: bik.TrackResult) -> None:
    middle = len(result.q) // 2
    draw_arm_in_space(axes, result.robot, result.q[middle], alpha=0.3)
    draw_arm_in_space(axes, result.robot, result.q[0])
    axes.plot(*result.reference.T, color=VERMILION, linewidth=4.0, alpha=0.45, label="circle", zorder=5)
    axes.plot(*result.position.T, color=BLUE, label="tip", zorder=6)
    axes.set_zlim(0.0, None)
    axes.view_init(elev=18, azim=-55)
    scale_alike(axes, zoom=1.0)
    axes.legend(loc="upper left")
