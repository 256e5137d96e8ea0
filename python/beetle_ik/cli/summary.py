"""Summary of a tracked path: errors, limits and cost."""

from pathlib import Path
from typing import Any

import numpy as np
import typer
from numpy.typing import NDArray

from .. import Limits, Robot, TrackResult
from ..calls.text import counted
from .files import print_files
from .show import listed, print_pairs
from .wording import in_options


def summarize(result: TrackResult, solver: str, dt: float, seed: int, limits_from: str | None) -> dict[str, Any]:
    """Collects errors, limits and cost of a tracked path; `limits_from` names the option that gave the limits."""
    error = result.position_error
    highest = np.nanmax(result.velocity_limit, axis=0)
    own = result.robot.velocity_limit
    return {
        "robot": result.robot.name,
        "solver": solver,
        "dt": dt,
        "seed": seed,
        "steps": len(result.time) - 1,
        "success": result.success,
        "status": result.status.name,
        "message": in_options(result.message),
        "position_tolerance": result.position_tolerance,
        "position_error": {
            "mean": error[1:].mean(),
            "max": error[1:].max(),
            "steady_mean": error[len(error) // 2 :].mean(),  # over the second half, when the approach is over
        },
        "clearance": None if np.isnan(result.clearance).all() else result.clearance.min(),
        "limit_margin": result.limit_margin,
        "max_violation": result.max_violation,
        **carried(result.robot, result.limits),
        "velocity_limit": {
            "source": limits_from or f"{result.robot.name}'s own",
            "lowest": np.nanmin(result.velocity_limit, axis=0),
            "highest": highest,
            "above_robot": {
                name: limit
                for name, limit, above in zip(result.robot.joint_names, own, highest > own, strict=True)
                if above
            },
        },
        "evaluations": result.evaluations,
        "evaluations_per_step": result.step_evaluations[1:].mean(),
        "elapsed": result.elapsed,
    }


def carried(robot: Robot, limits: Limits) -> dict[str, Any]:
    """Returns payload (kg) and torque limits of a motion within torque limits; an empty dict for other motions."""
    if limits.torque is None:
        return {}
    return {"payload": sum(payload.mass for payload in robot.payloads), "torque_limit": limits.torque}


def print_summary(summary: dict[str, Any], out: Path | None) -> None:
    """Prints the summary as a table, a note on limits above the robot's own, and the folder of the files."""
    error, limit = summary["position_error"], summary["velocity_limit"]
    clearance = summary["clearance"]
    print_pairs(
        f"{summary['robot']}, {counted(summary['steps'], 'step')} of {summary['dt']:g} s: {summary['message']}",
        [
            ("mean position error [m]", f"{error['mean']:.3g}"),
            ("  second half", f"{error['steady_mean']:.3g}"),
            ("  maximum", f"{error['max']:.3g}"),
            *([] if clearance is None else [("smallest clearance [m]", f"{clearance:.3g}")]),
            ("smallest velocity margin [rad/s]", f"{summary['limit_margin']:.3g}"),
            ("largest limit violation [rad, m]", f"{summary['max_violation']:.3g}"),
            ("velocity limit [rad/s]", f"{_span(limit['lowest'], limit['highest'])} ({limit['source']})"),
            ("evaluations", f"{summary['evaluations']} ({summary['evaluations_per_step']:.0f} per step)"),
            ("time [ms]", f"{1e3 * summary['elapsed']:.3g}"),
        ],
    )
    if limit["above_robot"]:
        typer.echo(_above_robot(summary["robot"], limit))
    print_files(out)


def _span(lowest: NDArray[np.float64], highest: NDArray[np.float64]) -> str:
    """Formats the range of a limit: one range if all joints agree, else one per joint."""
    spans = [
        f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}" for low, high in zip(lowest, highest, strict=True)
    ]
    return spans[0] if len(set(spans)) == 1 else ", ".join(spans)


def _above_robot(robot: str, limit: dict[str, Any]) -> str:
    above = limit["above_robot"]
    joints = f"{', '.join(above)}: {listed(np.round(list(above.values()), 3))}"
    return (
        f"Note: a velocity limit of up to {limit['highest'].max():.4g} rad/s is above the real {robot}'s own "
        f"in {len(above)} of its {len(limit['highest'])} joints ({joints})."
    )
