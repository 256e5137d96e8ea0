"""Whole poses for arms with four and five joints: `solve`, which meets the position first, beside soft weights.

    python benches/position_first.py --poses 100 --out DIR

The arms (`peers/few_joints.py`) get poses of their own, turned by a random rotation of about a third of a radian. All
libraries begin at the configuration that has the pose before the turn, as when a hand is led, and take all poses in a
row, three times in turn; Pinocchio judges the answers. With `--descents 200` so many descents of scipy for each pose
find the least rotation error, which takes hours. It writes `position_first.csv`, which the site shows. A library that
is not installed is named with the reason.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import csv
import time
from pathlib import Path

import numpy as np
import pinocchio as pin
from peers.adapter import load
from peers.chain import SEED, Chain
from peers.few_joints import PositionFirst, WeightedClik, WeightedMink, WeightedPlaco, arms

LIBRARIES = [PositionFirst, WeightedPlaco, WeightedMink, WeightedClik]
ROUNDS = 3
TURN = 0.2  # standard deviation of each component of the rotation vector (rad)
HEADER = ["arm", "library", "time [us]", "position error, median [mm]", "worst [mm]", "rotation error, median [rad]"]
SHARE = "within 1e-3 rad of the least"


def main() -> None:
    """Measures all arms and writes the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--poses", type=int, default=100, help="poses of each arm (default: 100)")
    parser.add_argument("--descents", type=int, default=0, help="descents of scipy for each pose (default: none)")
    parser.add_argument("--out", type=Path, default=Path())
    arguments = parser.parse_args()
    lines, missing = [], {}
    for chain in arms():
        libraries, absent = load(LIBRARIES, chain, 1e-6)
        missing |= absent
        lines += measured(chain, libraries, arguments.poses, arguments.descents)
    arguments.out.mkdir(parents=True, exist_ok=True)
    with (arguments.out / "position_first.csv").open("w", newline="") as file:
        csv.writer(file).writerows([HEADER + [SHARE] * (arguments.descents > 0), *lines])
    print(*(f"{library.name}: {library.settings}" for library in LIBRARIES if library.name not in missing), sep="\n")
    print(*(f"{name} is not measured: {reason}" for name, reason in missing.items()), sep="\n")


def measured(chain: Chain, libraries: list, count: int, descents: int) -> list[list[str]]:
    """Rows of the table for one arm."""
    random = np.random.default_rng(SEED)
    starts = random.uniform(chain.lower, chain.upper, (count, chain.dof))
    poses = [chain.pose(q) for q in starts]
    for pose in poses:
        pose[:3, :3] = pin.exp3(random.normal(0.0, TURN, 3)) @ pose[:3, :3]
    times, errors = {library: [] for library in libraries}, {library: [] for library in libraries}
    for library in ROUNDS * libraries:
        errors[library].clear()
        for pose, start in zip(poses, starts, strict=True):
            begin = time.perf_counter()
            q = library.solve_pose(pose, start)
            times[library].append(1e6 * (time.perf_counter() - begin))
            errors[library].append(error(chain, start if q is None else q, pose))
    least = np.array([least_turn(chain, pose, descents, k) for k, pose in enumerate(poses)]) if descents else None
    rows = []
    for library in libraries:
        away, turn = np.array(errors[library]).T
        row = [chain.name, library.name, f"{np.median(times[library]):.3g}", f"{1e3 * np.median(away):.2g}"]
        row += [f"{1e3 * away.max():.2g}", f"{np.median(turn):.3g}"]
        if least is not None:
            row.append(f"{np.sum((turn <= least + 1e-3) & (away < 1e-6))} of {count}")
        rows.append(row)
        print(*row, sep=", ", flush=True)
    return rows


def error(chain: Chain, q: np.ndarray, pose: np.ndarray) -> tuple[float, float]:
    """Distance (m) and angle (rad) between the tip and a pose; infinite outside the limits."""
    if ((q < chain.lower - 1e-9) | (q > chain.upper + 1e-9)).any():
        return np.inf, np.inf
    tip = chain.pose(q)
    return np.linalg.norm(tip[:3, 3] - pose[:3, 3]), np.linalg.norm(pin.log3(tip[:3, :3].T @ pose[:3, :3]))


def least_turn(chain: Chain, pose: np.ndarray, descents: int, seed: int) -> float:
    """Least angle (rad) at the position that descents with growing weights find; infinite if none arrives there."""
    from scipy.optimize import least_squares

    model, data, frame = chain.model, chain.model.createData(), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED

    def residual(q: np.ndarray, weight: float) -> np.ndarray:
        pin.framesForwardKinematics(model, data, q)
        tip = data.oMf[chain.tip_frame]
        turn = pin.log3(tip.rotation @ pose[:3, :3].T)
        return np.concatenate((weight * (tip.translation - pose[:3, 3]), turn))

    def slope(q: np.ndarray, weight: float) -> np.ndarray:
        jacobian = pin.computeFrameJacobian(model, data, q, chain.tip_frame, frame)
        turn = data.oMf[chain.tip_frame].rotation @ pose[:3, :3].T
        # The derivative of log3(exp(w) R) by w, which acts from the left.
        jacobian[3:] = pin.Jlog3(turn) @ turn.T @ jacobian[3:]
        jacobian[:3] *= weight
        return jacobian

    random, least = np.random.default_rng(seed), np.inf
    for _ in range(descents):
        q = random.uniform(chain.lower, chain.upper)
        for weight in (10.0, 300.0, 1e4, 3e5):
            inside = np.clip(q, chain.lower + 1e-9, chain.upper - 1e-9)
            bounds = (chain.lower, chain.upper)
            q = least_squares(residual, inside, slope, bounds=bounds, args=(weight,), max_nfev=60).x
            if weight == 300.0 and error(chain, q, pose)[0] > 1e-2:
                break
        away, turn = error(chain, q, pose)
        least = min(least, turn) if away < 1e-6 else least
    return least


if __name__ == "__main__":
    main()
