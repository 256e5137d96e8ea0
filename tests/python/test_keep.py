"""What must hold along the way: `keep=` of the planners, judged by numpy at 5,000 samples of the timed motion."""

from __future__ import annotations

import numpy as np
import pytest
from kept_motions import ARMS, KINDS, Arm, allowed, arm, constraint, end_of, errors, samples
from numpy.typing import NDArray

import beetle_ik as bik

Array = NDArray[np.float64]
LIMITS = {
    "velocity": bik.Limits(velocity=1.0),
    "acceleration": bik.Limits(velocity=1.0, acceleration=4.0),
    "jerk": bik.Limits(velocity=1.0, acceleration=4.0, jerk=40.0),
}


def judge(arm: Arm, plan: bik.Plan, keeps: list[bik.Keep]) -> None:
    """Checks that everything holds at each sample, and that the bounds of the plan are true and tight."""
    poses = arm.poses(samples(plan))
    assert len(plan.kept) == len(keeps)
    for keep, (kept, bounds) in zip(keeps, plan.kept, strict=True):
        assert kept == keep
        found, most = errors(keep, poses), allowed(keep)
        assert not np.isinf(found).any(), f"outside of the region: {keep}"
        limited = np.isfinite(most)
        if keep.task is not None and keep.task.weights is not None:
            limited &= np.asarray(keep.task.weights) != 0.0
        assert np.isnan(bounds[~limited]).all(), bounds
        largest = found.max(axis=0)[limited]
        most, bounds = most[limited], bounds[limited]
        assert (largest <= most * (1 + 1e-6) + 1e-9).all(), f"{largest} beyond {most}: {keep}"
        assert (bounds >= largest - 1e-9).all(), f"bounds {bounds} below {largest}: {keep}"
        assert (bounds <= 1.02 * largest + 0.02 * np.minimum(most, 0.1) + 1e-9).all(), f"{bounds} of {largest}: {keep}"


def problem(
    name: str, seed: int, kinds: list[str], tolerance: float, *, bodies: bool = False, at_limit: bool = False
) -> tuple[Arm, list[bik.Keep], Array, Array] | None:
    random = np.random.default_rng([len(name), seed])
    one = arm(name, random, bodies)
    lower, upper = (np.clip(bound, -3.0, 3.0) for bound in (one.robot.lower, one.robot.upper))
    start = lower + (upper - lower) * random.uniform(0.1, 0.9, one.robot.dof)
    keeps = [constraint(kind, one.poses(start[None])[0], tolerance, random, at_limit=at_limit) for kind in kinds]
    end = end_of(one, keeps, start, random)
    return None if end is None else (one, keeps, start, end)
