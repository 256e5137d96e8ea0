"""What a planned motion is reported by: options, figures, files."""

from collections.abc import Callable
from contextlib import nullcontext
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from ... import (
    BAS,
    PSO,
    QPSO,
    BeeColony,
    BeetleSwarm,
    DifferentialEvolution,
    Firefly,
    Genetic,
    Limits,
    Plan,
    Stop,
    plot,
)
from ..._files import whole_file, whole_folder
from ..options import numbers
from ..show import print_json, print_pairs, to_json
from ..track_files import can_draw

Velocity = Annotated[
    str | None,
    typer.Option("--velocity", help="Limit in rad/s: a number, or one a joint: v1,v2,...; else the robot's."),
]
Acceleration = Annotated[str | None, typer.Option("--acceleration", help="The same in rad/s^2; else there is none.")]
Budget = Annotated[
    int | None, typer.Option("--max-evaluations", min=1, help="Budget of the search; else the method's own.")
]
Out = Annotated[Path | None, typer.Option(help="Folder for trajectory.csv, trajectory.npz, plan.png and summary.json.")]
Animated = Annotated[bool, typer.Option("--animation", help="Write plan.gif too; needs --out.")]


class SearchName(StrEnum):
    """Searches by their names on the command line."""

    BAS = "bas"
    BEE_COLONY = "bee-colony"
    BEETLE_SWARM = "beetle-swarm"
    DIFFERENTIAL_EVOLUTION = "differential-evolution"
    FIREFLY = "firefly"
    GENETIC = "genetic"
    PSO = "pso"
    QPSO = "qpso"


_SEARCHES: dict[SearchName, Callable[[], Any]] = {
    SearchName.BAS: BAS,
    SearchName.BEE_COLONY: BeeColony,
    SearchName.BEETLE_SWARM: BeetleSwarm,
    SearchName.DIFFERENTIAL_EVOLUTION: DifferentialEvolution,
    SearchName.FIREFLY: Firefly,
    SearchName.GENETIC: Genetic,
    SearchName.PSO: PSO,
    SearchName.QPSO: QPSO,
}
Solver = Annotated[SearchName | None, typer.Option(help="What searches; else the method's own.")]


def options(
    velocity: str | None, acceleration: str | None, solver: SearchName | None, max_evaluations: int | None
) -> dict[str, Any]:
    """What both planners take."""
    chosen: dict[str, Any] = {
        "limits": Limits(velocity=_limit("--velocity", velocity), acceleration=_limit("--acceleration", acceleration)),
        "solver": None if solver is None else _SEARCHES[solver](),
    }
    if max_evaluations is not None:
        chosen["stop"] = Stop(max_evaluations=max_evaluations)
    return chosen


def _limit(option: str, text: str | None) -> float | list[float] | None:
    if text is None:
        return None
    values = numbers(option, text)
    return values[0] if len(values) == 1 else values


def report(make: Callable[[], Plan], method: str, seed: int, out: Path | None, animated: bool, as_json: bool) -> None:
    """Plan, write the files, print, and leave with the exit status of the plan."""
    with nullcontext() if out is None else whole_folder(out, option="--out") as folder:
        plan = make()
        summary = _summarize(plan, method, seed)
        if folder is not None:
            _write(plan, summary, folder, animated)
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
        "message": plan.message,
        "cost": plan.cost,
        "duration": plan.trajectory.duration,
        "start_q": plan.trajectory.q[0],
        "end_q": plan.trajectory.at(plan.trajectory.duration)[0],
        "accuracy": plan.accuracy,
        "clearance": plan.clearance,
        "violations": [str(violation) for violation in plan.violations],
        "largest_velocity": plan.trajectory.max_velocity(),
        "largest_acceleration": plan.trajectory.max_acceleration(),
        "evaluations": plan.evaluations,
        "elapsed": plan.elapsed,
    }


def _write(plan: Plan, summary: dict[str, Any], folder: Path, animated: bool) -> None:
    plan.trajectory.to_csv(folder / "trajectory.csv")
    plan.trajectory.to_npz(folder / "trajectory.npz")
    with whole_file(folder / "summary.json") as stream:
        stream.write(to_json(summary).encode() + b"\n")
    if can_draw():
        plan.plot().savefig(folder / "plan.png")
        if animated:
            plot.animation(plan).save(folder / "plan.gif", writer="pillow")


def _print(plan: Plan, summary: dict[str, Any], out: Path | None) -> None:
    rows = [("duration [s]", f"{summary['duration']:.6g}")]
    if plan.accuracy == plan.accuracy:  # NaN from end to end
        rows.append(("distance from the path, at most [m]", f"{plan.accuracy:.3g}"))
    if plan.clearance == plan.clearance:
        rows.append(("smallest clearance [m]", f"{plan.clearance:.3g}"))
    rows += [("breaks", violation) for violation in summary["violations"]]
    rows += [("evaluations", str(plan.evaluations)), ("time [ms]", f"{1e3 * plan.elapsed:.3g}")]
    print_pairs(f"{plan.robot.name}: {plan.message}", rows)
    if out is not None:
        figure = "" if can_draw() else ", without a figure: that needs `pip install beetle-ik[plot]`"
        typer.echo(f"Files in {out}/{figure}")
