"""Inverse kinematics libraries side by side: the same targets, tolerance, limits and machine.

    python benches/compare.py --robots DIR --targets 1000 --out DIR

Every library gets the same chain (see `peers/chain.py`), target and random start, called one target at a time from one
thread, the call included; then a circle to follow. Pinocchio's forward kinematics judges the answers.
`benches/README.md` says how to set it up.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import functools
import platform
import tempfile
import warnings
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np
from peers import arms, closed_form, local, restarting, stepping, tracking
from peers.adapter import Adapter, load
from peers.chain import Chain
from peers.measure import Solver, batch_rate, interleave, judge, per_call
from peers.report import (
    ROW_COLUMNS,
    TRACKING_COLUMNS,
    Row,
    plain_section,
    plot,
    row_line,
    summary_columns,
    summary_lines,
    times_section,
    tracking_lines,
    write_table,
)

BEETLE_IK = restarting.BeetleIk
GENERAL = [
    BEETLE_IK,
    restarting.BeetleIkFromStart,
    restarting.RoboticsToolbox,
    restarting.OptIk,
    restarting.TracIk,
    closed_form.Eaik,
    closed_form.EaikCall,
    closed_form.Ssik,
]
# Single descents from the start. They take milliseconds: run apart, to spare the caches of the others, and on
# fewer targets.
LOCAL = [
    local.PinocchioClik,
    local.Klampt,
    local.PyBullet,
    local.IkPy,
    stepping.Placo,
    stepping.Mink,
    stepping.Pink,
]
TRACKING = [
    tracking.BeetleIkTrack,
    tracking.BeetleIkTracker,
    stepping.Placo,
    restarting.RoboticsToolbox,
    restarting.OptIk,
    stepping.Mink,
    stepping.Pink,
]
EVERY = [*dict.fromkeys((*GENERAL, *LOCAL, *TRACKING))]

POSE = "pose, 1e-6 m and 1e-6 rad"
TASKS = {
    POSE: ("solve_pose", 1e-6),
    "pose, 1e-9 m and 1e-9 rad": ("solve_pose", 1e-9),
    "position, 1e-6 m": ("solve_position", 1e-6),
}
LOCAL_SHARE = 5  # the first of so many targets
IN_A_ROW = "in a row"
ORDERS = {"alternating": 1, IN_A_ROW: 50}  # targets that a library gets before the next one has its turn
ROUNDS = 3
BATCH = 20_000


@dataclass
class Measured:
    """Figures so far; texts are cells of tables."""

    targets: int  # a robot
    only: list[str] | None  # names of the libraries that are measured; None: all
    rows: list[Row] = field(default_factory=list)
    followed: list[tracking.Followed] = field(default_factory=list)
    kinematics: list[list[str]] = field(default_factory=list)
    batches: list[list[str]] = field(default_factory=list)
    loads: list[float] = field(default_factory=list)  # load averages of the last minute; a busy machine spoils ratios

    def among(self, libraries: list[type[Adapter]]) -> list[type[Adapter]]:
        """Selects the libraries that are measured."""
        return [library for library in libraries if self.only is None or library.name in self.only]


def main() -> None:
    """Measures everything and writes it down, again after each robot: the run is long."""
    arguments = parse_arguments()
    warnings.filterwarnings("ignore", category=DeprecationWarning)  # libraries of libraries
    arguments.out.mkdir(parents=True, exist_ok=True)
    measured = Measured(arguments.targets, arguments.only)
    with tempfile.TemporaryDirectory() as scratch:
        for chain in arms.chosen(arguments, Path(scratch)):
            print(f"{chain.name} ({chain.dof} joints)", flush=True)
            measure(chain, measured)
            measured.loads.append(os.getloadavg()[0])
            write(measured, arguments.out)
    print(f"wrote compare.csv, summary.csv, tracking.csv, compare.md and compare.png to {arguments.out}")


def measure(chain: Chain, measured: Measured) -> None:
    """Measures everything on one robot."""
    for task in TASKS:
        measured.rows += compare(chain, task, measured.among(GENERAL), measured.targets, ROUNDS)
    measured.rows += compare(chain, POSE, measured.among(LOCAL), max(1, measured.targets // LOCAL_SHARE), 1)
    measured.kinematics += time_kinematics(chain, measured.among([*GENERAL, *LOCAL]))
    measured.batches.append(time_batch(chain))
    if chain.name == tracking.ROBOT:
        measured.followed += tracking.compare_tracking(
            chain, load(measured.among(TRACKING), chain, tracking.TOLERANCE)[0]
        )


def write(measured: Measured, out: Path) -> None:
    """Writes the tables, the report and the picture."""
    write_table(out / "compare.csv", ROW_COLUMNS, [*map(row_line, measured.rows)])
    summary = summary_lines(measured.rows, POSE, ORDERS, versions())
    write_table(out / "summary.csv", summary_columns(ORDERS), summary)
    write_table(out / "tracking.csv", TRACKING_COLUMNS, tracking_lines(measured.followed))
    (out / "compare.md").write_text(markdown(measured), encoding="utf-8")
    title = f"{measured.targets} random reachable targets a robot: {POSE}, {IN_A_ROW}"
    plot(measured.rows, POSE, IN_A_ROW, title, out / "compare.png")


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arms.add_arguments(parser, robots=[Path(__file__).parents[2] / "shared" / "robots"])
    parser.add_argument("--only", nargs="+", help="names of the libraries to measure (default: all)")
    parser.add_argument("--targets", type=int, default=1000, help="targets a robot (default: 1000)")
    parser.add_argument("--out", type=Path, default=Path("compare"), help="where the results go (default: compare)")
    return parser.parse_args()


def compare(chain: Chain, task: str, libraries: list[type[Adapter]], count: int, rounds: int) -> list[Row]:
    """Measures the rows of one task on one robot, in every order."""
    method, tolerance = TASKS[task]
    libraries = [library for library in libraries if library.offers(method)]
    adapters, missing = load(libraries, chain, tolerance)
    poses, starts = chain.targets(count)
    targets = poses[:, :3, 3].copy() if method == "solve_position" else poses
    solvers: dict[str, Solver] = {adapter.name: getattr(adapter, method) for adapter in adapters}
    for solve in solvers.values():
        solve(targets[0], starts[0])  # what is loaded at the first call is not timed
    rows = []
    for order, in_a_row in ORDERS.items():
        measured = interleave(solvers, targets, starts, in_a_row=in_a_row, rounds=rounds)
        times = {one.name: judge(chain, targets, measured[one.name], tolerance, one.chosen) for one in adapters}
        rows += [
            Row(task, order, chain.name, library.name, times.get(library.name), missing.get(library.name, ""))
            for library in libraries
        ]
    return rows


def time_kinematics(chain: Chain, libraries: list[type[Adapter]]) -> list[list[str]]:
    """Measures forward kinematics and Jacobian of every library that has them, in ns a call."""
    configurations = np.random.default_rng(0).uniform(chain.lower, chain.upper, (1000, chain.dof))
    adapters, _ = load([library for library in libraries if library.offers("fk")], chain, TASKS[POSE][1])
    poses = per_call({adapter.name: adapter.fk for adapter in adapters}, configurations)
    both = [adapter for adapter in adapters if adapter.offers("fk_and_jacobian")]
    jacobians = per_call({adapter.name: adapter.fk_and_jacobian for adapter in both}, configurations)
    return [
        [chain.name, name, f"{time:.0f}", f"{jacobians[name]:.0f}" if name in jacobians else "-"]
        for name, time in poses.items()
    ]


def time_batch(chain: Chain) -> list[str]:
    """Measures the solves of beetle-ik per second, on one core and on all."""
    adapter = BEETLE_IK(chain, 1e-6)
    targets, _ = chain.targets(BATCH)
    return [chain.name, *(f"{batch_rate(adapter, targets, threads):,.0f}" for threads in (1, os.cpu_count() or 1))]


def markdown(measured: Measured) -> str:
    """Returns the whole report."""
    rows, count = measured.rows, measured.targets
    sections = [
        f"# Inverse kinematics libraries compared\n\n{count} reachable targets a robot, drawn uniformly inside the "
        "limits, and one random start each. One thread, one call a target from Python, call included. Solved: within "
        "the tolerance by Pinocchio's forward kinematics and inside the limits. Failures count with the time that "
        "they took.\n\n"
        "Alternating: each library gets a target before any gets the next, so that every call comes after other work "
        f"and finds the caches cold. In a row: each library gets {ORDERS[IN_A_ROW]} targets before the next library "
        f"has its turn. Of a target's {ROUNDS} calls in each order the median counts (the libraries that solve "
        f"once from the start are measured among themselves, by one call on {count // LOCAL_SHARE} of the targets).\n\n"
        f"{processor()}, Python {platform.python_version()}, {platform.system()}; load average (this run is one) from "
        f"{min(measured.loads):.1f} to {max(measured.loads):.1f}.\n",
        plain_section(
            "Libraries and settings",
            ["library", "version", "settings"],
            [[library.name, versions()[library.name], library.settings] for library in measured.among(EVERY)],
        ),
        *(times_section(task, order, rows) for task in TASKS for order in ORDERS),
        plain_section(
            "A circle of 0.2 m, iiwa14, position, warm-started", TRACKING_COLUMNS, tracking_lines(measured.followed)
        ),
        plain_section("Kinematics, ns a call", ["robot", "library", "FK", "FK + Jacobian"], measured.kinematics),
        plain_section(
            f"Batch of {BATCH:,} poses by beetle-ik, poses a second",
            ["robot", "one thread", f"{os.cpu_count()} threads"],
            measured.batches,
        ),
    ]
    return "\n".join(sections)


def versions() -> dict[str, str]:
    """Versions of the installed libraries, by name."""
    found = {}
    for library in EVERY:
        try:
            found[library.name] = version(library.distribution)
        except PackageNotFoundError:
            found[library.name] = "not installed"
    return found


@functools.cache
def processor() -> str:
    """Name of the processor, which Python itself only knows on some systems."""
    listing = Path("/proc/cpuinfo")
    lines = listing.read_text().splitlines() if listing.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return f"{names[0] if names else platform.processor()}, {os.cpu_count()} logical cores"


if __name__ == "__main__":
    main()
