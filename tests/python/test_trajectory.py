"""Joint motion as polynomials between knots."""

import numpy as np
import pytest

import beetle_ik as bik

TIME = np.array([0.0, 0.5, 1.25, 2.0])


def motion(t: np.ndarray | float) -> list[np.ndarray]:
    """Positions, velocities and accelerations of two joints."""
    phase, rate = np.multiply.outer(t, [1.0, 2.0]) + 0.3, np.array([1.0, 2.0])
    return [np.sin(phase), rate * np.cos(phase), -(rate**2) * np.sin(phase)]


def random_pieces(degree: int) -> np.ndarray:
    """Coefficients (3, 2, degree + 1) of a motion that does not jump."""
    coefficients = np.random.default_rng(degree).normal(size=(3, 2, degree + 1))
    for i, span in enumerate(np.diff(TIME)[:-1]):
        coefficients[i + 1, :, 0] = coefficients[i] @ span ** np.arange(degree + 1)
    return coefficients


def test_samples_without_velocities_are_joined_linearly() -> None:
    q = motion(TIME)[0]
    trajectory = bik.Trajectory.from_samples(TIME, q)
    assert (trajectory.duration, trajectory.joint_names) == (2.0, ["q1", "q2"])
    assert trajectory.coefficients.shape == (3, 2, 2)
    dense = np.linspace(0.0, 2.0, 101)
    expected = np.column_stack([np.interp(dense, TIME, column) for column in q.T])
    np.testing.assert_allclose(trajectory.at(dense)[0], expected, rtol=0, atol=1e-15)
    slopes = np.diff(q, axis=0) / np.diff(TIME)[:, None]
    np.testing.assert_allclose(trajectory.max_velocity(), np.abs(slopes).max(axis=0), rtol=1e-14)
    np.testing.assert_array_equal(trajectory.max_acceleration(), [0.0, 0.0])


@pytest.mark.parametrize(("derivatives", "degree"), [(2, 3), (3, 5)])
def test_segments_keep_the_given_derivatives(derivatives: int, degree: int) -> None:
    given = motion(TIME)[:derivatives]
    trajectory = bik.Trajectory.from_samples(TIME, *given[:1], **dict(zip(("qd", "qdd"), given[1:], strict=False)))
    assert trajectory.coefficients.shape == (3, 2, degree + 1)
    for read, expected in zip(trajectory.at(TIME), given, strict=False):
        np.testing.assert_allclose(read, expected, rtol=0, atol=1e-12)
    np.testing.assert_allclose(trajectory.at(1.0)[0], motion(1.0)[0], rtol=0, atol=1e-2)


def test_coefficients_are_ascending_powers_since_the_knot() -> None:
    coefficients = random_pieces(degree=3)
    trajectory = bik.Trajectory(TIME, coefficients, joint_names=["a", "b"])
    np.testing.assert_array_equal(trajectory.coefficients, coefficients)
    t = 0.8
    powers = (t - TIME[1]) ** np.arange(4)
    q, qd, qdd = trajectory.at(t)
    np.testing.assert_allclose(q, coefficients[1] @ powers, rtol=1e-13)
    np.testing.assert_allclose(qd, coefficients[1, :, 1:] @ (np.arange(1, 4) * powers[:-1]), rtol=1e-13)
    np.testing.assert_allclose(qdd, coefficients[1, :, 2:] @ ([2.0, 6.0] * powers[:-2]), rtol=1e-13)


def test_extremes_are_those_of_dense_sampling() -> None:
    trajectory = bik.Trajectory(TIME, random_pieces(degree=5))
    _, qd, qdd = trajectory.at(np.linspace(0.0, 2.0, 200_001))
    np.testing.assert_allclose(trajectory.max_velocity(), np.abs(qd).max(axis=0), rtol=1e-6)
    np.testing.assert_allclose(trajectory.max_acceleration(), np.abs(qdd).max(axis=0), rtol=1e-3)


@pytest.mark.parametrize("pause", [0.0, 0.5])
def test_one_motion_follows_the_other(pause: float) -> None:
    arm = bik.Robot.named("ur5e")
    home, pick, place = 0.3 * arm.random_configurations(3, seed=5)
    there = bik.plan_point_to_point(arm, start_q=home, end_q=pick, limits=bik.Limits(acceleration=3.0)).trajectory
    back = bik.time_optimal([pick, place], bik.Limits(velocity=1.0, acceleration=2.0), joint_names=arm.joint_names)
    both = there.then(back, pause=pause)
    assert both.joint_names == arm.joint_names
    assert both.duration == pytest.approx(there.duration + pause + back.duration, rel=1e-15)
    t = np.linspace(0.0, back.duration, 50)
    for before, after in zip(back.at(t), both.at(there.duration + pause + t), strict=True):
        np.testing.assert_allclose(after, before, atol=1e-9)
    np.testing.assert_array_equal(both.at(0.7 * there.duration), there.at(0.7 * there.duration))
    np.testing.assert_allclose(both.at(there.duration + 0.5 * pause)[0], pick, atol=1e-12)


def test_what_cannot_follow_is_told() -> None:
    one = bik.Trajectory.from_samples([0.0, 1.0], [[0.0], [1.0]], joint_names=["a"])
    other = bik.Trajectory.from_samples([0.0, 1.0], [[1.0], [2.0]], joint_names=["b"])
    for call, says in (
        (lambda: one.then(one), "trajectory: joint 'a' jumps from 1 to 0 at t = 1 s"),
        (lambda: one.then(one, pause=0.5), "trajectory: joint 'a' jumps from 1 to 0 at t = 1 s"),
        (lambda: one.then(other), "trajectory: the motion that follows moves other joints: b instead of a"),
        (lambda: one.then(one, pause=-1.0), "pause must be from 0 to 1000000 s, got -1"),
    ):
        with pytest.raises(bik.InvalidInputError) as caught:
            call()
        assert str(caught.value) == says


def test_a_jump_is_no_motion() -> None:
    coefficients = random_pieces(degree=1)
    coefficients[1, 0, 0] = coefficients[0, 0] @ [1.0, 0.5] + 1.0
    with pytest.raises(bik.InvalidInputError, match=r"^trajectory: joint 'q1' jumps from .* to .* at t = 0.5 s$"):
        bik.Trajectory(TIME, coefficients)


def test_a_trajectory_takes_one_time_or_many() -> None:
    trajectory = bik.Trajectory.from_samples(TIME, motion(TIME)[0])
    for single, several in zip(trajectory.at(0.7), trajectory.at([0.7, 0.9]), strict=True):
        assert (single.shape, several.shape) == ((2,), (2, 2))
        np.testing.assert_array_equal(single, several[0])


def test_times_outside_are_clamped() -> None:
    trajectory = bik.Trajectory.from_samples(TIME, motion(TIME)[0])
    np.testing.assert_array_equal(trajectory.at([-1.0, 9.0])[0], trajectory.at([0.0, 2.0])[0])


def test_samples_end_at_the_end() -> None:
    trajectory = bik.Trajectory.from_samples(TIME, motion(TIME)[0])
    time, q, qd, qdd = trajectory.sample(0.3)
    np.testing.assert_allclose(time, [0.0, 0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.0], rtol=0, atol=1e-15)
    for sampled, expected in zip((q, qd, qdd), trajectory.at(time), strict=True):
        np.testing.assert_array_equal(sampled, expected)


def test_samples_at_the_knots_are_properties() -> None:
    q, qd, qdd = motion(TIME)
    trajectory = bik.Trajectory.from_samples(TIME, q, qd=qd, qdd=qdd)
    np.testing.assert_allclose(trajectory.q, q, rtol=0, atol=1e-13)
    np.testing.assert_allclose(trajectory.qd, qd, rtol=0, atol=1e-12)
    np.testing.assert_allclose(trajectory.qdd, qdd, rtol=0, atol=1e-11)
    np.testing.assert_array_equal(trajectory.time, TIME)
    assert repr(trajectory) == "<Trajectory of 2 joints, 2 s, 4 knots>"
