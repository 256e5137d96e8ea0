"""`beetle-ik plan point-to-point`: plans a motion between two positions."""

from enum import StrEnum
from typing import Annotated, Any

import typer

from ... import InvalidInputError, Scene, plan_point_to_point, pose
from ...papers import TPBSO
from ..options import (
    Acceleration,
    AsJson,
    BaseLink,
    First,
    Jerk,
    LinkRadius,
    Margin,
    Payload,
    RobotName,
    SceneFile,
    Seed,
    Tilt,
    TipLink,
    TipSpeed,
    TorqueLimits,
    Trusted,
    Up,
    UrdfFile,
    Velocity,
    kept_upright,
    load_robot,
    loaded,
    numbers,
    pose_first,
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


_POSE_NUMBERS = 6

Place = Annotated[
    str | None,
    typer.Option(
        metavar="X,Y,Z[,ROLL,PITCH,YAW]", help="Position of the tip in m; with angles in rad, its orientation too."
    ),
]
Configuration = Annotated[str | None, typer.Option(metavar="Q1,Q2,...", help="Joint positions instead of a tip pose.")]


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
    approach: Annotated[
        float | None, typer.Option(metavar="M", help="Length in m of a straight line of the tip before the end.")
    ] = None,
    retreat: Annotated[
        float | None, typer.Option(metavar="M", help="Length in m of a straight line of the tip after the start.")
    ] = None,
    free_start: Annotated[bool, typer.Option("--free-start", help="Move out of a contact at the start first.")] = False,
    first: First = None,
    tilt: Tilt = None,
    up: Up = None,
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
    """Plan a motion between two places of the tip, or two configurations, from rest to rest."""
    arm, torque = loaded(load_robot(robot, urdf, base, tip, link_radius, trusted=trusted), payload, torque_limits)
    ends = _end("start", start, start_q) | _end("end", end, end_q)
    chosen = {"method": _method(method, solver)} | options(
        velocity, acceleration, jerk, tip_speed, torque, max_evaluations
    )
    keep = kept_upright(arm, tilt, up)
    obstacles = None if scene is None else Scene.load(scene)
    report(
        lambda: plan_point_to_point(
            arm,
            **ends,
            objective=objective.value,
            approach=approach,
            retreat=retreat,
            free_start=free_start,
            task=pose_first(first, *(ends[name] for name in ("start", "end") if name in ends)),
            keep=keep,
            obstacles=obstacles,
            margin=margin,
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
    """Returns an end of the motion as an argument of `plan_point_to_point`: a place of the tip or joint positions."""
    match place, configuration:
        case str(), None:
            return {name: _place(f"--{name}", place)}
        case None, str():
            return {f"{name}_q": numbers(f"--{name}-q", configuration)}
        case None, None:
            raise InvalidInputError(f"no {name} was given: use --{name} X,Y,Z[,ROLL,PITCH,YAW] or --{name}-q Q1,Q2,...")
    raise InvalidInputError(f"both --{name} and --{name}-q were given: give one of them")


def _place(option: str, text: str) -> Any:
    """Reads a position, or a pose."""
    values = numbers(option, text)
    if len(values) == _POSE_NUMBERS:
        return pose(values[:3], rpy=values[3:])
    if len(values) != 3:
        raise InvalidInputError(f"{option}: expected X,Y,Z or X,Y,Z,ROLL,PITCH,YAW, got {len(values)} numbers")
    return values


def _method(method: Method, solver: SearchName | None) -> Any:
    """Returns the method as `plan_point_to_point` takes it."""
    if method is Method.TPBSO:
        return TPBSO(solver=search(solver))
    if solver is not None:
        raise InvalidInputError(f"--solver is the search of --method tpbso; {method} has its own: leave it out")
    return method.value
