"""Joint values over time, a line for each joint."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .style import line

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from .._core import Robot

ROW_HEIGHT = 2.4  # inches per panel over time
_LEGEND_ROWS = 10
_NEAR = 0.7  # share of a torque limit from which on it is drawn


def draw_joints(axes: Axes, time: NDArray[np.float64], values: NDArray[np.float64], names: Sequence[str]) -> None:
    """Draws the columns of `values` (k, n) over `time` (k,)."""
    for j, name in enumerate(names):
        axes.plot(time, values[:, j], label=name, **line(j))


def draw_torques(axes: Axes, time: NDArray[np.float64], torques: NDArray[np.float64], robot: Robot) -> None:
    """Draws joint torques (k, n) over `time` (k,), with the limits that the motion comes near."""
    draw_joints(axes, time, torques, robot.joint_names)
    for j, limit in enumerate(robot.torque_limit):
        if abs(torques[:, j]).max() > _NEAR * limit:
            for bound in (-limit, limit):
                axes.axhline(bound, linewidth=0.8, alpha=0.7, **line(j))
    axes.set_ylabel("torque [N m, N]")


def legend_columns(names: Sequence[str]) -> int:
    """Returns the number of columns of a legend with these names."""
    return -(-len(names) // _LEGEND_ROWS)
