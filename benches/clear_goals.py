"""Collision-free solutions at the goal poses of MotionBenchMaker: `solve(obstacles=)` compared with other ways.

    python benches/clear_goals.py --data DIR --out DIR

DIR holds `panda.json`, `ur5.json` and `robots/`, as in the README of the data. Each pose has a solution: the goal
configuration. The bodies are the spheres that decide there what is valid; the margin is 0. Compared with rejection: all
solutions of ssik, EAIK or this library's own `solve_all`, tested by coal until one is clear. Coal judges every answer.
"""

# ruff: noqa: E402

import os

# Read by numerical libraries when they are loaded, so before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import gc
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import perf_counter_ns

import numpy as np
from peers.clear import ARMS, CoalScene, MotionBenchArm, rejections
from peers.report import plain_section, write_table

import beetle_ik as bik

Way = Callable[[int], np.ndarray | None]
COLUMNS = ["arm", "way", "poses", "solved clear", "median_us", "mean_us", "p99_us"]
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
            lines += measure(arm, problems, Path(scratch), notes)
    write_table(arguments.out / "clear_goals.csv", COLUMNS, lines)
    text = plain_section("Goal poses of MotionBenchMaker, margin 0", COLUMNS, lines)
    (arguments.out / "clear_goals.md").write_text("\n".join([text, *notes]) + "\n", encoding="utf-8")
    print("\n".join([text, *notes]))


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder of MotionBenchMaker's problems")
    parser.add_argument("--every", type=int, default=1, help="take one of so many poses (default: all)")
    parser.add_argument("--out", type=Path, default=Path("clear_goals"), help="where the results go")
    return parser.parse_args()


def measure(arm: MotionBenchArm, problems: list[dict], scratch: Path, notes: list[str]) -> list[list[str]]:
    """Times every way on every pose, one after the other, and judges the answers."""
    scenes = [arm.scene(problem) for problem in problems]
    judges = [CoalScene(arm, problem) for problem in problems]
    targets = [arm.robot.fk(problem["goal"]) for problem in problems]
    ways: dict[str, Way] = {
        "beetle-ik solve(obstacles=)": lambda i: solved(arm.robot, targets[i], scenes[i]),
    }
    for name, reject in rejections(arm, scratch, notes).items():
        ways[name] = lambda i, reject=reject: reject(targets[i], judges[i])
    return [line(arm, name, way, targets, judges, notes) for name, way in ways.items()]


def solved(robot: bik.Robot, target: np.ndarray, scene: bik.Scene) -> np.ndarray | None:
    """Returns a solution that this library calls clear."""
    solution = bik.solve(robot, target, obstacles=scene, margin=0.0)
    return solution.q if solution.success else None


def line(
    arm: MotionBenchArm, name: str, way: Way, targets: list[np.ndarray], judges: list[CoalScene], notes: list[str]
) -> list[str]:
    """Times one way, judges it, and returns its line of the table."""
    times, answers = np.empty(len(targets)), []
    way(0)  # what is loaded at the first call is not timed
    gc.collect()
    gc.disable()
    for i in range(len(targets)):
        begin = perf_counter_ns()
        q = way(i)
        times[i] = (perf_counter_ns() - begin) * 1e-3
        answers.append(q)
    gc.enable()
    good = 0
    for target, judge, q in zip(targets, judges, answers, strict=True):
        if q is None:
            continue
        miss = np.abs(arm.robot.fk(q) - target).max()
        if miss < REACHED and judge.clearance(q) >= -1e-9:
            good += 1
        else:
            notes.append(f"- {arm.name}, {name}: misses by {miss:.2g}, clearance by coal {judge.clearance(q):.3g} m")
    figures = [np.median(times), times.mean(), np.quantile(times, 0.99)]
    print(f"  {name}: {good} of {len(targets)}, median {figures[0]:.1f} us, p99 {figures[2]:.1f} us", flush=True)
    return [arm.name, name, str(len(targets)), str(good), *(f"{value:.4g}" for value in figures)]


if __name__ == "__main__":
    main()
