"""Reachability maps: poses a second, memory, size on disk, and agreement with a search on poses of theirs."""

import argparse
import resource
import tempfile
import time
from pathlib import Path

import numpy as np

import beetle_ik as bik


def main() -> None:
    """Prints a row for each robot."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("robots", nargs="*", default=["ur5e", "panda"])
    parser.add_argument("--voxel", type=float, default=0.025)
    parser.add_argument("--directions", type=int, default=50)
    parser.add_argument("--rolls", type=int, default=4)
    parser.add_argument("--poses", type=int, default=10_000)
    given = parser.parse_args()
    for name in given.robots:
        robot = bik.Robot.named(name)
        began = time.perf_counter()
        found = bik.reachability(robot, voxel=given.voxel, directions=given.directions, rolls=given.rolls)
        seconds = time.perf_counter() - began
        poses = found.index.size * found.orientations
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "map.npz"
            found.to_npz(file)
            size = file.stat().st_size / 1e6
        print(f"{found}")
        print(f"  {seconds:.1f} s, {poses / seconds / 1e6:.2f} million poses a second, peak {peak:.0f} MB")
        print(f"  bits {found.bits.nbytes / 1e6:.1f} MB in memory, {size:.2f} MB as npz")
        print(f"  {agreement(found, given.poses)}", flush=True)


def agreement(found: bik.ReachabilityMap, count: int) -> str:
    """Compares poses drawn from reached voxels with `solve` and its whole budget."""
    rng = np.random.default_rng(0)
    voxels = np.argwhere(found.index > 0)
    picked = voxels[rng.integers(len(voxels), size=count)].tolist()
    numbers = rng.integers(found.orientations, size=count)
    poses = np.array([found.poses((x, y, z))[k] for (x, y, z), k in zip(picked, numbers, strict=True)])
    reached = found.query(poses)
    # Explicit solvers search with all of the budget.
    searched = bik.solve_batch(found.robot, poses, solver=bik.MultiStart(bik.LevenbergMarquardt())).success
    missed, alone = int((searched & ~reached).sum()), int((reached & ~searched).sum())
    return f"of {int(reached.sum())} poses reached by the map, search misses {alone}; the map misses {missed}"


if __name__ == "__main__":
    main()
