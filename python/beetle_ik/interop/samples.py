"""Samples of a trajectory for other libraries."""

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
