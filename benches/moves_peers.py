"""Straight lines of the tip at a constant speed: `plan_moves` beside roboplan and tesseract, judged by Pinocchio.

    python benches/moves_peers.py --robots DIR [--programs 50] [--out DIR]

`DIR` holds `ur5.urdf`, `panda.urdf` and their `robots.json`. A program is a start at rest and lines through two to four
random poses, the same for all planners. These take turns, program by program, on one core; of calls that take less than
50 ms the median of three counts. Writes `moves_peers.csv`, which the site shows.
"""

import argparse
import csv
import gc
import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from peers.line_movers import INSTANTS, BeetleLines, LineArm, LineMotion, LineMover, RoboplanLines, TesseractLines

SPEED = 0.1  # m/s
ACCELERATION = 5.0  # rad/s^2
NEAR = 0.02  # m: nearer to an end of a line the speed may change
REPEATED = 0.05  # s: faster calls are measured three times
ARMS = {
    "ur5": [0.0, -1.5, 1.8, -1.9, -1.57, 0.3],
    "panda": [0.0, -0.6, 0.0, -2.2, 0.0, 1.8, 0.7],
}
COLUMNS = [
    "arm",
    "planner",
    "found",
    "median, ms",
    "95 %, ms",
    "duration, median, s",
    "from the lines, median of the largest, mm",
    "largest, mm",
    "speed of that asked: median, %",
    "lowest, %",
    "highest, %",
    "instants within 1 %, %",
    "joint velocity of its limit, %",
    "joint acceleration, %",
]


@dataclass(frozen=True)
class Judged:
    """Figures of one motion."""

    off_line: float  # m, largest, and no less than the end is missed by
    speeds: np.ndarray  # of that asked, away from the ends of lines
    velocity: float  # largest, of the limit
    acceleration: float  # largest change of a velocity between successive knots over the time, of the limit


class Judge:
    """Judge by the kinematics of Pinocchio, which roboplan uses too."""

    def __init__(self, arm: LineArm) -> None:
        """Loads the URDF of an arm."""
        self.arm = arm
        self.model = pin.buildModelFromUrdf(arm.urdf)
        self.data = self.model.createData()
        self.base, self.tip = self.model.getFrameId(arm.base), self.model.getFrameId(arm.tip)
        if [*self.model.names][1:] != arm.joints:
            raise ValueError(f"Pinocchio has the joints {[*self.model.names]}")

    def pose(self, q: np.ndarray) -> np.ndarray:
        """Pose (4, 4) of the tip in the base."""
        pin.framesForwardKinematics(self.model, self.data, q)
        return (self.data.oMf[self.base].inverse() * self.data.oMf[self.tip]).homogeneous

    def speed(self, q: np.ndarray, qd: np.ndarray) -> float:
        """Speed of the tip's origin (m/s)."""
        pin.forwardKinematics(self.model, self.data, q, qd)
        return float(np.linalg.norm(pin.getFrameVelocity(self.model, self.data, self.tip).linear))

    def judge(self, motion: LineMotion, corners: np.ndarray) -> Judged:
        """Figures of a motion along the lines between `corners` (m, 3)."""
        q, qd = motion.at(np.linspace(0.0, motion.knots[-1], INSTANTS))
        tips = np.array([self.pose(row)[:3, 3] for row in q])
        away = np.linalg.norm(tips[:, None] - corners, axis=2).min(axis=1) > NEAR
        speeds = [self.speed(*row) / SPEED for row in zip(q[away], qd[away], strict=True)]
        qdd = np.diff(motion.at(motion.knots)[1], axis=0) / np.diff(motion.knots)[:, None]
        return Judged(
            max(from_lines(tips, corners).max(), float(np.linalg.norm(tips[-1] - corners[-1]))),
            np.array(speeds),
            np.max(np.abs(qd) / self.arm.velocity),
            np.max(np.abs(qdd)) / ACCELERATION,
        )


def from_lines(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distances of points (m, 3) from the nearest of the lines between `corners`."""
    distances = []
    for start, end in pairwise(corners):
        way = end - start
        along = np.clip((points - start) @ way / (way @ way), 0.0, 1.0)
        distances.append(np.linalg.norm(points - start - along[:, None] * way, axis=1))
    return np.min(distances, axis=0)


def unit(random: np.random.Generator) -> np.ndarray:
    """Random direction."""
    vector = random.normal(size=3)
    return vector / np.linalg.norm(vector)


def draw(judge: Judge, start: np.ndarray, random: np.random.Generator) -> list[np.ndarray]:
    """Two to four poses, each 80 to 200 mm from the last, half of them turned by up to 0.3 rad."""
    poses = [judge.pose(start)]
    for _ in range(random.integers(2, 5)):
        pose = poses[-1].copy()
        pose[:3, 3] += random.uniform(0.08, 0.2) * unit(random)
        angle = random.uniform(0.0, 0.3) if random.random() < 0.5 else 0.0
        pose[:3, :3] = pin.exp3(angle * unit(random)) @ pose[:3, :3]
        poses.append(pose)
    return poses


def timed(mover: LineMover, start: np.ndarray, poses: list[np.ndarray]) -> tuple[Any | None, float]:
    """Result of a planner, and the CPU time of the call (s)."""
    times: list[float] = []
    gc.collect()
    gc.disable()
    while not times or (times[0] < REPEATED and len(times) < 3):
        begin = time.process_time()
        found = mover.plan(start, poses, SPEED)
        times.append(time.process_time() - begin)
    gc.enable()
    return found, float(np.median(times))


def measure(arm: LineArm, movers: list[LineMover], count: int) -> list[list[str]]:
    """Lines of the table for one arm."""
    judge = Judge(arm)
    kept: list[list[tuple[float, float, Judged]]] = [[] for _ in movers]
    for seed in range(count):
        random = np.random.default_rng(seed)
        start = np.array(ARMS[arm.name]) + random.uniform(-0.3, 0.3, len(arm.joints))
        poses = draw(judge, start, random)
        corners = np.array([pose[:3, 3] for pose in poses])
        for mover, rows in zip(movers, kept, strict=True):
            found, seconds = timed(mover, start, poses[1:])
            if found is not None:
                motion = mover.motion(found)
                rows.append((seconds, motion.knots[-1], judge.judge(motion, corners)))
    return [line(arm, mover, rows, count) for mover, rows in zip(movers, kept, strict=True)]


def line(arm: LineArm, mover: LineMover, rows: list[tuple[float, float, Judged]], count: int) -> list[str]:
    """Line of the table for one planner."""
    if not rows:
        return [arm.name, mover.name, f"0 of {count}", *["-"] * (len(COLUMNS) - 3)]
    seconds, durations, judged = (np.array(column) for column in zip(*rows, strict=True))
    off = 1e3 * np.array([each.off_line for each in judged])
    speeds = 100.0 * np.concatenate([each.speeds for each in judged])
    held = [*np.percentile(speeds, [50, 0, 100]), 100.0 * np.mean(np.abs(speeds - 100.0) < 1.0)]
    figures = [*(1e3 * np.percentile(seconds, [50, 95])), np.median(durations), np.median(off), off.max()]
    limits = [100.0 * max(each.velocity for each in judged), 100.0 * max(each.acceleration for each in judged)]
    return [
        *(arm.name, mover.name, f"{len(rows)} of {count}"),
        *(f"{figure:.3g}" for figure in figures),
        *(f"{figure:.4g}" if mover.takes_speed else "-" for figure in held),
        *(f"{figure:.4g}" for figure in limits),
    ]


def movers_of(arm: LineArm) -> list[LineMover]:
    """The planners, each with its settings; says which are not installed."""
    makers: list[Callable[[], LineMover]] = [
        lambda: BeetleLines(arm, 0.0),
        lambda: BeetleLines(arm, 0.005),
        lambda: RoboplanLines(arm),
        lambda: RoboplanLines(arm, max_position_error=1e-3, toppra_blend_deviation=1e-4),
        lambda: TesseractLines(arm, 0.01),
    ]
    movers = []
    for make in makers:
        try:
            movers.append(make())
        except ImportError as reason:
            print(f"left out: {reason}")
    return movers


def main() -> None:
    """Measures, prints and writes the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=Path, required=True)
    parser.add_argument("--programs", type=int, default=50)
    parser.add_argument("--out", type=Path, default=Path())
    given = parser.parse_args()
    known = json.loads((given.robots / "robots.json").read_text(encoding="utf-8"))
    lines = []
    for name in ARMS:
        about, urdf = known[name], str(given.robots / f"{name}.urdf")
        joints, _, _, _, velocity = zip(*about["joints"], strict=True)
        arm = LineArm(name, urdf, about["base"], about["tip"], list(joints), np.array(velocity), ACCELERATION)
        lines += measure(arm, movers_of(arm), given.programs)
    for each in lines:
        print("; ".join(f"{column}: {value}" for column, value in zip(COLUMNS, each, strict=True)))
    with (given.out / "moves_peers.csv").open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *lines])


if __name__ == "__main__":
    main()
