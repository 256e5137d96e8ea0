"""`beetle-ik robots`: the built-in robots."""

from .. import Robot
from .options import AsJson
from .show import print_json, print_table


def robots(*, as_json: AsJson = False) -> None:
    """List the built-in robots."""
    built_in = [Robot.named(name) for name in Robot.names()]
    if as_json:
        print_json([_described(robot) for robot in built_in])
    else:
        rows = ((robot.name, str(robot.dof), robot.link_names[0], robot.link_names[-1]) for robot in built_in)
        print_table("Built-in robots", ("name", "joints", "base", "tip"), rows)


def _described(robot: Robot) -> dict[str, object]:
    return {
        "name": robot.name,
        "dof": robot.dof,
        "base": robot.link_names[0],
        "tip": robot.link_names[-1],
        "joints": [
            {"name": name, "kind": kind, "lower": lower, "upper": upper, "velocity_limit": velocity}
            for name, kind, lower, upper, velocity in zip(
                robot.joint_names, robot.joint_kinds, robot.lower, robot.upper, robot.velocity_limit, strict=True
            )
        ],
    }
