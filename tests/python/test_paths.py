"""Reference paths against their formulas."""

import numpy as np
import pytest
from numpy.typing import NDArray

import beetle_ik as bik

Array = NDArray[np.float64]

CENTER = np.array([0.3, -0.2, 1.0])
A, B = np.array([0.6, 0.8, 0.0]), np.array([0.0, 0.0, -1.0])  # orthonormal, of no coordinate plane
DURATION = 8.0
TIMES = np.linspace(0.0, DURATION, 65)


def in_plane(u: Array, v: Array) -> Array:
    """Points at coordinates u along `A`, v along `B`, from the centre."""
    return CENTER + np.outer(u, A) + np.outer(v, B)


def assert_passes_through(path: bik.Path, times: Array, points: Array) -> None:
    np.testing.assert_allclose(path.position(times), points, rtol=0, atol=1e-14)


def assert_velocity_is_the_derivative(path: bik.Path, times: Array) -> None:
    step = 1e-5
    difference = (path.position(times + step) - path.position(times - step)) / (2 * step)
    np.testing.assert_allclose(path.velocity(times), difference, rtol=0, atol=1e-7)


def test_circle_follows_its_equation() -> None:
    path = bik.paths.circle(CENTER, 0.5, DURATION, a=A, b=B)
    angle = 2 * np.pi * TIMES / DURATION
    assert_passes_through(path, TIMES, in_plane(0.25 * np.cos(angle), 0.25 * np.sin(angle)))
    assert_velocity_is_the_derivative(path, TIMES[1:-1])
    assert path.duration == DURATION
    assert repr(path) == "<Path of 8 s>"


@pytest.mark.parametrize(("k", "turns"), [(2, 1.0), (3, 0.5), (4, 1.0), (5, 0.5)])
def test_rose_follows_its_equation(k: int, turns: float) -> None:
    path = bik.paths.rose(CENTER, DURATION, radius=0.2, k=k, a=A, b=B)
    angle = 2 * np.pi * turns * TIMES / DURATION  # an odd rose is complete after half a turn
    distance = 0.2 * np.cos(k * angle)
    assert_passes_through(path, TIMES, in_plane(distance * np.cos(angle), distance * np.sin(angle)))
    assert_velocity_is_the_derivative(path, TIMES[1:-1])


def test_hypotrochoid_follows_its_equation() -> None:
    path = bik.paths.hypotrochoid(CENTER, DURATION, outer_radius=0.5, inner_radius=0.3, distance=0.4, a=A, b=B)
    turn = 6 * np.pi * TIMES / DURATION  # closes after lcm(0.3, 0.5) / 0.5 = 3 rounds
    ratio = 0.2 / 0.3
    u = 0.2 * np.cos(turn) + 0.4 * np.cos(ratio * turn)
    v = 0.2 * np.sin(turn) - 0.4 * np.sin(ratio * turn)
    assert_passes_through(path, TIMES, in_plane(u, v))
    assert_velocity_is_the_derivative(path, TIMES[1:-1])


def test_letter_m_passes_through_its_corners() -> None:
    path = bik.paths.letter_m(CENTER, DURATION, width=0.4, height=0.6, a=A, b=B)
    corners = path.position(np.linspace(0.0, DURATION, 5))
    u, v = ((corners - CENTER) @ axis for axis in (A, B))
    np.testing.assert_allclose(u, [-0.2, -0.2, 0.0, 0.2, 0.2], rtol=0, atol=1e-15)
    assert (v[0], v[1]) == (pytest.approx(-0.3), pytest.approx(0.3))
    assert (v[3], v[4]) == (pytest.approx(0.3), pytest.approx(-0.3))
    assert v[2] < v[1]


def test_pentagram_passes_through_its_points() -> None:
    path = bik.paths.pentagram(CENTER, DURATION, radius=0.3, a=A, b=B)
    angle = np.pi / 2 + np.arange(6) * 4 * np.pi / 5
    points = path.position(np.linspace(0.0, DURATION, 6))
    expected = in_plane(0.3 * np.cos(angle), 0.3 * np.sin(angle))
    mirrored = in_plane(-0.3 * np.cos(angle), 0.3 * np.sin(angle))
    assert min(np.abs(points - expected).max(), np.abs(points - mirrored).max()) < 1e-14
    speed = np.linalg.norm(path.velocity(TIMES), axis=1)
    np.testing.assert_allclose(speed, speed[0], rtol=1e-12)


def test_polyline_keeps_its_speed() -> None:
    path = bik.paths.polyline([[0, 0, 0], [1, 0, 0], [1, 3, 0]], duration=4.0)
    np.testing.assert_allclose(
        path.position([0, 0.5, 1, 2, 4]), [[0, 0, 0], [0.5, 0, 0], [1, 0, 0], [1, 1, 0], [1, 3, 0]]
    )
    np.testing.assert_allclose(path.velocity([0.5, 3.0]), [[1, 0, 0], [0, 1, 0]])


def test_times_outside_are_clamped() -> None:
    path = bik.paths.polyline([[0, 0, 0], [1, 0, 0]], duration=1.0)
    np.testing.assert_array_equal(path.position([-5.0, 9.0]), [[0, 0, 0], [1, 0, 0]])


def test_a_path_takes_one_time_or_many() -> None:
    path = bik.paths.circle(CENTER, 0.5, DURATION).with_orientation(np.eye(3))
    for method, shape in ((path.position, (3,)), (path.velocity, (3,)), (path.pose, (4, 4))):
        single, several = method(1.0), method([1.0, 2.0])
        assert (single.shape, several.shape) == (shape, (2, *shape))
        np.testing.assert_array_equal(single, several[0])


def test_samples_are_joined_by_straight_lines() -> None:
    time, points = [0.0, 1.0, 3.0], np.array([[0, 0, 0], [1, 2, 3], [1, 2, 5]])
    path = bik.paths.from_samples(time, points)
    np.testing.assert_allclose(
        path.position([0, 0.5, 1, 2, 3]), [[0, 0, 0], [0.5, 1, 1.5], [1, 2, 3], [1, 2, 4], [1, 2, 5]]
    )
    assert path.duration == 3.0


def test_samples_of_poses_turn_at_constant_speed() -> None:
    poses = [bik.pose([0, 0, 0]), bik.pose([1, 0, 0], rotvec=[0, 0, 1.0])]
    path = bik.paths.from_samples([0.0, 2.0], poses)
    np.testing.assert_allclose(path.pose(0.5), bik.pose([0.25, 0, 0], rotvec=[0, 0, 0.25]), rtol=0, atol=1e-15)
    assert repr(path) == "<Path of 2 s, with orientation>"


def test_a_function_is_the_path() -> None:
    path = bik.paths.from_function(lambda t: (np.cos(t), np.sin(t), t), duration=3.0)
    np.testing.assert_array_equal(path.position(1.0), [np.cos(1.0), np.sin(1.0), 1.0])
    times = np.array([0.0, 1.0, 3.0])  # at the ends the difference is one-sided
    expected = np.column_stack((-np.sin(times), np.cos(times), np.ones(3)))
    np.testing.assert_allclose(path.velocity(times), expected, rtol=0, atol=1e-4)


def test_a_function_is_asked_only_within_its_duration() -> None:
    asked: list[float] = []

    def path(t: float) -> list[float]:
        asked.append(t)
        return [t, 0.0, 0.0]

    time, positions = bik.paths.from_function(path, duration=1.0).sample(0.3)
    np.testing.assert_allclose(time, [0.0, 0.3, 0.6, 0.9, 1.2])
    np.testing.assert_allclose(positions[:, 0], [0.0, 0.3, 0.6, 0.9, 1.0])
    assert (min(asked), max(asked)) == (0.0, 1.0)


class OwnError(Exception):
    """An error of the user's."""


def test_what_a_function_raises_comes_out_unchanged() -> None:
    error = OwnError("the sensor is off")

    def path(t: float) -> list[float]:
        if t > 0.5:
            raise error
        return [t, 0.0, 0.0]

    broken = bik.paths.from_function(path, duration=1.0)
    assert broken.position(0.5)[0] == 0.5
    calls = [lambda: broken.position(0.75), lambda: broken.velocity([0.75]), lambda: broken.sample(0.1)]
    calls += [lambda: bik.track(bik.Robot.planar([1.0, 1.0]), broken, [0.1, 0.2], dt=0.1)]
    for call in calls:
        with pytest.raises(OwnError) as caught:
            call()
        assert caught.value is error


def test_orientation_by_a_matrix_or_a_function() -> None:
    circle = bik.paths.circle(CENTER, 0.5, DURATION)
    down = np.diag([1.0, -1.0, -1.0])
    held = circle.with_orientation(down)
    np.testing.assert_array_equal(held.pose(1.0)[:3, :3], down)
    np.testing.assert_array_equal(held.pose(1.0)[:3, 3], circle.position(1.0))
    turning = circle.with_orientation(lambda t: bik.pose([0, 0, 0], rotvec=[0, 0, t])[:3, :3])
    np.testing.assert_allclose(turning.pose(1.5)[:3, :3], bik.pose([0, 0, 0], rotvec=[0, 0, 1.5])[:3, :3], atol=1e-15)
    assert (repr(held), repr(circle)) == ("<Path of 8 s, with orientation>", "<Path of 8 s>")


def test_orientation_of_samples_can_be_replaced() -> None:
    path = bik.paths.from_samples([0.0, 1.0], [np.eye(4), bik.pose([1, 0, 0], rpy=[1, 0, 0])])
    np.testing.assert_array_equal(path.with_orientation(np.eye(3)).pose(1.0)[:3, :3], np.eye(3))


@pytest.mark.parametrize(("duration", "dt", "ticks"), [(3.0, 0.1, 30), (1.0, 0.3, 4), (0.7, 0.7, 1)])
def test_ticks_cover_the_duration(duration: float, dt: float, ticks: int) -> None:
    path = bik.paths.circle(CENTER, 0.5, duration)
    time, positions = path.sample(dt)
    np.testing.assert_array_equal(time, dt * np.arange(ticks + 1))
    np.testing.assert_array_equal(positions, path.position(time))
