"""The pseudo-inverse behind the servos of the other controllers, a case missing from the paper's comparison.

Also eq. (13) as printed, whose sign the library does not offer.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ... import Robot
from .servo import DISTURBANCE, DISTURBANCE_RATE, DT, MOST, TIME_CONSTANT

_Array = NDArray[np.float64]
_FASTEST = np.array([1.0, 1.0, 0.8])  # rad/s, rad/s, m/s: Table 1
_LOWER, _UPPER = (
    np.array([-1.2, -0.96, 0.0]),
    np.array([1.2, 0.96, 0.3]),
)  # section 3.2, mirrored
_GAIN = 50.0  # 1/s, K of the task
_POSTURE_GAIN = 20.0  # 1/s
_COARSE = 0.005  # s
_LONG = 8.0  # s


def _weighted_pseudo_inverse(jacobian: _Array) -> _Array:
    """Returns eq. (8) with the weights of eq. (11)."""
    inverse_weights = np.diag((2.0 * _FASTEST) ** 2)
    return np.asarray(inverse_weights @ jacobian.T @ np.linalg.inv(jacobian @ inverse_weights @ jacobian.T))


def on_servos(
    arm: Robot, wanted: Callable[[float], _Array], velocity: Callable[[float], _Array], duration: float
) -> _Array:
    """Returns joint errors (steps, 3) with each velocity command sent to a servo, as in `servo.simulate`.

    Uses eq. (12) in closed loop, with the posture held through the null space; the arm begins at rest, as in `servo`.
    """
    q, v = wanted(0.0), np.zeros(3)
    errors = np.empty((round(duration / DT), 3))
    for i in range(len(errors)):
        t = i * DT
        reference, rate = wanted(t), velocity(t)
        errors[i] = reference - q
        jacobian = arm.jacobian(q)[:2]
        inverse = _weighted_pseudo_inverse(jacobian)
        task = arm.jacobian(reference)[:2] @ rate + _GAIN * (arm.fk(reference)[:2, 3] - arm.fk(q)[:2, 3])
        posture = rate + _POSTURE_GAIN * (reference - q)
        u = np.clip(inverse @ task + posture - inverse @ (jacobian @ posture), -MOST, MOST)
        v = v + DT / TIME_CONSTANT * (u + DISTURBANCE * np.sin(DISTURBANCE_RATE * t) - v)
        q = q + DT * v
    return errors


def null_space_cost(
    arm: Robot, wanted: Callable[[float], _Array], velocity: Callable[[float], _Array], *, sign: float
) -> float:
    """Returns the mean cost of eq. (14) over 8 s with q0' = `sign` times its gradient, eq. (12) and (13)."""
    middle, width = 0.5 * (_LOWER + _UPPER), _UPPER - _LOWER
    q, costs = wanted(0.0), []
    for i in range(round(_LONG / _COARSE)):
        t = i * _COARSE
        reference = wanted(t)
        jacobian = arm.jacobian(q)[:2]
        inverse = _weighted_pseudo_inverse(jacobian)
        task = arm.jacobian(reference)[:2] @ velocity(t) + _GAIN * (arm.fk(reference)[:2, 3] - arm.fk(q)[:2, 3])
        posture = sign * 2.0 / 3.0 * (q - middle) / width**2
        q = q + _COARSE * (inverse @ task + posture - inverse @ (jacobian @ posture))
        costs.append(np.mean(((q - middle) / width) ** 2))
    return float(np.mean(costs))
