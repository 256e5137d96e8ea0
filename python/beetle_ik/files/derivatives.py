"""Continuity of the derivatives of a trajectory."""

import numpy as np

from .._core import Trajectory

# Jumps of an acceleration below this fraction of the joint's largest count as rounding.
_ROUNDING = 1e-6


def has_continuous_acceleration(trajectory: Trajectory) -> bool:
    """Whether no joint's velocity or acceleration jumps at a knot."""
    coefficients = trajectory.coefficients
    powers = coefficients.shape[2]
    spans = np.diff(trajectory.time)[:, np.newaxis]
    derivative = coefficients
    for largest in (trajectory.max_velocity(), trajectory.max_acceleration()):
        derivative = derivative[:, :, 1:] * np.arange(1, powers)
        powers -= 1
        ends = np.sum([derivative[:, :, k] * spans**k for k in range(powers)], axis=0)
        jumps = np.abs(ends[:-1] - derivative[1:, :, 0])
        if np.any(jumps > _ROUNDING * largest):
            return False
    return True
