"""Trajectories as episodes of a LeRobot dataset."""

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from .._core import InvalidInputError, Trajectory
from ..calls.arguments import require, require_text
from .samples import named_joints, samples

Features: TypeAlias = dict[str, dict[str, Any]]
Frames: TypeAlias = list[dict[str, Any]]


def to_lerobot(
    trajectory: Trajectory,
    *,
    fps: int,
    task: str,
    degrees: bool = True,
    joint_names: Sequence[str] | None = None,
    others: Mapping[str, float] | None = None,
) -> tuple[Features, Frames]:
    """Converts a trajectory to an episode of a LeRobot dataset: features, and frames for its `add_frame`.

    `LeRobotDataset.create(repo_id, fps, features)` makes the dataset, `add_frame(frame)` adds each frame, and
    `save_episode()` writes the episode.

    Args:
        trajectory: the motion.
        fps: frames per second, a whole number.
        task: the task, in words.
        degrees: whether the joints, which must all turn, are written in degrees, as for LeRobot's arms; False: rad, m.
        joint_names: names of the joints in the order of q; None: those of the trajectory.
        others: constant values of further entries, such as {"gripper": 50.0}.

    A frame has "observation.state", the positions at its time, "action", those at the time of the next frame, both (n,)
    float32, and "task". Entries are named "joint.pos".

    Raises:
        InvalidInputError: `fps` is not a positive whole number, or `joint_names` has another number of joints.
    """
    time = samples(trajectory, None)[0]
    require("fps", fps, int, np.integer)
    if fps <= 0:
        raise InvalidInputError(f"fps must be positive, got {fps}")
    require_text("task", task)
    fixed = dict(others or {})
    names = [f"{name}.pos" for name in (*named_joints(trajectory, joint_names), *fixed)]
    count = 1 + int(np.ceil(trajectory.duration * fps - 1e-6))
    at = np.minimum(time[0] + np.arange(count) / fps, time[-1])
    q = trajectory.at(at)[0]
    still = np.broadcast_to(np.array(list(fixed.values()), dtype=float), (count, len(fixed)))
    rows = np.hstack((np.rad2deg(q) if degrees else q, still)).astype(np.float32)
    feature = {"dtype": "float32", "shape": (len(names),), "names": names}
    frames = [
        {"observation.state": rows[i], "action": rows[min(i + 1, count - 1)].copy(), "task": task} for i in range(count)
    ]
    return {"observation.state": dict(feature), "action": dict(feature)}, frames
