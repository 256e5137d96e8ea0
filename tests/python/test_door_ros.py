"""The node `beetle-ik ros` in a process of its own, and cyclonedds here; skipped where that or loopback is missing."""

import gc
import os
import re
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer

import beetle_ik as bik

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed")
LOOPBACK = (
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address='127.0.0.1'/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<Peers><Peer address='127.0.0.1'/></Peers></Discovery></Domain></CycloneDDS>"
)
os.environ["CYCLONEDDS_URI"] = LOOPBACK  # of this process and of the nodes that it starts

from cyclonedds.core import DDSException  # noqa: E402

from beetle_ik.cli.ros import ros  # noqa: E402
from beetle_ik.interop.ros import messages as msg  # noqa: E402
from beetle_ik.interop.ros import node as ros_node  # noqa: E402
from beetle_ik.interop.ros.dds import Graph, mangled, quality  # noqa: E402
from beetle_ik.interop.ros.node import Topics  # noqa: E402

WAIT = 60.0  # s, for messages that must come
URDF = """<robot name="arm">
  <link name="base"/><link name="upper"/><link name="fore"/><link name="hand"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <joint name="shoulder" type="revolute"><parent link="upper"/><child link="fore"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="fore"/><child link="hand"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
</robot>"""
ROBOT = bik.Robot.from_urdf(URDF)
START = np.array([0.1, 0.4, -0.7])
TOPICS = Topics()


class Peer:
    """The other side: publishes what the node reads, and keeps what it writes."""

    def __init__(self, domain: int) -> None:
        self.graph = Graph(domain, lambda level, text: pytest.fail(f"{level}: {text}"))
        topics = {
            "description": (TOPICS.description, msg.String, quality(latched=True, depth=1)),
            "states": (TOPICS.states, msg.JointState, quality(latched=True, depth=1)),
            "pose": (TOPICS.pose, msg.PoseStamped, quality(latched=True, depth=1)),
            "twist": (TOPICS.twist, msg.TwistStamped, quality(latched=True, depth=1)),
            "goal": (TOPICS.goal, msg.PoseStamped, quality(latched=True, depth=1)),
            "obstacles": (TOPICS.obstacles, msg.MarkerArray, quality(latched=True, depth=1)),
        }
        self.writers = {name: self.graph.publisher(*of) for name, of in topics.items()}
        self.commands: list[msg.JointTrajectory] = []
        self.planned: list[msg.MarkerArray] = []
        self.graph.subscribe(TOPICS.commands, msg.JointTrajectory, quality(), self.commands.append)
        self.graph.subscribe(TOPICS.planned, msg.MarkerArray, quality(latched=True), self.planned.append)

    def send(self, name: str, message: Any) -> None:
        self.writers[name].write(message)

    def until(self, done: Callable[[], object], again: Callable[[], None] | None = None) -> None:
        """Handles messages until it is done; `again` sends once more what a reader may have missed."""
        for _ in range(int(WAIT / 0.05)):
            if done():
                return
            if again is not None:
                again()
            self.graph.wait(0.05)
        pytest.fail("nothing came")


class Node:
    """The command in a process of its own, and what it has said."""

    def __init__(self, domain: int, *options: str) -> None:
        command = [sys.executable, "-m", "beetle_ik", "ros", "--domain", str(domain), *options]
        self.process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=os.environ | {"PYTHONUNBUFFERED": "1"},
        )
        self.said: list[str] = []

    def says(self, begin: str, part: str = "") -> str:
        """Waits for a line."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.said.append(line.rstrip("\n"))
            if line.startswith(begin) and part in line:
                return self.said[-1]
        raise AssertionError(f"no line {begin!r} in {self.said}")

    def ends(self) -> int:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        self.process.communicate(timeout=60)
        return self.process.returncode


def poses(q: np.ndarray, frame: str = "base") -> msg.PoseStamped:
    tip = ROBOT.fk(q)
    half = 0.5 * np.arctan2(tip[1, 0], tip[0, 0])
    return msg.PoseStamped(
        msg.Header(frame_id=frame),
        msg.Pose(msg.Point(*tip[:3, 3].tolist()), msg.Quaternion(0.0, 0.0, float(np.sin(half)), float(np.cos(half)))),
    )


def state(q: np.ndarray) -> msg.JointState:
    """The joints in another order than the robot's, among those of a gripper."""
    return msg.JointState(
        name=["finger", "elbow", "lift", "shoulder"], position=[0.02, *np.asarray(q)[[2, 0, 1]].tolist()]
    )


@pytest.fixture
def domain() -> int:
    number = 1 + os.getpid() % 100
    try:
        Graph(number, lambda *_: None)
    except DDSException as missing:
        pytest.skip(f"no DDS on loopback here: {missing}")
    return number


@pytest.fixture
def node(domain: int) -> Iterator[Node]:
    started = Node(domain, "--robot-description")
    yield started
    if started.process.poll() is None:
        started.process.kill()
        started.process.communicate()


def test_topics_and_types_have_the_names_of_ros() -> None:
    assert mangled("/joint_states") == mangled("joint_states") == "rt/joint_states"
    assert msg.JointState.__idl__.idl_transformed_typename == "sensor_msgs::msg::dds_::JointState_"
    assert msg.JointTrajectory.__idl__.idl_transformed_typename == "trajectory_msgs::msg::dds_::JointTrajectory_"


@pytest.mark.parametrize("release", ["ROS2_HUMBLE", "ROS2_JAZZY", "ROS2_KILTED"])
def test_messages_are_bytes_of_ros(release: str) -> None:
    typesys = pytest.importorskip("rosbags.typesys", reason="rosbags is not installed")
    store = typesys.get_typestore(typesys.Stores[release])
    marker = msg.Marker(msg.Header(msg.Time(3, 4), "base"), "a", 5, 1, 2, points=[msg.Point(1.0, 2.0, 3.0)], text="é")
    marker.texture.data, marker.mesh_file.filename = [1, 2, 3], "part.dae"
    point = msg.JointTrajectoryPoint([1.0, 2.0], [], [0.5], [], msg.Duration(1, 2))
    for message in (
        msg.String("<robot/>"),
        state(START),
        poses(START),
        msg.TwistStamped(msg.Header(frame_id="hand"), msg.Twist(msg.Vector3(1.0, 2.0, 3.0))),
        msg.JointTrajectory(joint_names=["a", "bc"], points=[point, point]),
        msg.MarkerArray([marker, msg.Marker()]),
    ):
        name = type(message).__idl__.idl_transformed_typename.replace("::", "/").replace("dds_/", "").removesuffix("_")
        data = bytes(message.serialize(use_version_2=False))
        assert bytes(store.serialize_cdr(store.deserialize_cdr(data, name), name)) == data


def test_a_goal_becomes_a_trajectory_around_markers(node: Node, domain: int) -> None:
    peer = Peer(domain)
    node.says("info: waits for robot_description")
    peer.send("description", msg.String("/etc/passwd"))
    assert node.says("error") == "error: robot_description: expected the text of a URDF, got '/etc/passwd'"
    peer.send("description", msg.String(URDF))
    assert node.says("info: ready") == "info: ready: robot 'arm' from 'base' to 'hand'"
    peer.until(
        lambda: peer.commands, lambda: (peer.send("states", state(START)), peer.send("goal", poses(START + 0.3)))
    )
    sent = peer.commands[0]
    assert sent.joint_names == ["lift", "shoulder", "elbow"]
    np.testing.assert_allclose(sent.points[0].positions, START, atol=1e-12)
    np.testing.assert_allclose(ROBOT.fk(sent.points[-1].positions), ROBOT.fk(START + 0.3), atol=1e-5)
    peer.until(lambda: peer.planned)
    line = peer.planned[0].markers[0].points
    np.testing.assert_allclose([line[0].x, line[0].y, line[0].z], ROBOT.fk(START)[:3, 3], atol=1e-9)
    assert node.ends() == 0


def test_messages_that_cannot_be_used_are_answered_by_a_line(node: Node, domain: int) -> None:
    peer = Peer(domain)
    peer.send("description", msg.String(URDF))
    node.says("info: ready")
    states = "error: joint_states: "
    for wrong, said in (
        (msg.JointState(name=["lift"], position=[]), states + "1 names, but 0 positions"),
        (msg.JointState(name=["lift"], position=[np.nan]), states + "joint 'lift' is at nan"),
        (msg.JointState(name=["lift", "lift"], position=[0.0, 0.1]), states + "joint 'lift' is there twice"),
    ):
        peer.send("states", wrong)
        assert node.says("error") == said
    peer.send("goal", poses(START))
    assert node.says("error") == "error: beetle/goal_pose: no joint states have arrived yet"
    peer.send("states", msg.JointState(name=["elbow", "lift"], position=[0.0, 0.1]))
    peer.send("pose", poses(START, "camera"))
    assert node.says("error") in (
        "error: beetle/target_pose: no joint states have arrived yet for shoulder",
        "error: beetle/target_pose: no joint states have arrived yet",
        "error: beetle/target_pose: the pose is given in frame 'camera', and this node takes those in 'base'",
    )
    peer.send("obstacles", msg.MarkerArray([msg.Marker(ns="m", id=1, type=9)]))
    assert node.says("error: beetle/obs").endswith(
        "marker m/1: type 9; expected a cube (1), sphere (2) or cylinder (3)"
    )
    assert node.ends() == 0


def send_bytes(peer: Peer, domain: int, data: bytes, number: int) -> None:
    """Sends bytes as a message of the joint states, as a writer without checks would: by a packet of RTPS made here."""
    writer = peer.writers["states"].get_guid().bytes
    body = struct.pack("<HH4x", 0, 16) + writer[12:] + struct.pack("<iI", 0, number) + data
    packet = b"RTPS\x02\x05\x01\x10" + writer[:12] + struct.pack("<BBH", 0x15, 0x05, len(body)) + body
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as port:
        for participant in range(10):
            port.sendto(packet, ("127.0.0.1", 7400 + 250 * domain + 11 + 2 * participant))


@pytest.mark.parametrize("data", [b"\xff" * 20, b"\0" * 8 + b"\x10\0\0\0abcd", b"\0" * 4])
def test_bytes_of_no_message_leave_a_line(node: Node, domain: int, data: bytes) -> None:
    peer = Peer(domain)
    peer.send("description", msg.String(URDF))
    node.says("info: ready")
    peer.send("states", msg.JointState(name=["lift"], position=[]))
    node.says("error: joint_states: 1 names")  # it hears this writer
    for number in range(2, 5):
        send_bytes(peer, domain, b"\0\1\0\0" + data, number)
    node.says("", "deserialization rt/joint_states/sensor_msgs::msg::dds_::JointState_ failed")
    exchange(Peer(domain))
    assert node.ends() == 0


def test_an_end_does_not_search_for_garbage(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(_node: ros_node.Node) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(ros_node.Node, "__init__", lambda *_: None)
    monkeypatch.setattr(ros_node.Node, "run", interrupted)
    kept = [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)]
    try:
        with pytest.raises(typer.Exit):
            ros("ur5e")
        assert gc.get_freeze_count() > 0
    finally:
        gc.unfreeze()
        for each, before in zip((signal.SIGINT, signal.SIGTERM), kept, strict=True):
            signal.signal(each, before)


def test_the_servo_follows_and_stops_when_the_stream_ends(node: Node, domain: int) -> None:
    peer = Peer(domain)
    peer.send("description", msg.String(URDF))
    peer.send("states", state(START))
    node.says("info: ready")
    twist = msg.TwistStamped(msg.Header(), msg.Twist(msg.Vector3(0.0, 0.0, 0.1)))
    peer.until(lambda: len(peer.commands) > 30, lambda: (peer.send("states", state(START)), peer.send("twist", twist)))
    node.says("info: rests")  # nobody sends any more
    peer.until(lambda: len(peer.commands) > 31)
    q = np.array([each.points[0].positions for each in peer.commands])
    assert q[-1, 0] > START[0] + 0.01
    np.testing.assert_allclose(q[:, 1:], np.broadcast_to(START[1:], q[:, 1:].shape), atol=1e-3)
    peer.commands.clear()
    peer.until(lambda: len(peer.commands) > 30, lambda: peer.send("pose", poses(START + 0.02)))
    node.says("info: rests")
    assert node.ends() == 0


def test_ctrl_c_leaves_a_stop_within_the_limits(node: Node, domain: int) -> None:
    peer = Peer(domain)
    peer.send("description", msg.String(URDF))
    peer.send("states", state(START))
    node.says("info: ready")
    twist = msg.TwistStamped(msg.Header(), msg.Twist(msg.Vector3(0.0, 0.0, 0.2)))
    again = lambda: (peer.send("states", state(START)), peer.send("twist", twist))  # noqa: E731
    peer.until(lambda: len(peer.commands) > 30, again)
    node.process.send_signal(signal.SIGINT)
    peer.until(lambda: len(peer.commands[-1].points) > 2, again)
    assert node.ends() == 0
    q = np.array([point.positions for point in peer.commands[-1].points])
    assert np.abs(np.diff(q, 2, axis=0)).max() <= 5.0 * 0.01**2 + 1e-9
    np.testing.assert_array_equal(q[-1], q[-2])


def exchange(peer: Peer) -> None:
    """Sends a goal until a trajectory comes."""
    peer.commands.clear()
    peer.send("description", msg.String(URDF))
    peer.until(
        lambda: peer.commands, lambda: (peer.send("states", state(START)), peer.send("goal", poses(START + 0.1)))
    )


def test_either_side_may_restart(domain: int) -> None:
    peer = Peer(domain)
    for _ in range(2):
        node = Node(domain, "--robot-description")
        exchange(peer)
        assert node.ends() == 0
    del peer
    node = Node(domain, "--robot-description")
    for _ in range(2):
        exchange(Peer(domain))
    assert node.ends() == 0


def test_the_block_of_the_page_runs() -> None:
    page = Path(__file__).parents[2] / "docs" / "ros2_without_ros.md"
    (block,) = re.findall(r"^```py\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    exec(compile(block, page.name, "exec"), {})


def test_the_command_says_what_it_needs(tmp_path: Path) -> None:
    for options, said in (
        ([], "give either a robot, such as --urdf arm.urdf, or --robot-description"),
        (["ur5e", "--robot-description"], "give either a robot, such as --urdf arm.urdf, or --robot-description"),
        (["ur5e", "--rate", "0"], "--rate must be from 1 to 1000 commands per second, got 0"),
    ):
        command = [sys.executable, "-m", "beetle_ik", "ros", *options]
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
        assert (done.returncode, done.stderr) == (2, f"Error: {said}\n")
