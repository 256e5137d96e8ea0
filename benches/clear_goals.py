"""Collision-free solutions at the goal poses of MotionBenchMaker: `solve(obstacles=)` compared with other ways.

    python benches/clear_goals.py --data DIR --out DIR

DIR holds `panda.json`, `ur5.json` and `robots/`, as in the README of the data. Each pose has a solution: the goal
configuration. The bodies are the spheres that decide there what is valid; the margin is 0. Compared with rejection: all
solutions of ssik, EAIK or this library's own `solve_all`, or those that roboticstoolbox finds from random starts,
tested by coal until one is clear. Compared also with mink, pink and placo, whose quadratic programs keep obstacles away
by constraints, from random starts. Those take seconds, and get one of `--slow` poses.

Coal judges every answer. Times are those of the processor, so that a busy machine counts less.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import gc
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import process_time_ns

import numpy as np
from peers.barriers import BARRIERS, SETTINGS, Barriers
from peers.clear import ARMS, CoalScene, MotionBenchArm, rejections
from peers.report import plain_section, write_table

import beetle_ik as bik

Call = Callable[[], np.ndarray | None]
Way = Callable[[int], Call]  # what is made for a pose before the clock starts
COLUMNS = ["arm", "way", "poses", "solved clear", "median_us", "p99_us"]
REACHED = 1e-5  # m and rad


def main() -> None:
    """Measures both arms and writes the table."""
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    lines, notes = [], []
    with tempfile.TemporaryDirectory() as scratch:
        for name in ARMS:
            arm = MotionBenchArm(arguments.data, name)
            problems = arm.problems()[:: arguments.every]
            print(f"{name}: {len(problems)} poses", flush=True)
            lines += measure(arm, problems, Path(scratch), arguments, notes)
    write_table(arguments.out / "clear_goals.csv", COLUMNS, lines)
    text = plain_section("Goal poses of MotionBenchMaker, margin 0", COLUMNS, lines)
    text = "\n".join([text, f"mink, pink, placo: {SETTINGS}.", "", *notes])
    (arguments.out / "clear_goals.md").write_text(text + "\n", encoding="utf-8")
    print(text)


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder of MotionBenchMaker's problems")
    parser.add_argument("--every", type=int, default=1, help="take one of so many poses (default: all)")
    parser.add_argument("--slow", type=int, default=5, help="slow libraries get one of so many of these (default: 5)")
    parser.add_argument("--only", nargs="*", default=[], help="names that a way must contain one of (default: all)")
    parser.add_argument("--out", type=Path, default=Path("clear_goals"), help="where the results go")
    return parser.parse_args()


def measure(
    arm: MotionBenchArm, problems: list[dict], scratch: Path, arguments: argparse.Namespace, notes: list[str]
) -> list[list[str]]:
    """Times every method on its poses, one after the other, and judges the answers."""
    scenes = [arm.scene(problem) for problem in problems]
    judges = [CoalScene(arm, problem) for problem in problems]
    targets = [arm.robot.fk(problem["goal"]) for problem in problems]
    ways: dict[str, tuple[Way, int]] = {
        "beetle-ik solve(obstacles=)": (lambda i: lambda: solved(arm.robot, targets[i], scenes[i]), 1),
    }
    for name, reject in rejections(arm, scratch, notes).items():
        ways[name] = (lambda i, reject=reject: lambda: reject(targets[i], judges[i])), 1
    for library in BARRIERS:
        ways[library.name] = (
            by_barriers(library, arm, problems, scratch, targets, judges),
            arguments.slow if library.slow else 1,
        )
    wanted = {name: way for name, way in ways.items() if not arguments.only or any(o in name for o in arguments.only)}
    lines = []
    for name, (way, every) in wanted.items():
        try:
            lines.append(line(arm, name, way, targets[::every], judges[::every], every, notes))
        except ImportError as reason:
            notes.append(f"- {arm.name}, {name}: {reason}")
    return lines


def by_barriers(
    library: type[Barriers],
    arm: MotionBenchArm,
    problems: list[dict],
    scratch: Path,
    targets: list[np.ndarray],
    judges: list[CoalScene],
) -> Way:
    """Method of a library that builds a model of each scene."""

    def prepared(i: int) -> Call:
        model = library(arm, problems[i], scratch)
        return lambda: model.solve(targets[i], judges[i], arm.robot.lower, arm.robot.upper)

    return prepared


def solved(robot: bik.Robot, target: np.ndarray, scene: bik.Scene) -> np.ndarray | None:
    """Returns a solution that this library calls clear."""
    solution = bik.solve(robot, target, obstacles=scene, margin=0.0)
    return solution.q if solution.success else None


def line(
    arm: MotionBenchArm,
    name: str,
    way: Way,
    targets: list[np.ndarray],
    judges: list[CoalScene],
    every: int,
    notes: list[str],
) -> list[str]:
    """Times one method on one of `every` poses, judges it, and returns its line of the table."""
    times, answers = np.empty(len(targets)), []
    way(0)()  # what is loaded at the first call is not timed
    gc.collect()
    gc.disable()
    for i in range(len(targets)):
        call = way(i * every)
        begin = process_time_ns()
        q = call()
        times[i] = (process_time_ns() - begin) * 1e-3
        answers.append(q)
    gc.enable()
    good = 0
    for target, judge, q in zip(targets, judges, answers, strict=True):
        if q is None:
            continue
        miss = np.abs(arm.robot.fk(q) - target).max()
        inside = (q >= arm.robot.lower - 1e-9).all() and (q <= arm.robot.upper + 1e-9).all()
        if miss < REACHED and inside and judge.clearance(q) >= -1e-9:
            good += 1
        else:
            notes.append(
                f"- {arm.name}, {name}: misses by {miss:.2g}, clearance by coal {judge.clearance(q):.3g} m, "
                f"{'inside' if inside else 'outside'} the limits"
            )
    figures = [np.median(times), np.quantile(times, 0.99)]
    print(f"  {name}: {good} of {len(targets)}, median {figures[0]:.1f} us, p99 {figures[1]:.1f} us", flush=True)
    return [arm.name, name, str(len(targets)), str(good), *(f"{value:.4g}" for value in figures)]


if __name__ == "__main__":
    main()
