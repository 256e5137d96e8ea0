"""The paper's panels (a) to (f): the arm along its path, coordinates, joints, objective and errors over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import beetle_ik as bik

from ...report import BLUE, GREEN, ORANGE, SKY, VERMILION, draw_arm_in_space, drawing, line, scale_alike
from .settings import STAR, Array, Run, star_as_printed

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

_EVERY = 50  # rows of 1 ms from one drawn point to the next
_POSTURES = (0.0, 0.03, 0.25, 0.5, 1.0)  # fractions of the run at which the arm is drawn


def draw_run(run: Run, robot: bik.Robot) -> Drawing:
    """Draws all panels of one run."""
    with drawing(10.0) as figure:
        grid = figure.add_gridspec(3, 2, height_ratios=[2.6, 1.0, 1.0])
        top = grid[0, :].subgridspec(1, 2, width_ratios=[1.5, 1.0])
        _draw_arm(figure.add_subplot(top[0], projection="3d"), run, robot)
        _draw_front(figure.add_subplot(top[1]), run)
        over_time = [figure.add_subplot(grid[1 + i // 2, i % 2]) for i in range(4)]
        _draw_over_time(over_time, run)
        for axes in over_time:
            axes.set(xlim=(0.0, run.time[-1]), xlabel="time [s]")
    return figure


def _draw_arm(space: Any, run: Run, robot: bik.Robot) -> None:
    """Draws panels (a) and (f): postures from home to the end, and the path."""
    last = len(run.time) - 1
    for i, share in enumerate(_POSTURES):
        alpha = 1.0 if i == len(_POSTURES) - 1 else 0.25
        draw_arm_in_space(space, robot, run.result.q[round(share * last)], alpha=alpha)
    space.plot(*run.result.reference[::_EVERY].T, color=VERMILION, linewidth=3.0, alpha=0.8, label="path", zorder=4)
    space.plot(*run.tip[::_EVERY].T, color=BLUE, linewidth=0.9, label="tool at θ", zorder=5)
    scale_alike(space, zoom=0.9)
    space.view_init(elev=16.0, azim=-25.0)
    space.legend(loc="upper right", fontsize="small")


def _draw_front(front: Any, run: Run) -> None:
    """Draws the path as seen along x, with the commanded tool."""
    rows = slice(None, None, _EVERY)
    reference = run.result.reference
    front.plot(*run.result.position[rows, 1:].T, color=SKY, linewidth=0.4, label="commanded tool")
    front.plot(*reference[rows, 1:].T, color=VERMILION, linewidth=4.0, alpha=0.45, label="path")
    front.plot(*run.tip[rows, 1:].T, color=BLUE, linewidth=0.9, label="tool at θ")
    low, high = reference[:, 1:].min(axis=0), reference[:, 1:].max(axis=0)
    margin = 0.5 * float((high - low).max())
    front.set(xlabel="y [m]", ylabel="z [m]", title="seen along x")
    front.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin), aspect="equal")
    front.legend(loc="upper left", fontsize="small")


def _draw_over_time(panels: list[Any], run: Run) -> None:
    coordinates, joints, objective, errors = panels
    rows = slice(None, None, _EVERY)
    time, tip, reference = run.time[rows], run.tip[rows], run.result.reference[rows]
    for k, (name, colour) in enumerate(zip("xyz", (BLUE, GREEN, ORANGE), strict=True)):
        coordinates.plot(time, reference[:, k], color=colour, linewidth=4.0, alpha=0.3)
        coordinates.plot(time, tip[:, k], color=colour, label=name)
        errors.plot(time, tip[:, k] - reference[:, k], color=colour, label=name)
    for j, q in enumerate(run.result.q[rows].T):
        joints.plot(time, q, label=f"{j + 1}", **line(j))
    objective.semilogy(time, run.sent_h[rows], color=SKY, linewidth=0.4, label="h(θ′), commanded")
    objective.semilogy(time, run.h[rows], color=BLUE, label="h(θ)")
    errors.set_ylim(-0.1, 0.1)
    coordinates.set_ylabel("position at θ [m]")
    joints.set_ylabel("joints [rad]")
    errors.set_ylabel("error at θ [m]")
    objective.set_ylabel("objective [m²]")
    for axes in (coordinates, joints, errors):
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    objective.legend(loc="upper right", fontsize="small")


def draw_stars() -> Drawing:
    """Draws eq. (20) as printed beside the hypotrochoid."""
    time = np.linspace(0.0, STAR.duration, 1001)
    curves: tuple[tuple[str, Array], ...] = (
        ("as printed", np.array([star_as_printed(t) for t in time])),
        ("as it must be meant", np.asarray(STAR.position(time))),
    )
    with drawing(3.4) as figure:
        panels = figure.subplots(1, 2, sharex=True, sharey=True)
        for axes, (name, points) in zip(panels, curves, strict=True):
            axes.plot(points[:, 1], points[:, 2], color=BLUE)
            axes.set(title=name, xlabel="y [m]", aspect="equal")
        panels[0].set_ylabel("z [m]")
    return figure
