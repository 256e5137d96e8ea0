"""A few arms of `benches/random_chains.py`, and a test that its check notices errors."""

import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import beetle_ik as bik

sys.path.insert(0, str(Path(__file__).parents[2] / "benches"))

from random_chains import KINDS, Count, judge, tried

STRUCTURED = ("spherical wrist", "three parallel")


@pytest.mark.parametrize("kind", KINDS)
def test_random_arms_miss_nothing_where_complete_is_said(kind: str) -> None:
    count = tried(kind, arms=2, poses=4, descents=30, seed=3)
    assert (count.wrong, count.missing_though_complete) == (0, 0)
    # Elsewhere zeros of a polynomial are counted, which is no proof.
    assert count.complete >= 4 if kind in STRUCTURED else count.complete == 0
    assert count.found_again > 0


def test_solutions_that_are_missing_or_wrong_are_noticed() -> None:
    robot = bik.Robot.named("ur5e")
    q = np.array([0.4, -1.2, 1.1, -1.3, 0.9, 0.2])
    pose = robot.fk(q)
    all_of_them = bik.solve_all(robot, pose).q
    for handed_over, missing, wrong in [
        (all_of_them, 0, 0),
        (all_of_them[1:], 1, 0),
        (np.vstack([all_of_them, all_of_them[:1]]), 0, 1),
    ]:
        count = Count()
        found = SimpleNamespace(q=handed_over, complete=True, singular=False)
        judge(robot, pose, found, all_of_them, count)
        assert (count.missing, count.missing_though_complete, count.wrong) == (missing, missing, wrong)
