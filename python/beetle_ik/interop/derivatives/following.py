"""The derivative of a solution by its target."""

import numpy as np

from ..._core import Robot, solve_batch
from .rows import Rows

REACHED = 1e-6
"""Largest error of a target that counts as reached (m, rad), that of `solve`."""

PRECISE = 1e-12
"""Tolerance of the search (m, rad): its error divided by a step is the error of a finite difference."""


def solutions(robot: Robot, targets: Rows, starts: Rows | None = None) -> Rows:
    """Returns configurations and, in a last column, 1 where the target is reached and 0 where not: (m, n + 1).

    Args:
        robot: the arm.
        targets: poses (m, 4, 4), positions (m, 3) or, of several tips, poses (m, tips, 4, 4).
        starts: configurations (m, n); None: as in `solve`.
    """
    each = targets if targets.ndim < 4 else {tip: targets[:, i] for i, tip in enumerate(robot.tips)}
    batch = solve_batch(robot, each, start_q=starts, position_tolerance=PRECISE, rotation_tolerance=PRECISE)
    reached = (batch.position_error <= REACHED) & ~(batch.rotation_error > REACHED)  # NaN: orientation free
    return np.column_stack((batch.q, reached))


def following(robot: Robot, rows: int, damping: float, q: Rows, reached: Rows) -> Rows:
    """Returns how the joints follow a motion of the target, J^+, and one of the start, I - J^+ J: (m, n, k + n).

    Args:
        robot: the arm.
        rows: components of a target: 6 of a pose, 3 of a position; k is rows * tips.
        damping: singular value of the Jacobian (m/rad, 1) below which motions are damped.
        q: solutions (m, n).
        reached: 1 where the target is reached (m,).

    A joint at its limit is held where the others can follow without it. Where they cannot, the derivative is one-sided:
    it holds for targets that lead the joint inside. If the target is out of reach, joints at limits are held.
    """
    jacobian = robot.jacobian(q).reshape(len(q), len(robot.tips), 6, robot.dof)[:, :, :rows]
    jacobian = jacobian.reshape(len(q), -1, robot.dof)
    free = np.ones((len(q), robot.dof))
    inverse, rank = _damped_inverse(jacobian, damping)
    near = 1e-9 * (1.0 + np.abs(q))
    held = (q <= robot.lower + near) | (q >= robot.upper - near)
    some = np.flatnonzero(held.any(axis=1))
    if some.size:
        without, rank_without = _damped_inverse(np.where(held[some, None, :], 0.0, jacobian[some]), damping)
        hold = (rank_without == rank[some]) | (reached[some] < 0.5)
        inverse[some[hold]] = without[hold]
        free[some[hold]] = ~held[some[hold]]
    inverse *= free[:, :, None]
    rest = (np.eye(robot.dof) - inverse @ jacobian) * free[:, None, :] * free[:, :, None]
    return np.concatenate((inverse, rest), axis=-1)


def _damped_inverse(jacobian: Rows, damping: float) -> tuple[Rows, Rows]:
    """Returns pseudoinverses (m, n, k) and ranks (m,); small singular values s are damped to s / (s^2 + d^2).

    d^2 grows from 0 at s = `damping` to damping^2 at s = 0, for each singular value alone: the inverse is exact where
    the arm is not singular, continuous, and never larger than 1 / damping. Compare Nakamura and Hanafusa (1986).
    """
    left, values, right = np.linalg.svd(jacobian, full_matrices=False)
    gains = values / np.maximum(values, damping) ** 2  # s^2 + d^2, with d^2 = damping^2 - s^2
    inverse = np.einsum("mki,mk,mjk->mij", right, gains, left, optimize=True)
    return inverse, np.sum(values >= damping, axis=1)
