"""Best postures from Python. The core tests the numbers themselves."""

import pickle

import numpy as np
import pytest

import beetle_ik as bik

ARM = bik.Robot.planar([0.5, 0.5, 0.5])
E = (0.5, 0.5, 0.0)
QUADRANT = ((0.0, 0.0), (np.inf, np.inf))


def test_the_best_posture_of_a_planar_arm_is_found() -> None:
    tip = bik.papers.planar_posture(ARM, E)
    assert tip.success
    assert np.pi * tip.index == pytest.approx(1.720667, rel=1e-5)
    assert tip.index == pytest.approx(ARM.manipulability(tip.q, motion="position"), rel=1e-12)
    np.testing.assert_allclose(ARM.fk(tip.q)[:3, 3], E, atol=1e-12)
    whole = bik.papers.planar_posture(ARM, E, measure="overall", region=QUADRANT)
    assert whole.index == pytest.approx(1.900676, rel=1e-5)
    assert whole.index == pytest.approx(ARM.link_manipulability(whole.q).sum(), rel=1e-12)
    assert whole.history.shape == (0,)


def test_the_published_swarm_improves_over_generations() -> None:
    found = bik.papers.planar_posture(ARM, E, swarm=bik.papers.CircleSwarm(), seed=3)
    assert found.history.shape == (10,)
    assert (np.diff(found.history) >= 0.0).all()
    assert found.history[-1] == found.index
    again = bik.papers.planar_posture(ARM, E, swarm=bik.papers.CircleSwarm(), seed=3)
    np.testing.assert_array_equal(found.q, again.q)
    swarm = bik.papers.CircleSwarm(population=20, generations=50, signed=True)
    assert pickle.loads(pickle.dumps(swarm)) == swarm
    assert eval(repr(swarm), {"CircleSwarm": bik.papers.CircleSwarm}) == swarm


def test_any_arm_finds_its_best_posture() -> None:
    robot = bik.Robot.named("panda")
    q = 0.5 * (robot.lower + robot.upper) + 0.2
    goal = bik.goals.Manipulability()
    best = bik.solve(robot, robot.fk(q), goals=goal, prefer="best")
    near = bik.solve(robot, robot.fk(q), start_q=q, goals=goal)
    assert best.success
    assert robot.manipulability(best.q) >= robot.manipulability(near.q) * (1 - 1e-6)
    links = bik.goals.LinkManipulability(weight=2.0)
    assert pickle.loads(pickle.dumps(links)) == links
    assert repr(links) == "goals.LinkManipulability(motion='position', weight=2.0)"


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: bik.papers.planar_posture(bik.Robot.planar([1, 1]), E), "needs at least 3 links, got 2"),
        (lambda: bik.papers.planar_posture(bik.Robot.named("ur5e"), E), "joints that turn about z in one plane"),
        (lambda: bik.papers.planar_posture(ARM, [0.5, 0.5]), r"target: expected shape \(3,\), got \(2,\)"),
        (
            lambda: bik.papers.planar_posture(ARM, E, measure="sum"),
            "measure must be one of 'tip', 'overall', got 'sum'",
        ),
        (lambda: bik.papers.planar_posture(ARM, E, region=[0, 1]), r"region: expected shape \(2, 2\), got \(2,\)"),
        (lambda: bik.papers.CircleSwarm(c1=1.0), r"c1 \+ c2 must be above 4, got 3.05"),
        (lambda: bik.papers.CircleSwarm(population=-1), "population must be zero or more, got -1"),
        (lambda: bik.solve(ARM, E, prefer="best"), 'prefer="best" needs goals to compare solutions by'),
    ],
)
def test_wrong_input_is_named(call: object, message: str) -> None:
    with pytest.raises(bik.InvalidInputError, match=message):
        call()


def test_a_target_out_of_reach_is_a_status() -> None:
    found = bik.papers.planar_posture(ARM, [2.0, 0.0, 0.0])
    assert not found.success
    assert found.status is bik.Status.OUT_OF_REACH
    assert found.message == "no posture: the tip stays 0.5000 m away; move the target nearer"
    assert np.isnan(found.index)
