"""Robot and limits from the parameters of both nodes."""

from rclpy.node import Node

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


def say_by(node: Node):
    """Logs lines of the shared logic by the node's logger."""
    return lambda level, text: getattr(node.get_logger(), level)(text)
