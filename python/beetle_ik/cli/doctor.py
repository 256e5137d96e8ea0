"""`beetle-ik doctor`: versions, extras, CPU and a self-test."""

import typer

from .. import Robot, solve
from ..installed.versions import versions
from .options import AsJson
from .show import print_json, print_pairs


def doctor(*, as_json: AsJson = False) -> None:
    """Show versions, extras and CPU, and solve one target to check that the library works."""
    robot = Robot.named("iiwa14")
    solution = solve(robot, robot.fk(robot.random_configurations(1, seed=0)[0]))
    found = dict(versions()) | {"self-test": solution.message}
    if as_json:
        print_json(found)
    else:
        print_pairs("beetle-ik doctor", found.items())
    raise typer.Exit(0 if solution.success else 1)
