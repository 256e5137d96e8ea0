"""What several figures show: the arm on its way, the cost against evaluations, the joints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import beetle_ik as bik

from ...report import BLACK, BLUE, SKY, line
from .settings import UNITS, Criterion, best_so_far

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_POINTS = 400
_WITH_PENALTIES = {"time": 17.0, "tip_travel": 17.0, "joint_travel": 100.0}  # costs above: something is broken


def draw_arm(axes: Axes, plan: bik.Plan, snapshots: int = 5) -> None:
    """The arm at a few moments, darker as time goes by, and the way of its tip."""
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
    """Where it covers nothing."""
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, fontsize="small", columnspacing=1.0)


def draw_search(axes: Axes, plans: Sequence[bik.Plan], *, name: str, color: str, evaluations: int) -> None:
    """Mean and spread (one standard deviation) of the best cost so far, from where all plans keep what they must."""
    counts = np.unique(np.geomspace(100, evaluations, 120).astype(int)).astype(float)
    costs = best_so_far(plans, counts)
    costs[costs > _WITH_PENALTIES[plans[0].objective]] = np.nan
    found = np.isfinite(costs).all(axis=0)
    mean, spread = costs[:, found].mean(axis=0), costs[:, found].std(axis=0)
    axes.fill_between(counts[found], mean - spread, mean + spread, color=color, alpha=0.2, linewidth=0)
    axes.plot(counts[found], mean, color=color, label=name)
    axes.set(xscale="log", yscale="log", xlabel="evaluations")


def draw_bound(axes: Axes, value: float, name: str) -> None:
    """A value that no plan, or none known, goes below."""
    axes.axhline(value, color=BLACK, linestyle="--", linewidth=1.0, label=name)


def label(objective: Criterion) -> str:
    """What an axis of costs is called."""
    return f"{objective.replace('_', ' ')} [{UNITS[objective]}]"


def draw_joints(axes: Axes, plan: bik.Plan) -> None:
    """Joint positions over time."""
    time = np.linspace(0.0, plan.trajectory.duration, _POINTS)
    for j, q in enumerate(plan.trajectory.at(time)[0].T):
        axes.plot(time, q, label=f"joint {j + 1}", **line(j))
    axes.set(xlabel="time [s]", ylabel="joint position [rad]")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
