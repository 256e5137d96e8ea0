"""Speed of the tips over time: of translation on the left axis, of rotation on the right one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .style import BLUE, GREEN, ORANGE, VERMILION

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from .._core import Robot, Trajectory

_DASHES = ("-", "--", ":", "-.")  # one for each tip
_HEADROOM = 1.1  # height of an axis over its data
_STILL = 1e-9  # m/s, rad/s: height of an axis without motion


def tip_speeds(
    robot: Robot, q: NDArray[np.float64], qd: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns the speeds (k, tips) (m/s) and the turn speeds (k, tips) (rad/s) for q and qd (k, n)."""
    jacobians = robot.jacobian(q).reshape(len(q), -1, 6, q.shape[1])
    twists = np.einsum("ktin,kn->kti", jacobians, qd)
    return np.linalg.norm(twists[..., :3], axis=-1), np.linalg.norm(twists[..., 3:], axis=-1)


def draw_tip_speeds(axes: Axes, trajectory: Trajectory, robot: Robot, samples: int) -> None:
    """Draws both speeds of each tip; a limit goes onto the axis of its speed, as `axhline`."""
    time = np.linspace(0.0, trajectory.duration, samples)
    q, qd, _ = trajectory.at(time)
    beside = axes.twinx()
    names = robot.tips if len(robot.tips) > 1 else ("tip",)
    panels = ((axes, "tip speed [m/s]", (BLUE, GREEN)), (beside, "tip turn speed [rad/s]", (VERMILION, ORANGE)))
    for (panel, label, colors), speeds in zip(panels, tip_speeds(robot, q, qd), strict=True):
        for i, name in enumerate(names):
            panel.plot(time, speeds[:, i], color=colors[i % 2], linestyle=_DASHES[i % 4], label=name)
        panel.set_ylim(0.0, _HEADROOM * max(float(speeds.max()), _STILL))
        panel.set_ylabel(label, color=colors[0])
        panel.tick_params(axis="y", colors=colors[0])
    beside.grid(visible=False)
    beside.spines["right"].set_visible(True)
    if len(names) > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.12, 1.0), fontsize="small")
