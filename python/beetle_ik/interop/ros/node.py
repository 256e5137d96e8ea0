"""The node of `beetle-ik ros`: servo and planner on DDS."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from cyclonedds.util import duration

from ..._core import InvalidInputError, Limits, Plan, Robot, Step
from . import messages
from .dds import Graph, quality
from .joint_trajectory import to_ros
from .planner import Planner
from .reading import States
from .servo import Say, Servo, answered

_WAKE = 0.05  # s: Ctrl-C is noticed within this time
_POINTS = 50  # of the line that shows a plan


@dataclass(frozen=True)
class Topics:
    """Names of topics."""

    description: str = "robot_description"
    states: str = "joint_states"
    pose: str = "beetle/target_pose"
    twist: str = "beetle/target_twist"
    goal: str = "beetle/goal_pose"
    obstacles: str = "beetle/obstacles"
    commands: str = "joint_trajectory_controller/joint_trajectory"
    planned: str = "beetle/planned"


class Node:
    """Waits for the robot, then follows targets and plans to goals, until `run` is interrupted.

    Args:
        robot: the arm; None: from the description.
        load: makes the arm of a description.
        limits: its limits.
        rate: commands per second while a target is followed.
        domain: number of the domain.
        topics: names of topics.
        say: logs a level and a text.
    """

    def __init__(
        self,
        robot: Robot | None,
        load: Callable[[str], Robot],
        limits: Limits,
        rate: float,
        domain: int,
        topics: Topics,
        say: Say,
    ) -> None:
        """Opens the topics."""
        self.load, self.limits, self.dt, self.topics = load, limits, 1.0 / rate, topics
        self.log = say
        self.said: dict[str, str] = {}
        self.graph = Graph(domain, self.say)
        self.busy_until = 0.0
        self.servo: Servo | None = None
        self.description = ""
        self.commands = self.graph.publisher(topics.commands, messages.JointTrajectory, quality())
        self.planned = self.graph.publisher(topics.planned, messages.MarkerArray, quality(latched=True, depth=1))
        if robot is not None:
            self.take(robot)
        else:
            latched = quality(latched=True, depth=1)
            self.hear(topics.description, messages.String, latched, self.on_description)
            self.say("info", f"waits for {topics.description}")

    def say(self, level: str, text: str) -> None:
        """Logs a line, unless the last one of its level was the same: a stream repeats its mistakes."""
        if self.said.get(level) != text:
            self.said[level] = text
            self.log(level, text)

    def hear(self, topic: str, kind: type, quality: Any, handle: Callable[[Any], None]) -> None:
        """Subscribes to a topic; a message that cannot be used is answered by a line of the log."""
        self.graph.subscribe(topic, kind, quality, lambda message: answered(self.say, topic, handle, message))

    def take(self, robot: Robot) -> None:
        """Begins with a robot."""
        self.robot, self.states = robot, States(robot)
        servo = self.servo = Servo(robot, self.limits, self.dt, self.say)
        self.planner = Planner(robot, self.limits)
        topics, fresh = self.topics, quality(reliable=False, depth=5)
        self.hear(topics.states, messages.JointState, fresh, self.states.read)
        self.hear(topics.obstacles, messages.MarkerArray, quality(), self.planner.markers)
        self.hear(
            topics.pose, messages.PoseStamped, quality(depth=1), lambda given: self.follow(servo, servo.pose, given)
        )
        self.hear(
            topics.twist, messages.TwistStamped, quality(depth=1), lambda given: self.follow(servo, servo.move, given)
        )
        self.hear(topics.goal, messages.PoseStamped, quality(), self.on_goal)
        self.say("info", f"ready: robot '{robot.name}' from '{robot.link_names[0]}' to '{robot.tips[0]}'")

    def on_description(self, message: Any) -> None:
        """Loads the robot of a description, once."""
        if message.data == self.description:
            return
        if self.description:
            raise InvalidInputError("another description than before: restart the node to use it")
        if "<" not in message.data:  # else a path, which nobody may make this process read
            raise InvalidInputError(f"expected the text of a URDF, got {message.data!r:.60}")
        self.take(self.load(message.data))
        self.description = message.data

    def follow(self, servo: Servo, keep: Callable[[Any], None], message: Any) -> None:
        """Keeps a target, and starts the servo where the arm is if it rests."""
        if time.monotonic() < self.busy_until:
            raise InvalidInputError("a planned motion is under way: send targets when it has ended")
        if servo.jog is None:
            servo.start(self.states.require())
        keep(message)

    def on_goal(self, message: Any) -> None:
        """Plans from rest where the arm is, and sends the motion."""
        if time.monotonic() < self.busy_until:
            raise InvalidInputError("a planned motion is under way: send the goal when it has ended")
        if self.servo is not None and self.servo.jog is not None:
            raise InvalidInputError("the arm follows targets: send the goal when it rests")
        plan = self.planner.plan(self.states.require(), message)
        if not plan.success:
            raise InvalidInputError(plan.message)
        self.commands.write(_trajectory(plan))
        self.planned.write(self.line(plan))
        self.busy_until = time.monotonic() + plan.trajectory.duration
        self.log("info", f"planned {plan.trajectory.duration:.3f} s")

    def line(self, plan: Plan) -> messages.MarkerArray:
        """Returns the way of the tip as a line."""
        motion = plan.trajectory
        places = self.robot.fk(motion.at(np.linspace(0.0, motion.duration, _POINTS))[0])[:, :3, 3]
        return messages.MarkerArray(
            [
                messages.Marker(
                    header=messages.Header(frame_id=self.robot.link_names[0]),
                    ns="beetle_ik",
                    type=4,  # LINE_STRIP
                    scale=messages.Vector3(x=0.005),
                    color=messages.ColorRGBA(0.0, 0.62, 0.45, 1.0),
                    points=[messages.Point(*place.tolist()) for place in places],
                )
            ]
        )

    def tick(self) -> None:
        """Sends a command while a target is followed."""
        step = None if self.servo is None else self.servo.tick(time.time_ns())
        if step is None:
            return
        self.command([step])
        if self.servo is not None and self.servo.rests:
            self.servo.jog = None  # the next target starts where the arm is then
            self.log("info", "rests")

    def command(self, steps: list[Step]) -> None:
        """Sends the commands of ticks to come."""
        points = [
            messages.JointTrajectoryPoint(positions=step.q.tolist(), time_from_start=_duration((k + 1) * self.dt))
            for k, step in enumerate(steps)
        ]
        self.commands.write(messages.JointTrajectory(joint_names=list(self.robot.joint_names), points=points))

    def end(self) -> None:
        """Sends the whole stop of an arm that follows a target, in one message."""
        if self.servo is not None and self.servo.jog is not None:
            self.command(self.servo.stopping())
            self.commands.wait_for_acks(duration(milliseconds=50))

    def run(self) -> None:
        """Serves until an exception, as Ctrl-C raises one."""
        try:
            self.serve()
        finally:
            self.end()

    def serve(self) -> None:
        """Waits for messages and sends commands, for ever."""
        due = time.monotonic()
        while True:
            self.graph.wait(min(max(due - time.monotonic(), 0.0), _WAKE))
            now = time.monotonic()
            if now >= due:
                self.tick()
                due = max(due + self.dt, now)  # ticks that a plan has held up are left out


def _trajectory(plan: Plan) -> messages.JointTrajectory:
    """Returns the plan every 10 ms, with velocities and accelerations."""
    given = to_ros(plan.trajectory, dt=0.01)
    points = [
        messages.JointTrajectoryPoint(**point | {"time_from_start": messages.Duration(**point["time_from_start"])})
        for point in given["points"]
    ]
    return messages.JointTrajectory(joint_names=given["joint_names"], points=points)


def _duration(seconds: float) -> messages.Duration:
    nanoseconds = round(seconds * 1e9)
    return messages.Duration(nanoseconds // 1_000_000_000, nanoseconds % 1_000_000_000)
