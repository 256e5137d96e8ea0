"""One control loop, one call a tick: the same as `track`, step by step."""

import copy
import itertools
import pickle

import numpy as np
import pytest
from iiwa_circle import CIRCLE, IIWA, LIMITS, ON_CIRCLE

import beetle_ik as bik


@pytest.mark.parametrize("solver", [None, bik.LevenbergMarquardt(), bik.papers.BAS(variant="chain")])
def test_steps_give_the_bits_of_a_track(solver: bik.papers.BAS | bik.LevenbergMarquardt | None) -> None:
    result = bik.track(IIWA, CIRCLE, ON_CIRCLE, dt=0.2, solver=solver, limits=LIMITS, position_tolerance=1e-5, seed=3)
    tracker = bik.Tracker(IIWA, ON_CIRCLE, dt=0.2, solver=solver, limits=LIMITS, position_tolerance=1e-5, seed=3)
    for i in range(1, len(result.time)):
        step = tracker.step(result.reference[i])
        # The first step of `track` also knows the error at the start, which a random search has to beat.
        if solver is None or isinstance(solver, bik.LevenbergMarquardt):
            assert np.array_equal(step.q, result.q[i])
            assert np.array_equal(step.qd, result.qd[i])
        assert step.success
        assert step.position_error <= 1e-5
    assert tracker.time == result.time[-1]


def test_the_model_based_rule_needs_two_evaluations_a_step() -> None:
    result = bik.track(IIWA, CIRCLE, ON_CIRCLE, dt=0.2, position_tolerance=1e-9)
    assert result.evaluations <= 310
    assert result.position_error[5:].max() < 1e-11
    assert result.max_violation == 0.0


def test_far_targets_are_approached_at_the_allowed_speed() -> None:
    tracker = bik.Tracker(IIWA, np.zeros(7), dt=0.01, limits=bik.Limits(velocity=0.5))
    step = tracker.step([0.4, 0.3, 0.8])
    assert step.status == bik.Status.IMPROVED
    assert np.abs(step.qd).max() == pytest.approx(0.5, abs=1e-12)
    for _ in range(600):
        step = tracker.step([0.4, 0.3, 0.8])
    assert step.success
    assert step.message.startswith("within the tolerances, ")


def test_a_target_out_of_reach_keeps_the_best() -> None:
    tracker = bik.Tracker(IIWA, ON_CIRCLE, dt=0.1)
    errors = [tracker.step([3.0, 0.0, 0.5]).position_error for _ in range(60)]
    assert all(after <= before for before, after in itertools.pairwise(errors))
    last = tracker.step([3.0, 0.0, 0.5])
    assert last.status == bik.Status.CAPPED
    assert "no nearer than in the tick before" in last.message


def test_an_arm_without_a_target_says_so() -> None:
    tracker = bik.Tracker(IIWA, ON_CIRCLE, dt=0.01, limits=bik.Limits(velocity=1.0, acceleration=5.0), timeout=0.1)
    assert tracker.step(None).message == "no target yet: the arm comes to rest and waits for one"
    tracker.step([0.4, 0.3, 0.8])
    tracker.stop()
    *_, stopped = (tracker.step(None) for _ in range(60))
    distance = f"{stopped.position_error:.4f} m away from the last target"
    assert stopped.message == f"stopped by stop(), {distance}: the next target makes it go on"
    tracker.step([0.4, 0.3, 0.8])
    *_, late = (tracker.step(None) for _ in range(60))
    distance = f"{late.position_error:.4f} m away from the last target"
    waits = "the arm comes to rest and waits for the next one"
    assert late.message == f"no target for 0.1000 s, {distance}: {waits}"
    assert pickle.loads(pickle.dumps(late)).message == late.message


def test_a_tracker_is_not_pickled_but_made_again() -> None:
    tracker = bik.Tracker(IIWA, ON_CIRCLE, dt=0.01)
    said = (
        "a Tracker is a loop in progress, which cannot be pickled or copied: keep its arguments and make another "
        "one, then reset it to q and qd of the last step"
    )
    for act in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match=f"^{said}$"):
            act(tracker)
    session = bik.BroydenBAS().session(ON_CIRCLE, dt=0.01)
    with pytest.raises(TypeError, match=r"^a ControlSession is a loop in progress, .* begin another one at the q of"):
        pickle.dumps(session)


def test_reset_begins_again_with_the_same_bits() -> None:
    tracker = bik.Tracker(IIWA, ON_CIRCLE, dt=0.2, solver=bik.papers.BAS(), position_tolerance=1e-4)
    first = [tracker.step(p).q for p in CIRCLE.sample(0.2)[1][1:20]]
    tracker.reset(ON_CIRCLE)
    assert tracker.time == 0.0
    assert np.array_equal(tracker.q, ON_CIRCLE)
    again = [tracker.step(p).q for p in CIRCLE.sample(0.2)[1][1:20]]
    assert np.array_equal(first, again)


def test_poses_are_followed_too() -> None:
    path = CIRCLE.with_orientation(IIWA.fk(ON_CIRCLE)[:3, :3])
    tracker = bik.Tracker(IIWA, ON_CIRCLE, dt=0.2, position_tolerance=1e-8, rotation_tolerance=1e-8)
    for t in np.arange(1, 151) * 0.2:
        step = tracker.step(path.pose(t))
        assert step.success
        assert step.rotation_error <= 1e-8


def test_wrong_input_is_named() -> None:
    tracker = bik.Tracker(IIWA, ON_CIRCLE, dt=0.2)
    with pytest.raises(bik.InvalidInputError, match="target must be finite, but coordinate y is NaN"):
        tracker.step([0.0, np.nan, 0.0])
    assert tracker.time == 0.0
    with pytest.raises(bik.LimitError, match="q: joint 'joint_a1' at 9 is outside its limits"):
        tracker.reset([9, 0, 0, 0, 0, 0, 0])
    with pytest.raises(
        bik.UnsupportedLimit, match="Tracker cannot honour callable velocity limits: it has no end time"
    ):
        bik.Tracker(IIWA, ON_CIRCLE, dt=0.2, limits=bik.Limits(velocity=lambda t: 1.0 + t))


LED = np.array([0.6, 0.8, 0.0])  # leads the Panda into a dead end
PANDA = bik.Robot.named("panda")
START = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])


def led_too_far_and_back(limits: bik.Limits, **options: bool) -> tuple[list[np.ndarray], bik.Step]:
    tracker, home, rows = bik.Tracker(PANDA, START, dt=0.02, limits=limits, **options), PANDA.fk(START), [START]
    for tick in range(700):
        target = home.copy()
        target[:3, 3] += 1.3 * LED * max(1.0 - abs(tick / 200 - 1.0), 0.0)
        step = tracker.step(target)
        rows.append(step.q)
    return rows, step


@pytest.mark.parametrize("more", [{}, {"acceleration": 5.0}, {"acceleration": 5.0, "jerk": 50.0}])
def test_an_arm_led_too_far_and_back_returns(more: dict[str, float]) -> None:
    rows, step = led_too_far_and_back(bik.Limits(velocity=1.5, **more))
    assert step.success, step.message
    q = np.array(rows)
    assert (q >= PANDA.lower).all()
    assert (q <= PANDA.upper).all()
    moves = np.vstack([np.zeros((3, 7)), np.diff(q, axis=0)])
    for order, limit in enumerate((1.5, *more.values())):
        assert np.abs(moves).max() <= limit * 0.02 ** (order + 1) * (1 + 1e-6)
        moves = np.diff(moves, axis=0)


@pytest.mark.parametrize(
    ("name", "start", "way", "times"),
    [
        # It swings away from its way back at first, and is given time to brake.
        (
            "panda",
            [0.98233371, -0.99357679, -1.92091128, -2.14844872, -1.63379597, 0.48444543, 0.45319806],
            [-0.292288112, 0.835362214, 0.465550891],
            (0.0, 4.0, 6.0, 8.0),
        ),
        # The pose is on the rim of the reach, where the sampled branches of the closed form miss it.
        (
            "gen3",
            [0.0, -1.12486470291, 0.0, 0.0, 1.5, 0.0, -1.5],
            [0.97740838, -0.89190448, -1.49972639],
            (0.0, 1.0, 1.5, 3.5),
        ),
    ],
)
def test_a_way_back_is_found_and_taken(
    name: str, start: list[float], way: list[float], times: tuple[float, ...]
) -> None:
    robot, limits = bik.Robot.named(name), bik.Limits(velocity=1.5, acceleration=5.0)
    tracker, home = bik.Tracker(robot, start, dt=0.01, limits=limits), robot.fk(np.array(start))
    for t in np.arange(0.0, 14.0, 0.01):
        target = home.copy()
        target[:3, 3] += np.array(way) * np.interp(t, times, (0.0, 1.0, 1.0, 0.0))
        step = tracker.step(target)
    assert step.success, step.message


def test_a_dead_end_is_told_with_the_joint_that_holds_the_arm() -> None:
    _, step = led_too_far_and_back(bik.Limits(velocity=1.5), recover=False)
    assert step.status == bik.Status.CAPPED
    assert step.message == (
        "joint 'panda_joint4', at its upper limit, holds the arm 0.1818 m and 0.02470 rad away; the target is in reach"
        ": recover=True lets the arm go to a configuration on it"
    )
    assert pickle.loads(pickle.dumps(step)).message == step.message


def test_a_stop_of_thousands_of_turns_ends_when_it_says() -> None:
    # A tick's worth of jerk is a hundred roundings of the position: each tick braked half a percent less than meant.
    turntable = bik.Robot.from_dh(a=[0.0], alpha=[0.0], d=[0.0], velocity=[50.0])
    limits = bik.Limits(acceleration=0.2, jerk=0.0032)
    tracker = bik.Tracker(turntable, [0.0], dt=0.002, limits=limits)
    tracker.reset([0.6], [25.0], [0.0])
    for _ in range(round(tracker.stop() / tracker.dt) + 1):
        step = tracker.step(None)
    assert step.q[0] > 1000.0
    assert step.qd[0] == 0.0


@pytest.mark.parametrize("recover", [False, True])
@pytest.mark.parametrize("angle", [1e-5, 5e-4, 1e-3])
def test_an_arm_at_a_limit_near_its_target_says_what_holds_it(angle: float, recover: bool) -> None:
    arm = bik.Robot.named("ur5e")
    q = np.array([0.3, -1.2, 1.2, -1.5, -1.57, arm.upper[5]])
    target = arm.fk(q) @ bik.pose([0.0, 0.0, 0.0], rpy=[0.0, 0.0, angle])
    limits = bik.Limits(velocity=1.5, acceleration=5.0, jerk=50.0)
    tracker = bik.Tracker(arm, q, dt=0.01, limits=limits, recover=recover)
    for _ in range(400):
        step = tracker.step(target)
    assert step.status is bik.Status.CAPPED
    assert step.message.startswith("joint 'wrist_3_joint', at its upper limit, holds the arm ")
    assert "another configuration reaches the target" in step.message
    assert np.abs(step.q - q).max() < 0.01, "no turn for so little"
