"""`beetle-ik plan retime`: time-optimal timing of joint positions from a file."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from numpy.typing import NDArray

from ... import Limits, Trajectory, plot, time_optimal
from ...calls.text import counted
from ...files.csv_table import read_table
from ...files.trajectories import joint_positions
from ..files import print_files, results_folder, write_files
from ..options import AsJson, Jerk, limit
from ..show import listed, print_json, print_pairs


class SplineName(StrEnum):
    """Joint paths by their names on the command line."""

    NATURAL = "natural"
    NOT_A_KNOT = "not-a-knot"
    CLAMPED = "clamped"
    POLYLINE = "polyline"


def retime(
    file: Annotated[
        Path,
        typer.Argument(help="CSV with a column per joint, named 'JOINT' or 'q:JOINT'; a column 'time' sets the knots."),
    ],
    *,
    acceleration: Annotated[
        str, typer.Option("--acceleration-limit", help="rad/s^2: one number, or one per joint: a1,a2,...")
    ],
    velocity: Annotated[
        str | None, typer.Option("--velocity-limit", help="rad/s: one number, or one per joint; default: none.")
    ] = None,
    jerk: Jerk = None,
    spline: Annotated[SplineName, typer.Option(help="Curve through the rows.")] = SplineName.NATURAL,
    blend: Annotated[
        float | None, typer.Option(help="Polyline: distance from a corner at which its rounding starts, in rad.")
    ] = None,
    tolerance: Annotated[
        str | None,
        typer.Option(
            help="How far the motion may leave the path in each joint, in rad: one number, or one per joint. "
            "Noise of a recording is smoothed inside it; default: exactly on the path."
        ),
    ] = None,
    gridpoints: Annotated[
        int | None, typer.Option(help="Points where the acceleration may change; chosen automatically by default.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for trajectory.csv, trajectory.npz, limits.png and summary.json.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Time the joint path through the rows of FILE as fast as the limits allow."""
    table = read_table(file, [])
    joints, waypoints = joint_positions(file, table)
    time = table.get("time")
    limits = Limits(
        acceleration=limit("--acceleration-limit", acceleration),
        velocity=limit("--velocity-limit", velocity),
        jerk=limit("--jerk-limit", jerk),
    )
    with results_folder(out) as folder:
        trajectory = time_optimal(
            waypoints,
            limits,
            knots=None if spline == SplineName.POLYLINE else time,
            spline=spline.value,
            blend=blend,
            gridpoints=gridpoints,
            joint_names=joints,
            tolerance=limit("--tolerance", tolerance),
        )
        summary = _summarize(file, trajectory, limits, waypoints, time)
        if folder is not None:
            write_files(folder, trajectory, summary, {"limits.png": lambda: plot.saturation(trajectory, limits)})
    if as_json:
        print_json(summary)
    else:
        _print(summary, out)


def _summarize(
    file: Path,
    trajectory: Trajectory,
    limits: Limits,
    waypoints: NDArray[np.float64],
    time: NDArray[np.float64] | None,
) -> dict[str, Any]:
    reached = {
        "velocity": trajectory.max_velocity(),
        "acceleration": trajectory.max_acceleration(),
        "jerk": trajectory.max_jerk(),
    }
    return {
        "file": str(file),
        "joints": trajectory.joint_names,
        "waypoints": len(waypoints),
        "success": True,
        "duration": trajectory.duration,
        "duration_before": None if time is None else time[-1] - time[0],
        "pieces": len(trajectory.time) - 1,
        "limits": {name: getattr(limits, name) for name in reached},
        "largest": reached,
        "saturation": {
            name: np.max(values / getattr(limits, name))
            for name, values in reached.items()
            if getattr(limits, name) is not None
        },
    }


def _print(summary: dict[str, Any], out: Path | None) -> None:
    before = summary["duration_before"]
    change = [] if before is None else [("duration in the file [s]", f"{before:.6g}")]
    print_pairs(
        f"{counted(len(summary['joints']), 'joint')}, {counted(summary['waypoints'], 'waypoint')}",
        [
            ("duration [s]", f"{summary['duration']:.6g}"),
            *change,
            *((f"largest {name}", listed(values)) for name, values in summary["largest"].items()),
            *((f"share of the {name} limit", f"{share:.4g}") for name, share in summary["saturation"].items()),
        ],
    )
    print_files(out)
