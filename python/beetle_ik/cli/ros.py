"""`beetle-ik ros`: a ROS 2 node without a ROS installation."""

import gc
import os
import signal
from typing import Annotated, Any

import typer

from .. import InvalidInputError, Limits, Robot
from ..installed.needs import library
from .options import BaseLink, LinkRadius, RobotName, TipLink, Trusted, UrdfFile, load_robot

_TOPICS = "Topics"


def _topic(name: str, what: str) -> Any:
    return typer.Option(f"--{name}", help=what, rich_help_panel=_TOPICS)


def ros(
    robot: RobotName = None,
    *,
    robot_description: Annotated[
        bool, typer.Option("--robot-description", help="Take the robot from the topic of the description.")
    ] = False,
    rate: Annotated[float, typer.Option(help="Commands per second while a target is followed.")] = 100.0,
    acceleration: Annotated[float, typer.Option(help="Acceleration limit of each joint (rad/s^2, m/s^2).")] = 5.0,
    jerk: Annotated[float, typer.Option(help="Jerk limit of each joint (rad/s^3, m/s^3).")] = 100.0,
    domain: Annotated[int | None, typer.Option(help="Domain; default: ROS_DOMAIN_ID, else 0.")] = None,
    description: Annotated[str, _topic("description", "std_msgs/String, read.")] = "robot_description",
    states: Annotated[str, _topic("states", "sensor_msgs/JointState, read.")] = "joint_states",
    target_pose: Annotated[str, _topic("target-pose", "geometry_msgs/PoseStamped, followed.")] = "beetle/target_pose",
    target_twist: Annotated[
        str, _topic("target-twist", "geometry_msgs/TwistStamped, followed.")
    ] = "beetle/target_twist",
    goal: Annotated[str, _topic("goal", "geometry_msgs/PoseStamped, planned to.")] = "beetle/goal_pose",
    obstacles: Annotated[
        str, _topic("obstacles", "visualization_msgs/MarkerArray, kept clear of by plans.")
    ] = "beetle/obstacles",
    commands: Annotated[
        str, _topic("commands", "trajectory_msgs/JointTrajectory, written.")
    ] = "joint_trajectory_controller/joint_trajectory",
    planned: Annotated[str, _topic("planned", "visualization_msgs/MarkerArray, written.")] = "beetle/planned",
    urdf: UrdfFile = None,
    tip: TipLink = None,
    base: BaseLink = None,
    link_radius: LinkRadius = None,
    trusted: Trusted = False,
) -> None:
    """Serve ROS 2 over DDS, without a ROS installation: follow poses and twists, plan to goals. Ctrl-C ends it."""
    library("cyclonedds", "cyclonedds", "beetle-ik ros", extra="ros")
    from ..interop.ros.node import Node, Topics

    given = robot is not None or urdf is not None
    if given == robot_description:
        raise InvalidInputError("give either a robot, such as --urdf arm.urdf, or --robot-description")
    if not 1.0 <= rate <= 1000.0:
        raise InvalidInputError(f"--rate must be from 1 to 1000 commands per second, got {rate:g}")

    def load(text: str) -> Robot:
        arm = Robot.from_urdf(text, base=base, tip=tip)
        return arm if link_radius is None else arm.with_capsules(radius=link_radius)

    node = Node(
        load_robot(robot, urdf, base, tip, link_radius, trusted=trusted) if given else None,
        load,
        Limits(acceleration=acceleration, jerk=jerk),
        rate,
        _domain() if domain is None else domain,
        Topics(description, states, target_pose, target_twist, goal, obstacles, commands, planned),
        _say,
    )
    for ending in (signal.SIGINT, signal.SIGTERM):  # a background process may have been started without the first
        signal.signal(ending, signal.default_int_handler)
    try:
        node.run()
    except KeyboardInterrupt:
        gc.freeze()  # what is left is freed by the system: to search it for cycles first takes most of the end
        raise typer.Exit from None  # the way to end it


def _domain() -> int:
    text = os.environ.get("ROS_DOMAIN_ID", "") or "0"
    if not text.isdecimal():
        raise InvalidInputError(f"ROS_DOMAIN_ID must be a whole number, got {text!r:.60}")
    return int(text)


def _say(level: str, text: str) -> None:
    typer.echo(f"{level}: {text}", err=level != "info")


__all__ = ["ros"]
