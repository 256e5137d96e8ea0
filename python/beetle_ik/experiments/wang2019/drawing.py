"""Common parts of figures: cost against evaluations, the moving arm, joint positions and velocities."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import beetle_ik as bik

from ...report import BLACK, BLUE, FORBIDDEN, SKY, line
from .searches import Plans, Search, best_so_far
from .settings import UNITS, Criterion

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_POINTS = 400
_WITH_PENALTIES = {"time": 17.0, "tip_travel": 17.0, "joint_travel": 100.0}  # higher costs include penalties


def draw_arm(axes: Axes, plan: bik.Plan, snapshots: int = 5) -> None:
    """Draws the arm at a few moments, darker as time goes by, and the path of its tip."""
    times = np.linspace(0.0, plan.trajectory.duration, snapshots)
    for i, q in enumerate(plan.trajectory.at(times)[0]):
        corners = plan.robot.link_poses(q)[:, :2, 3]
        share = i / (snapshots - 1)
        label = "arm" if i == snapshots - 1 else None
        axes.plot(*corners.T, color=SKY, alpha=0.3 + 0.7 * share, marker="o", markersize=3, linewidth=1.5, label=label)
    q = plan.trajectory.at(np.linspace(0.0, plan.trajectory.duration, _POINTS))[0]
    tip = plan.robot.fk(q)[:, :2, 3]
    axes.plot(*tip.T, color=BLUE, label="tip")
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    legend_above(axes, columns=3)


def legend_above(axes: Axes, *, columns: int) -> None:
    """Puts the legend above the axes, where it covers nothing."""
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, fontsize="small", columnspacing=1.0)


def draw_searches(axes: Axes, searches: Sequence[Search], plans: Plans) -> None:
    """Draws the mean best cost so far of each search, from the point where all its plans meet the requirements.

    The shaded band is one standard deviation of the first search.
    """
    for i, search in enumerate(searches):
        counts = np.unique(np.geomspace(100, search.evaluations, 120).astype(int)).astype(float)
        best = best_so_far(plans[search.name], counts)
        best[best > _WITH_PENALTIES[plans[search.name][0].objective]] = np.nan
        found = np.isfinite(best).all(axis=0)
        mean, spread = best[:, found].mean(axis=0), best[:, found].std(axis=0)
        if i == 0:
            axes.fill_between(counts[found], mean - spread, mean + spread, color=search.color, alpha=0.2, linewidth=0)
        axes.plot(counts[found], mean, label=search.name, **line(i) | {"color": search.color})
    axes.set(xscale="log", yscale="log", xlabel="evaluations")


def draw_bound(axes: Axes, value: float, name: str) -> None:
    """Draws a lower bound, or the best known value."""
    axes.axhline(value, color=BLACK, linestyle="--", linewidth=1.0, label=name)


def label(objective: Criterion) -> str:
    """Returns the label of an axis of costs."""
    return f"{objective.replace('_', ' ')} [{UNITS[objective]}]"


def draw_positions(axes: Axes, plan: bik.Plan) -> None:
    """Draws joint positions over time."""
    time = np.linspace(0.0, plan.trajectory.duration, _POINTS)
    for j, q in enumerate(plan.trajectory.at(time)[0].T):
        axes.plot(time, q, label=f"joint {j + 1}", **line(j))
    axes.set(xlabel="time [s]", ylabel="joint position [rad]")
    legend_above(axes, columns=5)


def draw_velocities(axes: Axes, plan: bik.Plan, limit: float) -> None:
    """Draws joint velocities over time, and shades values beyond `limit` (rad/s) if the axis reaches them."""
    time = np.linspace(0.0, plan.trajectory.duration, _POINTS)
    velocities = plan.trajectory.at(time)[1]
    for j, velocity in enumerate(velocities.T):
        axes.plot(time, velocity, **line(j))
    top = 1.15 * min(limit, float(np.abs(velocities).max()))
    for sign in (-1.0, 1.0):
        axes.axhspan(sign * limit, sign * 1.15 * limit, color=FORBIDDEN, linewidth=0)
    axes.set(xlabel="time [s]", ylabel="joint velocity [rad/s]", ylim=(-top, top))
