"""Completeness of a set of solutions, tested against the solutions of other libraries and of random descents."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pinocchio as pin

from .chain import TURN, Chain
from .measure import LIMIT_SLACK

SAME = 1e-5  # rad: solutions nearer than this are one
REACHED = 1e-6  # m and rad
SINGULAR = 1e-7  # smallest singular value of the Jacobian (m and rad) below which a solution is listed apart
CHUNK = 100_000  # descents at once


@dataclass
class Verdict:
    """Result of the comparison on one arm."""

    known: int = 0  # solutions of the union, each counted once
    missing: list[tuple[int, np.ndarray]] = field(default_factory=list)  # number of the pose, solution
    singular: list[tuple[int, np.ndarray]] = field(default_factory=list)  # missing beside a singularity
    found_again: int = 0  # solutions of the set that the union has
    solutions: int = 0  # of the set
    wrong: int = 0  # of the set: outside the limits, off the pose, or returned twice


def judge(chain: Chain, targets: np.ndarray, ours: list[np.ndarray], theirs: list[np.ndarray]) -> Verdict:
    """Compares two lists of solutions (k, n), one entry per pose; those of others count once they are verified."""
    verdict = Verdict()
    for number, (target, mine, others) in enumerate(zip(targets, ours, theirs, strict=True)):
        good = distinct(verified(chain, target, mine))
        verdict.solutions += len(mine)
        verdict.wrong += len(mine) - len(good)
        union = distinct(verified(chain, target, others))
        distances = apart(union, good)
        again = (distances < SAME).any(axis=0).sum() if len(union) else 0
        verdict.known += len(union)
        verdict.found_again += int(again)
        for q in union[(distances >= SAME).all(axis=1)]:
            polished = polish(
                chain, target, q
            )  # near a singularity, a small error of the pose is a large one of the joints
            if polished is None or (apart(polished[None], good) < SAME).any():
                verdict.known -= 1
            else:
                smallest = smallest_singular_value(chain, polished)
                (verdict.singular if smallest < SINGULAR else verdict.missing).append((number, polished))
    return verdict


def smallest_singular_value(chain: Chain, q: np.ndarray) -> float:
    """Smallest singular value of the Jacobian, m and rad mixed."""
    return float(np.linalg.svd(jacobian(chain, q), compute_uv=False)[-1])


def apart(some: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Largest difference of joints between each of `some` (j, n) and of `others` (k, n), whole turns aside: (j, k)."""
    difference = some[:, None, :] - others[None, :, :]
    return np.abs(difference - TURN * np.round(difference / TURN)).max(axis=2, initial=0.0)


def distinct(solutions: np.ndarray) -> np.ndarray:
    """Removes repeated solutions."""
    near = np.triu(apart(solutions, solutions) < SAME, 1)
    return solutions[~near.any(axis=0)]


def verified(chain: Chain, target: np.ndarray, solutions: np.ndarray) -> np.ndarray:
    """Selects the solutions that reach the pose inside the limits, after whole turns."""
    inside = chain.unwound(np.asarray(solutions, dtype=float).reshape(-1, chain.dof) + LIMIT_SLACK) - LIMIT_SLACK
    inside = inside[(inside <= chain.upper + LIMIT_SLACK).all(axis=1)]
    return inside[[bool(np.abs(_error(chain, q, target)).max() <= REACHED) for q in inside]] if len(inside) else inside


def polish(chain: Chain, target: np.ndarray, q: np.ndarray) -> np.ndarray | None:
    """Refines `q` to a solution inside the limits, to rounding, by Newton's method; None if there is none."""
    for _ in range(20):
        error = _error(chain, q, target)
        if np.abs(error).max() < 1e-13:
            break
        q = q + np.linalg.lstsq(jacobian(chain, q), error, rcond=1e-12)[0]
    found = verified(chain, target, q)
    return found[0] if len(found) and np.abs(_error(chain, found[0], target)).max() < 1e-10 else None


def jacobian(chain: Chain, q: np.ndarray) -> np.ndarray:
    """Jacobian (6, n), world-aligned at the tip."""
    data = chain.model.createData()
    frame = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    return pin.computeFrameJacobian(chain.model, data, q, chain.tip_frame, frame)


def _error(chain: Chain, q: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Error of the pose (6,): m, and a rotation vector (rad), world-aligned."""
    pose = chain.pose(q)
    return np.concatenate([target[:3, 3] - pose[:3, 3], pin.log3(target[:3, :3] @ pose[:3, :3].T)])


def descents(robot: Any, chain: Chain, targets: np.ndarray, count: int) -> Iterable[np.ndarray]:
    """Distinct solutions (k, n) of `count` Levenberg-Marquardt descents from random starts, pose by pose."""
    import beetle_ik

    random = np.random.default_rng(1)
    at_once = max(1, CHUNK // max(1, count))
    for first in range(0, len(targets), at_once):
        some = targets[first : first + at_once]
        starts = random.uniform(chain.lower, chain.upper, (len(some) * count, chain.dof))
        ended = beetle_ik.solve_batch(
            robot,
            np.repeat(some, count, axis=0),
            start_q=starts,
            solver=beetle_ik.LevenbergMarquardt(),
            position_tolerance=1e-9,
            rotation_tolerance=1e-9,
        )
        for q, success in zip(np.split(ended.q, len(some)), np.split(ended.success, len(some)), strict=True):
            yield distinct(q[success])
