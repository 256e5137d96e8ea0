"""`beetle-ik calibrate`: the arm as it is built, from a table of measurements."""

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from numpy.typing import NDArray

from .. import Calibration, InvalidInputError, Robot, Scene, pose
from .. import calibrate as calibrate_robot
from ..files.csv_table import read_table, write_table
from ..files.whole import whole_file
from ..plot import calibration as figure_of
from .files import can_draw, print_files, results_folder
from .options import (
    AsJson,
    BaseLink,
    Margin,
    RobotName,
    SceneFile,
    Seed,
    TipLink,
    Trusted,
    UrdfFile,
    load_robot,
    numbers,
)
from .show import as_argument, print_json, print_pairs, to_json
from .wording import in_options

_POSITION = ("x", "y", "z")
_QUATERNION = ("qx", "qy", "qz", "qw")
_DISTANCE = "distance"


def calibrate(
    measurements: Annotated[
        Path,
        typer.Argument(
            help="A CSV file: a column for each joint, by its name or q1, q2, ... (rad, m), and x,y,z (m), perhaps "
            "with qx,qy,qz,qw, or distance (m) of a ball bar."
        ),
    ],
    robot: RobotName = None,
    *,
    fit: Annotated[
        str | None, typer.Option(help="What may differ: some of offsets,links,tool,base; default: all.")
    ] = None,
    sigma: Annotated[
        str | None, typer.Option(help="Noise: one number (m), or length,angle (m, rad); default: estimated.")
    ] = None,
    center: Annotated[str | None, typer.Option(help="Fixed end of a ball bar, a guess: x,y,z in m.")] = None,
    tool: Annotated[
        str | None, typer.Option(help="Guess of the measured point in the frame of the tip link: x,y,z in m.")
    ] = None,
    suggest: Annotated[int, typer.Option(help="Number of further configurations to suggest.")] = 0,
    scene: SceneFile = None,
    margin: Margin = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for calibrated.urdf (of a URDF), report.md with a figure, and tables."),
    ] = None,
    seed: Seed = 0,
    urdf: UrdfFile = None,
    tip: TipLink = None,
    base: BaseLink = None,
    trusted: Trusted = False,
    as_json: AsJson = False,
) -> None:
    """Calibration: zeros, links, tool and base of an arm as it is built, from positions or poses of its tip."""
    arm = load_robot(robot, urdf, base, tip, trusted=trusted)
    if tool is not None:
        arm = arm.with_tool(pose(numbers("--tool", tool, 3)))
    q, measured = _read(measurements, arm)
    if measured.ndim == 1 and center is None:
        raise InvalidInputError("distances need a guess of the fixed end of the ball bar: --center x,y,z")
    options: dict[str, Any] = {
        "fit": None if fit is None else [part.strip() for part in fit.split(",")],
        "sigma": None if sigma is None else _noise(sigma),
        "center": None if center is None else numbers("--center", center, 3),
        "obstacles": None if scene is None else Scene.load(scene),
        "margin": margin,
        "suggest": suggest,
        "seed": seed,
    }
    found = calibrate_robot(arm, q, measured, **options)
    file = urdf or (Path(robot) if robot and robot.lower().endswith(".urdf") else None)
    with results_folder(out) as folder:
        if folder is not None:
            _write(folder, found, file)
    _show(arm, found, as_json)
    if not as_json:
        print_files(out)
    raise typer.Exit(0 if found.success else 1)


def _noise(text: str) -> float | list[float]:
    values = numbers("--sigma", text)
    return values[0] if len(values) == 1 else values


def _read(file: Path, arm: Robot) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns joint angles and measurements."""
    table = read_table(file, ())
    numbered = [f"q{i + 1}" for i in range(arm.dof)]
    names = numbered if set(numbered) <= set(table) else arm.joint_names
    kind = (_DISTANCE,) if _DISTANCE in table else _POSITION
    for name in (*names, *kind):
        if name not in table:
            raise InvalidInputError(f"{file}, line 1: column '{name}' is missing; columns found: {', '.join(table)}")
    q = np.column_stack([table[name] for name in names])
    if kind == (_DISTANCE,):
        return q, table[_DISTANCE]
    points = np.column_stack([table[name] for name in _POSITION])
    if not set(_QUATERNION) <= set(table):
        return q, points
    turns = np.column_stack([table[name] for name in _QUATERNION])
    return q, np.array([pose(point, xyzw=turn) for point, turn in zip(points, turns, strict=True)])


def _write(folder: Path, found: Calibration, file: Path | None) -> None:
    """Writes the calibrated URDF, the tables, and the report with its figure."""
    if file is not None:
        with whole_file(folder / "calibrated.urdf") as stream:
            stream.write(found.to_urdf(file).encode())
    with whole_file(folder / "parameters.csv") as stream:
        rows = [f"{name},{value!r},{found.deviations[name]!r}" for name, value in found.parameters.items()]
        stream.write("\n".join(["parameter,value,deviation", *rows, ""]).encode())
    write_table(folder / "errors.csv", ["before", "after"], np.column_stack([found.errors_before, found.errors_after]))
    if can_draw():
        figure_of(found).savefig(folder / "calibration.png")
    with whole_file(folder / "summary.json") as stream:
        stream.write(to_json(_summary(found)).encode() + b"\n")
    with whole_file(folder / "report.md") as stream:
        stream.write(_report(found).encode())


def _summary(found: Calibration) -> dict[str, Any]:
    fields = (
        "rms_before",
        "rms_placed",
        "rms_after",
        "rms_held_out",
        "rotation_rms_before",
        "rotation_rms_after",
        "rotation_rms_held_out",
        "outliers",
        "sigma",
        "parameters",
        "deviations",
        "base",
        "tool",
        "center",
        "suggested",
    )
    known = found.identifiable
    return {
        "success": found.success,
        "message": in_options(found.message),
        **{field: getattr(found, field) for field in fields},
        "rank": known.rank,
        "possible": known.possible,
        "condition": known.condition,
        "unknown": known.unknown,
    }


def _report(found: Calibration) -> str:
    """Returns the report in Markdown."""
    kinds = zip(found.robot.joint_names, found.robot.joint_kinds, strict=True)
    slides = {f"offset {joint}" for joint, kind in kinds if kind == "prismatic"}
    rows = [
        f"| {name} | {_in_small(name, value, slides)} | {_in_small(name, found.deviations[name], slides)} |"
        for name, value in found.parameters.items()
    ]
    figure = ["", "![Errors before and after](calibration.png)"] if can_draw() else []
    known = found.identifiable
    return "\n".join(
        [
            "# Calibration",
            "",
            f"{found.message[0].upper()}{in_options(found.message)[1:]}.",
            *figure,
            "",
            f"Determined: {known.rank} of {known.possible} combinations, condition {known.condition:.4g}.",
            "",
            "| parameter | value | standard deviation |",
            "|---|---|---|",
            *rows,
            "",
        ]
    )


def _in_small(name: str, value: float, slides: set[str]) -> str:
    """Formats a length in mm, an angle in mrad."""
    is_length = name in slides or name.split()[-1] in (*_POSITION, "height")
    return f"{1e3 * value:.4g} {'mm' if is_length else 'mrad'}"


def _show(arm: Robot, found: Calibration, as_json: bool) -> None:
    if as_json:
        print_json({"robot": arm.name, **_summary(found)})
        return
    print_pairs(
        f"{arm.name}: {in_options(found.message)}",
        [
            ("error before [m]", f"{found.rms_before:.4g}"),
            ("error after [m]", f"{found.rms_after:.4g}"),
            ("error held out [m]", f"{found.rms_held_out:.4g}"),
            ("determined", f"{found.identifiable.rank} of {found.identifiable.possible}"),
            ("condition", f"{found.identifiable.condition:.4g}"),
        ],
    )
    for q in found.suggested:
        typer.echo(f"measure at q [rad, m]: {as_argument(q)}")
