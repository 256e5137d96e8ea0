"""Options and output shared by both planners."""

import math
from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from ... import Break, InvalidInputError, Limits, MoveReport, Plan, Stop, plot
from ..files import can_draw, print_files, results_folder, write_files
from ..options import SolverName, limit, make_solver
from ..show import print_json, print_pairs
from ..summary import carried
from ..wording import in_options

Budget = Annotated[
    int | None, typer.Option("--max-evaluations", min=1, help="Budget of the search; default: the method's own.")
]
Out = Annotated[Path | None, typer.Option(help="Folder for trajectory.csv, trajectory.npz, plan.png and summary.json.")]
Animated = Annotated[bool, typer.Option("--animation", help="Write plan.gif too; needs --out.")]


class SearchName(StrEnum):
    """The solvers that need only values of the objective."""

    BAS = SolverName.BAS
    BEE_COLONY = SolverName.BEE_COLONY
    BEETLE_SWARM = SolverName.BEETLE_SWARM
    DIFFERENTIAL_EVOLUTION = SolverName.DIFFERENTIAL_EVOLUTION
    FIREFLY = SolverName.FIREFLY
    GENETIC = SolverName.GENETIC
    PSO = SolverName.PSO
    QPSO = SolverName.QPSO


Solver = Annotated[SearchName | None, typer.Option(help="Solver of the search; default: the method's own.")]


def options(
    velocity: str | None,
    acceleration: str | None,
    jerk: str | None,
    tip_speed: float | None,
    torque: Any,
    max_evaluations: int | None,
) -> dict[str, Any]:
    """Returns the keywords common to all planners; `torque` are the torque limits, or None."""
    chosen: dict[str, Any] = {
        "limits": Limits(
            velocity=limit("--velocity-limit", velocity),
            acceleration=limit("--acceleration-limit", acceleration),
            jerk=limit("--jerk-limit", jerk),
            tip_speed=tip_speed,
            torque=torque,
        ),
    }
    if max_evaluations is not None:
        chosen["stop"] = Stop(max_evaluations=max_evaluations)
    return chosen


def search(solver: SearchName | None) -> Any:
    """Returns the solver of this name with its defaults."""
    return None if solver is None else make_solver(SolverName(solver))


def report(make: Callable[[], Plan], method: str, seed: int, out: Path | None, animated: bool, as_json: bool) -> None:
    """Plans, writes the files, prints the summary and exits with the status of the plan."""
    if animated and out is None:
        raise InvalidInputError("--animation writes a file: use --out DIR too")
    with results_folder(out) as folder:
        plan = make()
        summary = _summarize(plan, method, seed)
        if folder is not None:
            write_files(folder, plan.trajectory, summary, {"plan.png": plan.plot})
            if animated and can_draw():
                plot.animation(plan).save(folder / "plan.gif", writer="pillow")
    if as_json:
        print_json(summary)
    else:
        _print(plan, summary, out)
    raise typer.Exit(0 if plan.success else 1)


def _summarize(plan: Plan, method: str, seed: int) -> dict[str, Any]:
    return {
        "robot": plan.robot.name,
        "method": method,
        "objective": plan.objective,
        "seed": seed,
        "success": plan.success,
        "status": plan.status.name,
        "message": in_options(plan.message),
        "cost": plan.cost,
        "duration": plan.trajectory.duration,
        "start_q": plan.trajectory.q[0],
        "end_q": plan.trajectory.at(plan.trajectory.duration)[0],
        "accuracy": plan.accuracy,
        "clearance": plan.clearance,
        "tilt": plan.kept[0][1][-1] if plan.kept else math.nan,
        "violations": [str(violation) for violation in plan.violations],
        "moves": [_move(move) for move in plan.moves],
        "breaks": [_break(each) for each in plan.breaks],
        "largest_velocity": plan.trajectory.max_velocity(),
        "largest_acceleration": plan.trajectory.max_acceleration(),
        **carried(plan.robot, plan.limits),
        "evaluations": plan.evaluations,
        "elapsed": plan.elapsed,
    }


def _move(move: MoveReport) -> dict[str, Any]:
    bound_by = [{key: getattr(bound, key) for key in ("limit", "of", "start", "end")} for bound in move.bound_by]
    return {"name": move.name, "start": move.start, "end": move.end, "speed": move.speed, "bound_by": bound_by}


def _break(each: Break) -> dict[str, Any]:
    return {key: getattr(each, key) for key in ("at", "until", "reason", "start", "end")}


def _print(plan: Plan, summary: dict[str, Any], out: Path | None) -> None:
    rows = [("duration [s]", f"{summary['duration']:.6g}")]
    if not math.isnan(plan.accuracy):  # planned along a path
        rows.append(("distance from the path, at most [m]", f"{plan.accuracy:.3g}"))
    if not math.isnan(plan.clearance):  # planned among obstacles
        rows.append(("smallest clearance [m]", f"{plan.clearance:.3g}"))
    if not math.isnan(summary["tilt"]):
        rows.append(("largest tilt [rad]", f"{summary['tilt']:.4g}"))
    for i, move in enumerate(plan.moves):
        named = f"move {i}" if move.name is None else f"move {i} '{move.name}'"
        rows.append((named, f"{move.start:.3f} to {move.end:.3f} s, {move.message}"))
    for i, each in enumerate(plan.breaks):
        place = f"{each.at:.4g}" if each.at == each.until else f"{each.at:.4g} to {each.until:.4g}"
        rows.append((f"break {i}", f"at {place}, {each.start:.3f} to {each.end:.3f} s: {each.reason}"))
    rows += [("violation", violation) for violation in summary["violations"]]
    rows += [("evaluations", str(plan.evaluations)), ("time [ms]", f"{1e3 * plan.elapsed:.3g}")]
    print_pairs(f"{plan.robot.name}: {summary['message']}", rows)
    print_files(out)
