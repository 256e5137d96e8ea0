"""Tracking among obstacles: `Tracker` beside mink, pink and placo with their barriers, on the same streams.

    python benches/track_among_obstacles.py --scenes 200 --out DIR

A Panda and an iiwa14 follow circles and jumps past boxes, with and without a sphere that crosses. Ours runs with
velocity limits alone, with acceleration limits and with jerk limits; the others solve one quadratic program a tick,
with velocity limits, on the first `--slow` scenes. Coal judges the clearance, at the ticks and between them.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import gc
import logging
import tempfile
import warnings
from dataclasses import dataclass
from pathlib import Path
from time import process_time_ns

import numpy as np
from peers import clear_streams, motion
from peers.clear_movers import MOVERS, ClearMover
from peers.clear_streams import DT, MARGIN, Judge, Scene
from peers.report import plain_section, write_table

import beetle_ik as bik

ARMS = ("panda", "iiwa14")
ON_PATH = 1e-4  # m
ROUNDING = 1e-9
COLUMNS = [
    *("arm", "library", "scenes", "ticks", "below the margin", "of these in contact", "deepest_mm", "by the sphere"),
    *("limit broken by", "no solution", "on the path", "of those without obstacles", "held", "median_us", "p99_us"),
]


@dataclass(frozen=True)
class Run:
    """Run of one mover in one scene, tick by tick."""

    clearance: np.ndarray  # the least in each tick, m
    by_sphere: np.ndarray  # whether that is to the sphere
    on_path: np.ndarray
    on_free_path: np.ndarray  # the same without obstacles
    times: np.ndarray  # us
    excess: float  # largest rate relative to its limit
    infeasible: int
    held: int


def main() -> None:
    """Measures both arms and writes the table, again after each mover: the run is long."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=200, help="scenes of each arm (default: 200)")
    parser.add_argument("--slow", type=int, default=20, help="scenes for the slow libraries (default: 20)")
    parser.add_argument("--only", nargs="*", default=[], help="names that a mover must contain one of (default: all)")
    parser.add_argument("--out", type=Path, default=Path("track_clear"), help="where the results go")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    warnings.filterwarnings("ignore")  # of libraries, about solvers and deprecated calls
    logging.disable(logging.WARNING)
    lines, notes = [], []
    wanted = [each for each in MOVERS if not arguments.only or any(name in each.name for name in arguments.only)]
    with tempfile.TemporaryDirectory() as scratch:
        for arm in ARMS:
            robot = bik.Robot.named(arm).with_capsules(radius=clear_streams.RADIUS)
            scenes = [clear_streams.scene(robot, number) for number in range(arguments.scenes)]
            for mover in wanted:
                taken = scenes[: arguments.slow] if mover.slow else scenes
                try:
                    runs = [run(mover, scene, Path(scratch), arm, notes) for scene in taken]
                except ImportError as reason:
                    notes.append(f"- {mover.name}, not measured: {reason}")
                    continue
                subsets = {len(runs), min(len(runs), arguments.slow)}  # ours on the scenes of the slow ones too
                lines += [line(arm, mover, runs[:count]) for count in sorted(subsets)]
                print(*lines[-len(subsets) :], sep="\n", flush=True)
                write(arguments.out, lines, notes)


def run(mover: type[ClearMover], scene: Scene, scratch: Path, arm: str, notes: list[str]) -> Run:
    """Runs one mover in one scene, with the obstacles and without."""
    among, free = (mover(scene, scratch, among=is_among) for is_among in (True, False))
    q, times = drive(among, scene)
    free_q, _ = drive(free, scene)
    smooth = len(mover.limits) > 1
    clearance, by_sphere = Judge(scene).clearances(q, smooth=smooth)
    from_rest = np.vstack([q[:1], q[:1], q])
    excess = max(motion.excess(from_rest, order, DT, limit) for order, limit in enumerate(mover.limits, start=1))
    outside = np.maximum(scene.robot.lower - q, q - scene.robot.upper).max()
    if not mover.slow and (clearance.min() < MARGIN - ROUNDING or excess > 1.0 + ROUNDING or outside > ROUNDING):
        notes.append(
            f"- {arm}, scene {scene.number} ({scene.kind}), {mover.name}: clearance {1e3 * clearance.min():.3g} mm "
            f"in tick {clearance.argmin()}, largest rate over its limit {excess:.10g}, outside its range {outside > 0}"
        )
    return Run(
        clearance, by_sphere, on_path(scene, q), on_path(scene, free_q), times, excess, among.infeasible, among.held
    )


def drive(mover: ClearMover, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Returns the commands of the mover (k + 1, n), and the processor time of each tick (us)."""
    q, times = [scene.start], []
    gc.collect()
    gc.disable()
    for tick, target in enumerate(scene.targets):
        begin = process_time_ns()
        q.append(mover.step(target, DT * tick))
        times.append((process_time_ns() - begin) * 1e-3)
    gc.enable()
    return np.array(q), np.array(times)


def on_path(scene: Scene, q: np.ndarray) -> np.ndarray:
    """Returns whether the tip is at its target after each tick."""
    return np.linalg.norm(scene.robot.fk(q[1:])[:, :3, 3] - scene.targets[:, :3, 3], axis=1) < ON_PATH


def line(arm: str, mover: type[ClearMover], runs: list[Run]) -> list[str]:
    """Figures of all runs of a mover."""
    clearance, by_sphere, on_path, on_free_path, times = (
        np.concatenate([getattr(each, name) for each in runs])
        for name in ("clearance", "by_sphere", "on_path", "on_free_path", "times")
    )
    below, ticks = clearance < MARGIN - 1e-6, len(clearance)
    deepest = max(0.0, 1e3 * (MARGIN - clearance.min()))
    excess = max(0.0, max(each.excess for each in runs) - 1.0)
    return [
        *(arm, mover.name, str(len(runs)), str(ticks)),
        *(str(below.sum()), str((clearance < 0.0).sum()), f"{deepest:.3g}", str((below & by_sphere).sum())),
        *(f"{excess:.2g}" if excess > ROUNDING else "-", str(sum(each.infeasible for each in runs))),
        *(f"{on_path.mean():.3f}", f"{(on_path & on_free_path).sum() / on_free_path.sum():.3f}"),
        f"{sum(each.held for each in runs) / ticks:.3f}" if not mover.slow else "-",
        *(f"{np.median(times):.3g}", f"{np.quantile(times, 0.99):.3g}"),
    ]


def write(out: Path, lines: list[list[str]], notes: list[str]) -> None:
    """Writes the table and the notes."""
    write_table(out / "track_clear.csv", COLUMNS, lines)
    text = plain_section(f"Tracking among obstacles, margin {1e3 * MARGIN:g} mm", COLUMNS, lines)
    (out / "track_clear.md").write_text("\n".join([text, *notes]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
