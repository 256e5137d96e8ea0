"""A hand that stays upright past a wall: `plan_point_to_point` with `keep=upright(...)`, and without it.

    python benches/keeps.py --problems 40 --out DIR
    python benches/keeps.py --shared FILE --robots DIR --out DIR

A Panda goes from one side of a wall to the other with its hand within 10 and within 30 degrees of down, under
acceleration limits. Problems are drawn; `--shared` reads others from a JSON file, for the arm of MotionBenchMaker in
`--robots`. Each is planned with and without the constraint, alternating. The judge is Denavit and Hartenberg's table
in numpy: the tilt at 5,000 samples of the timed motion. It writes `keeps.csv`.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import importlib.util
import json
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from peers.report import write_table

import beetle_ik as bik

TILTS = (10.0, 30.0)  # deg
SAMPLES = 5000
LIMITS = bik.Limits(acceleration=10.0)
COLUMNS = [
    "problems", "tilt [deg]", "solved", "kept", "largest tilt [deg]", "median [ms]", "largest [ms]",
    "without: median [ms]", "without: tilt kept", "duration ratio",
]  # fmt: skip
# Craig's form: a (m), d (m), alpha (rad) before each joint, from the maker's manual.
PANDA = [
    (0.0, 0.333, 0.0), (0.0, 0.0, -np.pi / 2), (0.0, 0.316, np.pi / 2), (0.0825, 0.0, np.pi / 2),
    (-0.0825, 0.384, -np.pi / 2), (0.0, 0.0, np.pi / 2), (0.088, 0.0, np.pi / 2),
]  # fmt: skip


@dataclass
class Problem:
    """An arm among obstacles, from one configuration (7,) to another."""

    robot: bik.Robot
    obstacles: list[Any]
    start: np.ndarray
    end: np.ndarray


@dataclass
class Measured:
    """What came of the problems with one tilt."""

    times: list[float] = field(default_factory=list)  # ms
    without: list[float] = field(default_factory=list)  # ms
    largest: list[float] = field(default_factory=list)  # deg, of solved ones
    free: list[float] = field(default_factory=list)  # deg, without the constraint
    ratios: list[float] = field(default_factory=list)


def main() -> None:
    """Measures all problems and writes the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--problems", type=int, default=40, help="number of drawn problems (default: 40)")
    parser.add_argument("--shared", type=Path, help="JSON file of further problems")
    parser.add_argument("--robots", type=Path, help="folder of MotionBenchMaker, for these")
    parser.add_argument("--out", type=Path, default=Path())
    arguments = parser.parse_args()
    lines = []
    for tilt in TILTS:
        lines.append(row("drawn", tilt, measure(drawn(arguments.problems, tilt), tilt)))
        if arguments.shared is not None and arguments.robots is not None:
            lines.append(row("shared", tilt, measure(read(arguments.shared, arguments.robots), tilt)))
        print(*lines, sep="\n", flush=True)
    if arguments.shared is None or arguments.robots is None:
        print("shared problems: skipped, --shared and --robots were not given")
    if importlib.util.find_spec("roboplan") is None:
        print("roboplan's PoseConstraint: skipped, roboplan is not installed")
    arguments.out.mkdir(parents=True, exist_ok=True)
    write_table(arguments.out / "keeps.csv", COLUMNS, lines)


def tilts(q: np.ndarray) -> np.ndarray:
    """Angles (m,) (deg) of the hand to down at q (m, 7), by the table."""
    turned = np.broadcast_to(np.eye(3), (len(q), 3, 3))
    for (_, _, alpha), angle in zip(PANDA, q.T, strict=True):
        c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(alpha), np.sin(alpha)
        rows = [[c, -s, 0 * c], [s * ca, c * ca, -sa + 0 * c], [s * sa, c * sa, ca + 0 * c]]
        turned = turned @ np.moveaxis(np.array(rows), -1, 0)
    z = turned[:, :, 2]
    return np.degrees(np.arctan2(np.hypot(z[:, 0], z[:, 1]), -z[:, 2]))


def drawn(count: int, tilt: float) -> list[Problem]:
    """Draws problems: a wall of random height and place, a hand at each side of it."""
    robot = bik.Robot.named("panda").with_capsules(radius=0.05)
    rng = np.random.default_rng(int(tilt))
    problems: list[Problem] = []
    while len(problems) < count:
        height, y = rng.uniform(0.2, 0.45), rng.uniform(-0.08, 0.08)
        wall = bik.obstacles.Box(center=(0.6, y, height / 2), size=(0.6, rng.uniform(0.04, 0.12), height))
        ends = [hand(robot, side, tilt, wall, rng) for side in (-1.0, 1.0)]
        if all(end is not None for end in ends):
            problems.append(Problem(robot, [wall], ends[0], ends[1]))
    return problems


def hand(robot: bik.Robot, side: float, tilt: float, wall: Any, rng: np.random.Generator) -> Any:
    """Returns a clear configuration with the hand low at a side of the wall; None if none was found."""
    leaning, about = np.radians(tilt) * rng.uniform(0.0, 0.9), rng.uniform(0.0, 2 * np.pi)
    lean = bik.pose(rotvec=leaning * np.array([np.cos(about), np.sin(about), 0.0]))
    place = [rng.uniform(0.35, 0.6), side * rng.uniform(0.2, 0.5), rng.uniform(0.15, 0.4)]
    target = lean @ bik.pose(rpy=[np.pi, 0.0, rng.uniform(-np.pi, np.pi)])
    target[:3, 3] = place
    found = bik.solve(
        robot, target, start_q=robot.random_configurations(1, int(rng.integers(2**31)))[0], obstacles=[wall]
    )
    return found.q if found.success else None


def read(file: Path, robots: Path) -> list[Problem]:
    """Reads problems for the Panda of MotionBenchMaker."""
    folder = robots / "robots" / "panda"
    robot = bik.Robot.from_urdf(folder / "panda_spherized.urdf", tip="panda_hand", srdf=folder / "panda.srdf")
    found = []
    for each in json.loads(file.read_text(encoding="utf-8"))["problems"]:
        obstacles: list[Any] = []
        for box in each["boxes"]:
            turn = bik.pose(xyzw=box["xyzw"])[:3, :3]
            size = 2 * np.array(box["half_extents"])
            obstacles.append(bik.obstacles.Box(box["position"], size, rotation=turn, touch=["panda_link0"]))
        for rod in each["cylinders"]:
            axis = bik.pose(xyzw=rod["xyzw"])[:3, 2]
            obstacles.append(bik.obstacles.Cylinder(rod["position"], axis, rod["radius"], rod["length"]))
        found.append(Problem(robot, obstacles, np.array(each["start"]), np.array(each["goal"])))
    return found


def measure(problems: list[Problem], tilt: float) -> Measured:
    """Plans every problem with and without the constraint, one after the other."""
    result = Measured()
    for problem in problems:
        keep = bik.upright(problem.robot, tilt=np.radians(tilt))
        kept, took = plan(problem, keep)
        free, took_without = plan(problem, None)
        result.times.append(took)
        result.without.append(took_without)
        result.free.append(largest(free))
        if kept.success:
            result.largest.append(largest(kept))
            result.ratios.append(kept.trajectory.duration / free.trajectory.duration)
    return result


def plan(problem: Problem, keep: bik.Keep | None) -> tuple[bik.Plan, float]:
    """Returns a plan and the time that it took (ms)."""
    begin = time.perf_counter()
    found = bik.plan_point_to_point(
        problem.robot, start_q=problem.start, end_q=problem.end, obstacles=problem.obstacles, keep=keep, limits=LIMITS
    )
    return found, 1e3 * (time.perf_counter() - begin)


def largest(found: bik.Plan) -> float:
    """Returns the largest tilt (deg) of the timed motion."""
    return float(tilts(found.trajectory.sample(found.trajectory.duration / SAMPLES)[1]).max())


def row(name: str, tilt: float, measured: Measured) -> dict[str, Any]:
    """Returns a line of the table."""
    count, most = len(measured.times), tilt * (1 + 1e-6)
    return {
        "problems": name,
        "tilt [deg]": f"{tilt:g}",
        "solved": f"{len(measured.largest)} / {count}",
        "kept": f"{sum(each <= most for each in measured.largest)} / {len(measured.largest)}",
        "largest tilt [deg]": f"{max(measured.largest, default=np.nan):.4g}",
        "median [ms]": f"{np.median(measured.times):.3g}",
        "largest [ms]": f"{max(measured.times):.3g}",
        "without: median [ms]": f"{np.median(measured.without):.3g}",
        "without: tilt kept": f"{sum(each <= most for each in measured.free)} / {count}",
        "duration ratio": f"{np.median(measured.ratios) if measured.ratios else np.nan:.3g}",
    }


if __name__ == "__main__":
    main()
