"""`beetle-ik track`: follows a path."""

from pathlib import Path
from typing import Annotated, Any

import typer

from .. import InvalidInputError, Limits, Robot, Scene
from .. import Path as ReferencePath
from .. import track as track_path
from .curves import CurveName, make_curve, read_points
from .files import results_folder, write_files
from .options import (
    Acceleration,
    AsJson,
    BaseLink,
    Jerk,
    JointWeights,
    LinkRadius,
    Margin,
    Payload,
    RobotName,
    SceneFile,
    Seed,
    SolverName,
    StartQ,
    TipLink,
    TipSpeed,
    TorqueLimits,
    Trusted,
    UrdfFile,
    Velocity,
    limit,
    load_robot,
    loaded,
    make_solver,
    numbers,
    sinusoid,
)
from .show import print_json
from .summary import print_summary, summarize

_PATH = "Path"
_CURVE = "Curve: by default in the x-y plane, placed and sized to suit the arm"

# A band of 1.7e-5 m gives the BAS paper's mean error of 1e-5 m.
_BAND = 1.7e-5

Point = Annotated[str | None, typer.Option(metavar="X,Y,Z", help="Centre of the curve in m.", rich_help_panel=_CURVE)]
Direction = Annotated[
    str | None, typer.Option(metavar="X,Y,Z", help="Unit vector in the plane of the curve.", rich_help_panel=_CURVE)
]


def track(
    robot: RobotName = None,
    *,
    curve: Annotated[CurveName | None, typer.Option(help="A built-in curve.", rich_help_panel=_PATH)] = None,
    points: Annotated[
        Path | None,
        typer.Option("--path", help="A CSV file: columns x,y,z in m, optionally time in s.", rich_help_panel=_PATH),
    ] = None,
    duration: Annotated[
        float | None, typer.Option(help="Duration of the path in s; default 30.", rich_help_panel=_PATH)
    ] = None,
    center: Point = None,
    diameter: Annotated[float | None, typer.Option(metavar="METRES", help="circle.", rich_help_panel=_CURVE)] = None,
    radius: Annotated[
        float | None, typer.Option(metavar="METRES", help="pentagram, rose.", rich_help_panel=_CURVE)
    ] = None,
    outer_radius: Annotated[
        float | None, typer.Option(metavar="METRES", help="hypotrochoid.", rich_help_panel=_CURVE)
    ] = None,
    inner_radius: Annotated[
        float | None, typer.Option(metavar="METRES", help="hypotrochoid.", rich_help_panel=_CURVE)
    ] = None,
    distance: Annotated[
        float | None,
        typer.Option(
            metavar="METRES",
            help="hypotrochoid: distance of the pen from the inner centre.",
            rich_help_panel=_CURVE,
        ),
    ] = None,
    width: Annotated[float | None, typer.Option(metavar="METRES", help="letter-m.", rich_help_panel=_CURVE)] = None,
    height: Annotated[float | None, typer.Option(metavar="METRES", help="letter-m.", rich_help_panel=_CURVE)] = None,
    k: Annotated[
        int | None, typer.Option("--k", help="rose: its radius is radius cos(k u).", rich_help_panel=_CURVE)
    ] = None,
    a: Direction = None,
    b: Direction = None,
    velocity: Velocity = None,
    velocity_sinusoid: Annotated[
        str | None,
        typer.Option(
            metavar="MEAN,AMPLITUDE,OMEGA",
            help="A velocity limit that varies, the same for all joints: mean + amplitude sin(omega t), in rad/s.",
        ),
    ] = None,
    acceleration: Acceleration = None,
    jerk: Jerk = None,
    tip_speed: TipSpeed = None,
    payload: Payload = None,
    torque_limits: TorqueLimits = False,
    ease: Annotated[
        bool,
        typer.Option("--ease", help="Begin with an approach from rest that meets the moving path within the limits."),
    ] = False,
    solver: Annotated[
        SolverName | None,
        typer.Option(help="Default: the model-based rule. bas, chain and greedy are beetle antennae search."),
    ] = None,
    position_tolerance: Annotated[float, typer.Option(help="Allowed position error in m.")] = _BAND,
    dt: Annotated[float, typer.Option(help="Time step in s.")] = 0.2,
    start_q: StartQ = None,
    joint_weights: JointWeights = None,
    scene: SceneFile = None,
    margin: Margin = None,
    link_radius: LinkRadius = None,
    seed: Seed = 0,
    out: Annotated[
        Path | None, typer.Option(help="Folder for trajectory.csv, trajectory.npz, track.png and summary.json.")
    ] = None,
    urdf: UrdfFile = None,
    tip: TipLink = None,
    base: BaseLink = None,
    trusted: Trusted = False,
    as_json: AsJson = False,
) -> None:
    """Follow a path with the tip, within the joint limits."""
    arm, torque = loaded(load_robot(robot, urdf, base, tip, link_radius, trusted=trusted), payload, torque_limits)
    triples = {"center": center, "a": a, "b": b}
    others = {
        "diameter": diameter,
        "radius": radius,
        "outer_radius": outer_radius,
        "inner_radius": inner_radius,
        "distance": distance,
        "width": width,
        "height": height,
        "k": k,
    }
    given: dict[str, Any] = {name: numbers(f"--{name}", text, 3) for name, text in triples.items() if text is not None}
    given |= {name: value for name, value in others.items() if value is not None}
    path = _reference(arm, curve, points, duration, given)
    limits, limits_from = _limits(velocity, velocity_sinusoid, acceleration, jerk, tip_speed, torque)
    with results_folder(out) as folder:
        result = track_path(
            arm,
            path,
            None if start_q is None else numbers("--start-q", start_q),
            dt=dt,
            solver=None if solver is None else make_solver(solver),
            limits=limits,
            position_tolerance=position_tolerance,
            obstacles=None if scene is None else Scene.load(scene),
            margin=margin,
            joint_weights=None if joint_weights is None else numbers("--joint-weights", joint_weights),
            seed=seed,
            ease=ease,
            progress=not as_json,
        )
        summary = summarize(result, solver or "model-based", dt, seed, limits_from)
        if folder is not None:
            write_files(folder, result.trajectory, summary, {"track.png": result.plot})
    if as_json:
        print_json(summary)
    else:
        print_summary(summary, out)
    raise typer.Exit(0 if result.success else 1)


def _limits(
    velocity: str | None,
    velocity_sinusoid: str | None,
    acceleration: str | None,
    jerk: str | None,
    tip_speed: float | None,
    torque: Any,
) -> tuple[Limits | None, str | None]:
    """Returns the given limits, and the name of the option that gave the velocity limit."""
    if velocity is not None and velocity_sinusoid is not None:
        raise InvalidInputError("both --velocity-limit and --velocity-sinusoid were given: give one of them")
    given: dict[str, Any] = {}
    limits_from = None
    if velocity_sinusoid is not None:
        limits_from = "--velocity-sinusoid"
        given["velocity"] = sinusoid(limits_from, velocity_sinusoid)
    if velocity is not None:
        limits_from = "--velocity-limit"
        given["velocity"] = limit(limits_from, velocity)
    if acceleration is not None:
        given["acceleration"] = limit("--acceleration-limit", acceleration)
    if jerk is not None:
        given["jerk"] = limit("--jerk-limit", jerk)
    if tip_speed is not None:
        given["tip_speed"] = tip_speed
    if torque is not None:
        given["torque"] = torque
    return Limits(**given) if given else None, limits_from


def _reference(
    robot: Robot, curve: CurveName | None, points: Path | None, duration: float | None, given: dict[str, Any]
) -> ReferencePath:
    if points is not None:
        if curve is not None or given:
            raise InvalidInputError("--path takes its points from the file: leave out --curve and its parameters")
        return read_points(points, duration)
    if curve is None:
        raise InvalidInputError(f"no path was given: use --path FILE or --curve with one of {', '.join(CurveName)}")
    return make_curve(curve, robot, duration, given)
