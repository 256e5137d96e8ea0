"""Trajectories for MoveIt."""

from collections.abc import Sequence
from typing import Any

from .._core import Trajectory
from .ros import to_ros


def to_moveit(
    trajectory: Trajectory,
    *,
    dt: float | None = None,
    frame_id: str = "",
    joint_names: Sequence[str] | None = None,
) -> dict[str, Any]:
    """Converts a trajectory to the fields of a `moveit_msgs/RobotTrajectory`, as a dict of plain values.

    Args:
        trajectory: the motion.
        dt: time between points (s), as for `to_ros`; None: points at the knots.
        frame_id: frame_id of the headers.
        joint_names: names of the joints in the order of q, those of the planning group; None: those of the trajectory.

    Raises:
        InvalidInputError: as `to_ros`.
    """
    joints = to_ros(trajectory, dt=dt, frame_id=frame_id, joint_names=joint_names)
    header = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": frame_id}
    nothing: dict[str, Any] = {"header": header, "joint_names": [], "points": []}
    return {"joint_trajectory": joints, "multi_dof_joint_trajectory": nothing}
