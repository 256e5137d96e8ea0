"""`beetle-ik solve`: inverse kinematics of one target."""

import math
from typing import Annotated, Any

import typer

from .. import Robot, Scene, Solution, SolutionSet, Stop, pose, solve_all
from .. import solve as solve_target
from .options import (
    AsJson,
    BaseLink,
    LinkRadius,
    Margin,
    RobotName,
    SceneFile,
    Seed,
    SolverName,
    Start,
    TipLink,
    UrdfFile,
    load_robot,
    make_solver,
    numbers,
)
from .show import as_argument, print_json, print_pairs


def solve(
    robot: RobotName = None,
    *,
    position: Annotated[str, typer.Option(help="Target position of the tip: x,y,z in m.")],
    rpy: Annotated[str | None, typer.Option(help="Target orientation: roll,pitch,yaw in rad; default: free.")] = None,
    start: Start = None,
    solver: Annotated[
        SolverName | None, typer.Option(help="Default: the closed form, else Levenberg-Marquardt from many starts.")
    ] = None,
    position_tolerance: Annotated[float, typer.Option(help="Allowed position error in m.")] = 1e-6,
    rotation_tolerance: Annotated[float, typer.Option(help="Allowed rotation error in rad.")] = 1e-6,
    max_evaluations: Annotated[int | None, typer.Option(help="Budget: evaluations of the forward kinematics.")] = None,
    seed: Seed = 0,
    every: Annotated[
        bool, typer.Option("--all", help="All solutions, nearest to the start first, and whether any is missing.")
    ] = False,
    scene: SceneFile = None,
    margin: Margin = None,
    link_radius: LinkRadius = None,
    urdf: UrdfFile = None,
    tip: TipLink = None,
    base: BaseLink = None,
    as_json: AsJson = False,
) -> None:
    """Inverse kinematics: joint positions for a position or a pose of the tip."""
    arm = load_robot(robot, urdf, base, tip, link_radius)
    point = numbers("--position", position, 3)
    target = point if rpy is None else pose(point, rpy=numbers("--rpy", rpy, 3))
    options: dict[str, Any] = {
        "start": None if start is None else numbers("--start", start),
        "obstacles": None if scene is None else Scene.load(scene),
        "margin": margin,
        "solver": None if solver is None else make_solver(solver),
        "position_tolerance": position_tolerance,
        "rotation_tolerance": rotation_tolerance,
        "stop": None if max_evaluations is None else Stop(max_evaluations=max_evaluations),
        "seed": seed,
    }
    if every:
        found = solve_all(arm, target, **options)
        _show_all(arm, found, as_json)
        raise typer.Exit(0 if found.success else 1)
    solution = solve_target(arm, target, **options)
    _show(arm, solution, rpy is not None, as_json)
    raise typer.Exit(0 if solution.success else 1)


def _show_all(robot: Robot, found: SolutionSet, as_json: bool) -> None:
    if as_json:
        fields = ("q", "success", "message", "complete", "singular", "evaluations", "elapsed")
        print_json(
            {"robot": robot.name, "status": found.status.name} | {field: getattr(found, field) for field in fields}
        )
        return
    print_pairs(
        f"{robot.name}: {found.message}",
        [
            ("closed form", robot.closed_form),
            ("complete", "yes" if found.complete else "not proven"),
            ("evaluations", str(found.evaluations)),
            ("time [ms]", f"{1e3 * found.elapsed:.3g}"),
        ],
    )
    for q in found.q:
        typer.echo(f"q [rad, m]: {as_argument(q)}")


def _show(robot: Robot, solution: Solution, oriented: bool, as_json: bool) -> None:
    if as_json:
        fields = (
            "q",
            "success",
            "message",
            "position_error",
            "rotation_error",
            "clearance",
            "iterations",
            "restarts",
            "evaluations",
        )
        status = {"robot": robot.name, "status": solution.status.name, "elapsed": solution.elapsed}
        print_json(status | {field: getattr(solution, field) for field in fields})
        return
    rotation = [("rotation error [rad]", f"{solution.rotation_error:.3g}")] if oriented else []
    clearance = [] if math.isnan(solution.clearance) else [("clearance [m]", f"{solution.clearance:.3g}")]
    print_pairs(
        f"{robot.name}: {solution.message}",
        [
            ("position error [m]", f"{solution.position_error:.3g}"),
            *rotation,
            *clearance,
            ("evaluations", str(solution.evaluations)),
            ("time [ms]", f"{1e3 * solution.elapsed:.3g}"),
        ],
    )
    typer.echo(f"q [rad, m]: {as_argument(solution.q)}")  # on its own line, so that no terminal width breaks it
