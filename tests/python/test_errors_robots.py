"""Wrong robots, URDFs and joint angles: the exception and the exact message that a user sees."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from mistakes import Invalid, Limit, Unknown, Urdf, assert_told, told, with_entry

import beetle_ik as bik

IIWA = bik.Robot.named("iiwa14")
NAMES = ", ".join(bik.Robot.names())


def dh(**fields: object) -> bik.Robot:
    return bik.Robot.from_dh(**{"a": [1.0], "alpha": [0.0], "d": [0.0], **fields})


@told(
    [
        (lambda: IIWA.fk(with_entry(2, np.nan)), Invalid, "joint angles must be finite, but joint 'joint_a3' is NaN"),
        (lambda: IIWA.fk(with_entry(6, np.inf)), Invalid, "joint angles must be finite, but joint 'joint_a7' is inf"),
        (
            lambda: IIWA.jacobian([[0.0] * 7, with_entry(3, -np.inf)]),
            Invalid,
            "joint angles must be finite, but joint 'joint_a4' of configuration 1 is -inf",
        ),
        (lambda: IIWA.fk([0.0] * 6), Invalid, "joint angles of robot 'iiwa14': expected 7 joints, got 6"),
        (lambda: IIWA.jacobian([]), Invalid, "joint angles of robot 'iiwa14': expected 7 joints, got 0"),
        (
            lambda: IIWA.link_poses([0.0] * 8),
            Invalid,
            "joint angles of robot 'iiwa14': expected 7 joints (joint_a1 to joint_a7), got 8",
        ),
        (lambda: IIWA.manipulability([0.0]), Invalid, "joint angles of robot 'iiwa14': expected 7 joints, got 1"),
        (
            lambda: IIWA.fk(np.zeros((2, 6))),
            Invalid,
            "joint angles of robot 'iiwa14': expected shape (7,) or (m, 7), got (2, 6)",
        ),
        (
            lambda: IIWA.jacobian(np.zeros((2, 2, 7))),
            Invalid,
            "joint angles of robot 'iiwa14': expected shape (7,) or (m, 7), got (2, 2, 7)",
        ),
        (lambda: IIWA.fk(1.0), Invalid, "joint angles of robot 'iiwa14': expected shape (7,) or (m, 7), got ()"),
        (lambda: IIWA.link_poses(np.zeros((2, 7))), Invalid, "joint angles: expected one dimension, got shape (2, 7)"),
        (lambda: IIWA.fk("home"), Invalid, "joint angles must be an array of numbers, got 'home'"),
        (lambda: IIWA.fk(None), Invalid, "joint angles must be an array of numbers, got None"),
        (lambda: IIWA.fk([1j] * 2), Invalid, "joint angles must be an array of numbers, got [1j, 1j]"),
        (
            lambda: IIWA.fk([[0.0], [0.0, 1.0]]),
            Invalid,
            "joint angles must be an array of numbers, got [[0.0], [0.0, 1.0]]",
        ),
        (
            lambda: IIWA.fk("a" * 80),
            Invalid,
            f"joint angles must be an array of numbers, got '{'a' * 56}...",
        ),
        (lambda: IIWA.random_configurations(-1), Invalid, "m must be zero or more, got -1"),
        (lambda: IIWA.random_configurations(1, seed=-3), Invalid, "seed must be zero or more, got -3"),
        (
            lambda: IIWA.random_configurations(1, seed=2**64),
            Invalid,
            "seed must be below 2^64, got 18446744073709551616",
        ),
    ]
)
def test_wrong_joint_positions_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


@told(
    [
        (
            lambda: bik.Robot.named("iiwa41"),
            Unknown,
            f"no robot is named 'iiwa41' (did you mean 'iiwa14'?); known robots: {NAMES}",
        ),
        (
            lambda: bik.Robot.named("Panda"),
            Unknown,
            f"no robot is named 'Panda' (did you mean 'panda'?); known robots: {NAMES}",
        ),
        (lambda: bik.Robot.named("zzz"), Unknown, f"no robot is named 'zzz'; known robots: {NAMES}"),
        (
            lambda: bik.Robot("iiwa14"),
            bik.CallError,
            "a robot is made by Robot.named(name), Robot.from_urdf(path), Robot.from_dh(...) or Robot.planar(lengths)",
        ),
        (lambda: bik.Robot.planar([]), Invalid, "lengths of a planar arm: expected at least 1, got 0"),
        (lambda: bik.Robot.planar([1, -1]), Invalid, "length 1 of a planar arm must be positive and finite, got -1"),
        (
            lambda: bik.Robot.planar([1] * 65),
            Invalid,
            "robot 'planar65': 65 moving joints between base and tip; at most 64 are supported",
        ),
        (
            lambda: bik.Robot.planar([1, 1], lower=1, upper=-1),
            Limit,
            "joint 'joint_1': lower limit 1 is above upper limit -1",
        ),
        (
            lambda: bik.Robot.planar([1, 1], velocity=[1, -1]),
            Limit,
            "velocity limit of joint 'joint_2' is -1 at t = 0 s: a limit cannot be negative",
        ),
        (
            lambda: bik.Robot.planar([1, 1], velocity=[1, 2, 3]),
            Invalid,
            "velocity: expected a number or 2 values (one per joint), got 3",
        ),
        (
            lambda: dh(alpha=[0, 0]),
            Invalid,
            "alpha in the DH table of robot 'dh': expected 1 entries, as in a, got 2",
        ),
        (
            lambda: dh(kinds=["hinge"]),
            Invalid,
            "kind of a joint must be one of 'revolute', 'continuous', 'prismatic', got 'hinge'",
        ),
        (lambda: dh(convention="craig"), Invalid, "convention must be one of 'modified', 'standard', got 'craig'"),
        (lambda: dh(d=[np.nan]), Invalid, "d in the DH table of robot 'dh' must be finite, but entry 0 is NaN"),
        (
            lambda: IIWA.with_limits(lower=3.0),
            Limit,
            "joint 'joint_a1': lower limit 3 is above upper limit 2.9670597283903604",
        ),
        (
            lambda: IIWA.with_limits(upper=[1.0] * 6),
            Invalid,
            "upper: expected a number or 7 values (one per joint), got 6",
        ),
        (lambda: IIWA.with_tool(np.eye(3)), Invalid, "tool: expected shape (4, 4), got (3, 3)"),
        (lambda: IIWA.with_base(None), Invalid, "base must be an array of numbers, got None"),
        (
            lambda: IIWA.with_tool(np.diag([1, 1, -1, 1])),
            Invalid,
            "tool is not a rigid transform: its rotation is a reflection (determinant -1): turn one of its axes round",
        ),
        (
            lambda: IIWA.with_base(2 * np.eye(4)),
            Invalid,
            "base is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)",
        ),
    ]
)
def test_wrong_robots_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


ARM = """<robot name="arm">
<link name="base"/> <link name="upper"/> <link name="hand"/>
<joint name="a" type="revolute"><parent link="base"/><child link="upper"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="2" velocity="1"/></joint>
<joint name="b" type="prismatic"><parent link="upper"/><child link="hand"/>
<axis xyz="0 0 1"/><limit lower="0" upper="1" velocity="1"/></joint>
</robot>"""


def load(old: str = "", new: str = "", **links: str) -> bik.Robot:
    """The arm after one replacement in its text."""
    assert old in ARM
    return bik.Robot.from_urdf(ARM.replace(old, new, 1) if old else ARM, **links)


@told(
    [
        (lambda: bik.Robot.from_urdf("<robot"), Urdf, "URDF line 1: not XML: the document does not have a root node"),
        (
            lambda: bik.Robot.from_urdf("<robot name='r'><link name='l'/></robot>"),
            Urdf,
            "URDF line 1: <robot> has no <joint>: a chain needs at least one that moves",
        ),
        (
            lambda: load('<child link="upper"/>', '<child link="base"/>'),
            Urdf,
            "URDF line 3: the joints form a cycle: base -> base",
        ),
        (
            lambda: load('<child link="hand"/>', '<child link="base"/>', tip="upper"),
            Urdf,
            "URDF line 5: the joints form a cycle: base -> upper -> base",
        ),
        (
            lambda: load('xyz="0 0 1"', 'xyz="0 0 0"'),
            Urdf,
            "URDF line 3: axis of joint 'a' is zero: it must have a direction",
        ),
        (lambda: load('lower="-1"', 'lower="3"'), Limit, "joint 'a': lower limit 3 is above upper limit 2"),
        (
            lambda: load('<link name="hand"/>', '<link name="hand"/><link name="loose"/>'),
            Urdf,
            "URDF: no joint leads to any of the links 'base', 'loose': a tree has one root",
        ),
        (
            lambda: load("revolute", "floating"),
            Urdf,
            "URDF line 3: joint 'a' is floating, and a chain takes only revolute, continuous, prismatic, fixed and "
            "mimic joints: take base and tip on one side of it, a base from 'upper' on or a tip up to 'base'",
        ),
        (
            lambda: load('name="arm">', 'name="arm" xmlns:xacro="http://wiki.ros.org/xacro"><xacro:include/>'),
            Urdf,
            "URDF line 1: <xacro:include> is not expanded: run `xacro robot.xacro > robot.urdf` and load the result",
        ),
        (
            lambda: load('<parent link="upper"/>', '<parent link="base"/>'),
            Urdf,
            "robot 'arm' ends in 2 links: say which one is the tip; leaves, by number of joints: upper (1), hand (1)",
        ),
        (
            lambda: load(tip="hnad"),
            Unknown,
            "robot 'arm' has no link 'hnad' (did you mean 'hand'?); its links: base, upper, hand",
        ),
        (lambda: load(base="world"), Unknown, "robot 'arm' has no link 'world'; its links: base, upper, hand"),
        (lambda: load(base="hand", tip="hand"), Urdf, "URDF: base and tip are both 'hand': a chain needs two links"),
    ]
)
def test_wrong_urdf_is_named_with_its_line(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


def test_a_missing_urdf_file_is_named(tmp_path: Path) -> None:
    file = tmp_path / "none.urdf"
    with pytest.raises(Invalid) as caught:
        bik.Robot.from_urdf(file)
    assert str(caught.value).startswith(f"cannot read '{file}': ")  # then the operating system's reason


def test_urdf_in_another_encoding_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_bytes("<?xml version='1.0'?>\n<robot name='Müller'/>".encode("latin-1"))
    message = f"{file}: URDF line 2: byte 0xfc is not UTF-8; save the file with the encoding UTF-8"
    assert_told(lambda: bik.Robot.from_urdf(file), Urdf, message)


@pytest.mark.parametrize("text", ["<robot", ARM.replace("revolute", "floating", 1)])
def test_an_error_of_a_file_names_it(tmp_path: Path, text: str) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(text)
    with pytest.raises(Urdf) as of_text:
        bik.Robot.from_urdf(text)
    with pytest.raises(Urdf) as of_file:
        bik.Robot.from_urdf(file)
    assert str(of_file.value) == f"{file}: {of_text.value}"


def test_an_error_of_an_srdf_names_that_file_alone(tmp_path: Path) -> None:
    urdf, srdf = tmp_path / "arm.urdf", tmp_path / "arm.srdf"
    urdf.write_text(ARM)
    srdf.write_text("<sdf/>")
    wrong = "SRDF line 1: the outermost element must be <robot>, found <sdf>"
    assert_told(lambda: bik.Robot.from_urdf(urdf, srdf=srdf), Urdf, f"{srdf}: {wrong}")
    assert_told(lambda: bik.Robot.from_urdf(urdf, srdf="<sdf/>"), Urdf, wrong)
    srdf.write_bytes("<robot name='Müller'/>".encode("latin-1"))
    assert_told(
        lambda: bik.Robot.from_urdf(urdf).with_srdf(srdf),
        Urdf,
        f"{srdf}: SRDF line 1: byte 0xfc is not UTF-8; save the file with the encoding UTF-8",
    )


def test_a_file_of_urdf_is_read_by_name_and_by_path(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(ARM)
    assert bik.Robot.from_urdf(file) == bik.Robot.from_urdf(str(file)) == bik.Robot.from_urdf(ARM)
