"""Tracking among obstacles from Python: clearance, messages, moving obstacles, wrong input."""

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import beetle_ik as bik
from beetle_ik.cli.app import app

READY = np.array([0.0, -0.4, 0.0, -2.2, 0.0, 1.9, 0.78])
ROBOT = bik.Robot.named("panda").with_capsules(radius=0.05)
TIP = ROBOT.fk(READY)
WALL = bik.obstacles.Box(TIP[:3, 3] + (0.0, 0.2, 0.0), (0.3, 0.04, 0.6))
LIMITS = bik.Limits(velocity=1.5, acceleration=5.0)


def behind_the_wall() -> np.ndarray:
    target = TIP.copy()
    target[1, 3] += 0.3
    return target


@pytest.mark.parametrize("limits", [None, LIMITS, bik.Limits(velocity=1.5, acceleration=5.0, jerk=50.0)])
def test_a_wall_holds_the_arm_and_the_step_says_so(limits: bik.Limits | None) -> None:
    tracker = bik.Tracker(ROBOT, READY, dt=0.01, limits=limits, obstacles=[WALL], margin=0.01)
    for _ in range(200):
        step = tracker.step(behind_the_wall())
        assert step.clearance >= 0.01
        assert step.clearance == bik.obstacles.clearance(ROBOT, step.q, [WALL])
    assert step.status == bik.Status.HELD_BY_OBSTACLE
    assert not step.success
    assert "held back by an obstacle or another link" in step.message
    assert "m from obstacle 0 (Box))" in step.message
    assert step.nearest is not None
    assert step.nearest.other == "obstacle 0 (Box)"
    again = pickle.loads(pickle.dumps(step))
    assert (again.clearance, again.nearest, again.message) == (step.clearance, step.nearest, step.message)


def test_without_obstacles_nothing_is_checked_and_nothing_changes() -> None:
    plain = bik.Tracker(ROBOT, READY, dt=0.01, limits=LIMITS)
    far = bik.Tracker(ROBOT, READY, dt=0.01, limits=LIMITS, obstacles=[bik.obstacles.Sphere((5.0, 0.0, 0.0), 0.1)])
    for _ in range(50):
        one, other = plain.step(behind_the_wall()), far.step(behind_the_wall())
        np.testing.assert_array_equal(one.q, other.q)
    assert np.isnan(one.clearance)
    assert one.nearest is None
    assert plain.obstacles is None
    assert other.clearance < 5.0


def test_links_alone_keep_clear_of_each_other() -> None:
    thick = bik.Robot.named("panda").with_capsules(radius=0.08)
    start = [0.0, 0.0, 0.0, -1.5, 0.0, 1.6, 0.8]
    folded = thick.fk([-0.08, -1.56, 2.46, -2.76, 1.1, 1.04, 1.76])
    least = {}
    for checked in (None, True):
        tracker = bik.Tracker(thick, start, dt=0.01, self_collision=checked)
        least[checked] = min(bik.obstacles.clearance(thick, tracker.step(folded).q) for _ in range(300))
    assert least[None] < 0.0
    assert least[True] >= 1e-3


def test_obstacles_are_replaced_between_ticks() -> None:
    tracker = bik.Tracker(ROBOT, READY, dt=0.01, limits=LIMITS, margin=0.01, obstacles=[])
    assert tracker.obstacles == ()
    for tick in range(150):
        ball = bik.obstacles.Sphere(TIP[:3, 3] + (0.0, 0.6 - 0.003 * tick, 0.0), 0.1)
        moving = bik.obstacles.Moving(ball, (0.0, -0.3, 0.0))
        tracker.obstacles = [WALL, moving]
        step = tracker.step(TIP)
        assert step.clearance >= 0.01, tick
    assert tracker.obstacles == (WALL, moving)
    assert step.status == bik.Status.HELD_BY_OBSTACLE
    tracker.obstacles = None
    for _ in range(200):
        step = tracker.step(TIP)
    assert step.success
    assert np.isnan(step.clearance)


def test_a_moving_obstacle_is_a_value() -> None:
    moving = bik.obstacles.Moving(WALL, [0.0, 0.1, 0.0])
    assert moving == pickle.loads(pickle.dumps(moving))
    assert hash(moving) == hash(bik.obstacles.Moving(WALL, (0.0, 0.1, 0.0)))
    assert moving != bik.obstacles.Moving(WALL, (0.0, 0.2, 0.0))
    assert moving.shape == WALL
    np.testing.assert_array_equal(moving.velocity, [0.0, 0.1, 0.0])
    assert repr(moving) == f"obstacles.Moving({WALL!r}, [0.0, 0.1, 0.0])"


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (
            lambda: bik.solve(ROBOT, TIP, obstacles=[bik.obstacles.Moving(WALL, (0, 0, 1))]),  # type: ignore[list-item]
            "obstacle 0 is a Moving; only a Tracker takes obstacles that move: give its shape",
        ),
        (lambda: bik.obstacles.Moving(3, (0, 0, 1)), "shape must be made by bik.obstacles"),  # type: ignore[arg-type]
        (lambda: bik.obstacles.Moving(WALL, (0, 0)), "velocity: expected shape (3,), got (2,)"),
        (lambda: bik.obstacles.Moving(WALL, (0, 0, np.nan)), "velocity must be finite"),
        (lambda: bik.Tracker(ROBOT, READY, dt=0.01, obstacles=[3]), "obstacle 0 must be made by bik.obstacles"),  # type: ignore[list-item]
        (lambda: bik.Tracker(bik.Robot.named("panda"), READY, dt=0.01, obstacles=[WALL]), "has no capsules"),
        (lambda: bik.Tracker(ROBOT, READY, dt=0.01, margin=0.1), "margin= needs obstacles="),
        (lambda: bik.Tracker(ROBOT, READY, dt=0.01, obstacles=[WALL], margin=-1), "margin must be zero or more"),
    ],
)
def test_wrong_input_is_named(call: Any, words: str) -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        call()
    assert words in str(caught.value)


def test_wrong_obstacles_leave_the_tracker_as_it_was() -> None:
    tracker = bik.Tracker(ROBOT, READY, dt=0.01, obstacles=[WALL])
    with pytest.raises(bik.InvalidInputError):
        tracker.obstacles = [WALL, 3]  # type: ignore[list-item]
    assert tracker.obstacles == (WALL,)


def circle() -> bik.Path:
    center = TIP[:3, 3] - (0.1, 0.0, 0.0)
    return bik.paths.circle(center=center, diameter=0.2, duration=4.0)


def test_a_track_keeps_clear_and_says_what_held_it() -> None:
    wall = bik.obstacles.Box(TIP[:3, 3] + (-0.1, 0.12, 0.0), (0.3, 0.04, 0.6))
    result = bik.track(ROBOT, circle(), READY, dt=0.02, obstacles=[wall], margin=0.01)
    assert result.status == bik.Status.LOST
    assert "an obstacle or another link held the arm back" in result.message
    assert result.clearance.shape == result.time.shape
    assert result.clearance.min() >= 0.01
    np.testing.assert_array_equal(result.clearance, bik.obstacles.clearance(ROBOT, result.q, [wall]))
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(result)).clearance, result.clearance)
    free = bik.track(ROBOT, circle(), READY, dt=0.02)
    assert free.success
    assert np.isnan(free.clearance).all()


def test_an_approach_is_not_kept_clear_and_refused() -> None:
    with pytest.raises(bik.InvalidInputError, match="the approach of ease=True is not kept clear of obstacles"):
        bik.track(ROBOT, circle(), READY, dt=0.02, limits=LIMITS, ease=True, obstacles=[WALL])


@pytest.mark.parametrize(
    "obstacle",
    [bik.obstacles.Sphere((0.0, 0.0, 0.5), 2.0), bik.obstacles.HalfSpace((0.0, 0.0, 1.0), 0.4)],
    ids=["round the whole arm", "floor above the foot"],
)
def test_an_arm_that_nothing_can_clear_says_so(obstacle: bik.obstacles.Obstacle) -> None:
    tracker = bik.Tracker(ROBOT, READY, dt=0.01, limits=LIMITS, obstacles=[obstacle])
    for _ in range(50):
        step = tracker.step(TIP)
    assert step.status == bik.Status.IN_COLLISION
    assert step.clearance < 0.0
    assert "nearer than the margin to an obstacle or another link" in step.message
    assert step.inside_limits


def test_on_the_command_line(tmp_path: Path) -> None:
    wall = bik.obstacles.Box((0.3, 0.35, 0.5), (0.6, 0.04, 1.0))
    bik.Scene([wall]).save(tmp_path / "scene.json")
    options = ["--curve", "circle", "--diameter", "0.4", "--center", "0.45,0.2,0.5", "--duration", "4", "--dt", "0.02"]
    scene = ["--scene", str(tmp_path / "scene.json"), "--margin", "0.02", "--link-radius", "0.06"]
    ended = CliRunner().invoke(app, ["track", "panda", *options, *scene, "--json"])
    assert ended.exit_code == 1
    summary = json.loads(ended.stdout)
    assert summary["clearance"] >= 0.02
    assert "an obstacle or another link held the arm back" in summary["message"]
    shown = CliRunner().invoke(app, ["track", "panda", *options, *scene])
    assert "smallest clearance [m]" in shown.stdout
    free = CliRunner().invoke(app, ["track", "panda", *options, "--json"])
    assert json.loads(free.stdout)["clearance"] is None
