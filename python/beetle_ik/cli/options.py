"""Options that several commands share, and how their text is read."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import beetle_ik as bik

from .. import InvalidInputError, Robot, Sinusoid

if TYPE_CHECKING:
    from .._core import _Single

_ROBOT = "Robot"


def complete_robot(incomplete: str) -> list[str]:
    """Returns the built-in robots that begin with what was typed."""
    return [name for name in Robot.names() if name.startswith(incomplete)]


RobotName = Annotated[
    str | None,
    typer.Argument(help="A built-in robot; `beetle-ik robots` lists them.", autocompletion=complete_robot),
]
UrdfFile = Annotated[
    Path | None, typer.Option("--urdf", help="A URDF file instead of a built-in robot.", rich_help_panel=_ROBOT)
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
Start = Annotated[str | None, typer.Option(help="Joint positions to start from: q1,q2,...")]
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
) -> Robot:
    """Loads the built-in robot or the one in the URDF file, whichever was given; with capsules of `link_radius`."""
    robot = _load(name, urdf, base, tip, trusted)
    return robot if link_radius is None else robot.with_capsules(radius=link_radius)


def _load(name: str | None, urdf: Path | None, base: str | None, tip: str | list[str] | None, trusted: bool) -> Robot:
    if urdf is not None:
        if name is not None:
            raise InvalidInputError(f"both the robot '{name}' and --urdf '{urdf}' were given: give one of them")
        return Robot.from_urdf(urdf, base=base, tip=tip or None, trusted=trusted)
    if name is None:
        raise InvalidInputError(
            "no robot was given: name a built-in one (`beetle-ik robots` lists them) or use --urdf FILE"
        )
    if base is not None or tip:
        raise InvalidInputError(
            "--base and --tip can only be used with --urdf: a built-in robot has its own base and tip"
        )
    return Robot.named(name)


def numbers(option: str, text: str, length: int | None = None) -> list[float]:
    """Reads numbers separated by commas; `length` is how many there must be, if that is known."""
    values = [_number(option, entry.strip()) for entry in text.split(",")]
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


def sinusoid(option: str, text: str) -> Sinusoid:
    """Reads a limit given as `mean,amplitude,angular_frequency`."""
    mean, amplitude, angular_frequency = numbers(option, text, 3)
    return Sinusoid(mean=mean, amplitude=amplitude, angular_frequency=angular_frequency)


def _number(option: str, entry: str) -> float:
    try:
        return float(entry)
    except ValueError:
        raise InvalidInputError(f"{option}: '{entry}' is not a number") from None
