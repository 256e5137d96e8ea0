"""`WeightedPseudoInverse` and acceleration limits from Python. The core tests the numbers themselves."""

import pickle

import numpy as np
import pytest
from iiwa_circle import CIRCLE, IIWA

import beetle_ik as bik

ARM = bik.Robot.named("hydraulic3")
OPEN = bik.Limits(lower=-np.inf, upper=np.inf)


def wanted(t: float) -> np.ndarray:
    """The joints' reference of the paper, at t (s)."""
    return np.array([0.5 * np.cos(np.pi * t / 2), 0.5 * np.cos(np.pi * t / 2), 0.2 * np.sin(np.pi * t / 2)])


def velocity(t: float) -> np.ndarray:
    return (
        np.pi / 2 * np.array([-0.5 * np.sin(np.pi * t / 2), -0.5 * np.sin(np.pi * t / 2), 0.2 * np.cos(np.pi * t / 2)])
    )


PATH = bik.paths.from_function(lambda t: ARM.fk(wanted(t))[:3, 3], 2.0)


def test_the_gain_reduces_errors_and_runge_kutta_makes_none() -> None:
    def worst(**options: object) -> float:
        rule = bik.WeightedPseudoInverse(**options)
        return bik.track(ARM, PATH, wanted(0.0), dt=0.01, solver=rule, limits=OPEN).position_error.max()

    assert worst(gain=0) == pytest.approx(3.0e-3, rel=0.02)
    assert worst(gain=50) == pytest.approx(8.3e-5, rel=0.02)
    assert worst(gain=0, integrator="rk4") < 1e-9  # the path's velocity is a finite difference


def test_a_posture_that_moves_is_followed() -> None:
    time = np.linspace(0.0, 2.0, 201)
    rows = np.array([wanted(t) for t in time])
    posture = bik.Trajectory.from_samples(time, rows, qd=np.array([velocity(t) for t in time]))
    rule = bik.WeightedPseudoInverse(gain=50, posture=posture)
    result = bik.track(ARM, PATH, wanted(0.0), dt=0.01, solver=rule)
    assert np.abs(result.q - rows).max() < 4e-4


def test_a_tracker_takes_the_velocity_of_the_target() -> None:
    rule = bik.WeightedPseudoInverse(gain=50)
    tracked = bik.track(ARM, PATH, wanted(0.0), dt=0.01, solver=rule)
    tracker = bik.Tracker(ARM, wanted(0.0), dt=0.01, solver=rule)
    for t in tracked.time[1:101]:
        step = tracker.step(PATH.position(t), velocity=PATH.velocity(t))
    # What the first tick did not know of is forgotten by now.
    assert step.position_error == pytest.approx(tracked.position_error[100], rel=1e-6)
    without = bik.Tracker(ARM, wanted(0.0), dt=0.01, solver=rule)
    for t in tracked.time[1:101]:
        step = without.step(PATH.position(t))
    assert step.position_error < 1e-4
    with pytest.raises(bik.InvalidInputError, match="velocity of the target must be finite, but coordinate x is NaN"):
        tracker.step(PATH.position(0.0), velocity=[np.nan, 0.0, 0.0])


def test_accelerations_are_kept() -> None:
    robot = bik.Robot.named("iiwa14")
    start = [0.3, 0.6, 0.2, -1.3, 0.4, 0.9, 0.1]
    center = robot.fk(start)[:3, 3] - [0.1, 0.0, 0.0]
    limits = bik.Limits(acceleration=6.0)
    result = bik.track(robot, bik.paths.circle(center, 0.2, 3.0), start, dt=0.01, limits=limits)
    assert np.abs(np.diff(result.qd, axis=0)).max() <= 0.06 * (1 + 1e-9)
    assert result.max_violation == 0.0
    assert result.position_error[150:].max() < 1e-6


def test_goals_act_in_the_null_space() -> None:
    middle, half = (ARM.lower + ARM.upper) / 2, (ARM.upper - ARM.lower) / 2

    def off_centre(**goals: object) -> float:
        rule = bik.WeightedPseudoInverse(gain=50)
        result = bik.track(ARM, PATH, wanted(0.0), dt=0.01, solver=rule, **goals)
        assert result.position_error.max() < 2e-4
        return np.mean(((result.q - middle) / half) ** 2)

    assert off_centre(goals=bik.goals.Centring(weight=1 / 3)) < 0.97 * off_centre()


def test_the_rule_is_a_value() -> None:
    posture = bik.Trajectory.from_samples([0.0, 1.0], [[0.0] * 3, [0.1] * 3])
    rule = bik.WeightedPseudoInverse(
        gain=10.0, integrator="rk4", weights=[1.0, 2.0, 3.0], posture=posture, damping=1e-6
    )
    assert pickle.loads(pickle.dumps(rule)) == rule
    assert rule != bik.WeightedPseudoInverse()
    assert (rule.gain, rule.integrator, rule.posture_gain, rule.damping) == (10.0, "rk4", 20.0, 1e-6)
    plain = bik.WeightedPseudoInverse(gain=10.0, weights=[1.0, 2.0, 3.0])
    assert eval(repr(plain), {"WeightedPseudoInverse": bik.WeightedPseudoInverse}) == plain
    np.testing.assert_array_equal(rule.weights, [1.0, 2.0, 3.0])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"gain": -1.0}, "gain must be zero or positive, and finite, got -1"),
        ({"integrator": "heun"}, "integrator must be one of 'euler', 'rk4', got 'heun'"),
        ({"weights": [1.0, 0.0, 1.0]}, r"weights\[1\] must be positive and finite, got 0"),
        ({"weights": [1.0]}, "weights for robot 'hydraulic3': expected 3 joints, got 1"),
        ({"gain": 300.0}, "gain must be below 2 / dt = 200, beyond which errors grow, got 300"),
    ],
)
def test_wrong_options_are_named(options: dict[str, object], message: str) -> None:
    with pytest.raises(bik.InvalidInputError, match=message):
        bik.Tracker(ARM, wanted(0.0), dt=0.01, solver=bik.WeightedPseudoInverse(**options))


def test_the_gain_of_a_posture_matters_where_there_is_one() -> None:
    slow = bik.WeightedPseudoInverse()  # posture_gain 20, more than 2 / dt
    assert bik.track(IIWA, CIRCLE, dt=0.2, solver=slow, position_tolerance=0.02).success
    stretched = bik.Trajectory.from_samples([0.0, 30.0], [[0.0] * 7] * 2, joint_names=IIWA.joint_names)
    with pytest.raises(bik.InvalidInputError, match=r"^posture_gain must be below 2 / dt = 10, .*, got 20$"):
        bik.track(IIWA, CIRCLE, dt=0.2, solver=bik.WeightedPseudoInverse(posture=stretched))
