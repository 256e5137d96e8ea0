"""The ROS 2 nodes of examples/ros2, against a stub of rclpy's interface and of the message definitions.

The stub knows the names and types of fields and refuses others, as the generated messages do. No ROS runs here.
"""

import importlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

import beetle_ik as bik

NODES = Path(__file__).parents[2] / "examples" / "ros2"
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


def message(type_name: str, /, **fields: type) -> type:
    """A message class: fields of these types, empty unless given; nothing else can be set."""

    def set_field(self: Any, field: str, value: object) -> None:
        if field not in fields:
            raise AttributeError(f"{type_name} has no field {field}")
        if not isinstance(value, fields[field]):
            raise TypeError(f"{type_name}.{field} is a {fields[field].__name__}, not {value!r}")
        object.__setattr__(self, field, value)

    def init(self: Any, **values: object) -> None:
        for field, kind in fields.items():
            setattr(self, field, values.pop(field, kind()))
        assert not values, f"{type_name} has no fields {list(values)}"

    return type(type_name, (), {"__init__": init, "__setattr__": set_field})


STAMP = message("Time", sec=int, nanosec=int)
DURATION = message("Duration", sec=int, nanosec=int)
HEADER = message("Header", stamp=STAMP, frame_id=str)
POINT = message("Point", x=float, y=float, z=float)
QUATERNION = message("Quaternion", x=float, y=float, z=float, w=float)
POSE = message("Pose", position=POINT, orientation=QUATERNION)
POSE_STAMPED = message("PoseStamped", header=HEADER, pose=POSE)
VECTOR = message("Vector3", x=float, y=float, z=float)
TWIST = message("Twist", linear=VECTOR, angular=VECTOR)
TWIST_STAMPED = message("TwistStamped", header=HEADER, twist=TWIST)
MARKERS = message("MarkerArray", markers=list)
JOINT_STATE = message("JointState", header=HEADER, name=list, position=list, velocity=list, effort=list)
NUMBERS = message("Float64MultiArray", layout=object, data=list)
POINTS = message(
    "JointTrajectoryPoint", positions=list, velocities=list, accelerations=list, effort=list, time_from_start=DURATION
)
TRAJECTORY = message("JointTrajectory", header=HEADER, joint_names=list, points=list)
GOAL = message("FollowJointTrajectory_Goal", trajectory=TRAJECTORY)
RESPONSE = message("Trigger_Response", success=bool, message=str)


class Instant:
    """rclpy.time.Time."""

    def __init__(self, nanoseconds: int) -> None:
        self.nanoseconds = nanoseconds

    @classmethod
    def from_msg(cls, stamp: Any) -> "Instant":
        return cls(stamp.sec * 1_000_000_000 + stamp.nanosec)

    def __sub__(self, other: "Instant") -> "Instant":
        return Instant(self.nanoseconds - other.nanoseconds)


class Node:
    """rclpy.node.Node, with what the nodes use of it."""

    parameters: dict[str, object] = {}  # noqa: RUF012

    def __init__(self, name: str) -> None:
        self.name, self.now, self.log = name, 0, []
        self.callbacks: dict[str, Callable[..., Any]] = {}
        self.published: list[Any] = []

    def declare_parameter(self, name: str, default: object) -> SimpleNamespace:
        return SimpleNamespace(value=self.parameters.get(name, default))

    def get_parameter(self, name: str) -> SimpleNamespace:
        return SimpleNamespace(value=self.parameters.get(name, {"acceleration": 5.0, "jerk": 100.0}.get(name, "")))

    def create_publisher(self, kind: type, topic: str, depth: int) -> SimpleNamespace:
        assert (kind, depth) == (NUMBERS, 1)
        self.topic = topic
        return SimpleNamespace(publish=self.published.append)

    def create_subscription(self, kind: type, topic: str, callback: Callable[..., Any], depth: int) -> None:
        assert kind in (JOINT_STATE, POSE_STAMPED, TWIST_STAMPED, MARKERS)
        assert depth == 1
        self.callbacks[topic] = callback

    def create_service(self, kind: object, name: str, callback: Callable[..., Any]) -> None:
        del kind
        self.callbacks[name] = callback

    def create_timer(self, period: float, callback: Callable[[], None]) -> None:
        self.period, self.callbacks["timer"] = period, callback

    def get_clock(self) -> SimpleNamespace:
        return SimpleNamespace(now=lambda: Instant(self.now))

    def get_logger(self) -> SimpleNamespace:
        def say(level: str) -> Callable[[str], None]:
            return lambda text: self.log.append((level, text))

        return SimpleNamespace(info=say("info"), warning=say("warning"), error=say("error"))


class Future:
    """A result that is there at once."""

    def __init__(self, value: object) -> None:
        self.value = value

    def result(self) -> object:
        return self.value

    def add_done_callback(self, callback: Callable[["Future"], None]) -> None:
        callback(self)


class Controller:
    """A joint_trajectory_controller, in place of rclpy.action.ActionClient."""

    ready, accepted, status, goals = True, True, 4, []

    def __init__(self, node: Node, kind: object, name: str) -> None:
        del node, kind
        self.name = name

    def server_is_ready(self) -> bool:
        return self.ready

    def send_goal_async(self, goal: Any) -> Future:
        self.goals.append(goal)
        outcome = SimpleNamespace(
            status=self.status, result=SimpleNamespace(error_code=-4, error_string="path tolerance")
        )
        return Future(SimpleNamespace(accepted=self.accepted, get_result_async=lambda: Future(outcome)))


MODULES: dict[str, dict[str, object]] = {
    "rclpy": {},
    "rclpy.node": {"Node": Node},
    "rclpy.time": {"Time": Instant},
    "rclpy.task": {"Future": Future},
    "rclpy.action": {"ActionClient": Controller},
    "action_msgs.msg": {"GoalStatus": SimpleNamespace(STATUS_SUCCEEDED=4)},
    "builtin_interfaces.msg": {"Duration": DURATION},
    "control_msgs.action": {"FollowJointTrajectory": SimpleNamespace(Goal=GOAL)},
    "geometry_msgs.msg": {"PoseStamped": POSE_STAMPED, "TwistStamped": TWIST_STAMPED},
    "sensor_msgs.msg": {"JointState": JOINT_STATE},
    "std_msgs.msg": {"Float64MultiArray": NUMBERS},
    "std_srvs.srv": {"Trigger": SimpleNamespace(Request=object, Response=RESPONSE)},
    "trajectory_msgs.msg": {"JointTrajectory": TRAJECTORY, "JointTrajectoryPoint": POINTS},
    "visualization_msgs.msg": {"MarkerArray": MARKERS},
}


@pytest.fixture
def ros(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    for name, content in MODULES.items():
        for made in (name.split(".")[0], name):
            if made not in sys.modules:
                monkeypatch.setitem(sys.modules, made, ModuleType(made))
        vars(sys.modules[name]).update(content)
    monkeypatch.syspath_prepend(str(NODES))
    monkeypatch.setattr(Node, "parameters", {"robot_description": URDF, "rate": 100.0})
    monkeypatch.setattr(Controller, "goals", [])
    yield
    for name in ("arm", "servo", "plan_and_execute"):
        sys.modules.pop(name, None)


@pytest.fixture
def servo(ros: None) -> Any:
    del ros
    return importlib.import_module("servo").ServoNode()


@pytest.fixture
def planner(ros: None) -> Any:
    del ros
    return importlib.import_module("plan_and_execute").PlannerNode()


ROBOT = bik.Robot.from_urdf(URDF)
START = np.array([0.1, 0.4, 0.8])
# As the driver sends them: in an order of its own, with the gripper's joint.
STATE = JOINT_STATE(name=["elbow", "gripper", "lift", "shoulder"], position=[0.8, 0.02, 0.1, 0.4])
GRIPPER = JOINT_STATE(name=["gripper"], position=[0.02])


def posed(q: np.ndarray, *, frame: str = "base", seconds: int = 0, nanoseconds: int = 0) -> Any:
    """The pose of the tip at q as a message."""
    tip = ROBOT.fk(q)
    half = 0.5 * np.arctan2(tip[1, 0], tip[0, 0])
    place = POINT(x=float(tip[0, 3]), y=float(tip[1, 3]), z=float(tip[2, 3]))
    turn = QUATERNION(z=float(np.sin(half)), w=float(np.cos(half)))
    header = HEADER(stamp=STAMP(sec=seconds, nanosec=nanoseconds), frame_id=frame)
    return POSE_STAMPED(header=header, pose=POSE(position=place, orientation=turn))


def commands(node: Any) -> np.ndarray:
    return np.array([sent.data for sent in node.published])


def test_the_servo_waits_for_the_joint_states(servo: Any) -> None:
    servo.callbacks["joint_states"](GRIPPER)
    servo.callbacks["timer"]()
    assert (servo.published, servo.period, servo.topic) == ([], 0.01, "~/commands")
    servo.callbacks["joint_states"](STATE)
    servo.callbacks["timer"]()
    np.testing.assert_array_equal(commands(servo), [START])


def test_the_servo_reaches_the_pose_within_the_limits(servo: Any) -> None:
    servo.callbacks["joint_states"](STATE)
    goal = posed(START + 0.2)
    for _ in range(200):
        servo.callbacks["~/target"](goal)
        servo.callbacks["timer"]()
    q = commands(servo)
    np.testing.assert_allclose(ROBOT.fk(q[-1]), ROBOT.fk(START + 0.2), atol=1e-4)
    still = np.vstack([START, START, START, q])
    assert np.abs(np.diff(still, axis=0)).max() <= 0.01 + 1e-9
    assert np.abs(np.diff(still, 2, axis=0)).max() <= 5.0 * 0.01**2 + 1e-9
    assert np.abs(np.diff(still, 3, axis=0)).max() <= 100.0 * 0.01**3 + 1e-9


def test_a_stamped_pose_is_as_old_as_its_stamp_says(servo: Any) -> None:
    servo.callbacks["joint_states"](STATE)
    seen = []
    follow = servo.servo.jog.tracker.step
    servo.servo.jog.tracker = SimpleNamespace(
        step=lambda *target, **options: seen.append(options) or follow(*target), time=3.0, dt=0.01
    )
    servo.now = 5_000_000_000
    servo.callbacks["~/target"](posed(START, seconds=4, nanoseconds=950_000_000))
    servo.callbacks["timer"]()
    assert seen == [{"stamp": pytest.approx(3.0 + 0.01 - 0.05)}]


def test_the_servo_refuses_other_frames_and_poses_that_are_none(servo: Any) -> None:
    servo.callbacks["joint_states"](STATE)
    servo.callbacks["~/target"](posed(START, frame="camera"))
    broken = posed(START)
    broken.pose.position.x = float("nan")
    servo.callbacks["~/target"](broken)
    servo.callbacks["timer"]()
    errors = [text for level, text in servo.log if level == "error"]
    assert errors[0] == "~/target: the pose is given in frame 'camera', and this node takes those in 'base'"
    assert "nan" in errors[1].lower()
    np.testing.assert_array_equal(commands(servo), [START])


def test_the_servo_stops_on_request(servo: Any) -> None:
    stop = servo.callbacks["~/stop"]
    assert stop(None, RESPONSE()).message == "the arm has not started"
    servo.callbacks["joint_states"](STATE)
    servo.callbacks["~/target"](posed(START + 0.5))
    for _ in range(20):
        servo.callbacks["timer"]()
    answer = stop(None, RESPONSE())
    assert answer.success
    ticks = round(float(answer.message.split()[2]) / 0.01)
    for _ in range(ticks + 3):
        servo.callbacks["timer"]()
    assert np.ptp(commands(servo)[-2:], axis=0).max() == 0.0


def test_the_planner_sends_a_motion_to_the_goal(planner: Any) -> None:
    planner.callbacks["joint_states"](STATE)
    planner.callbacks["~/goal"](posed(START + 0.3))
    (goal,) = Controller.goals
    sent = goal.trajectory
    assert sent.joint_names == ["lift", "shoulder", "elbow"]
    assert sent.points[0].positions == START.tolist()
    np.testing.assert_allclose(ROBOT.fk(sent.points[-1].positions), ROBOT.fk(START + 0.3), atol=1e-5)
    np.testing.assert_allclose(sent.points[-1].velocities, 0.0, atol=1e-9)
    times = [point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec for point in sent.points]
    assert times[0] == 0.0
    assert np.all(np.diff(times) > 0.0)
    assert planner.log == [("info", "arrived")]
    assert not planner.busy


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"ready": False}, "~/goal: the controller's action server is not there: is the controller active?"),
        ({"accepted": False}, "the controller rejected the trajectory"),
        ({"status": 6}, "the motion ended with error code -4: path tolerance"),
    ],
)
def test_the_planner_says_what_went_wrong(planner: Any, change: dict[str, Any], said: str, monkeypatch: Any) -> None:
    for name, value in change.items():
        monkeypatch.setattr(Controller, name, value)
    planner.callbacks["joint_states"](STATE)
    planner.callbacks["~/goal"](posed(START + 0.3))
    assert planner.log == [("error", said)]
    assert not planner.busy


def test_the_planner_refuses_what_it_cannot_begin(planner: Any) -> None:
    planner.callbacks["~/goal"](posed(START))
    planner.callbacks["joint_states"](STATE)
    planner.busy = True
    planner.callbacks["~/goal"](posed(START))
    planner.busy = False
    far = posed(START)
    far.pose.position.x = 9.0
    planner.callbacks["~/goal"](far)
    errors = [text for _, text in planner.log]
    assert errors[:2] == [
        "~/goal: no joint states have arrived yet",
        "~/goal: a motion is under way: send the goal when it has ended",
    ]
    assert len(errors) == 3
    assert Controller.goals == []


def test_a_node_without_a_robot_says_what_is_missing(ros: None, monkeypatch: pytest.MonkeyPatch) -> None:
    del ros
    monkeypatch.setattr(Node, "parameters", {})
    with pytest.raises(ValueError, match="the parameter robot_description is empty"):
        importlib.import_module("servo").ServoNode()
