"""Checks of the viewer's arguments."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from .._core import BeetleIkError, InvalidInputError, LimitError, Robot, Trajectory, pose
from ..calls.labelled import labelled

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .._core import Path
    from .arm import Targets

    Array = NDArray[np.float64]

_PATH_POINTS = 500
_ROUNDING = 1e-6  # excess over a limit, as a fraction of the range, that the library takes for rounding


def configuration(robot: Robot, q: ArrayLike) -> Array:
    """Returns `q` as a new array (n,) of finite numbers."""
    ordered = q if labelled(q) is None else robot.q_from(q)
    robot.fk(ordered)  # refuses other lengths and NaN
    if np.ndim(ordered) != 1:
        raise InvalidInputError(f"q must be one configuration ({robot.dof},), got shape {np.shape(ordered)}")
    return _fixed(ordered)


def inside_limits(robot: Robot, q: ArrayLike) -> Array:
    """Returns `configuration` without rounding beyond the position limits; an error if it is outside them."""
    checked = configuration(robot, q)
    for name, value, low, high in zip(robot.joint_names, checked, robot.lower, robot.upper, strict=True):
        rounding = _ROUNDING * (high - low if np.isfinite(high - low) else 1.0)
        if not low - rounding <= value <= high + rounding:
            raise LimitError(f"q: joint '{name}' at {value:.6g} is outside its limits [{low:.6g}, {high:.6g}]")
    return _fixed(robot.clip(checked))


def target_poses(target: Any, present: Targets) -> Targets:
    """Returns the targets `present`, updated by `target`: a dict by the names of tips, or the pose of the only tip."""
    if not isinstance(target, Mapping):
        if len(present) > 1:
            raise InvalidInputError(
                f"target must be a dict with the tips {_named(present)} as keys, got {target!r:.60}"
            )
        (tip,) = present
        return {tip: _target_pose("target", target, present[tip])}
    for tip in target:
        if tip not in present:
            raise InvalidInputError(f"target: no tip is named {tip!r:.60}; tips: {_named(present)}")
    return present | {tip: _target_pose(f"target of '{tip}'", each, present[tip]) for tip, each in target.items()}


def _named(targets: Targets) -> str:
    return ", ".join(map(repr, targets))


def _target_pose(name: str, target: ArrayLike, present: Array) -> Array:
    """Returns a pose (4, 4), or a position (3,) with the orientation of the pose `present`."""
    try:
        given = np.asarray(target, dtype=float)
        if given.shape == (3,):
            return _fixed(pose(given, matrix=present[:3, :3]))
        if given.shape == (4, 4) and (given[3] == (0, 0, 0, 1)).all():
            return _fixed(pose(given[:3, 3], matrix=given[:3, :3]))
    except BeetleIkError as error:
        raise InvalidInputError(f"{name}: {error}") from error
    except (TypeError, ValueError):
        pass
    raise InvalidInputError(f"{name} must be a pose (4, 4) or a position (3,), got {target!r:.60}")


def path_points(path: Path | ArrayLike) -> Array:
    """Returns positions (k, 3) along a path of `bik.paths`, positions (k, 3) or poses (k, 4, 4)."""
    if isinstance(path, _core.Path):
        return path.position(np.linspace(0.0, path.duration, _PATH_POINTS))
    try:
        points = np.asarray(path, dtype=float)
    except (TypeError, ValueError):
        points = np.empty(0)
    if points.ndim == 3 and points.shape[1:] == (4, 4):
        points = points[:, :3, 3]
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 2 or not np.isfinite(points).all():
        raise InvalidInputError(f"path must be one of bik.paths, positions (k, 3) or poses (k, 4, 4), got {path!r:.60}")
    return points


def motion_of(result: Any) -> Trajectory | None:
    """Returns the motion of a result; None if it has none."""
    if isinstance(result, Trajectory):
        return result
    if isinstance(result, _core.Plan | _core.TrackResult):
        return result.trajectory
    if isinstance(result, _core.ModelFreeResult):
        return Trajectory.from_samples(result.time, result.q)
    return None


def in_joint_order(robot: Robot, motion: Trajectory) -> Trajectory:
    """Returns `motion` with its joints in the order of q; one whose joints have none of the robot's names as it is.

    Raises:
        InvalidInputError: some joints have names of the robot's joints, and others do not.
    """
    names, joints = motion.joint_names, robot.joint_names
    if names == joints or not set(names) & set(joints):
        return motion
    if sorted(names) != sorted(joints):
        raise InvalidInputError(f"joints of the motion: {', '.join(names)}; those of the robot: {', '.join(joints)}")
    order = [names.index(joint) for joint in joints]
    return Trajectory(motion.time, motion.coefficients[:, order], joint_names=joints)


def postures_of(result: Any) -> Array:
    """Returns the configurations (k, n) of a result without a motion.

    Raises:
        InvalidInputError: the result has no configurations.
    """
    if isinstance(result, _core.Solution | _core.SolutionSet | _core.SelfMotion):
        return np.atleast_2d(result.q)
    shown = "Trajectory, Plan, TrackResult, ModelFreeResult, Solution, SolutionSet or SelfMotion"
    raise InvalidInputError(f"result must be a {shown}, got {result!r:.60}")


def _fixed(values: ArrayLike) -> Array:
    array = np.array(values, dtype=float)
    array.flags.writeable = False
    return array
