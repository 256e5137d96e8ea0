"""All solutions of a pose: `solve_all` compared with other libraries, and tested for missing solutions.

    python benches/all_solutions.py --arms ur5e kr6_r900 xarm6 --poses 10000 --descents 200 --out DIR

The default arms are part of `ssik`; most of them are not in our own catalog.
Times: one pose per call, alternating and in a row. Completeness: tested against the union of the solutions of the
others and of random descents, which count if they reach the pose by Pinocchio's forward kinematics inside the limits.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from peers import arms, closed_form, completeness, restarting, solutions_report
from peers.adapter import Adapter, load
from peers.chain import Chain
from peers.measure import Calls, interleave
from peers.report import plain_section, write_table

LIBRARIES = [restarting.BeetleIk, closed_form.Eaik, closed_form.Ssik, closed_form.Opw]
ORDERS = {"alternating": 1, "in a row": 50}  # poses that a library gets before the next one has its turn
ROUNDS = 3
TOLERANCE = 1e-6
REDUNDANCY_SAMPLES = 16
SHOWN = 20  # missing solutions written out for an arm


@dataclass
class Measured:
    """Figures so far, as lines of tables, and the reasons for missing libraries."""

    times: list[list[str]] = field(default_factory=list)
    complete: list[list[str]] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def main() -> None:
    """Measures all arms and writes the results, again after each arm: the run is long."""
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    measured = Measured()
    with tempfile.TemporaryDirectory() as scratch:
        for chain in arms.chosen(arguments, Path(scratch)):
            print(f"{chain.name} ({chain.dof} joints)", flush=True)
            measure(chain, arguments, measured)
            write(measured, arguments.out)
    print(f"wrote solutions.csv, times.csv, completeness.csv and all_solutions.md to {arguments.out}")


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arms.add_arguments(parser, arms=(*arms.SIX_JOINTS, *arms.SEVEN_JOINTS))
    parser.add_argument("--timed", type=int, default=500, help="poses an arm that are timed (default: 500)")
    parser.add_argument("--poses", type=int, default=1000, help="poses an arm that are searched (default: 1000)")
    parser.add_argument("--descents", type=int, default=200, help="random descents a pose (default: 200)")
    parser.add_argument("--out", type=Path, default=Path("all_solutions"), help="where the results go")
    return parser.parse_args()


def measure(chain: Chain, arguments: argparse.Namespace, measured: Measured) -> None:
    """Measures times and counts on one arm, and completeness if its solutions are finitely many."""
    adapters, missing = load(LIBRARIES, chain, TOLERANCE)
    if reason := missing.get(restarting.BeetleIk.name):
        raise SystemExit(f"{chain.name}: {reason}")
    measured.notes += [f"- {name}, {chain.name}: {reason}" for name, reason in missing.items()]
    if arguments.timed:
        measure_times(chain, adapters, arguments.timed, measured)
    if chain.dof <= 6 and arguments.poses:
        measure_completeness(chain, adapters, arguments, measured)


TIMES_COLUMNS = [
    *("robot", "joints", "structure", "order", "library", "median_us", "mean_us", "p99_us", "time_over_ours"),
    *("solutions_a_pose", "poses_without", "poses_with_more_than_ours"),
]


def measure_times(chain: Chain, adapters: list[Adapter], poses: int, measured: Measured) -> None:
    """Measures the time of each library for a pose, and counts its solutions."""
    targets, starts = chain.targets(poses)
    solvers = {adapter.name: adapter.solve_all for adapter in adapters}
    structure = adapters[0].robot.closed_form
    for solve in solvers.values():
        solve(targets[0], starts[0])  # what is loaded at the first call is not timed
    for order, in_a_row in ORDERS.items():
        calls = interleave(solvers, targets, starts, in_a_row=in_a_row, rounds=ROUNDS)
        times = {name: np.median(each.times, axis=0) for name, each in calls.items()}
        counts = {name: good_solutions(chain, targets, each) for name, each in calls.items()}
        ours = adapters[0].name
        for name, mine in times.items():
            figures = [np.median(mine), mine.mean(), np.quantile(mine, 0.99), mine.mean() / times[ours].mean()]
            held = [counts[name].mean(), (counts[name] == 0).sum(), (counts[name] > counts[ours]).sum()]
            row = [chain.name, str(chain.dof), structure, order, name, *(f"{value:.4g}" for value in (*figures, *held))]
            measured.times.append(row)


def good_solutions(chain: Chain, targets: np.ndarray, calls: Calls) -> np.ndarray:
    """Counts the solutions of each pose that reach it inside the limits, each once."""
    return np.array(
        [
            len(completeness.distinct(completeness.verified(chain, target, found)))
            for target, found in zip(targets, calls.answers[0], strict=True)
        ]
    )


COMPLETE_COLUMNS = [
    *("arm", "structure", "poses", "said to be complete", "solutions", "wrong", "known to others"),
    *("found by others too", "missing", "missing where said complete", "missing beside a singularity"),
]


def measure_completeness(
    chain: Chain, adapters: list[Adapter], arguments: argparse.Namespace, measured: Measured
) -> None:
    """Looks for solutions that `solve_all` misses."""
    import beetle_ik

    targets, starts = chain.targets(arguments.poses)
    robot = adapters[0].robot
    sets = [beetle_ik.solve_all(robot, target) for target in targets]
    theirs = [
        np.vstack([found, *(adapter.solve_all(target, start) for adapter in adapters[1:])])
        for target, start, found in zip(
            targets, starts, completeness.descents(robot, chain, targets, arguments.descents), strict=True
        )
    ]
    verdict = completeness.judge(chain, targets, [each.q for each in sets], theirs)
    said = [each.complete for each in sets]
    counts = [
        *(len(targets), sum(said), verdict.solutions, verdict.wrong, verdict.known, verdict.found_again),
        *(len(verdict.missing), sum(said[number] for number, _ in verdict.missing), len(verdict.singular)),
    ]
    measured.complete.append([chain.name, robot.closed_form, *map(str, counts)])
    for number, q in verdict.missing[:SHOWN]:
        smallest = completeness.smallest_singular_value(chain, q)
        measured.missing.append(
            f"- {chain.name}, pose {number}{' (said complete)' if said[number] else ''}: {q.tolist()}, "
            f"smallest singular value {smallest:.2g}"
        )


def write(measured: Measured, out: Path) -> None:
    """Writes the tables and the report."""
    write_table(out / "times.csv", TIMES_COLUMNS, measured.times)
    summary = solutions_report.summary_lines([dict(zip(TIMES_COLUMNS, line, strict=True)) for line in measured.times])
    write_table(out / "solutions.csv", solutions_report.SUMMARY_COLUMNS, summary)
    write_table(out / "completeness.csv", COMPLETE_COLUMNS, measured.complete)
    settings = [[library.name, library.settings] for library in LIBRARIES]
    sections = [
        "# All solutions\n\nPoses of configurations drawn uniformly inside the limits. Solutions count that reach the "
        f"pose within {completeness.REACHED:g} m and rad inside the limits, each once, whole turns aside.\n",
        plain_section("Libraries and settings", ["library", "settings"], settings),
        plain_section("In short", solutions_report.SUMMARY_COLUMNS, summary),
        plain_section("Times", TIMES_COLUMNS, measured.times),
        plain_section("Complete", COMPLETE_COLUMNS, measured.complete),
        "Missing:\n",
        *measured.missing,
        "\nNot measured:\n",
        *measured.notes,
    ]
    (out / "all_solutions.md").write_text("\n".join(sections) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
