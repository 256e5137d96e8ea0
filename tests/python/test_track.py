"""Tracking: the BAS paper's circle, and the arrays of a result."""

import hashlib
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from iiwa_circle import CIRCLE, IIWA, LIMITS, START
from mistakes import SLACK

import beetle_ik as bik

DT = 0.2


def follow_paper(**options: object) -> bik.TrackResult:
    return bik.track(IIWA, CIRCLE, START, dt=DT, limits=LIMITS, **options)


@pytest.mark.parametrize(
    ("solver", "band", "steady", "most_evaluations"),
    # The bands and counts of Cheng et al. (2020) as the notes to it read them; greedy goes to any band.
    [
        (bik.papers.BAS(variant="star"), 1.7e-5, (8e-6, 1.3e-5), 200_000),
        (bik.papers.BAS(variant="chain"), 2.2e-5, (8e-6, 1.3e-5), 65_000),
        (bik.papers.BAS(variant="chain"), 1e-3, (4e-4, 7e-4), 25_000),
        (bik.papers.BAS(variant="greedy"), 1e-9, (0.0, 1e-9), 100_000),
        (None, 1e-9, (0.0, 1e-9), 1_000),
    ],
    ids=["star", "chain", "chain, 1 mm", "greedy", "default"],
)
def test_the_papers_circle_is_followed_within_its_band(
    solver: object, band: float, steady: tuple[float, float], most_evaluations: int
) -> None:
    for seed in range(4):
        result = follow_paper(solver=solver, position_tolerance=band, seed=seed)
        assert result.success, result.message
        assert steady[0] <= result.position_error[75:].mean() <= steady[1]
        assert result.evaluations <= most_evaluations
        assert bik.Status.CAPPED not in result.step_status
        assert np.all(np.abs(result.qd[1:]) <= result.velocity_limit[1:] + 1e-12)
        assert np.all((IIWA.lower <= result.q) & (result.q <= IIWA.upper))
        assert result.max_violation == 0.0


@pytest.fixture(scope="module")
def followed() -> bik.TrackResult:
    return follow_paper(solver=bik.papers.BAS(variant="chain"), position_tolerance=1e-4)


def test_columns_have_the_documented_shapes(followed: bik.TrackResult) -> None:
    k, n = 151, 7
    for name, shape in {
        "time": (k,),
        "q": (k, n),
        "qd": (k, n),
        "velocity_limit": (k, n),
        "position": (k, 3),
        "reference": (k, 3),
        "position_error": (k,),
        "rotation_error": (k,),
        "step_status": (k,),
        "step_evaluations": (k,),
        "step_iterations": (k,),
    }.items():
        array = getattr(followed, name)
        assert array.shape == shape, name
        assert not array.flags.writeable, name
        assert getattr(followed, name) is array, f"{name} is made once"
    assert len(followed) == k


def test_rows_mean_what_they_say(followed: bik.TrackResult) -> None:
    np.testing.assert_array_equal(followed.time, DT * np.arange(151))
    np.testing.assert_array_equal(followed.q[0], START)
    np.testing.assert_array_equal(followed.qd[0], np.zeros(7))
    np.testing.assert_array_equal(followed.qd[1:], np.diff(followed.q, axis=0) / DT)
    np.testing.assert_array_equal(followed.reference, CIRCLE.position(followed.time))
    np.testing.assert_allclose(followed.position, IIWA.fk(followed.q)[:, :3, 3], rtol=0, atol=1e-15)
    distance = np.linalg.norm(followed.position - followed.reference, axis=1)
    np.testing.assert_allclose(followed.position_error, distance, rtol=0, atol=1e-15)
    assert np.all(np.isnan(followed.rotation_error))
    assert np.all(np.isnan(followed.velocity_limit[0]))


def test_statuses_follow_from_errors(followed: bik.TrackResult) -> None:
    error, status = followed.position_error, followed.step_status
    np.testing.assert_array_equal(status == bik.Status.SOLVED, error <= followed.position_tolerance)
    improved = np.flatnonzero(status == bik.Status.IMPROVED)
    assert np.all(error[improved[1:]] < error[improved[1:] - 1])
    assert (status[0], error[0] > 0.09) == (bik.Status.IMPROVED, True)
    assert followed.status is bik.Status.SOLVED


def test_totals_are_those_of_the_steps(followed: bik.TrackResult) -> None:
    assert followed.evaluations == followed.step_evaluations.sum()
    assert (followed.step_evaluations[0], followed.step_iterations[0]) == (1, 0)
    margin = (followed.velocity_limit[1:] - np.abs(followed.qd[1:])).min()
    assert followed.limit_margin == pytest.approx(margin, abs=1e-12)
    assert followed.limits.velocity == LIMITS.velocity
    assert followed.robot == IIWA
    assert followed.elapsed > 0.0
    joined = followed.time[np.argmax(followed.step_status == bik.Status.SOLVED)]
    assert followed.message.startswith(f"in the band of 1.000e-4 m from t = {joined:g} s on; worst error there ")
    assert repr(followed).startswith("<TrackResult SOLVED: 151 rows, in the band")


def test_the_trajectory_has_the_velocities_of_the_track(followed: bik.TrackResult) -> None:
    trajectory = followed.trajectory
    assert trajectory.joint_names == IIWA.joint_names
    np.testing.assert_array_equal(trajectory.q, followed.q)
    middles = trajectory.at(followed.time[:-1] + 0.5 * DT)
    np.testing.assert_allclose(middles[1], followed.qd[1:], rtol=0, atol=1e-12)
    np.testing.assert_allclose(trajectory.max_velocity(), np.abs(followed.qd).max(axis=0), rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    "solver", [bik.papers.BAS(), bik.papers.BAS(variant="greedy"), None], ids=["star", "greedy", "default"]
)
def test_limits_hold_where_the_path_is_out_of_reach(solver: object) -> None:
    robot = bik.Robot.planar([1.0] * 5)
    limits = bik.Limits(velocity=bik.Sinusoid(mean=0.2, amplitude=0.004, angular_frequency=1.0))
    far = bik.paths.circle((4.0, 1.0, 0.0), diameter=2.2, duration=10.0)
    result = bik.track(robot, far, [0.1] * 5, dt=0.2, solver=solver, limits=limits, position_tolerance=4e-5)
    assert not result.success
    assert result.status is not bik.Status.SOLVED
    assert np.all(np.abs(result.qd[1:]) <= result.velocity_limit[1:] + 1e-12)
    assert result.max_violation == 0.0
    assert len(result) == 51
    assert "the path is out of reach by at least 0." in result.message
    assert result.message.endswith("move or turn the target into reach, or move the base")


def test_limits_too_small_to_follow_end_in_a_status() -> None:
    result = bik.track(IIWA, CIRCLE, START, dt=DT, limits=bik.Limits(velocity=1e-4))
    assert result.status in (bik.Status.IMPROVED, bik.Status.CAPPED)
    assert result.message.startswith("never came within 1.000e-6 m (nearest ")
    assert np.abs(result.qd).max() <= 1e-4 + 1e-12


def test_without_a_start_the_first_point_is_solved_for() -> None:
    result = bik.track(IIWA, CIRCLE, dt=DT, limits=LIMITS)
    assert result.success, result.message
    assert result.position_error[0] <= 1e-6
    assert result.step_status[0] == bik.Status.SOLVED


def test_a_start_outside_its_limits_is_refused() -> None:
    start = START.copy()
    start[3] = -2.5
    with pytest.raises(bik.LimitError) as caught:
        bik.track(IIWA, CIRCLE, start, dt=DT)
    assert str(caught.value) == (
        f"start_q: joint 'joint_a4' at -2.5 is outside its limits [-2.0943951023931953, 2.0943951023931953] by "
        f"0.4056 rad: {SLACK}"
    )


def test_poses_along_a_path_are_followed() -> None:
    robot = bik.Robot.named("panda")
    start = np.array([0.0, -0.5, 0.0, -2.0, 0.0, 1.8, 0.8])
    first = robot.fk(start)
    circle = bik.paths.circle(first[:3, 3] - [0.1, 0.0, 0.0], diameter=0.2, duration=6.0)
    for orientation in (first[:3, :3], lambda t: first[:3, :3] @ bik.pose([0, 0, 0], rotvec=[0, 0, 0.1 * t])[:3, :3]):
        path = circle.with_orientation(orientation)
        result = bik.track(robot, path, start, dt=0.05, rotation_tolerance=1e-7)
        assert result.success, result.message
        np.testing.assert_allclose(robot.fk(result.q), path.pose(result.time), rtol=0, atol=2e-6)
        assert np.all(result.rotation_error <= 1e-7)


@pytest.mark.parametrize("variant", ["star", "chain", "greedy"])
def test_a_beetle_keeps_near_to_poses(variant: str) -> None:
    robot = bik.Robot.named("panda")
    start = np.array([0.0, -0.5, 0.0, -2.0, 0.0, 1.8, 0.8])
    first = robot.fk(start)
    line = bik.paths.polyline([first[:3, 3], first[:3, 3] + [0.0, 0.05, 0.0]], duration=1.0)
    path = line.with_orientation(first[:3, :3])
    result = bik.track(robot, path, start, dt=0.1, solver=bik.papers.BAS(variant=variant), position_tolerance=1e-3)
    assert result.position_error.max() < 2e-2
    assert result.rotation_error.max() < 5e-2
    assert result.max_violation == 0.0


def test_progress_counts_the_steps() -> None:
    calls: list[tuple[int, int]] = []
    follow_paper(progress=lambda done, total: calls.append((done, total)))
    assert calls[-1] == (150, 150)
    assert [done for done, _ in calls] == sorted({done for done, _ in calls})


def test_what_progress_raises_comes_out_unchanged() -> None:
    error = RuntimeError("the window is closed")

    def progress(_done: int, _total: int) -> None:
        raise error

    with pytest.raises(RuntimeError) as caught:
        follow_paper(progress=progress)
    assert caught.value is error


@pytest.mark.parametrize("progress", [True, False])
def test_a_progress_bar_is_silent_without_a_terminal(progress: bool, capfd: pytest.CaptureFixture[str]) -> None:
    follow_paper(progress=progress)
    assert capfd.readouterr() == ("", "")


def digest_of_paper(solver: object) -> str:
    return hashlib.sha256(follow_paper(solver=solver, seed=7).q.tobytes()).hexdigest()


@pytest.mark.parametrize(
    "solver", [bik.papers.BAS(variant="chain"), bik.MultiStart(bik.LevenbergMarquardt())], ids=repr
)
def test_the_same_seed_gives_the_same_bits_in_every_process(solver: object) -> None:
    here = digest_of_paper(solver)
    assert digest_of_paper(solver) == here
    names = "from beetle_ik import *; from beetle_ik.papers import *; import test_track"
    program = f"{names}; print(test_track.digest_of_paper({solver!r}))"
    folder = Path(__file__).parent
    elsewhere = subprocess.run([sys.executable, "-c", program], cwd=folder, check=True, capture_output=True, text=True)
    assert elsewhere.stdout.strip() == here


def test_another_seed_gives_another_motion() -> None:
    first, second = (follow_paper(solver=bik.papers.BAS(), seed=seed).q for seed in (1, 2))
    assert not np.array_equal(first, second)
