"""The figures of `benches/noisy_targets.py` and `benches/all_solutions.py`."""

import sys
from pathlib import Path

import numpy as np
import pytest
from oracle import SHARED, needs_shared

import beetle_ik as bik

pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
sys.path.insert(0, str(Path(__file__).parents[2] / "benches"))

from peers import completeness, motion
from peers.chain import Chain, load_chains

DT = 0.01


def test_settled_is_near_the_goal_from_then_on() -> None:
    assert motion.settling_time(np.array([0.2, 0.001, 0.1, 0.002, 0.001]), DT, noise=0.0) == pytest.approx(0.03)
    assert motion.settling_time(np.array([0.001, 0.001]), DT, noise=0.0) == 0.0
    assert np.isnan(motion.settling_time(np.array([0.001, 0.003]), DT, noise=0.0))
    assert motion.settling_time(np.array([0.2, 0.003]), DT, noise=0.001) == pytest.approx(0.01)


def test_the_lag_of_a_late_path_is_its_delay() -> None:
    angle = 0.02 * np.arange(2000)
    path = np.column_stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)])
    assert motion.lag(path, path, DT) == 0.0
    assert motion.lag(motion.delayed(path, 5.0), path, DT) == pytest.approx(5.0 * DT, rel=0.01)


def test_distance_from_the_straight_way() -> None:
    start, goal = np.zeros(3), np.array([1.0, 0.0, 0.0])
    points = np.array([[0.5, 0.0, 0.1], [1.2, 0.0, 0.0], [0.0, 0.0, 0.0]])
    assert motion.off_the_line(points[:1], start, goal) == pytest.approx(0.1)
    assert motion.off_the_line(points, start, goal) == pytest.approx(0.2)


def test_rates_are_finite_differences() -> None:
    time = DT * np.arange(100)
    q = np.column_stack([time**3, 2.0 * time**3])
    assert motion.rms_rate(q, 3, DT) == pytest.approx(6.0 * np.sqrt(2.5))
    assert motion.excess(q, 3, DT, 6.0) == pytest.approx(2.0)


def test_rotation_vectors_turn_as_pinocchio_says() -> None:
    import pinocchio as pin

    vectors = np.vstack([np.random.default_rng(0).normal(size=(50, 3)), np.zeros((1, 3)), 1e-9 * np.ones((1, 3))])
    np.testing.assert_allclose(motion.rotations(vectors), [pin.exp3(each) for each in vectors], atol=1e-14)


@pytest.fixture
def ur5(tmp_path: Path) -> Chain:
    return load_chains([SHARED / "robots" / "ur5.urdf"], tmp_path)[0]


@needs_shared
def test_a_solution_that_is_missing_or_wrong_is_noticed(ur5: Chain) -> None:
    targets, _ = ur5.targets(3)
    robot = bik.Robot.from_urdf(ur5.urdf, base=ur5.base, tip=ur5.tip)
    sets = [bik.solve_all(robot, target).q for target in targets]
    turned = [q + completeness.TURN * np.eye(6)[0] for q in sets]
    known = sum(map(len, sets))

    verdict = completeness.judge(ur5, targets, sets, turned)
    assert (verdict.known, verdict.found_again, verdict.wrong, verdict.missing) == (known, known, 0, [])

    verdict = completeness.judge(ur5, targets, [q[1:] for q in sets], turned)
    assert [number for number, _ in verdict.missing] == [0, 1, 2]

    spoilt = [np.vstack([q, q[:1], q[:1] + 1e-4]) for q in sets]  # one twice, one off the pose
    assert completeness.judge(ur5, targets, spoilt, turned).wrong == 6


@needs_shared
def test_descents_find_what_the_closed_form_finds(ur5: Chain) -> None:
    targets, _ = ur5.targets(3)
    robot = bik.Robot.from_urdf(ur5.urdf, base=ur5.base, tip=ur5.tip)
    found = list(completeness.descents(robot, ur5, targets, 200))
    assert [len(q) for q in found] == [len(bik.solve_all(robot, target)) for target in targets]
