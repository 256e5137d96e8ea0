"""Trajectories as bags of ROS 2."""

import os
import tempfile
from collections.abc import Sequence
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from .._core import InvalidInputError, Trajectory
from ..calls.arguments import require
from ..installed.needs import library
from .ros import to_ros
from .samples import samples

_NANO = 1_000_000_000
_VERSION = 9  # of the metadata


def to_rosbag(
    trajectory: Trajectory,
    folder: str | os.PathLike[str],
    *,
    dt: float = 0.01,
    stamp: float = 0.0,
    frame_id: str = "",
    joint_names: Sequence[str] | None = None,
    topic: str = "/joint_trajectory",
    states: str = "/joint_states",
) -> None:
    """Writes a bag of ROS 2 (MCAP) with the motion as one `JointTrajectory` and as a stream of `JointState`.

    No ROS is needed. `ros2 bag play` plays the states in real time.

    Args:
        trajectory: the motion.
        folder: the bag, a folder that does not exist yet; complete or not at all.
        dt: time between points, and between states (s).
        stamp: time at which the motion begins (s), on the clock of the bag.
        frame_id: frame_id of the headers.
        joint_names: names of the joints in the order of q; None: those of the trajectory.
        topic: topic of the `trajectory_msgs/JointTrajectory`, at `stamp`.
        states: topic of the `sensor_msgs/JointState`, positions and velocities.

    Raises:
        BeetleIkError: rosbags is not installed.
        InvalidInputError: as `to_ros`, a negative stamp, or equal topics.
        OSError: the folder exists, or its parent does not.
    """
    message = to_ros(trajectory, dt=dt, frame_id=frame_id, joint_names=joint_names)
    _, q, qd, _ = samples(trajectory, dt)
    require("topic", topic, str)
    require("states", states, str)
    if topic == states:
        raise InvalidInputError(f"topic and states must differ, got '{topic}' for both")
    if not (isinstance(stamp, Real) and 0.0 <= stamp < 2**31):
        raise InvalidInputError(f"stamp must be a time in s, zero or more, got {stamp!r:.60}")
    target = Path(folder)
    if target.exists():
        raise FileExistsError(f"The folder exists: '{target}'")
    if not target.parent.is_dir():
        raise FileNotFoundError(f"No such folder: '{target.parent}'")
    bags = library("rosbags.rosbag2", "rosbags", "a bag of ROS 2", extra="bags")
    typesys = library("rosbags.typesys", "rosbags", "a bag of ROS 2", extra="bags")
    messages = _Messages(typesys.get_typestore(typesys.Stores.LATEST))
    begin = round(stamp * _NANO)
    with tempfile.TemporaryDirectory(prefix=".beetle-ik-", dir=target.parent) as place:
        written = Path(place) / target.name
        with bags.Writer(written, version=_VERSION, storage_plugin=bags.StoragePlugin.MCAP) as writer:
            whole = messages.trajectory(message, begin)
            writer.write(messages.connection(writer, topic, whole), begin, messages.raw(whole))
            connection = None
            for point, positions, velocities in zip(message["points"], q, qd, strict=True):
                since = point["time_from_start"]
                at = begin + since["sec"] * _NANO + since["nanosec"]
                state = messages.state(message, at, positions, velocities)
                connection = connection or messages.connection(writer, states, state)
                writer.write(connection, at, messages.raw(state))
        written.rename(target)


class _Messages:
    """Makes messages of a type store."""

    def __init__(self, store: Any) -> None:
        self.store, self.types = store, store.types

    def connection(self, writer: Any, topic: str, message: Any) -> Any:
        return writer.add_connection(topic, message.__msgtype__, typestore=self.store)

    def raw(self, message: Any) -> Any:
        return self.store.serialize_cdr(message, message.__msgtype__)

    def trajectory(self, message: dict[str, Any], at: int) -> Any:
        point = self.types["trajectory_msgs/msg/JointTrajectoryPoint"]
        duration = self.types["builtin_interfaces/msg/Duration"]
        points = [
            point(
                **{name: np.array(value) for name, value in one.items() if name != "time_from_start"},
                time_from_start=duration(**one["time_from_start"]),
            )
            for one in message["points"]
        ]
        header = self.header(at, message["header"]["frame_id"])
        return self.types["trajectory_msgs/msg/JointTrajectory"](header, message["joint_names"], points)

    def state(self, message: dict[str, Any], at: int, q: Any, qd: Any) -> Any:
        header = self.header(at, message["header"]["frame_id"])
        state = self.types["sensor_msgs/msg/JointState"]
        return state(header, message["joint_names"], np.array(q), np.array(qd), np.array([]))

    def header(self, at: int, frame_id: str) -> Any:
        time = self.types["builtin_interfaces/msg/Time"](at // _NANO, at % _NANO)
        return self.types["std_msgs/msg/Header"](time, frame_id)
