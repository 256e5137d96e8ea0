"""Samples of a trajectory for other libraries."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInputError, Trajectory

Samples: TypeAlias = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]


def samples(trajectory: Trajectory, dt: float | None) -> Samples:
    """Returns times (k,) (s), and positions, velocities and accelerations (k, n), every `dt` (s) or at the knots.

    Raises:
        InvalidInputError: the argument is not a `Trajectory`, or `dt` is not positive.
    """
    if not isinstance(trajectory, Trajectory):
        hint = ": give its .trajectory" if hasattr(trajectory, "trajectory") else ""
        raise InvalidInputError(f"trajectory must be a Trajectory, got {trajectory!r:.60}{hint}")
    if dt is None:
        return trajectory.time, trajectory.q, trajectory.qd, trajectory.qdd
    return trajectory.sample(dt)


def named_joints(trajectory: Trajectory, names: Sequence[str] | None) -> list[str]:
    """Returns names of the joints, those of the trajectory if none are given.

    Raises:
        InvalidInputError: another number of names.
    """
    given = list(trajectory.joint_names if names is None else names)
    if len(given) != len(trajectory.joint_names):
        raise InvalidInputError(f"joint_names: expected {len(trajectory.joint_names)}, one per joint, got {len(given)}")
    return given
