"""Scenes of the recordings on the site: those of the gallery's examples, and some of their own."""

from __future__ import annotations

import contextlib
import io
import os
import runpy
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from viser.transforms import SO3

import beetle_ik as bik

EXAMPLES = Path(__file__).parents[2] / "examples"
TICK = 0.02  # s
READY = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])
FRONT, SIDE, WIDE = (1.15, -0.95, 0.9), (-0.35, -1.3, 1.2), (1.5, -1.25, 1.2)  # m, where the camera is
CENTER = (0.2, 0.0, 0.38)  # m, what it looks at


class Recorded(NamedTuple):
    """A viewer, and the frames of a recording; None: the motion that the viewer shows."""

    viewer: bik.Viewer
    frames: Iterator[float] | None = None


class Example(NamedTuple):
    """Names of an example's variables, and a camera."""

    robot: str = "robot"
    result: str = "result"
    obstacles: tuple[str, ...] = ()
    camera: tuple[float, float, float] = FRONT
    at: tuple[float, float, float] = CENTER


OF_EXAMPLES = {
    "01_pose_ik": Example(result="solution"),
    "02_your_urdf": Example(result="solution", camera=WIDE, at=(0.2, 0.0, 0.5)),
    "03_pointing": Example(result="pointing"),
    "05_all_solutions": Example(result="solutions"),
    "06_self_motion": Example(result="longest"),
    "07_waypoints_in_minimum_time": Example(result="trajectory"),
    "08_retime_a_recording": Example(result="motion"),
    "09_change_of_target": Example(result="to_first"),
    "10_around_an_obstacle": Example(result="plan", camera=(1.5, -0.9, 1.0)),
    "12_among_obstacles": Example(result="around", obstacles=("scene",)),
    "13_path_among_obstacles": Example(result="around", obstacles=("scene",)),
    "15_drawing_at_constant_speed": Example(),
    "17_joint_at_its_limit": Example(camera=WIDE, at=(0.2, 0.0, 0.65)),
    "20_motion_for_ros": Example(result="plan"),
    "22_mobile_base": Example(result="plan", camera=(1.0, -1.9, 2.2), at=(0.8, 0.7, 0.6)),
    "26_circle_by_bas": Example(camera=WIDE, at=(0.2, 0.1, 0.6)),
    "28_without_a_model": Example(robot="drawn", result="without", camera=WIDE, at=(0.2, 0.1, 0.6)),
}


def variables(name: str) -> dict[str, Any]:
    """Returns the variables that an example leaves, without what it prints, draws and writes."""
    folder = Path.cwd()
    with tempfile.TemporaryDirectory() as scratch, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a figure is not shown
        os.chdir(scratch)
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                return runpy.run_path(str(EXAMPLES / f"{name}.py"))
        finally:
            os.chdir(folder)
            plt.close("all")


@contextmanager
def viewed(robot: bik.Robot, q: Any = None, *, camera: Any = FRONT, at: Any = CENTER, **options: Any) -> Iterator[Any]:
    """Yields a viewer that is seen from `camera`."""
    with contextlib.redirect_stdout(io.StringIO()), bik.view(robot, q, port=0, **options) as viewer:
        viewer.server.initial_camera.position = camera
        viewer.server.initial_camera.look_at = at
        yield viewer


@contextmanager
def of_example(name: str) -> Iterator[Recorded]:
    """Yields the scene that an example leaves."""
    wanted, left = OF_EXAMPLES[name], variables(name)
    obstacles = [each for key in wanted.obstacles for each in left[key]]
    with viewed(left[wanted.robot], obstacles=obstacles, camera=wanted.camera, at=wanted.at) as viewer:
        viewer.show(left[wanted.result])
        yield Recorded(viewer)


@contextmanager
def pick_and_place() -> Iterator[Recorded]:
    """Yields a pick, in which the part moves with the gripper."""
    left = variables("11_pick_and_place")
    gripper, motion, part = left["gripper"], left["whole"], left["part"]
    grasped = left["pick"].trajectory.duration
    inverse = np.linalg.inv(gripper.fk(motion.at(grasped)[0]))
    with viewed(gripper, motion.q[0], camera=(1.25, 0.75, 0.8), at=(0.3, -0.05, 0.22)) as viewer:
        viewer.follow = "off"

        def frames() -> Iterator[float]:
            for time in np.arange(0.0, motion.duration + 1.0, TICK):
                viewer.q = motion.at(time)[0]
                moved = gripper.fk(viewer.q) @ inverse if time > grasped else np.eye(4)
                center = (moved @ [*part.center, 1.0])[:3]
                viewer.obstacles = [bik.obstacles.Box(center, part.size, moved[:3, :3]), left["wall"]]
                yield TICK

        yield Recorded(viewer, frames())


@contextmanager
def tray() -> Iterator[Recorded]:
    """Yields two arms that carry a tray along a circle."""
    left = variables("21_tray_in_two_hands")
    robot, run = left["robot"], left["together"]
    with viewed(robot, run.q[0], camera=(1.9, -1.2, 1.7), at=(0.3, 0.0, 0.85)) as viewer:
        viewer.follow = "off"
        board = viewer.server.scene.add_box("/tray", color=(242, 177, 52), dimensions=(0.03, 0.5, 0.3))

        def frames() -> Iterator[float]:
            for q in run.q[::2]:
                viewer.q = q
                hands = robot.fk(q)
                board.position = hands[:, :3, 3].mean(axis=0)
                yield 2 * TICK

        yield Recorded(viewer, frames())


@contextmanager
def cup_upright() -> Iterator[Recorded]:
    """Yields a cup that is carried past a wall, upright within ten degrees."""
    left = variables("30_a_cup_upright")
    robot, motion, wall = left["robot"], left["plan"].trajectory, left["wall"]
    with viewed(robot, motion.q[0], camera=(1.5, -0.55, 0.95), at=(0.35, 0.0, 0.35), obstacles=[wall]) as viewer:
        viewer.follow = "off"
        cup = viewer.server.scene.add_cylinder("/cup", radius=0.035, height=0.1, color=(242, 177, 52))

        def frames() -> Iterator[float]:
            for time in np.arange(0.0, motion.duration + 1.0, TICK):
                viewer.q = motion.at(time)[0]
                hand = robot.fk(viewer.q)
                cup.position = hand[:3, 3] + 0.06 * hand[:3, 2]
                cup.wxyz = SO3.from_matrix(hand[:3, :3]).wxyz
                yield TICK

        yield Recorded(viewer, frames())


@contextmanager
def place_first() -> Iterator[Recorded]:
    """Yields an arm with five joints at a row of poses, of which it meets the places alone."""
    left = variables("31_place_first")
    robot, asked, found = left["robot"], left["asked"], left["found"].q
    with viewed(robot, found[0], camera=(0.62, -0.42, 0.42), at=(0.14, 0.04, 0.12)) as viewer:
        viewer.follow = "off"
        wanted = viewer.server.scene.add_frame("/asked", axes_length=0.06, axes_radius=0.002)

        def frames() -> Iterator[float]:
            for k in (*range(len(found)), *reversed(range(len(found)))):
                viewer.q = found[k]
                wanted.position = asked[k][:3, 3]
                wanted.wxyz = SO3.from_matrix(asked[k][:3, :3]).wxyz
                yield 4 * TICK

        yield Recorded(viewer, frames())


@contextmanager
def base_that_stays() -> Iterator[Recorded]:
    """Yields a mobile arm whose heavy base drives only where the arm cannot reach."""
    left = variables("47_base_that_stays")
    robot, targets, heavy = left["robot"], left["targets"], left["heavy"]
    with viewed(robot, heavy[0], camera=(1.9, -2.3, 1.5), at=(0.9, 0.0, 0.4)) as viewer:
        viewer.follow = "off"
        viewer.server.scene.add_line_segments(
            "/path",
            points=np.stack((targets[:-1, :3, 3], targets[1:, :3, 3]), axis=1),
            colors=(242, 177, 52),
            line_width=3.0,
        )

        def frames() -> Iterator[float]:
            for q in heavy[::2]:
                viewer.q = q
                yield 2 * TICK

        yield Recorded(viewer, frames())


@contextmanager
def past_a_shelf() -> Iterator[Recorded]:
    """Yields a plan from one compartment of a shelf to another."""
    robot = bik.Robot.named("panda").with_capsules(radius=0.05)
    boards = [bik.obstacles.Box((0.65, 0.0, z), (0.35, 0.9, 0.02)) for z in (0.15, 0.5, 0.85)]
    boards += [bik.obstacles.Box((0.65, y, 0.5), (0.35, 0.02, 0.72)) for y in (-0.45, 0.0, 0.45)]
    inside = [bik.pose((0.6, y, z), rpy=(0.0, np.pi / 2, 0.0)) for y, z in ((-0.22, 0.32), (0.22, 0.68))]
    start = bik.solve(robot, inside[0], obstacles=boards, margin=0.01).q
    limits = bik.Limits(acceleration=3.0)
    plan = bik.plan_point_to_point(robot, start_q=start, end=inside[1], obstacles=boards, limits=limits)
    with viewed(robot, start, camera=SIDE, at=(0.4, 0.0, 0.45), obstacles=boards) as viewer:
        viewer.show(plan)
        yield Recorded(viewer)


@contextmanager
def dodge() -> Iterator[Recorded]:
    """Yields an arm that moves out of the way of a ball, and back."""
    robot = bik.Robot.named("panda").with_capsules(radius=0.06)
    hand, speed = robot.fk(READY), np.array([0.0, -0.3, 0.0])
    limits = bik.Limits(acceleration=8.0)
    tracker = bik.Tracker(robot, READY, dt=TICK, limits=limits, obstacles=[], margin=0.02)
    with viewed(robot, READY, camera=(1.3, 0.8, 0.9), at=CENTER) as viewer:
        viewer.follow = "off"

        def frames() -> Iterator[float]:
            for time in np.arange(0.0, 6.0, TICK):
                ball = bik.obstacles.Sphere((0.45, 0.9, 0.5) + time * speed, 0.1)
                tracker.obstacles = [bik.obstacles.Moving(ball, velocity=speed)]
                viewer.obstacles = [ball]
                viewer.q = tracker.step(hand).q
                yield TICK

        yield Recorded(viewer, frames())


@contextmanager
def circle() -> Iterator[Recorded]:
    """Yields a tracked circle."""
    robot = bik.Robot.named("iiwa14")
    path = bik.paths.circle((0.45, 0.0, 0.75), diameter=0.5, duration=6.0, a=(0, 1, 0), b=(0, 0, 1))
    with viewed(robot, camera=(1.3, -0.95, 1.1), at=(0.2, 0.0, 0.6)) as viewer:
        viewer.show(bik.track(robot, path, dt=TICK))
        yield Recorded(viewer)


@contextmanager
def reach() -> Iterator[Recorded]:
    """Yields a map of what an arm reaches, in which it moves."""
    left = variables("23_reachability_map")
    robot, q = left["robot"], np.array(READY)
    with viewed(robot, q, camera=(2.0, -1.7, 1.5)) as viewer:
        viewer.show(left["found"])
        viewer.follow = "off"

        def frames() -> Iterator[float]:
            for turn in np.linspace(0.0, 2 * np.pi, 120):
                viewer.q = q + np.sin(turn) * np.array([0.0, 0.4, 0.0, 0.5, 0.0, 0.0, 0.0])
                yield 2 * TICK

        yield Recorded(viewer, frames())


SCENES: dict[str, Callable[[], AbstractContextManager[Recorded]]] = {
    "circle": circle,
    "past_a_shelf": past_a_shelf,
    "dodge": dodge,
    "11_pick_and_place": pick_and_place,
    "21_tray_in_two_hands": tray,
    "23_reachability_map": reach,
    "30_a_cup_upright": cup_upright,
    "31_place_first": place_first,
    "47_base_that_stays": base_that_stays,
}
NAMES = (*SCENES, *OF_EXAMPLES)


def write(name: str, file: Path) -> None:
    """Writes a recording."""
    with SCENES[name]() if name in SCENES else of_example(name) as (viewer, frames):
        viewer.record(file, frames)
