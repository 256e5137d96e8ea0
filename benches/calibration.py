"""Calibration of random arms against the Cramér-Rao bound, with and without gross errors; times.

    python benches/calibration.py --arms 100 --out docs

writes `calibration.csv`: for each robot the error on new poses over the bound.
"""

import argparse
import csv
import statistics
import time
from pathlib import Path

import numpy as np
from peers.calibration_judge import Arm, Array, bound, built, rank, transform

import beetle_ik as bik

LENGTH, ANGLE, SIGMA, POSES, NEW = 1e-3, np.radians(0.5), 1e-4, 40, 200
ROBOTS = ("panda", "iiwa14", "ur5e", "ur10e")


def model_of(name: str) -> bik.Robot:
    """A model whose measured point is beside the last axis."""
    return bik.Robot.named(name).with_tool(transform(np.array([0.06, 0.03, 0.1]), np.zeros(3)))


def error(robot: bik.Robot, truth: bik.Robot, q: Array) -> float:
    """Root mean square of position errors."""
    apart = robot.fk(q)[:, :3, 3] - truth.fk(q)[:, :3, 3]
    return float(np.sqrt((apart**2).sum(1).mean()))


def one_arm(name: str, seed: int) -> dict[str, float]:
    """Calibrates one random arm, without and with 5 % gross errors."""
    rng = np.random.default_rng([46, seed])
    model = model_of(name)
    truth = built(model, rng, LENGTH, ANGLE)
    q, new = (model.random_configurations(count, seed=2 * seed + k) for k, count in enumerate((POSES, NEW)))
    measured = truth.fk(q)[:, :3, 3] + rng.normal(0, SIGMA, (POSES, 3))
    began = time.process_time()
    found = bik.calibrate(model, q, measured)
    took = time.process_time() - began
    wrong = rng.choice(POSES, POSES // 20, replace=False)
    gross = measured.copy()
    gross[wrong] += rng.normal(size=(len(wrong), 3)) * rng.uniform(0.005, 0.5, (len(wrong), 1))
    rough = bik.calibrate(model, q, gross)
    arm = Arm(truth)
    after = error(found.robot, truth, new)
    return {
        "before": error(model, truth, new),
        "after": after,
        "over_bound": after / bound(arm, q, new, SIGMA),
        "rank_agrees": float(found.identifiable.rank == rank(arm.jacobian(q, rotations=False))),
        "held_out": found.rms_held_out,
        "outliers_named": float(set(wrong.tolist()) <= set(rough.outliers)),
        "falsely_named": float(len(set(rough.outliers) - set(wrong.tolist())) + len(found.outliers)),
        "with_outliers_over_without": error(rough.robot, truth, new) / after,
        "processor_ms": 1e3 * took,
    }


def main() -> None:
    """Runs all arms and writes the table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--arms", type=int, default=100)
    options.add_argument("--out", type=Path, default=Path())
    given = options.parse_args()
    runs = {name: [one_arm(name, seed) for seed in range(i, given.arms, len(ROBOTS))] for i, name in enumerate(ROBOTS)}
    with (given.out / "calibration.csv").open("w", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(HEADER)
        every = [row for robot in runs.values() for row in robot]
        for name, rows in [*runs.items(), ("all", every)]:
            writer.writerow([name, *summary(rows)])
            print(name, dict(zip(HEADER[1:], summary(rows), strict=True)))


HEADER = (
    "robot",
    "arms",
    "before [mm]",
    "after [mm]",
    "over the bound, median",
    "over the bound, worst",
    "worse than before",
    "rank agrees",
    "gross errors named",
    "others named",
    "with gross errors, over without (median)",
    "with gross errors, over without (worst)",
    "processor time [ms]",
)


def summary(rows: list[dict[str, float]]) -> list[str]:
    """Returns one line of the table."""

    def of(key: str) -> list[float]:
        return [row[key] for row in rows]

    return [
        str(len(rows)),
        f"{1e3 * statistics.median(of('before')):.2f}",
        f"{1e3 * statistics.median(of('after')):.3f}",
        f"{statistics.median(of('over_bound')):.2f}",
        f"{max(of('over_bound')):.2f}",
        str(sum(row["after"] > row["before"] for row in rows)),
        f"{sum(of('rank_agrees')):.0f}",
        f"{sum(of('outliers_named')):.0f}",
        f"{sum(of('falsely_named')):.0f}",
        f"{statistics.median(of('with_outliers_over_without')):.2f}",
        f"{max(of('with_outliers_over_without')):.2f}",
        f"{statistics.median(of('processor_ms')):.1f}",
    ]


if __name__ == "__main__":
    main()
