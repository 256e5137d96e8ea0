"""Paths of a Panda among boxes: `plan_along_path(obstacles=)`, by time and by joint travel.

    python benches/paths_among_obstacles.py --paths DIR --robots DIR --out DIR

`--paths` holds the path problems of CppFlow (Morgan et al. 2024) as `NAME.csv` and `NAME.json`, `--robots` the data of
MotionBenchMaker. Each path has poses that the hand must pass within 0.1 mm and 0.1 deg. The bodies are spheres, and the
margin is 0.1 mm. `first` is the plan without a search for a better one. Coal judges every motion, at 2,000 instants.
`length` is the sum of |change of angle| over joints and waypoints, as in that paper, and `step` the largest change of a
joint from one waypoint to the next. A path that cannot be followed in one go is followed with `breaks=True`.
Without the data the program says so and ends.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import json
import sys
from pathlib import Path
from time import perf_counter

import numpy as np
from peers.clear import CoalScene, MotionBenchArm
from peers.report import plain_section, write_table

import beetle_ik as bik

PROBLEMS = ("panda__1cube_mini", "panda__1cube", "panda__2cubes", "panda__square")
COLUMNS = [
    "path",
    "plan",
    "success",
    "time_ms",
    "duration_s",
    "length_rad",
    "step_deg",
    "clearance_mm",
    "coal_mm",
    "breaks",
]
KINDS = {
    "boxes ignored": {"margin": None, "obstacles": None},
    "fastest": {},
    "shortest, first": {"objective": "joint_travel", "stop": bik.Stop(max_evaluations=1)},
    "shortest": {"objective": "joint_travel"},
}
MARGIN = 1e-4  # m
ACCURACY = 1e-4  # m and rad
INSTANTS = 2000


def main() -> None:
    """Plans along all paths and writes the table."""
    arguments = parse_arguments()
    if not (arguments.paths.is_dir() and arguments.robots.is_dir()):
        sys.exit(f"skipped: {arguments.paths} or {arguments.robots} is not there")
    arguments.out.mkdir(parents=True, exist_ok=True)
    arm = MotionBenchArm(arguments.robots, "panda")
    lines = []
    for name in PROBLEMS:
        problem = json.loads((arguments.paths / f"{name}.json").read_text(encoding="utf-8"))
        poses = read_poses(arguments.paths / f"{name}.csv")
        for kind in KINDS:
            lines.append(measure(arm, problem, poses, arguments.repeats, kind))
            print(lines[-1], flush=True)
    write_table(arguments.out / "paths_among_obstacles.csv", COLUMNS, lines)
    text = plain_section("Paths of CppFlow, margin 0.1 mm", COLUMNS, lines)
    (arguments.out / "paths_among_obstacles.md").write_text(text + "\n", encoding="utf-8")
    print(text)


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    shared = Path(__file__).resolve().parents[2] / "shared"
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--paths", type=Path, default=shared / "cppflow", help="folder of CppFlow's problems")
    parser.add_argument("--robots", type=Path, default=shared / "motionbenchmaker", help="folder of MotionBenchMaker")
    parser.add_argument("--repeats", type=int, default=3, help="plans of each problem; the shortest time counts")
    parser.add_argument("--out", type=Path, default=Path("paths_among_obstacles"), help="where the results go")
    return parser.parse_args()


def read_poses(file: Path) -> np.ndarray:
    """Reads poses (k, 4, 4) of the tip."""
    rows = np.loadtxt(file, delimiter=",", skiprows=1)
    return np.array([bik.pose(row[:3], wxyz=row[3:]) for row in rows])


def measure(arm: MotionBenchArm, problem: dict, poses: np.ndarray, repeats: int, kind: str) -> list:
    """Measures one line of the table."""
    limits = bik.Limits(acceleration=5.0, lower=problem["lower"], upper=problem["upper"])
    boxes = [bik.obstacles.Box(box["center"], box["size"]) for box in problem["boxes"]]
    around = {"obstacles": boxes, "margin": MARGIN} | KINDS[kind]
    times = []
    for _ in range(repeats):
        begin = perf_counter()
        plan = bik.plan_along_path(arm.robot, poses, limits=limits, accuracy=ACCURACY, breaks=True, **around)
        times.append(perf_counter() - begin)
    at_waypoints, steps = passed(arm.robot, plan.trajectory, poses)
    judge = CoalScene(arm, {"boxes": [as_judged(box) for box in problem["boxes"]], "cylinders": []})
    instants = np.linspace(0.0, plan.trajectory.duration, INSTANTS)
    least = min(judge.clearance(plan.trajectory.at(t)[0]) for t in instants)
    return [
        problem["problem"],
        kind,
        "yes" if plan.success else "no",
        f"{1e3 * min(times):.0f}",
        f"{plan.trajectory.duration:.2f}",
        f"{np.abs(np.diff(at_waypoints, axis=0)).sum():.2f}",
        f"{np.degrees(steps.max()):.1f}",
        "" if np.isnan(plan.clearance) else f"{1e3 * plan.clearance:.2f}",
        f"{1e3 * least:.2f}",
        str(len(plan.breaks)),
    ]


def as_judged(box: dict) -> dict:
    """Converts a box to the form of the judge."""
    return {"position": box["center"], "xyzw": [0, 0, 0, 1], "half_extents": 0.5 * np.asarray(box["size"])}


def passed(robot: bik.Robot, trajectory: bik.Trajectory, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Configurations at which the tip is nearest to each pose, in order, and the changes between them."""
    times = np.linspace(0.0, trajectory.duration, 20 * len(poses))
    qs = np.array([trajectory.at(t)[0] for t in times])
    tips = robot.fk(qs)
    rows, first = [], 0
    for pose in poses:
        ahead = slice(first, first + 400)
        off = np.linalg.norm(tips[ahead, :3, 3] - pose[:3, 3], axis=1)
        off += np.linalg.norm(tips[ahead, :3, :3] - pose[:3, :3], axis=(1, 2))
        first += int(off.argmin())
        rows.append(first)
    return qs[rows], np.abs(np.diff(qs[rows], axis=0))


if __name__ == "__main__":
    main()
