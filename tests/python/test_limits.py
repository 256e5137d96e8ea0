"""Limits in all their forms, applied to a track."""

import numpy as np
import pytest

import beetle_ik as bik

ROBOT = bik.Robot.planar([1.0] * 5)
START = [0.6697427192, -0.3400667941, -0.2474717864, -0.2588906663, 0.3263813181]  # on the circle's first point
CIRCLE = bik.paths.circle((4.0, 1.0, 0.0), diameter=1.4, duration=4.0)
DT = 0.1


def track(limits: bik.Limits, **options: object) -> bik.TrackResult:
    return bik.track(ROBOT, CIRCLE, START, dt=DT, limits=limits, **options)


def sinusoid(t: np.ndarray | float) -> np.ndarray | float:
    return 0.3 + 0.1 * np.sin(2.0 * t + 0.5)


SINUSOID = bik.Sinusoid(mean=0.3, amplitude=0.1, angular_frequency=2.0, phase=0.5)


def smallest_over_ticks(function: object, samples: int = 2001) -> np.ndarray:
    """The smallest value in every tick of the track, by dense sampling."""
    starts = DT * np.arange(40)
    return np.min(function(starts[:, None] + np.linspace(0.0, DT, samples)), axis=1)


def test_a_number_holds_for_all_joints() -> None:
    result = track(bik.Limits(velocity=0.4))
    np.testing.assert_array_equal(result.velocity_limit[1:], 0.4)
    assert result.limits.velocity == 0.4
    assert np.abs(result.qd).max() == pytest.approx(0.4, abs=1e-12)


def test_an_array_holds_joint_by_joint() -> None:
    velocity = np.array([0.5, 0.4, 0.3, 0.2, 0.1])
    result = track(bik.Limits(velocity=velocity))
    np.testing.assert_array_equal(result.velocity_limit[1:], np.tile(velocity, (40, 1)))
    assert np.all(np.abs(result.qd) <= velocity + 1e-12)


def test_a_sinusoid_binds_at_its_smallest_in_a_tick() -> None:
    result = track(bik.Limits(velocity=SINUSOID))
    np.testing.assert_allclose(result.velocity_limit[1:, 0], smallest_over_ticks(sinusoid), rtol=0, atol=1e-7)
    assert np.all(result.velocity_limit[1:, 0] <= smallest_over_ticks(sinusoid) + 1e-15)
    assert np.all(np.abs(result.qd[1:]) <= result.velocity_limit[1:] + 1e-12)


def test_a_sinusoid_may_differ_from_joint_to_joint() -> None:
    mean = np.array([0.2, 0.3, 0.4, 0.5, 0.6])
    result = track(bik.Limits(velocity=bik.Sinusoid(mean=mean, amplitude=0.0, angular_frequency=1.0)))
    np.testing.assert_array_equal(result.velocity_limit[1:], np.tile(mean, (40, 1)))


def test_at_the_start_of_a_tick_as_the_paper_has_it() -> None:
    result = track(bik.Limits(velocity=SINUSOID), limit_at="start")
    np.testing.assert_allclose(result.velocity_limit[1:, 2], sinusoid(result.time[:-1]), rtol=0, atol=1e-15)
    assert np.all(np.abs(result.qd[1:]) <= result.velocity_limit[1:] + 1e-12)


@pytest.mark.parametrize("per_joint", [False, True])
def test_a_function_is_a_velocity_limit(per_joint: bool) -> None:
    limits = bik.Limits(velocity=lambda t: np.full(5, sinusoid(t)) if per_joint else sinusoid(t))
    result = track(limits)
    ends_and_middle = np.min([sinusoid(0.5 * DT * (np.arange(40) * 2 + i)) for i in range(3)], axis=0)
    np.testing.assert_allclose(result.velocity_limit[1:, 3], ends_and_middle, rtol=0, atol=1e-15)
    assert np.all(np.abs(result.qd[1:]) <= result.velocity_limit[1:] + 1e-12)
    assert result.limits.velocity is limits.velocity


def test_functions_are_position_limits() -> None:
    closing = bik.Limits(
        lower=lambda t: -np.pi + 0.1 * t,
        upper=lambda t: np.array([1.0, 0.5, 0.5, 0.5, 1.0]) - 0.02 * t,
        velocity=np.inf,
    )
    result = track(closing, solver=bik.papers.BAS(variant="chain"))
    upper = np.array([1.0, 0.5, 0.5, 0.5, 1.0]) - 0.02 * result.time[:, None]
    assert np.all(result.q <= upper + 1e-12)
    assert result.max_violation == 0.0


def test_what_a_function_raises_comes_out_unchanged() -> None:
    error = KeyError("no limit for that time")

    def velocity(t: float) -> float:
        if t > 1.0:
            raise error
        return 0.5

    with pytest.raises(KeyError) as caught:
        track(bik.Limits(velocity=velocity))
    assert caught.value is error


def test_infinity_switches_a_limit_off() -> None:
    slow = ROBOT.with_limits(velocity=0.01)
    assert not bik.track(slow, CIRCLE, START, dt=DT).success
    free = bik.track(slow, CIRCLE, START, dt=DT, limits=bik.Limits(velocity=np.inf))
    assert free.success
    assert np.all(np.isinf(free.velocity_limit[1:]))
    assert free.limit_margin == np.inf


def test_a_function_may_leave_positions_unlimited() -> None:
    free = track(bik.Limits(lower=lambda _: -np.inf, upper=lambda _: np.inf, velocity=0.4))
    np.testing.assert_array_equal(free.q, track(bik.Limits(lower=-np.inf, upper=np.inf, velocity=0.4)).q)


def test_zero_locks_a_joint() -> None:
    result = track(bik.Limits(velocity=[1.0, 1.0, 0.0, 1.0, 1.0]))
    np.testing.assert_array_equal(result.q[:, 2], np.full(41, START[2]))
    assert result.success, result.message


@pytest.mark.parametrize("joint", range(3))
def test_equal_position_limits_lock_a_joint_of_a_plan(joint: int) -> None:
    end = np.array(START) + 0.1
    end[joint] = START[joint]
    bound = np.where(np.arange(5) == joint, START, np.inf)
    limits = bik.Limits(velocity=1.0, acceleration=3.0, lower=np.where(np.isinf(bound), -3.0, bound), upper=bound)
    plan = bik.plan_point_to_point(ROBOT, start_q=START, end_q=end, limits=limits)
    assert plan.success, plan.message
    np.testing.assert_array_equal(plan.trajectory.q[:, joint], START[joint])


def test_limits_left_out_are_the_robots() -> None:
    robot = ROBOT.with_limits(lower=-1.0, upper=1.0, velocity=0.7)
    result = bik.track(robot, CIRCLE, START, dt=DT, limits=bik.Limits(upper=2.0))
    assert result.limits.upper == 2.0
    np.testing.assert_array_equal(result.limits.lower, -np.ones(5))
    np.testing.assert_array_equal(result.limits.velocity, np.full(5, 0.7))
    assert (result.limits.acceleration, result.limits.jerk) == (None, None)


def test_limits_show_what_they_were_given() -> None:
    limits = bik.Limits(lower=-1, velocity=SINUSOID, jerk=[1.0, 2.0])
    assert (limits.lower, limits.upper, limits.acceleration) == (-1.0, None, None)
    assert limits.velocity == SINUSOID
    np.testing.assert_array_equal(limits.jerk, [1.0, 2.0])
    assert not limits.jerk.flags.writeable


@pytest.mark.parametrize("field", ["acceleration", "jerk"])
def test_a_single_configuration_has_no_motion_to_limit(field: str) -> None:
    with pytest.raises(bik.UnsupportedLimit) as caught:
        bik.solve(ROBOT, [1.0, 1.0, 0.0], limits=bik.Limits(**{field: 1.0}))
    message = f"solve cannot honour {field} limits: a single configuration has no motion; leave it out"
    assert str(caught.value) == message


@pytest.mark.parametrize("field", ["acceleration", "jerk"])
def test_switching_off_what_is_not_kept_is_fine(field: str) -> None:
    assert track(bik.Limits(velocity=np.inf, **{field: np.inf})).success


@pytest.mark.parametrize("upper", [bik.Sinusoid(mean=1.0, amplitude=0.1, angular_frequency=1.0), lambda t: 1.0 + t])
def test_one_configuration_has_no_time(upper: object) -> None:
    with pytest.raises(bik.UnsupportedLimit) as caught:
        bik.solve(ROBOT, [1.0, 1.0, 0.0], limits=bik.Limits(upper=upper))
    message = "solve cannot honour time-varying upper limits: one configuration has no time; give numbers"
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("velocity", "message"),
    [
        (-0.5, "velocity limit is -0.5: a limit cannot be negative"),
        ([1, 1, -2, 1, 1], "velocity limit of joint 3 is -2: a limit cannot be negative"),
        (
            bik.Sinusoid(mean=0.5, amplitude=1.0, angular_frequency=2.0),
            "velocity limit of joint 'joint_1' is -0.5 at t = 2.356194490192345 s: a limit cannot be negative",
        ),
        (lambda t: 3.0 - t, "velocity limit of joint 'joint_1' is -1 at t = 4 s: a limit cannot be negative"),
    ],
    ids=["number", "array", "sinusoid", "function"],
)
def test_a_negative_limit_is_told_at_once_or_with_its_time(velocity: object, message: str) -> None:
    with pytest.raises(bik.LimitError) as caught:
        track(bik.Limits(velocity=velocity))
    assert str(caught.value) == message
