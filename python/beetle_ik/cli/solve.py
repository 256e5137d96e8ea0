"""`beetle-ik solve`: inverse kinematics of one target."""

import math
from typing import Annotated, Any

import typer

from .. import InvalidInputError, Robot, Scene, Solution, SolutionSet, Status, Stop, pose, solve_all
from .. import solve as solve_target
from .options import (
    AsJson,
    BaseLink,
    First,
    JointWeights,
    LinkRadius,
    Margin,
    RobotName,
    SceneFile,
    Seed,
    SolverName,
    StartQ,
    TipLinks,
    Trusted,
    UrdfFile,
    load_robot,
    make_solver,
    numbers,
    pose_first,
)
from .show import as_argument, print_json, print_pairs
from .wording import in_options


def solve(
    robot: RobotName = None,
    *,
    position: Annotated[str | None, typer.Option(help="Target position of the tip: x,y,z in m.")] = None,
    rpy: Annotated[
        str | None, typer.Option(help="Target orientation: roll,pitch,yaw in rad, or as 90deg; default: free.")
    ] = None,
    target: Annotated[
        list[str] | None,
        typer.Option(help="Target of one of several tips: tip=x,y,z or tip=x,y,z,roll,pitch,yaw; give one for each."),
    ] = None,
    first: First = None,
    start_q: StartQ = None,
    joint_weights: JointWeights = None,
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
    tip: TipLinks = None,
    base: BaseLink = None,
    trusted: Trusted = False,
    as_json: AsJson = False,
) -> None:
    """Inverse kinematics: joint positions for a position or a pose of the tip."""
    arm = load_robot(robot, urdf, base, tip, link_radius, trusted=trusted)
    wanted = _wanted(position, rpy, target)
    options: dict[str, Any] = {
        "start_q": None if start_q is None else numbers("--start-q", start_q),
        "obstacles": None if scene is None else Scene.load(scene),
        "margin": margin,
        "solver": None if solver is None else make_solver(solver),
        "position_tolerance": position_tolerance,
        "rotation_tolerance": rotation_tolerance,
        "stop": None if max_evaluations is None else Stop(max_evaluations=max_evaluations),
        "seed": seed,
    }
    if first is not None:
        options["task"] = pose_first(first, *(wanted.values() if isinstance(wanted, dict) else [wanted]))
    if every:
        if joint_weights is not None:
            raise InvalidInputError("--joint-weights choose one solution: leave out --all")
        found = solve_all(arm, wanted, **options)
        _show_all(arm, found, as_json)
        raise typer.Exit(0 if found.success else 1)
    if joint_weights is not None:
        options["joint_weights"] = numbers("--joint-weights", joint_weights)
    solution = solve_target(arm, wanted, **options)
    _show(arm, solution, as_json)
    given_up = solution.status in (Status.ROTATION_GIVEN_UP, Status.POSITION_GIVEN_UP)
    raise typer.Exit(0 if solution.success or (first is not None and given_up) else 1)


def _wanted(position: str | None, rpy: str | None, targets: list[str] | None) -> Any:
    """Returns the target of the only tip, or a dict of targets by tip."""
    if targets:
        if position is not None or rpy is not None:
            raise InvalidInputError("--target gives tips their targets: leave out --position and --rpy")
        return dict(map(_named, targets))
    if position is None:
        raise InvalidInputError(
            "no target was given: use --position x,y,z, or --target tip=x,y,z for each of several tips"
        )
    return _placed(numbers("--position", position, 3), None if rpy is None else numbers("--rpy", rpy, 3))


def _named(text: str) -> tuple[str, Any]:
    """Reads "tip=x,y,z" or "tip=x,y,z,roll,pitch,yaw"."""
    tip, given, values = text.partition("=")
    entries = numbers("--target", values) if given else []
    if len(entries) not in (3, 6):
        raise InvalidInputError(f"--target: expected tip=x,y,z or tip=x,y,z,roll,pitch,yaw, got '{text}'")
    return tip, _placed(entries[:3], entries[3:] or None)


def _placed(point: list[float], rpy: list[float] | None) -> Any:
    return point if rpy is None else pose(point, rpy=rpy)


def _show_all(robot: Robot, found: SolutionSet, as_json: bool) -> None:
    if as_json:
        fields = ("q", "success", "complete", "singular", "evaluations", "elapsed")
        print_json(_beginning(robot, found) | {field: getattr(found, field) for field in fields})
        return
    print_pairs(
        f"{robot.name}: {in_options(found.message)}",
        [
            ("closed form", robot.closed_form),
            ("complete", "yes" if found.complete else "not proven"),
            ("evaluations", str(found.evaluations)),
            ("time [ms]", f"{1e3 * found.elapsed:.3g}"),
        ],
    )
    for q in found.q:
        typer.echo(f"q [rad, m]: {as_argument(q)}")


def _beginning(robot: Robot, result: Solution | SolutionSet) -> dict[str, Any]:
    return {"robot": robot.name, "status": result.status.name, "message": in_options(result.message)}


def _show(robot: Robot, solution: Solution, as_json: bool) -> None:
    if as_json:
        fields = (
            "q",
            "success",
            "position_error",
            "rotation_error",
            "clearance",
            "iterations",
            "restarts",
            "evaluations",
        )
        status = _beginning(robot, solution) | {"elapsed": solution.elapsed}
        if len(robot.tips) > 1:
            status["errors"] = solution.errors
        print_json(status | {field: getattr(solution, field) for field in fields})
        return
    clearance = [] if math.isnan(solution.clearance) else [("clearance [m]", f"{solution.clearance:.3g}")]
    print_pairs(
        f"{robot.name}: {in_options(solution.message)}",
        [
            *(pair for tip, errors in solution.errors.items() for pair in _errors(robot, tip, *errors)),
            *clearance,
            ("evaluations", str(solution.evaluations)),
            ("time [ms]", f"{1e3 * solution.elapsed:.3g}"),
        ],
    )
    typer.echo(f"q [rad, m]: {as_argument(solution.q)}")  # a line of its own: no terminal width breaks it


def _errors(robot: Robot, tip: Any, position: float, rotation: float) -> list[tuple[str, str]]:
    """Returns the errors of a tip with their names, without errors that the task leaves free."""
    of = f" of {tip}" if len(robot.tips) > 1 else ""
    both = ((f"position error{of} [m]", position), (f"rotation error{of} [rad]", rotation))
    return [(name, f"{value:.3g}") for name, value in both if not math.isnan(value)]
