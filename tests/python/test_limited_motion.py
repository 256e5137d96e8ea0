"""`Tracker` under acceleration and jerk limits: stops, missing and late targets, filters."""

import pickle
import re

import numpy as np
import pytest

import beetle_ik as bik

PANDA = bik.Robot.named("panda")
READY = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
LIMITS = bik.Limits(velocity=1.5, acceleration=5.0, jerk=50.0)
TARGET = [0.3, 0.4, 0.5]


def tracker(**options: object) -> bik.Tracker:
    return bik.Tracker(PANDA, READY, dt=0.002, **{"limits": LIMITS, **options})


def test_a_track_keeps_jerk_limits() -> None:
    start = PANDA.fk(READY)[:3, 3]
    circle = bik.paths.circle(start - np.array([0.05, 0.0, 0.0]), diameter=0.1, duration=5.0)
    result = bik.track(PANDA, circle, READY, dt=0.004, limits=LIMITS)
    assert result.max_violation == 0.0
    commands = np.vstack([[READY] * 3, result.q])
    jerk = np.diff(commands, 3, axis=0) / 0.004**3
    assert np.abs(jerk).max() <= 50.0
    assert result.position_error[-100:].max() < 1e-6


def test_stop_says_how_long_it_takes() -> None:
    moving = tracker()
    for _ in range(100):
        step = moving.step(TARGET)
    assert np.abs(step.qd).max() > 0.2
    seconds = moving.stop()
    begin = moving.time
    while np.abs(step.qd).max() > 1e-9:
        step = moving.step(None)
    assert moving.time - begin == pytest.approx(seconds, abs=0.0041)
    assert tracker(limits=None).stop() == 0.0


def test_without_limits_no_target_means_the_last_one() -> None:
    free = tracker(limits=bik.Limits(velocity=1.0))
    assert np.array_equal(free.step(None).q, READY)
    free.step(TARGET)
    for _ in range(2000):
        step = free.step(None)
    assert step.success


def test_a_late_target_is_followed_up_to_now() -> None:
    late = tracker()
    home = PANDA.fk(READY)[:3, 3]

    def hand(t: float) -> np.ndarray:
        return home + np.array([0.0, 0.1 * np.sin(t), 0.0])

    for tick in range(1, 2000):
        seen = 0.002 * tick - 0.05
        step = late.step(hand(seen), stamp=seen) if seen >= 0.0 and tick % 10 == 0 else late.step(None)
    assert np.linalg.norm(PANDA.fk(step.q)[:3, 3] - hand(late.time)) < 5e-4


def test_reset_in_motion() -> None:
    moving = tracker()
    qd = np.array([0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    moving.reset(READY, qd, qdd=np.zeros(7))
    step = moving.step(TARGET)
    assert np.abs(step.qd - qd).max() <= 50.0 * 0.002**2
    with pytest.raises(bik.BeetleIkError, match="cannot stop inside its limits; start slower or farther inside"):
        moving.reset(READY, 5.0 * np.ones(7))
    with pytest.raises(bik.BeetleIkError, match="qd"):
        moving.reset(READY, np.zeros(6))


def test_wrong_targets_leave_the_tracker_as_it_was() -> None:
    spoiled, clean = tracker(), tracker()
    for _ in range(20):
        with pytest.raises(bik.BeetleIkError):
            spoiled.step([np.nan, 0.0, 0.5])
        with pytest.raises(bik.BeetleIkError, match="stamp must be at most"):
            spoiled.step(TARGET, stamp=9.0)
        assert np.array_equal(spoiled.step(TARGET).q, clean.step(TARGET).q)


def moved(meters: float) -> np.ndarray:
    target = PANDA.fk(READY)
    target[1, 3] += meters
    return target


@pytest.mark.parametrize("restart", [1, 60])
def test_a_stamp_that_is_not_newer_is_told(restart: int) -> None:
    """A driver that leaves every stamp at 0, and a clock that starts again."""
    arm = bik.Tracker(PANDA, READY, dt=0.01, limits=LIMITS)
    for tick in range(restart):
        assert "ignored" not in arm.step(moved(0.0), stamp=0.01 * tick).message
    for tick in range(50):
        step = arm.step(moved(0.005 * (tick + 1)), stamp=0.0)
        assert not step.success
        assert step.status is bik.Status.CAPPED
        assert step.message.startswith("this target is ignored: its stamp, 0 s, is not after that of the last one, ")
        assert "leave stamp out" in step.message
        assert "tracker.time" in step.message
    for _ in range(50):
        step = arm.step(moved(0.25))
    assert step.status is bik.Status.IMPROVED


def test_packets_that_come_late_or_again_change_nothing() -> None:
    """The arm goes on as without them, and has solved what it meets."""
    given, spared = (bik.Tracker(PANDA, READY, dt=0.01, limits=LIMITS) for _ in range(2))
    for tick in range(100):
        stamp, target = 0.03 * tick, moved(0.0 if tick < 50 else 0.0005 * (tick - 50))
        for arm in (given, spared):
            arm.step(target, stamp=stamp)
        late, none = given.step(moved(0.3), stamp=stamp - 0.05), spared.step(None)
        np.testing.assert_array_equal(late.q, none.q)
        assert not late.success
        again, none = given.step(target, stamp=stamp), spared.step(None)
        np.testing.assert_array_equal(again.q, none.q)
        assert (again.status, again.message) == (none.status, none.message)
    at_rest = bik.Tracker(PANDA, READY, dt=0.01, limits=LIMITS)
    at_rest.step(moved(0.0), stamp=0.01)
    assert at_rest.step(moved(0.0), stamp=0.005).success


def test_a_stamp_ahead_of_the_clock_is_told_the_clock() -> None:
    with pytest.raises(
        bik.InvalidInputError, match=r"tracker\.time advances by dt in each step; leave stamp out"
    ) as told:
        tracker().step(TARGET, stamp=0.5)
    assert "at most 0.002, the end of the tick (s) on the clock of the tracker" in str(told.value)


def test_what_belongs_to_a_target() -> None:
    with pytest.raises(bik.BeetleIkError) as caught:
        tracker().step(None, stamp=0.0)
    assert str(caught.value) == "velocity and stamp belong to a target; leave them out in step(None)"
    with pytest.raises(bik.BeetleIkError, match="a stamp is used by the library's own rule under acceleration or jerk"):
        tracker(limits=None).step(TARGET, stamp=0.0)
    with pytest.raises(bik.BeetleIkError, match="timeout must be"):
        tracker(timeout=0.0)


def test_the_timeout_stops_the_arm() -> None:
    watched = tracker(timeout=0.05)
    for _ in range(50):
        watched.step(TARGET)
    for _ in range(300):
        step = watched.step(None)
    assert np.abs(step.qd).max() < 1e-12
    assert step.position_error > 0.01


@pytest.mark.parametrize("filter_", [bik.filters.LowPass(5.0), bik.filters.OneEuro(min_cutoff=2.0, beta=3.0)])
def test_filters_smooth_and_are_values(filter_: bik.filters.LowPass | bik.filters.OneEuro) -> None:
    copy = pickle.loads(pickle.dumps(filter_))
    assert copy == filter_
    assert hash(copy) == hash(filter_)
    assert eval(repr(filter_), vars(bik.filters)) == filter_
    home = PANDA.fk(READY)[:3, 3]
    smooth = tracker(target_filter=filter_, limits=None)
    smooth.step(home)
    assert smooth.step(home + np.array([0.0, 0.01, 0.0])).q == pytest.approx(READY, abs=3e-3)


def test_settings_of_filters_are_checked() -> None:
    for wrong in (lambda: bik.filters.LowPass(0.0), lambda: bik.filters.OneEuro(beta=-1.0)):
        with pytest.raises(bik.BeetleIkError):
            wrong()
    says = re.escape("target_filter must be filters.OneEuro, filters.LowPass or None, got 5")
    with pytest.raises(bik.BeetleIkError, match=says):
        tracker(target_filter=5)
