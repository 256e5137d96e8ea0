"""`beetle-ik plan along-path`: plans a motion along a path of the tip."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from ... import InvalidInputError, Robot, Scene, plan_along_path
from ... import Path as ReferencePath
from ...papers import TPBSO
from ..curves import CurveName, make_curve, read_points
from ..options import (
    Acceleration,
    AsJson,
    BaseLink,
    Jerk,
    LinkRadius,
    Margin,
    Payload,
    RobotName,
    SceneFile,
    Seed,
    StartQ,
    TipLink,
    TipSpeed,
    TorqueLimits,
    Trusted,
    UrdfFile,
    Velocity,
    load_robot,
    loaded,
    numbers,
)
from .planned import Animated, Budget, Out, SearchName, Solver, options, report, search

_DURATION = 1.0  # s; the planner ignores it


class Method(StrEnum):
    """Planners by their names."""

    TIMED = "timed"
    TPBSO = "tpbso"


class Objective(StrEnum):
    """Objectives by their names."""

    TIME = "time"
    JOINT_TRAVEL = "joint_travel"


def along_path(
    robot: RobotName = None,
    *,
    curve: Annotated[CurveName | None, typer.Option(help="A built-in curve, placed and sized to suit the arm.")] = None,
    points: Annotated[Path | None, typer.Option("--path", help="A CSV file: columns x,y,z in m.")] = None,
    method: Annotated[
        Method, typer.Option(help="timed: redundancy and timing together; tpbso: a beetle swarm with uniform timing.")
    ] = Method.TIMED,
    objective: Annotated[Objective, typer.Option(help="What to minimise.")] = Objective.TIME,
    accuracy: Annotated[float | None, typer.Option(help="Largest distance of the tip from the path in m.")] = None,
    breaks: Annotated[bool, typer.Option("--breaks", help="Leave the path where it cannot be followed.")] = False,
    start_q: StartQ = None,
    scene: SceneFile = None,
    margin: Margin = None,
    link_radius: LinkRadius = None,
    velocity: Velocity = None,
    acceleration: Acceleration = None,
    jerk: Jerk = None,
    tip_speed: TipSpeed = None,
    payload: Payload = None,
    torque_limits: TorqueLimits = False,
    solver: Solver = None,
    max_evaluations: Budget = None,
    seed: Seed = 0,
    out: Out = None,
    animation: Animated = False,
    urdf: UrdfFile = None,
    tip: TipLink = None,
    base: BaseLink = None,
    trusted: Trusted = False,
    as_json: AsJson = False,
) -> None:
    """Plan a motion that moves the tip along a path."""
    arm, torque = loaded(load_robot(robot, urdf, base, tip, link_radius, trusted=trusted), payload, torque_limits)
    path = _path(arm, curve, points)
    chosen = _method(method, solver) | options(velocity, acceleration, jerk, tip_speed, torque, max_evaluations)
    obstacles = None if scene is None else Scene.load(scene)
    report(
        lambda: plan_along_path(
            arm,
            path,
            start_q=None if start_q is None else numbers("--start-q", start_q),
            objective=objective.value,
            obstacles=obstacles,
            margin=margin,
            accuracy=accuracy,
            breaks=breaks,
            seed=seed,
            progress=not as_json,
            **chosen,
        ),
        method.value,
        seed,
        out,
        animation,
        as_json,
    )


def _method(method: Method, solver: SearchName | None) -> dict[str, Any]:
    """Returns the method and its search as `plan_along_path` takes them."""
    if method is Method.TPBSO:
        return {"method": TPBSO(solver=search(solver))}
    return {"method": method.value, "solver": search(solver)}


def _path(robot: Robot, curve: CurveName | None, points: Path | None) -> ReferencePath:
    match curve, points:
        case None, Path():
            return read_points(points, _DURATION)
        case CurveName(), None:
            return make_curve(curve, robot, _DURATION, {})
    raise InvalidInputError(f"give either --path FILE or --curve with one of {', '.join(CurveName)}")
