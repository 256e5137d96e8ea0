"""Robot, configuration and pose from the parameters and messages of both nodes."""

import numpy as np
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState

import beetle_ik as bik


def robot_of(node: Node) -> bik.Robot:
    """The robot of the parameters robot_description, base and tip."""
    for name in ("robot_description", "base", "tip"):
        node.declare_parameter(name, "")
    description = node.get_parameter("robot_description").value
    if not description:
        raise ValueError(
            "the parameter robot_description is empty: "
            "pass the URDF of the arm as text"
        )
    base, tip = (node.get_parameter(name).value or None for name in ("base", "tip"))
    return bik.Robot.from_urdf(description, base=base, tip=tip)


def limits_of(node: Node) -> bik.Limits:
    """Returns the limits of the URDF with those of the parameters.

    The parameters are acceleration (rad/s^2, m/s^2) and jerk (rad/s^3, m/s^3).
    """
    node.declare_parameter("acceleration", 5.0)
    node.declare_parameter("jerk", 100.0)
    return bik.Limits(
        acceleration=node.get_parameter("acceleration").value,
        jerk=node.get_parameter("jerk").value,
    )


def configuration(robot: bik.Robot, message: JointState) -> np.ndarray | None:
    """Returns the configuration (n,) in the order of the robot.

    None if a joint is missing, as in the message of a gripper.
    """
    position = dict(zip(message.name, message.position, strict=False))
    if not all(name in position for name in robot.joint_names):
        return None
    return np.array([position[name] for name in robot.joint_names])


def pose_of(message: PoseStamped) -> np.ndarray:
    """The pose (4, 4) of the message."""
    position, turn = message.pose.position, message.pose.orientation
    return bik.pose(
        [position.x, position.y, position.z], xyzw=[turn.x, turn.y, turn.z, turn.w]
    )


def refusal(robot: bik.Robot, message: PoseStamped) -> str | None:
    """Returns why the pose cannot be used; None if it can.

    Transform poses of other frames with tf2 before you send them.
    """
    base = robot.link_names[0]
    if message.header.frame_id not in ("", base):
        return (
            f"the pose is given in frame '{message.header.frame_id}', "
            f"and this node takes those in '{base}'"
        )
    return None
