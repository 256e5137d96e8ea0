"""The screw motion between two poses: constant speed along and about one axis (Chasles' theorem)."""

import numpy as np

from ..._core import Limits, Robot, Tracker, pose
from .poses import Array

_SMALL = 1e-4  # rad: below it the terms of the series left out are less than the rounding
_LARGEST_STEP = 0.3  # rad, m: of a joint between two poses of a screw; a larger one is a jump
_TICKS = 10
_TURN, _WAY = 0.03, 0.01  # rad, m: from one pose to the next


def screw(start: Array, end: Array, finer: int = 1) -> Array:
    """Returns poses (k, 4, 4) from start to end, both (4, 4), so close that joints may be interpolated between them."""
    rotation = end[:3, :3] @ start[:3, :3].T
    turn = rotation_vector(rotation)
    shift = end[:3, 3] - rotation @ start[:3, 3]
    speed = np.linalg.solve(_left_jacobian(turn), shift)
    way, angle = float(np.linalg.norm(end[:3, 3] - start[:3, 3])), float(np.linalg.norm(turn))
    count = 1 + int(np.ceil(finer * max(angle / _TURN, way / _WAY, 1.0)))
    return np.array([_exponential(s * turn, s * speed) @ start for s in np.linspace(0.0, 1.0, count)])


def followed(robot: Robot, q: Array, poses: Array) -> Array | str:
    """Returns joints (k, n) that follow poses from q, or what stops them."""
    tracker = Tracker(robot, q, dt=1.0, limits=Limits(velocity=np.inf), recover=False)
    rows = [q]
    for target in poses[1:]:
        for _ in range(_TICKS):
            step = tracker.step(target)
            if step.success:
                break
        else:
            return step.message
        if np.abs(step.q - rows[-1]).max() > _LARGEST_STEP:
            return "a joint would have to turn at once"
        rows.append(step.q)
    return np.array(rows)


def rotation_vector(rotation: Array) -> Array:
    """Returns the rotation vector (3,) of a rotation (3, 3), at most pi long."""
    skew = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    sine, cosine = np.linalg.norm(skew) / 2.0, (np.trace(rotation) - 1.0) / 2.0
    angle = np.arctan2(sine, cosine)
    if sine > 1e-6:
        return np.asarray(angle / (2.0 * sine) * skew)
    if cosine > 0.0:
        return skew / 2.0
    outer = (rotation + np.eye(3)) / 2.0  # of the axis with itself, for half a turn
    axis = outer[:, np.argmax(np.diag(outer))]
    return np.asarray(angle * axis / np.linalg.norm(axis))


def _exponential(turn: Array, speed: Array) -> Array:
    return pose(_left_jacobian(turn) @ speed, rotvec=turn)


def _left_jacobian(turn: Array) -> Array:
    """Returns the left Jacobian of SO(3), which makes a translation of the linear part of a twist."""
    angle = np.linalg.norm(turn)
    x, y, z = turn
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    if angle < _SMALL:
        return np.asarray(np.eye(3) + cross / 2.0 + cross @ cross / 6.0)
    first, second = (1.0 - np.cos(angle)) / angle**2, (angle - np.sin(angle)) / angle**3
    return np.asarray(np.eye(3) + first * cross + second * cross @ cross)
