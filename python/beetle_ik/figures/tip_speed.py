"""Speed of the tips over time: of translation on the left axis, of rotation on the right one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .style import BLUE, GREEN, ORANGE, VERMILION

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from .._core import Plan, Robot

_DASHES = ("-", "--", ":", "-.")  # one for each tip
_HEADROOM = 1.1  # height of an axis over its data
_FAR_LIMIT = 3.0  # a limit beyond this multiple of the speeds is left out
_STILL = 1e-9  # m/s, rad/s: height of an axis without motion


def tip_speeds(
    robot: Robot, q: NDArray[np.float64], qd: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns the speeds (k, tips) (m/s) and the turn speeds (k, tips) (rad/s) for q and qd (k, n)."""
    jacobians = robot.jacobian(q).reshape(len(q), -1, 6, q.shape[1])
    twists = np.einsum("ktin,kn->kti", jacobians, qd)
    return np.linalg.norm(twists[..., :3], axis=-1), np.linalg.norm(twists[..., 3:], axis=-1)


def draw_tip_speeds(axes: Axes, plan: Plan, samples: int) -> None:
    """Draws both speeds of each tip, with their limits."""
    time = np.linspace(0.0, plan.trajectory.duration, samples)
    q, qd, _ = plan.trajectory.at(time)
    moving, turning = tip_speeds(plan.robot, q, qd)
    beside = axes.twinx()
    _draw(axes, time, moving, plan.robot, plan.limits.tip_speed, "tip speed [m/s]", (BLUE, GREEN))
    _draw(beside, time, turning, plan.robot, plan.limits.tip_turn_speed, "tip turn speed [rad/s]", (VERMILION, ORANGE))
    beside.grid(visible=False)
    beside.spines["right"].set_visible(True)
    if len(plan.robot.tips) > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.12, 1.0), fontsize="small")


def _draw(
    axes: Axes,
    time: NDArray[np.float64],
    speeds: NDArray[np.float64],
    robot: Robot,
    limits: float | dict[str, float] | None,
    label: str,
    colors: tuple[str, str],
) -> None:
    """Draws the speeds (k, tips) on one axis, and their limits as thin lines if they are not far above."""
    top = max(float(speeds.max()), _STILL)
    for i, name in enumerate(robot.tips):
        line: dict[str, Any] = {"color": colors[i % len(colors)], "linestyle": _DASHES[i % len(_DASHES)]}
        axes.plot(time, speeds[:, i], label=name, **line)
        limit = limits.get(name) if isinstance(limits, dict) else limits
        if limit is not None and limit <= _FAR_LIMIT * float(speeds.max()):
            axes.axhline(limit, linewidth=0.6, **line)
            top = max(top, limit)
    axes.set_ylim(0.0, _HEADROOM * top)
    axes.set_ylabel(label, color=colors[0])
    axes.tick_params(axis="y", colors=colors[0])
