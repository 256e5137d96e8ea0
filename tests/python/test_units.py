"""Degrees for radians, millimetres for metres: one `UnitsWarning` per call, and none for what robots honestly do."""

import subprocess
import sys
import warnings
from collections.abc import Callable

import numpy as np
import pytest

import beetle_ik as bik

DEGREES = [0.0, -45.0, 0.0, -135.0, 0.0, 90.0, 45.0]
READY = np.radians(DEGREES)
PANDA = bik.Robot.named("panda").with_capsules(radius=0.05)
BALL = bik.obstacles.Sphere((400, 0, 300), 50)
JOINT2 = (
    "joint 'panda_joint2' is -45 rad (7.162 turns), which looks like degrees: -45 degrees are -0.7854 rad; "
    "np.radians converts degrees"
)
TARGET = (
    "y is 400 m (the arm reaches 0.9881 m), which looks like millimetres: 400 mm are 0.4000 m; lengths are in metres"
)
SPHERE = (
    "distance of obstacle 0 (Sphere) is 449.8 m (the arm reaches 0.9881 m), which looks like millimetres: "
    "449.8 mm are 0.4498 m; lengths are in metres"
)


def said(call: Callable[[], object]) -> list[str]:
    """Returns the warnings of a call, which are all of units and in this file."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    assert all(warning.category is bik.UnitsWarning and warning.filename == __file__ for warning in caught)
    return [str(warning.message) for warning in caught]


def urdf(lower: float, upper: float, velocity: float, rpy: str = "0 0 0") -> str:
    joint = (
        "<joint name='{0}' type='revolute'><parent link='{1}'/><child link='{2}'/>"
        "<origin xyz='0 0 0.3' rpy='{3}'/><axis xyz='0 1 0'/>"
        f"<limit lower='{lower}' upper='{upper}' velocity='{velocity}' effort='1'/></joint>"
    )
    return (
        "<robot name='arm'><link name='a'/><link name='b'/><link name='c'/>"
        f"{joint.format('one', 'a', 'b', rpy)}{joint.format('two', 'b', 'c', '0 0 0')}</robot>"
    )


@pytest.mark.parametrize(
    "call",
    [
        lambda: PANDA.fk(DEGREES),
        lambda: PANDA.fk([READY, DEGREES]),
        lambda: PANDA.fk(DEGREES, link="link_4"),
        lambda: PANDA.clip(DEGREES),
        lambda: PANDA.jacobian(DEGREES),
        lambda: PANDA.link_poses(DEGREES),
        lambda: PANDA.all_link_poses(DEGREES),
        lambda: PANDA.manipulability(DEGREES),
        lambda: PANDA.manipulability_gradient(DEGREES),
        lambda: bik.obstacles.clearance(PANDA, DEGREES),
        lambda: bik.obstacles.nearest(PANDA, DEGREES),
    ],
)
def test_joint_positions_in_degrees_warn_in_each_call(call: Callable[[], object]) -> None:
    assert said(call) == [f"joint angles: {JOINT2}"]


@pytest.mark.parametrize(
    ("what", "call"),
    [
        ("target: ", lambda: bik.solve(PANDA, [100, 400, 300])),
        ("target: ", lambda: bik.solve(PANDA, bik.pose([100, 400, 300]))),
        ("target: ", lambda: bik.solve_all(PANDA, bik.pose([100, 400, 300]))),
        ("targets: ", lambda: bik.solve_batch(PANDA, [[0.1, 0.4, 0.3], [100, 400, 300]])),
        ("targets: ", lambda: bik.solve_batch(PANDA, [bik.pose([100, 400, 300])])),
        ("path: ", lambda: bik.track(PANDA, bik.paths.circle((0, 400, 300), diameter=0.1, duration=0.1), dt=0.1)),
    ],
)
def test_targets_in_millimetres_warn_in_each_call(what: str, call: Callable[[], object]) -> None:
    assert said(call) == [what + TARGET]


@pytest.mark.parametrize(
    "call",
    [
        lambda: bik.solve(PANDA, [0.4, 0.1, 0.4], obstacles=[BALL]),
        lambda: bik.plan_point_to_point(PANDA, start_q=READY, end_q=0.9 * READY, obstacles=[BALL]),
        lambda: bik.obstacles.clearance(PANDA, READY, [BALL]),
        lambda: bik.Tracker(PANDA, READY, dt=0.01, obstacles=[BALL]),
        lambda: bik.solve(PANDA, [0.4, 0.1, 0.4], obstacles=bik.Scene([BALL])),
    ],
)
def test_obstacles_in_millimetres_warn_in_each_call(call: Callable[[], object]) -> None:
    assert said(call) == [SPHERE]


def test_payloads_and_speeds_of_moves_in_millimetres_warn() -> None:
    (payload,) = said(lambda: PANDA.with_payload(1.0, center=(0, 0, 100)))
    assert payload.startswith("center: z is 100 m (the arm reaches")
    line = bik.moves.Line(PANDA.fk(READY), speed=50)
    program = [bik.moves.Joints(0.9 * READY), line]
    limits = bik.Limits(acceleration=5.0)
    (speed,) = said(lambda: bik.plan_moves(PANDA, program, start_q=READY, limits=limits))
    assert speed.startswith("speed of move 1 is 50 m/s (no arm is as fast), which looks like")
    far = PANDA.fk(READY)
    far[:3, 3] *= 1000.0
    for move in (bik.moves.Line(far), bik.moves.Joints(far)):
        with pytest.raises(bik.InvalidInputError, match=r"move 0 cannot be reached.*; move 0: [xyz] is .*millimetres"):
            bik.plan_moves(PANDA, [move], start_q=READY, limits=limits)


def test_a_tracker_warns_once_of_its_targets() -> None:
    tracker = bik.Tracker(PANDA, READY, dt=0.01)

    def steps() -> None:
        for x in range(5):
            tracker.step([x, 400, 300])

    assert said(steps) == [f"target: {TARGET}"]
    assert said(lambda: setattr(bik.Tracker(PANDA, READY, dt=0.01), "obstacles", [BALL])) == [SPHERE]


def test_angles_of_a_pose_in_degrees_warn_and_degrees_takes_them() -> None:
    looks = "which looks like degrees: {0} degrees are {1} rad; degrees=True takes degrees"
    rpy = "rpy: entry 0 is 180 rad (28.65 turns), " + looks.format(180, 3.142)
    assert said(lambda: bik.pose([0, 0, 0], rpy=[180, 0, 90])) == [rpy]
    rotvec = "rotvec: entry 2 is 90 rad (14.32 turns), " + looks.format(90, 1.571)
    assert said(lambda: bik.pose([0, 0, 0], rotvec=[0, 0, 90])) == [rotvec]
    for form in ("rpy", "rotvec"):
        turned = bik.pose([1, 2, 3], degrees=True, **{form: [10.0, 200.0, -90.0]})
        np.testing.assert_array_equal(turned, bik.pose([1, 2, 3], **{form: np.radians([10.0, 200.0, -90.0])}))


def test_limits_in_degrees_warn_wherever_they_are_given() -> None:
    upper = (
        "upper limit of joint '{0}' (and {1}) is 170 rad (27.06 turns), which looks like degrees: "
        "170 degrees are 2.967 rad; limits are in radians: np.radians converts degrees"
    )
    velocity = (
        "velocity limit of joint '{0}' (and {1}) is 180 rad/s (28.65 turns per second), "
        "which looks like degrees per second: 180 degrees/s are 3.142 rad/s; "
        "limits are in radians per second: np.radians converts degrees"
    )
    both = f"{upper}; {velocity}"
    assert said(lambda: bik.Robot.from_urdf(urdf(-170, 170, 180))) == [both.format("one", "that of another joint")]
    assert said(lambda: bik.Robot.from_urdf(urdf(-2.9, 2.9, 180))) == [velocity.format("one", "that of another joint")]
    of_seven = ("panda_joint1", "those of 6 other joints")
    assert said(lambda: PANDA.with_limits(lower=-170, upper=170)) == [upper.format(*of_seven)]
    assert said(lambda: PANDA.with_limits(velocity=180)) == [velocity.format(*of_seven)]
    limits = bik.Limits(lower=-170, upper=170, velocity=180)
    assert said(lambda: bik.solve(PANDA, [0.4, 0.1, 0.4], limits=limits)) == [both.format(*of_seven)]
    table = {"a": [0.4, 0.3], "alpha": [0, 0], "d": [0, 0], "lower": -170, "upper": 170}
    assert said(lambda: bik.Robot.from_dh(**table)) == [upper.format("joint_1", "that of another joint")]
    assert said(lambda: bik.Robot.planar([0.4, 0.3], lower=-170, upper=170)) == [
        upper.format("joint_1", "that of another joint")
    ]


def test_angles_of_a_file_and_of_a_table_in_degrees_warn() -> None:
    ninety = "is 90 rad (14.32 turns), which looks like degrees: 90 degrees are 1.571 rad; "
    assert said(lambda: bik.Robot.from_urdf(urdf(-2.9, 2.9, 3, rpy="0 90 0"))) == [
        f"rpy of the origin of joint 'one': entry 1 {ninety}angles of a file are in radians"
    ]
    assert said(lambda: bik.Robot.from_dh(a=[0, 0.4], alpha=[90, 0], d=[0, 0])) == [
        f"alpha: entry 0 {ninety}np.radians converts degrees"
    ]


def test_lengths_of_a_robot_in_millimetres_warn() -> None:
    metres = "which looks like millimetres: {0} mm are {1} m; lengths are in metres"
    assert said(lambda: bik.Robot.planar([425, 392])) == [
        "reach of robot 'planar2' is 817 m (the sum of its links), " + metres.format(817, "0.8170")
    ]
    assert said(lambda: PANDA.with_tool(bik.pose([0, 0, 103]))) == [
        "tool: z is 103 m (the arm reaches 0.9881 m), " + metres.format(103, "0.1030")
    ]
    hand = [("link_7", (0, 0, 0), (0, 0, 0.1), 60.0)]
    assert said(lambda: PANDA.with_capsules(hand)) == [
        "radius of a body of link 'link_7' (given) is 60.05 m (the arm reaches 0.9881 m), "
        + metres.format("60.05", "0.06005")
    ]


def test_an_error_that_a_unit_caused_says_so_itself() -> None:
    with pytest.raises(bik.InvalidInputError) as told:
        bik.plan_point_to_point(PANDA, start_q=READY, end=[0, 400, 300])
    assert str(told.value).endswith(f"; end: {TARGET}")
    with pytest.raises(bik.LimitError) as told:
        bik.Tracker(PANDA, DEGREES, dt=0.01)
    assert str(told.value).endswith("; angles are in radians, and np.radians converts degrees")
    assert said(lambda: PANDA.fk(READY)) == []  # nothing is left over from the errors


def test_a_warning_may_be_made_an_error_or_be_silenced() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(bik.UnitsWarning, match="looks like degrees"):
            PANDA.fk(DEGREES)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore", bik.UnitsWarning)
        PANDA.fk(DEGREES)
    assert caught == []
    assert issubclass(bik.UnitsWarning, UserWarning)


HONEST = np.random.default_rng(5)


@pytest.mark.parametrize(
    "call",
    [
        lambda: PANDA.fk(np.full(7, 20.0)),
        lambda: PANDA.fk(1e3 * READY / 1e2),
        lambda: bik.Robot.from_dh(a=[1.0, 1.0], alpha=[0, 0], d=[0, 0]).fk([100.0, -85.3]),
        lambda: bik.Robot.from_dh(a=[1.0, 1.0], alpha=[0, 0], d=[0, 0]).fk(HONEST.uniform(-1e3, 1e3, (100, 2))),
        lambda: bik.solve(PANDA, [3.9, 0.0, 0.0]),
        lambda: bik.solve(PANDA, [25.0, 0.0, 0.0]),
        lambda: bik.solve(PANDA, [1e6, 0.0, 0.0]),
        lambda: bik.solve(PANDA.with_base(bik.pose([4e5, 5e6, 120.0])), [4e5, 5e6, 120.5]),
        lambda: bik.Robot.planar([10.0, 12.0, 8.0]),
        lambda: bik.solve(bik.Robot.planar([10.0, 12.0]), bik.pose([300.0, 0, 0])[:3, 3]),
        lambda: bik.solve(
            PANDA, [0.4, 0.1, 0.4], obstacles=[bik.obstacles.Box(size=(100, 100, 0.2), center=(0, 0, -0.1))]
        ),
        lambda: bik.solve(PANDA, [0.4, 0.1, 0.4], obstacles=[bik.obstacles.HalfSpace(normal=(0, 0, 1), offset=-700.0)]),
        lambda: bik.solve(PANDA, [0.4, 0.1, 0.4], obstacles=[bik.obstacles.Sphere((25.0, 0, 0), 2.0)]),
        lambda: bik.pose([0, 0, 0], rpy=[0.1, 0.2, 85.3]),
        lambda: bik.pose([0, 0, 0], rpy=[np.pi, -np.pi, 4 * np.pi]),
        lambda: bik.pose([400, 0, 300], rotvec=[0, 0, 20.0]),
        lambda: PANDA.with_limits(lower=-20 * np.pi, upper=20 * np.pi),
        lambda: PANDA.with_limits(velocity=100.0),
        lambda: PANDA.with_limits(velocity=np.inf),
        lambda: PANDA.with_mobile_base("planar", lower=(-50, -80, -np.pi), upper=(50, 80, np.pi)),
        lambda: bik.Robot.from_urdf(urdf(-10, 10, 1000)),
        lambda: bik.Robot.from_urdf(urdf(-1e16, 1e16, 28.6)),
        lambda: PANDA.with_tool(bik.pose([0, 0, 10.0])),
        lambda: [bik.Robot.named(name) for name in bik.Robot.names()],
    ],
)
def test_honest_values_do_not_warn(call: Callable[[], object]) -> None:
    assert said(call) == []


def test_configurations_inside_their_limits_never_warn() -> None:
    for name in bik.Robot.names():
        robot = bik.Robot.named(name)
        assert said(lambda robot=robot: robot.fk(robot.random_configurations(1000, seed=3))) == []


def test_a_warning_names_the_line_of_the_program_that_caused_it() -> None:
    program = "import beetle_ik as bik\nrobot = bik.Robot.named('ur5e')\nrobot.fk([0, -90, 90, 0, 0, 0])\n"
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert ran.stderr.startswith("<string>:3: UnitsWarning: joint angles: joint ")


def test_the_command_line_takes_degrees_and_warns_in_its_own_words() -> None:
    def ran(*arguments: str) -> "subprocess.CompletedProcess[str]":
        command = [sys.executable, "-m", "beetle_ik", *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True)

    pytest.importorskip("typer")
    degrees = ran("fk", "ur5e", "--q", "0,-90deg,90deg,0,45deg,0")
    radians = ran("fk", "ur5e", "--q", ",".join(map(str, np.radians([0, -90, 90, 0, 45, 0]))))
    assert (degrees.stdout, degrees.stderr) == (radians.stdout, "")
    warned = ran("fk", "ur5e", "--q", "0,-90,90,0,45,0").stderr
    assert warned.startswith("Warning: joint angles: joint '")
    assert warned.endswith("-90 degrees are -1.571 rad; 90deg is 90 degrees\n")
