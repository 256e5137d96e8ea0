"""Common mistakes of the first day, and the message for each."""

import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from mistakes import RADIANS, SLACK, Invalid, Limit, Unknown, assert_told, told
from typer.testing import CliRunner

import beetle_ik as bik
from beetle_ik.cli.app import app

PANDA = bik.Robot.named("panda")
READY = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
TARGET = PANDA.fk(READY)
MOTION = bik.time_optimal([READY, 0.9 * READY], bik.Limits(velocity=1.0, acceleration=1.0))
BUILT_IN = ", ".join(bik.Robot.names())
OF_SOLVE = (
    "robot, target, task, start_q, solver, position_tolerance, rotation_tolerance, goals, prefer, joint_weights, "
    "limits, obstacles, margin, self_collision, stop, seed"
)
SOLVERS = (
    "BAS, BeeColony, BeetleSwarm, DifferentialEvolution, Firefly, Genetic, PSO, QPSO, APPS, BroydenBAS, "
    "JacobianTranspose, LevenbergMarquardt, NewtonRaphson or MultiStart of one of them"
)


@told(
    [
        (
            lambda: bik.solve(TARGET, PANDA),  # type: ignore[arg-type]
            bik.CallError,
            "robot must be a Robot, such as Robot.named('panda'), got an array of shape (4, 4); the order is "
            "solve(robot, target, ...)",
        ),
        (
            lambda: bik.solve("panda", TARGET),  # type: ignore[arg-type]
            bik.CallError,
            "robot must be a Robot, such as Robot.named('panda'), got 'panda'",
        ),
        (
            lambda: bik.solve("arm.urdf", TARGET),  # type: ignore[arg-type]
            bik.CallError,
            "robot must be a Robot, such as Robot.from_urdf('arm.urdf'), got 'arm.urdf'",
        ),
        (
            lambda: bik.solve(PANDA, TARGET, q0=READY),  # type: ignore[call-arg]
            bik.CallError,
            f"solve() got an unexpected keyword argument 'q0' (did you mean 'start_q'?); its arguments: {OF_SOLVE}",
        ),
        (
            lambda: bik.Limits(vel=1.0),  # type: ignore[call-arg]
            bik.CallError,
            "Limits() got an unexpected keyword argument 'vel' (did you mean 'velocity'?); its arguments: lower, "
            "upper, velocity, acceleration, jerk, tip_speed, tip_acceleration, tip_turn_speed, torque",
        ),
        (
            lambda: bik.obstacles.Sphere(centre=(0, 0, 0), radius=0.1),  # type: ignore[call-arg]
            bik.CallError,
            "Sphere() got an unexpected keyword argument 'centre' (did you mean 'center'?); its arguments: center, "
            "radius, touch",
        ),
        (
            lambda: bik.paths.circle((0, 0, 0), radius=0.1, duration=1.0),  # type: ignore[call-arg]
            bik.CallError,
            "circle() got an unexpected keyword argument 'radius' (did you mean 'diameter'?); its arguments: center, "
            "diameter, duration, a, b",
        ),
        (
            lambda: PANDA.with_limits(vel=1.0),  # type: ignore[call-arg]
            bik.CallError,
            "with_limits() got an unexpected keyword argument 'vel' (did you mean 'velocity'?); its arguments: lower, "
            "upper, velocity",
        ),
        (
            lambda: bik.solve(PANDA),  # type: ignore[call-arg]
            bik.CallError,
            "solve() missing 1 required positional argument: 'target': call it as solve(robot, target, ...)",
        ),
        (
            lambda: bik.Tracker(PANDA, READY),  # type: ignore[call-arg]
            bik.CallError,
            "Tracker() missing 1 required keyword argument: 'dt': call it as Tracker(robot, start_q, dt=..., ...)",
        ),
        (
            lambda: bik.solve(PANDA, TARGET, READY),  # type: ignore[misc]
            bik.CallError,
            "solve() takes 2 positional arguments but 3 were given: name the others, such as task=...",
        ),
        (
            lambda: bik.time_optimal([READY, 0.9 * READY], None),  # type: ignore[arg-type]
            bik.CallError,
            "limits must be a Limits, such as Limits(velocity=1.5, acceleration=5.0), got None",
        ),
        (
            lambda: MOTION.sample(np.linspace(0, 1, 3)),  # type: ignore[arg-type]
            bik.CallError,
            "dt must be a number of seconds, got array([0. , 0.5, 1. ]); at(t) gives the motion at given times",
        ),
        (
            lambda: bik.moves.Line([0.4, 0.1, 0.3]),
            bik.InvalidInputError,
            "pose: expected shape (4, 4), got (3,), a position; bik.pose(position, rpy=angles) makes a pose of it and "
            "angles",
        ),
        (
            lambda: bik.moves.Line({"left": np.eye(4), "right": np.eye(4)}),  # type: ignore[arg-type]
            bik.InvalidInputError,
            "pose: a move leads one tip, got a dict: give its pose, and its name as tip='left'",
        ),
        (
            lambda: bik.plan_point_to_point(PANDA, start_q=READY, end_q=READY),
            bik.InvalidInputError,
            "trajectory: start and end are the same configuration: the arm is there already, nothing is to be planned",
        ),
        (
            lambda: bik.solve(PANDA, TARGET, margin="5mm"),  # type: ignore[arg-type]
            bik.CallError,
            "margin must be a number, got '5mm'",
        ),
        (
            lambda: bik.solve(PANDA, TARGET, seed=1.5),  # type: ignore[arg-type]
            bik.CallError,
            "seed must be a whole number, got 1.5",
        ),
        (
            lambda: bik.solve(PANDA, TARGET, self_collision="yes"),  # type: ignore[arg-type]
            bik.CallError,
            "self_collision must be True or False, got 'yes'",
        ),
        (
            lambda: bik.solve(PANDA, TARGET, prefer=1),  # type: ignore[arg-type]
            bik.CallError,
            "prefer must be text, got 1 (default: 'any')",
        ),
        (
            lambda: bik.Robot.from_urdf("arm.urdf", trusted="yes"),  # type: ignore[arg-type]
            bik.CallError,
            "trusted must be True or False, got 'yes'",
        ),
        (
            lambda: bik.Robot.from_urdf("arm.urdf", collision=True),  # type: ignore[arg-type]
            Invalid,
            "collision must be one of 'primitives', 'fit', 'hulls' or None, got True",
        ),
        (
            lambda: bik.solve(PANDA, TARGET, solver="lm"),  # type: ignore[arg-type]
            Invalid,
            f"solver must be {SOLVERS}, got 'lm': give an object, such as bik.LevenbergMarquardt()",
        ),
        (
            lambda: bik.solve(PANDA, [0.4, 0.0, 0.5, 0, 0, 0, 1]),
            Invalid,
            "target: expected a pose (4, 4) or a position (3,), got shape (7,); bik.pose(t[:3], xyzw=t[3:]) makes a "
            "pose of a position and a quaternion, or wxyz=",
        ),
        (
            lambda: bik.solve(PANDA, [0.4, 0.0, 0.5, 0, 0, 1]),
            Invalid,
            "target: expected a pose (4, 4) or a position (3,), got shape (6,); bik.pose(t[:3], rpy=t[3:]) makes a "
            "pose of a position and angles",
        ),
        (
            lambda: PANDA.fk(np.zeros(9)),
            Invalid,
            "joint angles of robot 'panda': expected 7 joints (panda_joint1 to panda_joint7), got 9",
        ),
        (
            lambda: bik.Tracker(PANDA, np.full(7, -0.3), dt=0.01),
            Limit,
            f"start_q: joint 'panda_joint6' at -0.3 is outside its limits [-0.0175, 3.7525] by 0.2825 rad: {SLACK}",
        ),
        (
            lambda: bik.Tracker(PANDA, [0, -40, 0, -135, 0, 90, 45], dt=0.01),
            Limit,
            f"start_q: joint 'panda_joint2' at -40 is outside its limits [-1.7628, 1.7628] by 38.24 rad: "
            f"move it inside; {RADIANS}",
        ),
        (
            lambda: bik.reachability(PANDA, voxel_size=0.1),  # type: ignore[call-arg]
            bik.CallError,
            "reachability() got an unexpected keyword argument 'voxel_size' (did you mean 'voxel'?); its arguments: "
            "robot, voxel, directions, rolls, region, task, obstacles, margin, self_collision, evaluations, "
            "quality, threads, progress, store",
        ),
        (
            lambda: bik.Scene(obstacle=[]),  # type: ignore[call-arg]
            bik.CallError,
            "Scene() got an unexpected keyword argument 'obstacle' (did you mean 'obstacles'?); its arguments: "
            "obstacles, attached",
        ),
        (
            lambda: bik.view("panda"),  # type: ignore[arg-type]
            Invalid,
            "robot must be a Robot, such as Robot.named('panda'), got 'panda'",
        ),
        (
            lambda: bik.Robot.named("pandda"),
            Unknown,
            f"no robot is named 'pandda' (did you mean 'panda'?); known robots: {BUILT_IN}",
        ),
        (
            lambda: bik.Robot.named("arm.urdf"),
            Unknown,
            "no robot is named 'arm.urdf'; a file is read by Robot.from_urdf('arm.urdf')",
        ),
        (
            lambda: bik.Robot.from_urdf("panda"),
            Invalid,
            "there is no file 'panda'; Robot.named('panda') is a built-in robot",
        ),
    ]
)
def test_a_natural_mistake_is_told(call: object, error: type[Exception], message: str) -> None:
    assert_told(call, error, message)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (
            '[{"type": "sphere", "centre": [0, 0, 0], "radius": 0.1}]',
            "obstacle 0 (sphere): unknown key 'centre' (did you mean 'center'?); keys: center, radius, touch",
        ),
        (
            '[{"type": "spere", "center": [0, 0, 0], "radius": 0.1}]',
            "obstacle 0: unknown type 'spere' (did you mean 'sphere'?); types: sphere, box, capsule, cylinder, "
            "half_space, ellipsoid, ellipse, convex_mesh, mesh, point_cloud, grid",
        ),
        (
            '[{"type": "sphere", "center": [0, 0, 0]}]',
            "obstacle 0 (sphere): the key 'radius' is missing; keys: center, radius, touch",
        ),
        (
            '{"obstacle": [], "obstacles": []}',
            'unknown key \'obstacle\' (did you mean \'obstacles\'?); keys: "version", "obstacles", "attached"',
        ),
        (
            '[\n  {"type": "sphere", "center": [0, 0, 0], "radius": 0.1},\n]',
            "not JSON: a comma after the last entry, line 2: remove it",
        ),
    ],
)
def test_a_mistake_in_a_scene_is_told(scene: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "scene.json"
    file.write_text(scene)
    assert_told(lambda: bik.Scene.load(file), Invalid, f"{file}: {message}")


GRIPPER = """<robot name="r"><link name="base"/><link name="hand"/><link name="finger"/>
<joint name="turn" type="continuous"><parent link="base"/><child link="hand"/></joint>
<joint name="grip" type="prismatic"><parent link="hand"/><child link="finger"/>
<limit lower="0" upper="0.04" velocity="1" effort="1"/></joint></robot>"""


def test_joints_of_a_gripper_are_named_where_they_are_too_many() -> None:
    robot = bik.Robot.from_urdf(GRIPPER, tip="hand")
    message = "joint angles of robot 'r': expected 1 joints (without grip, held in place), got 2"
    assert_told(lambda: robot.fk([0.0, 0.0]), Invalid, message)


def test_a_urdf_that_is_xacro_is_expanded(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    xacro = GRIPPER.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')
    file.write_text(xacro.replace("<link", '<xacro:property name="open" value="0.04"/><link', 1))
    assert bik.Robot.from_urdf(file, tip="hand") == bik.Robot.from_urdf(GRIPPER, tip="hand")


def _descriptions(monkeypatch: pytest.MonkeyPatch, names: list[str]) -> None:
    """Puts a package robot_descriptions with these names in place of the real one, and no example-robot-data."""
    package, listed = ModuleType("robot_descriptions"), ModuleType("robot_descriptions._descriptions")
    listed.DESCRIPTIONS = dict.fromkeys(names)  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, package.__name__, package)
    monkeypatch.setitem(sys.modules, listed.__name__, listed)
    monkeypatch.setattr("beetle_ik.robot_files.descriptions._data_folder", lambda: None)


def test_a_part_of_the_name_of_a_description_suggests_it(monkeypatch: pytest.MonkeyPatch) -> None:
    _descriptions(monkeypatch, ["fetch_description", "panda_description", "panda_mj_description"])
    assert_told(
        lambda: bik.Robot.from_description("panda"),
        Unknown,
        "robot_descriptions has no robot named 'panda'; did you mean panda_description or panda_mj_description? "
        "Robot.named('panda') is built in",
    )
    assert_told(
        lambda: bik.Robot.named("fetch"),
        Unknown,
        f"no robot is named 'fetch'; known robots: {BUILT_IN}; robot_descriptions has 'fetch_description'",
    )


def test_a_description_that_cannot_be_downloaded_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    _descriptions(monkeypatch, ["fetch_description"])
    sys.modules["robot_descriptions"].__path__ = [str(tmp_path)]
    (tmp_path / "fetch_description.py").write_text("raise OSError('git\\n  fatal: no network')")
    for call in (bik.Robot.from_description, bik.Robot.named):
        assert_told(
            lambda call=call: call("fetch_description"),  # type: ignore[misc]
            bik.BeetleIkError,
            "robot_descriptions cannot download 'fetch_description': no network; only the first use needs the network",
        )


def test_robots_of_example_robot_data_have_names(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for file in ("arm_description/urdf/arm.urdf", "arm_description/urdf/arm_long.urdf", "two/a.urdf", "two/b.urdf"):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text(GRIPPER.replace('name="r"', f'name="{Path(file).stem}"'))
    monkeypatch.setattr("beetle_ik.robot_files.descriptions._data_folder", lambda: tmp_path)
    forked = GRIPPER.replace("</robot>", '<link name="eye"/><joint name="held" type="fixed"><parent link="base"/>')
    forked += '<child link="eye"/></joint></robot>'
    (tmp_path / "arm_description" / "urdf" / "forked.urdf").write_text(forked)
    assert_told(
        lambda: bik.Robot.named("forked"),
        bik.UrdfError,
        "robot 'r' ends in 2 links: say which one is the tip; leaves, by number of joints: finger (2), eye (0); "
        "Robot.from_description('forked', tip=...) takes it",
    )
    for name, found in (("arm_description", "arm"), ("arm_long", "arm_long"), ("a", "a")):
        assert bik.Robot.named(name).name == bik.Robot.from_description(name).name == found
    assert_told(lambda: bik.Robot.named("two"), Unknown, "'two' of example-robot-data has several robots: a, b")


@pytest.mark.parametrize(
    "position",
    [["0.4,0.1,0.5"], ["0.4", "0.1", "0.5"], ["0.4,", "0.1,", "0.5"], ["0.4 0.1 0.5"], ["[0.4, 0.1, 0.5]"]],
)
def test_numbers_may_be_apart_on_the_command_line(position: list[str]) -> None:
    for option in (["--position", *position], [f"--position={position[0]}", *position[1:]]):
        done = CliRunner().invoke(app, ["solve", "panda", *option, "--json"])
        assert done.exit_code == 0, done.output
    alone = CliRunner().invoke(app, ["fk", "planar5", "--q", "-.1", "0.", "1e-1", "0", "0", "--json"])
    assert alone.exit_code == 0, alone.output


@pytest.mark.parametrize("command", [["fk", "--q", "0.1"], ["solve", "--position", "0,0,0"], ["view"], ["reach"]])
def test_a_file_names_a_robot_in_every_command(command: list[str], tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(GRIPPER)
    done = CliRunner().invoke(app, [command[0], str(file), *command[1:], "--tip", "nothing"])
    assert done.exit_code == 2
    assert done.stderr.startswith("Error: robot 'r' has no link 'nothing'; its links: base, hand, finger"), done.output


def test_the_command_line_says_which_extra_it_needs() -> None:
    program = "import sys; sys.modules['typer'] = None; from beetle_ik.cli import main; main()"
    done = subprocess.run([sys.executable, "-c", program], check=False, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (
        2,
        "Error: the command line needs typer: pip install 'beetle-ik[cli]'\n",
    )


@pytest.mark.parametrize(
    ("call", "wrong", "meant"),
    [
        (bik.solve, "q0", "start_q"),
        (bik.solve, "initial_guess", "start_q"),
        (bik.solve, "starts", "start_q"),
        (bik.solve, "pose", "target"),
        (bik.solve, "tol", "position_tolerance"),
        (bik.solve, "rot_tolerance", "rotation_tolerance"),
        (bik.solve, "max_iter", "stop"),
        (bik.solve, "world", "obstacles"),
        (bik.plan_point_to_point, "goal", "end"),
        (bik.plan_point_to_point, "q_start", "start_q"),
        (bik.plan_point_to_point, "velocity_limits", None),
        (bik.obstacles.Box, "extents", "size"),
        (bik.obstacles.Sphere, "centre", "center"),
        (bik.Limits, "vel", "velocity"),
        (bik.Limits, "acc", "acceleration"),
        (bik.Limits, "max_velocity", "velocity"),
        (bik.Limits, "x", None),
        (bik.Robot.from_urdf, "end_effector", "tip"),
        (bik.Robot.from_urdf, "base_link", "base"),
        (bik.track, "timestep", "dt"),
        (bik.reachability, "resolution", "voxel"),
        (PANDA.fk, "frame", "link"),
    ],
)
def test_the_argument_that_is_meant_is_suggested(call: Any, wrong: str, meant: str | None) -> None:
    with pytest.raises(bik.CallError) as caught:
        call(**{wrong: 1})
    hint = f"(did you mean '{meant}'?)" if meant else "did you mean"
    assert (hint in str(caught.value)) == (meant is not None), str(caught.value)
