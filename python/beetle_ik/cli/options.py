"""Options shared by several commands, and readers of their text."""

import math
import re
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import beetle_ik as bik

from .. import InvalidInputError, Keep, Robot, Sinusoid, tasks, upright
from ..robot_files.descriptions import is_description

if TYPE_CHECKING:
    from .._core import _Single

_ROBOT = "Robot"
_MJCF = ".xml"
_FILES = (".urdf", ".xacro", _MJCF)


def complete_robot(incomplete: str) -> list[str]:
    """Returns the built-in robots, files and folders that begin with what was typed."""
    before, slash, begun = incomplete.rpartition("/")
    folder = Path(before + slash)
    files = sorted(folder.iterdir()) if folder.is_dir() else []
    shown = (file.name + "/" * file.is_dir() for file in files if file.is_dir() or file.suffix in _FILES)
    found = [before + slash + name for name in shown if name.startswith(begun)]
    return [name for name in Robot.names() if name.startswith(incomplete)] + found


RobotName = Annotated[
    str | None,
    typer.Argument(
        help="A built-in robot (`beetle-ik robots` lists them), a file (URDF, xacro, or MJCF that ends in .xml), or a "
        "name of robot_descriptions.",
        autocompletion=complete_robot,
    ),
]
UrdfFile = Annotated[
    Path | None,
    typer.Option("--urdf", help="A URDF file; the same as naming it in place of the robot.", rich_help_panel=_ROBOT),
]
TipLink = Annotated[str | None, typer.Option("--tip", help="Tip link; default: the only leaf.", rich_help_panel=_ROBOT)]
TipLinks = Annotated[
    list[str] | None,
    typer.Option("--tip", help="Tip link; default: the only leaf. Several make several tips.", rich_help_panel=_ROBOT),
]
BaseLink = Annotated[
    str | None, typer.Option("--base", help="Base link, which stays fixed; default: the root.", rich_help_panel=_ROBOT)
]
Trusted = Annotated[
    bool,
    typer.Option(
        "--trusted",
        help="The xacro or MJCF file is your own: it may execute code, and read any file.",
        rich_help_panel=_ROBOT,
    ),
]
JointWeights = Annotated[
    str | None,
    typer.Option(help="Cost of moving each joint: w1,w2,...; heavy joints move where the others cannot do it."),
]
StartQ = Annotated[str | None, typer.Option("--start-q", help="Joint positions to start from: q1,q2,...")]
Velocity = Annotated[
    str | None,
    typer.Option("--velocity-limit", help="rad/s: one number, or one per joint: v1,v2,...; default: the robot's."),
]
Acceleration = Annotated[
    str | None,
    typer.Option("--acceleration-limit", help="rad/s^2: one number, or one per joint: a1,a2,...; default: none."),
]
Jerk = Annotated[
    str | None,
    typer.Option("--jerk-limit", help="rad/s^3: one number, or one per joint: j1,j2,...; default: none."),
]
TipSpeed = Annotated[float | None, typer.Option("--tip-speed", help="Largest speed of the tip in m/s; default: none.")]
Payload = Annotated[
    float | None,
    typer.Option(metavar="KG", help="Mass in kg at the tip; counts with --torque-limits."),
]
TorqueLimits = Annotated[
    bool, typer.Option("--torque-limits", help="Keep the torques that the robot's file gives as effort.")
]
SceneFile = Annotated[
    Path | None, typer.Option("--scene", help="Obstacles: a JSON file of shapes; the page on scenes has the format.")
]
Margin = Annotated[
    float | None,
    typer.Option("--margin", help="Distance in m to keep from obstacles and between links; default: 1 mm."),
]
LinkRadius = Annotated[
    float | None,
    typer.Option("--link-radius", help="Radius in m of a capsule along each link, which must not touch obstacles."),
]
Seed = Annotated[int, typer.Option(help="Seed of all random draws: the same seed gives the same bits.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON for machines instead of tables.")]


class FirstPart(StrEnum):
    """Parts of a pose that may come first."""

    POSITION = "position"
    ORIENTATION = "orientation"


First = Annotated[
    FirstPart | None,
    typer.Option(help="Part of a pose to meet exactly where the whole cannot be met; the other as near as it allows."),
]
Tilt = Annotated[
    str | None,
    typer.Option(
        metavar="ANGLE",
        help="Keep the axis --up of the tip within this angle of the vertical all the way: in rad, or as 10deg.",
    ),
]
Up = Annotated[
    str | None,
    typer.Option(
        metavar="AXIS",
        help="Axis of the tip that --tilt keeps up: x, y, z, -x, -y, -z or X,Y,Z; default: -z, a hand that hangs.",
    ),
]


class SolverName(StrEnum):
    """Solvers by their names on the command line."""

    BAS = "bas"
    CHAIN = "chain"
    GREEDY = "greedy"
    LM = "lm"
    NEWTON_RAPHSON = "newton-raphson"
    JACOBIAN_TRANSPOSE = "jacobian-transpose"
    APPS = "apps"
    BROYDEN_BAS = "broyden-bas"
    BEETLE_SWARM = "beetle-swarm"
    PSO = "pso"
    QPSO = "qpso"
    FIREFLY = "firefly"
    GENETIC = "genetic"
    BEE_COLONY = "bee-colony"
    DIFFERENTIAL_EVOLUTION = "differential-evolution"


_SOLVERS: dict[SolverName, "_Single"] = {
    SolverName.BAS: bik.papers.BAS(variant="star"),
    SolverName.CHAIN: bik.papers.BAS(variant="chain"),
    SolverName.GREEDY: bik.papers.BAS(variant="greedy"),
    SolverName.LM: bik.LevenbergMarquardt(),
    SolverName.NEWTON_RAPHSON: bik.NewtonRaphson(),
    SolverName.JACOBIAN_TRANSPOSE: bik.JacobianTranspose(),
    SolverName.APPS: bik.papers.APPS(),
    SolverName.BROYDEN_BAS: bik.BroydenBAS(),
    SolverName.BEETLE_SWARM: bik.papers.BeetleSwarm(),
    SolverName.PSO: bik.papers.PSO(),
    SolverName.QPSO: bik.papers.QPSO(),
    SolverName.FIREFLY: bik.papers.Firefly(),
    SolverName.GENETIC: bik.papers.Genetic(),
    SolverName.BEE_COLONY: bik.papers.BeeColony(),
    SolverName.DIFFERENTIAL_EVOLUTION: bik.DifferentialEvolution(),
}


def make_solver(name: SolverName) -> "_Single":
    """Returns the solver of this name with its default options."""
    return _SOLVERS[name]


def load_robot(
    name: str | None,
    urdf: Path | None,
    base: str | None,
    tip: str | list[str] | None,
    link_radius: float | None = None,
    *,
    trusted: bool = False,
    collision: str = "primitives",
) -> Robot:
    """Loads a robot by its name or file; with capsules of `link_radius`, or the collision shapes of a file."""
    if urdf is not None and name is not None:
        raise InvalidInputError(f"both the robot '{name}' and --urdf '{urdf}' were given: give one of them")
    if name is None and urdf is None:
        raise InvalidInputError(
            "no robot was given: name a built-in one (`beetle-ik robots` lists them) or a file, such as arm.urdf"
        )
    options: dict[str, Any] = {"base": base, "tip": tip or None, "trusted": trusted, "collision": collision}
    file = urdf or Path(str(name))
    if urdf is not None or file.suffix.lower() in _FILES:
        robot = (Robot.from_mjcf if file.suffix.lower() == _MJCF else Robot.from_urdf)(file, **options)
    else:
        robot = _named(str(name), options)
    return robot if link_radius is None else robot.with_capsules(radius=link_radius)


def _named(name: str, options: dict[str, Any]) -> Robot:
    """Returns the built-in robot or the description of this name."""
    if name not in Robot.names() and is_description(name):
        return Robot.from_description(name, **options)
    robot = Robot.named(name)
    if options["base"] is not None or options["tip"]:
        raise InvalidInputError(
            f"--base and --tip choose links of a file; the built-in robot '{name}' has its own: leave them out"
        )
    return robot


_WITH_ANGLES = ("--q", "--start", "--start-q", "--end", "--end-q", "--rpy", "--target", "--tilt")


def numbers(option: str, text: str, length: int | None = None) -> list[float]:
    """Reads numbers separated by commas or spaces, as numpy prints them; angles may be in degrees, such as 90deg.

    `length` is the required count.
    """
    entries = re.split(r"\s*,\s*|\s+", text.strip().removeprefix("[").removesuffix("]").strip())
    values = [_number(option, entry) for entry in entries]
    if length is not None and len(values) != length:
        raise InvalidInputError(
            f"{option}: expected {length} numbers separated by commas, got {len(values)} in '{text}'"
        )
    return values


def limit(option: str, text: str | None) -> float | list[float] | None:
    """Reads a limit: one number for all joints, or one per joint; None if the option was not given."""
    if text is None:
        return None
    values = numbers(option, text)
    return values[0] if len(values) == 1 else values


def kept_upright(robot: Robot, tilt: str | None, up: str | None) -> Keep | None:
    """Reads an axis of the tip and its largest angle to the vertical; None if neither was given."""
    if tilt is None:
        if up is not None:
            raise InvalidInputError("--up names the axis that --tilt keeps vertical: give --tilt too")
        return None
    name = "-z" if up is None else up
    if name.lstrip("-").isalpha() and name not in _AXES:
        raise InvalidInputError(f"--up: expected {', '.join(_AXES)} or X,Y,Z, got '{name}'")
    axis = _AXES[name] if name in _AXES else numbers("--up", name, 3)
    return upright(robot, axis=axis, direction=(0, 0, 1), tilt=numbers("--tilt", tilt, 1)[0])


_AXES = {
    sign + name: [number * (k == j) for k in range(3)]
    for sign, number in (("", 1.0), ("-", -1.0))
    for j, name in enumerate("xyz")
}


def sinusoid(option: str, text: str) -> Sinusoid:
    """Reads a limit given as `mean,amplitude,angular_frequency`."""
    mean, amplitude, angular_frequency = numbers(option, text, 3)
    return Sinusoid(mean=mean, amplitude=amplitude, angular_frequency=angular_frequency)


_NUMBER = r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?(?:deg)?"
_NUMBERS = re.compile(rf"([^\s=]+=)?{_NUMBER}(,{_NUMBER})*,?")  # `tip=0.4,` and `--position=0.4` too


def pose_first(first: FirstPart | None, *targets: object) -> tasks.Pose | None:
    """Task of `--first`, which orders the parts of a pose; a position alone, as a list, has none."""
    if first is None:
        return None
    if any(isinstance(target, list) for target in targets):
        raise InvalidInputError(
            "--first orders position and orientation, but this target is a position alone: give roll, pitch and yaw too"
        )
    return tasks.Pose(first=first.value)


def numbers_joined(arguments: list[str]) -> list[str]:
    """Joins numbers that follow the value of an option with commas, as in `--position 0.4 0.2, 0.5`."""
    joined: list[str] = []
    for argument in arguments:
        last, before = joined[-1:], joined[-2:-1]
        valued = any(entry.startswith("--") for entry in (*last, *before)) and not argument.startswith("--")
        if valued and re.fullmatch(rf"{_NUMBER},?", argument) and _NUMBERS.fullmatch(last[0]):
            joined[-1] = f"{last[0].rstrip(',')},{argument}"
        else:
            joined.append(argument)
    return [entry.rstrip(",") if _NUMBERS.fullmatch(entry) else entry for entry in joined]


def _number(option: str, entry: str) -> float:
    degrees = entry.removesuffix("deg")
    try:
        if degrees != entry and option in _WITH_ANGLES:
            return math.radians(float(degrees))
        return float(entry)
    except ValueError:
        raise InvalidInputError(f"{option}: '{entry}' is not a number") from None


def loaded(arm: Robot, payload: float | None, torque_limits: bool) -> tuple[Robot, Any]:
    """Returns the robot with its payload, and its torque limits if they are to be kept."""
    if payload is not None and not torque_limits:
        raise InvalidInputError("--payload counts only where torques are limited: use --torque-limits too")
    if not torque_limits:
        return arm, None
    carrying = arm if payload is None else arm.with_payload(payload)
    if not carrying.has_dynamics:
        carrying.torques([0.0] * carrying.dof)  # raises the reason
    if not any(map(math.isfinite, carrying.torque_limit)):
        raise InvalidInputError(f"--torque-limits: no joint of robot '{arm.name}' has an effort; its file gives it")
    return carrying, carrying.torque_limit
