"""Configurations of an arm for a pose, some joints of which may be held."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..._core import Limits, Obstacle, Robot, solve, solve_all
from .poses import Array

_APART = 0.1  # rad, m: norm of the difference of two configurations that count as distinct


def configurations(
    robot: Robot,
    target: Array,
    q: Array,
    held: NDArray[np.bool_] | None,
    *,
    count: int,
    tolerance: float,
    obstacles: Sequence[Obstacle] | None,
) -> tuple[list[Array], str]:
    """Returns configurations for a pose, nearest to q first, and a sentence on the search.

    Args:
        robot: the arm.
        target: the pose (4, 4).
        q: configuration (n,).
        held: joints (n,) that stay as in q; None: none.
        count: number of values of the parameter of a redundant arm, or of starts if joints are held.
        tolerance: largest error (m, rad).
        obstacles: what to keep clear of; None: nothing, not the links either.
    """
    if held is None:
        solutions = solve_all(
            robot,
            target,
            start_q=q,
            redundancy=count,
            position_tolerance=tolerance,
            rotation_tolerance=tolerance,
            obstacles=obstacles,
        )
        return list(solutions.q), solutions.message
    limits = Limits(lower=np.where(held, q, robot.lower), upper=np.where(held, q, robot.upper))
    tries = [
        solve(
            robot,
            target,
            start_q=start,
            limits=limits,
            position_tolerance=tolerance,
            rotation_tolerance=tolerance,
            obstacles=obstacles,
        )
        for start in (q, *np.where(held, q, robot.random_configurations(count, seed=0)))
    ]
    return _distinct([one.q for one in tries if one.success], q), tries[0].message


def _distinct(found: list[Array], q: Array) -> list[Array]:
    """Returns configurations that are apart, nearest to q first."""
    kept: list[Array] = []
    for one in sorted(found, key=lambda one: float(np.linalg.norm(one - q))):
        if all(np.linalg.norm(one - other) >= _APART for other in kept):
            kept.append(one)
    return kept
