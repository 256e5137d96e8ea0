"""Trajectories for ROS 2."""

import json
import os
from collections.abc import Sequence
from typing import Any

from ..._core import InvalidInputError, Trajectory
from ...calls.arguments import require_text
from ...files.derivatives import has_continuous_acceleration
from ...files.whole import whole_file
from ..samples import named_joints, samples

_NANO = 1_000_000_000
_CUBIC = 3


def to_ros(
    trajectory: Trajectory,
    *,
    dt: float | None = None,
    frame_id: str = "",
    joint_names: Sequence[str] | None = None,
) -> dict[str, Any]:
    """Converts a trajectory to the fields of a ROS 2 `trajectory_msgs/JointTrajectory`, as a dict of plain values.

    Args:
        trajectory: the motion.
        dt: time between points (s), for a controller that interpolates with another degree, or a trajectory whose
            derivatives jump. None: points at the knots.
        frame_id: frame_id of the header.
        joint_names: the controller's names of the joints, in the order of q; None: those of the trajectory.

    Points contain velocities if the degree is 2 or more, and accelerations if it is 4 or more or the acceleration is
    continuous. A controller that interpolates with the lowest degree then reproduces the trajectory.

    Raises:
        InvalidInputError: `dt` is not positive, two points fall into the same nanosecond, or `joint_names` has another
            number of joints.
    """
    time, *values_of = samples(trajectory, dt)
    require_text("frame_id", frame_id)
    names = named_joints(trajectory, joint_names)
    degree = trajectory.coefficients.shape[2] - 1
    with_accelerations = degree > _CUBIC or (degree > 1 and has_continuous_acceleration(trajectory))
    fields = ("positions", "velocities", "accelerations")[: 1 + (degree > 1) + with_accelerations]
    nanoseconds = [round(float(t) * _NANO) for t in time]
    for i in range(1, len(nanoseconds)):
        if nanoseconds[i] <= nanoseconds[i - 1]:
            raise InvalidInputError(f"points {i - 1} and {i} fall into the same nanosecond, t = {time[i]} s: give dt=")
    points = []
    for i, nanosecond in enumerate(nanoseconds):
        point: dict[str, Any] = {name: [] for name in ("positions", "velocities", "accelerations", "effort")}
        point |= {name: values[i].tolist() for name, values in zip(fields, values_of, strict=False)}
        points.append(point | {"time_from_start": _duration(nanosecond)})
    header = {"stamp": _duration(0), "frame_id": frame_id}
    return {"header": header, "joint_names": names, "points": points}


def to_ros_yaml(
    trajectory: Trajectory,
    file: str | os.PathLike[str],
    *,
    dt: float | None = None,
    frame_id: str = "",
    joint_names: Sequence[str] | None = None,
) -> None:
    """Writes `to_ros(trajectory, ...)` as YAML for `ros2 topic pub` and parameter files; complete or not at all."""
    message = to_ros(trajectory, dt=dt, frame_id=frame_id, joint_names=joint_names)
    header, points = message["header"], message["points"]
    lines = ["header:", f"  stamp: {_flow(header['stamp'])}", f"  frame_id: {_flow(header['frame_id'])}"]
    lines += [f"joint_names: {_flow(message['joint_names'])}", "points:"]
    for point in points:
        rows = [f"{name}: {_flow(value)}" for name, value in point.items()]
        lines += [f"  - {rows[0]}", *(f"    {row}" for row in rows[1:])]
    with whole_file(file) as stream:
        stream.write(("\n".join(lines) + "\n").encode())


def _duration(nanoseconds: int) -> dict[str, int]:
    return {"sec": nanoseconds // _NANO, "nanosec": nanoseconds % _NANO}


def _flow(value: Any) -> str:
    """Formats a value on one line of YAML. Text is quoted as in JSON, a subset of YAML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name}: {_flow(item)}" for name, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_flow(item) for item in value) + "]"
    if isinstance(value, float):
        text = repr(value)
        # YAML 1.1 reads 1e-07 as text: a float needs a decimal point.
        return text.replace("e", ".0e") if "e" in text and "." not in text else text
    return json.dumps(value)
