"""`beetle-ik plan point-to-point`: plans a motion between two positions."""

from enum import StrEnum
from typing import Annotated, Any

import typer

from ... import TPBSO, InvalidInputError, plan_point_to_point
from ...obstacles import Ellipse
from ..options import (
    Acceleration,
    AsJson,
    BaseLink,
    RobotName,
    Seed,
    TipLink,
    UrdfFile,
    Velocity,
    load_robot,
    numbers,
)
from .planned import Animated, Budget, Out, SearchName, Solver, options, report, search


class Method(StrEnum):
    """Planners by their names."""

    MINMAX = "minmax"
    TPBSO = "tpbso"


class Objective(StrEnum):
    """Objectives by their names."""

    TIME = "time"
    JOINT_TRAVEL = "joint_travel"
    TIP_TRAVEL = "tip_travel"


_ELLIPSE_NUMBERS = 5

Place = Annotated[str | None, typer.Option(metavar="X,Y,Z", help="Position of the tip in m.")]
Configuration = Annotated[
    str | None, typer.Option(metavar="Q1,Q2,...", help="Joint positions instead of a tip position.")
]


def point_to_point(
    robot: RobotName = None,
    *,
    start: Place = None,
    start_q: Configuration = None,
    end: Place = None,
    end_q: Configuration = None,
    method: Annotated[
        Method,
        typer.Option(
            help="minmax: the nearest configurations, joined directly; tpbso: via point found by a beetle swarm."
        ),
    ] = Method.MINMAX,
    objective: Annotated[Objective, typer.Option(help="What to minimise.")] = Objective.TIME,
    ellipses: Annotated[
        list[str] | None,
        typer.Option(
            "--ellipse", metavar="X,Y,A,B,ANGLE", help="An elliptical obstacle for a planar arm; may be repeated."
        ),
    ] = None,
    velocity: Velocity = None,
    acceleration: Acceleration = None,
    solver: Solver = None,
    max_evaluations: Budget = None,
    seed: Seed = 0,
    out: Out = None,
    animation: Animated = False,
    urdf: UrdfFile = None,
    tip: TipLink = None,
    base: BaseLink = None,
    as_json: AsJson = False,
) -> None:
    """Plan a motion between two positions, from rest to rest."""
    arm = load_robot(robot, urdf, base, tip)
    ends = _end("start", start, start_q) | _end("end", end, end_q)
    chosen = {"method": _method(method, solver)} | options(velocity, acceleration, max_evaluations)
    obstacles = [_ellipse(text) for text in ellipses or ()]
    report(
        lambda: plan_point_to_point(
            arm,
            **ends,
            objective=objective.value,
            obstacles=obstacles,
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


def _end(name: str, place: str | None, configuration: str | None) -> dict[str, Any]:
    """Returns an end of the motion as an argument of `plan_point_to_point`: a tip position or joint positions."""
    match place, configuration:
        case str(), None:
            return {name: numbers(f"--{name}", place, 3)}
        case None, str():
            return {f"{name}_q": numbers(f"--{name}-q", configuration)}
        case None, None:
            raise InvalidInputError(f"no {name} was given: use --{name} X,Y,Z or --{name}-q Q1,Q2,...")
    raise InvalidInputError(f"both --{name} and --{name}-q were given: give one of them")


def _method(method: Method, solver: SearchName | None) -> Any:
    """Returns the method as `plan_point_to_point` takes it."""
    if method is Method.TPBSO:
        return TPBSO(solver=search(solver))
    if solver is not None:
        raise InvalidInputError(f"--solver is the search of --method tpbso; {method} has its own: leave it out")
    return method.value


def _ellipse(text: str) -> Any:
    x, y, a, b, angle = numbers("--ellipse", text, _ELLIPSE_NUMBERS)
    return Ellipse((x, y), (a, b), angle)
