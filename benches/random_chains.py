"""Random arms of six joints: does `solve_all` miss solutions that random descents find?

    python benches/random_chains.py --arms 50 --poses 20 --descents 200 --seed 0

Each kind of geometry gets as many arms: any Denavit-Hartenberg parameters, a spherical wrist, three parallel axes, and
those two with every parameter off by up to 1e-6, 1e-4 and 1e-2. Poses are those of random configurations inside random
limits. A solution counts if a descent ends on it; it is missing if it is not in the set. Solutions beside a singularity
are counted apart. Arms that cannot move their tip in all directions are drawn again.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

import beetle_ik as bik

TURN = 2.0 * np.pi
SAME = 1e-5  # rad: solutions nearer than this are one
REACHED = 1e-6  # m and entries of the rotation
DESCENDED = 1e-10  # m and rad
SINGULAR = 1e-7  # smallest singular value of the Jacobian (m and rad) below which a solution is counted apart
ALIVE = 1e-3  # median of it over random configurations of an arm that is worth trying
TWISTS = np.array([-0.5, 0.0, 0.5]) * np.pi

Table = tuple[np.ndarray, np.ndarray, np.ndarray]  # a (m), alpha (rad), d (m), each (6,)


@dataclass
class Count:
    """Counts over the arms of one kind."""

    poses: int = 0
    complete: int = 0
    solutions: int = 0
    wrong: int = 0
    found_again: int = 0
    missing: int = 0
    missing_though_complete: int = 0
    singular: int = 0


def anything(random: np.random.Generator) -> Table:
    """Draws all parameters; a third of the twists are right angles or none, a third of the lengths are zero."""
    alpha = np.where(random.random(6) < 1 / 3, random.choice(TWISTS, 6), random.uniform(-np.pi, np.pi, 6))
    a, d = (np.where(random.random(6) < 1 / 3, 0.0, random.uniform(-0.5, 0.5, 6)) for _ in range(2))
    return a, alpha, d


def spherical_wrist(random: np.random.Generator) -> Table:
    """Draws an arm whose last three axes meet."""
    a, alpha, d = anything(random)
    a[3:5], d[4] = 0.0, 0.0
    alpha[3:5] = random.choice([-1.0, 1.0], 2) * random.uniform(0.3, 0.5 * np.pi, 2)
    return a, alpha, d


def three_parallel(random: np.random.Generator) -> Table:
    """Draws an arm whose axes 2 to 4 are parallel."""
    a, alpha, d = anything(random)
    alpha[1:3] = 0.0
    a[1:3] = random.uniform(0.2, 0.5, 2)
    alpha[[0, 3, 4]] = random.choice([-1.0, 1.0], 3) * random.uniform(0.3, 0.5 * np.pi, 3)
    return a, alpha, d


def shaken(kind: Callable[[np.random.Generator], Table], by: float) -> Callable[[np.random.Generator], Table]:
    """Returns `kind` with every parameter off by up to `by` (m, rad)."""
    return lambda random: tuple(values + random.uniform(-by, by, 6) for values in kind(random))


KINDS = {
    "any": anything,
    "spherical wrist": spherical_wrist,
    "three parallel": three_parallel,
    **{f"spherical wrist, off by {by:g}": shaken(spherical_wrist, by) for by in (1e-6, 1e-4, 1e-2)},
    **{f"three parallel, off by {by:g}": shaken(three_parallel, by) for by in (1e-6, 1e-4, 1e-2)},
}


def arm(kind: str, random: np.random.Generator) -> bik.Robot:
    """Draws an arm that moves its tip in all directions, and its limits, some of them wider than a turn."""
    while True:
        a, alpha, d = KINDS[kind](random)
        lower, upper = random.uniform(-6.0, -1.0, 6), random.uniform(1.0, 6.0, 6)
        robot = bik.Robot.from_dh(a=a, alpha=alpha, d=d, convention="standard", lower=lower, upper=upper)
        if np.median([smallest(robot, q) for q in random.uniform(lower, upper, (15, 6))]) > ALIVE:
            return robot


def apart(some: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Largest difference of joints between each of `some` (j, n) and of `others` (k, n), whole turns aside: (j, k)."""
    difference = some[:, None, :] - others[None, :, :]
    return np.abs(difference - TURN * np.round(difference / TURN)).max(axis=2, initial=0.0)


def distinct(solutions: np.ndarray) -> np.ndarray:
    """Returns the solutions without repetitions."""
    near = np.triu(apart(solutions, solutions) < SAME, 1)
    return solutions[~near.any(axis=0)]


def descended(robot: bik.Robot, pose: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """Returns the distinct solutions (k, 6) of descents from random starts."""
    starts = random.uniform(robot.lower, robot.upper, (count, robot.dof))
    ended = bik.solve_batch(
        robot,
        np.repeat(pose[None], count, axis=0),
        start_q=starts,
        solver=bik.LevenbergMarquardt(),
        position_tolerance=DESCENDED,
        rotation_tolerance=DESCENDED,
    )
    return distinct(ended.q[ended.success])


def judge(robot: bik.Robot, pose: np.ndarray, found: bik.SolutionSet, known: np.ndarray, count: Count) -> None:
    """Compares the solutions of a pose with those known."""
    inside = ((found.q >= robot.lower) & (found.q <= robot.upper)).all(axis=1)
    off = np.abs(robot.fk(found.q) - pose).max(axis=(1, 2), initial=0.0)
    count.poses += 1
    count.complete += found.complete
    count.solutions += len(found.q)
    count.wrong += int((~inside | (off > REACHED)).sum()) + len(found.q) - len(distinct(found.q))
    for q in known:
        # Near a singularity, a small error of the pose is a much larger one in the joints.
        conditioned = smallest(robot, q)
        same = max(SAME, 4.0 * DESCENDED / conditioned)
        if (apart(q[None], found.q) < same).any():
            count.found_again += 1
        elif conditioned < SINGULAR or found.singular:
            count.singular += 1
        else:
            count.missing += 1
            count.missing_though_complete += found.complete


def smallest(robot: bik.Robot, q: np.ndarray) -> float:
    """Returns the smallest singular value of the Jacobian (m and rad)."""
    return float(np.linalg.svd(robot.jacobian(q), compute_uv=False)[-1])


def main() -> None:
    """Tries all kinds and prints a row each."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arms", type=int, default=50, help="arms of each kind (default: 50)")
    parser.add_argument("--poses", type=int, default=20, help="poses of each arm (default: 20)")
    parser.add_argument("--descents", type=int, default=200, help="random descents a pose (default: 200)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the arms, the poses and the starts (default: 0)")
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS), help="(default: all)")
    arguments = parser.parse_args()
    print(f"{'kind':32}" + "".join(f"{name.replace('_', ' '):>25}" for name in Count.__dataclass_fields__))
    for kind in arguments.kinds:
        count = tried(kind, arguments.arms, arguments.poses, arguments.descents, arguments.seed)
        print(f"{kind:32}" + "".join(f"{value:25}" for value in vars(count).values()), flush=True)


def tried(kind: str, arms: int, poses: int, descents: int, seed: int) -> Count:
    """Compares `poses` poses of each of `arms` arms with `descents` descents a pose."""
    random, count = np.random.default_rng([seed, list(KINDS).index(kind)]), Count()
    for _ in range(arms):
        robot = arm(kind, random)
        for q in random.uniform(robot.lower, robot.upper, (poses, robot.dof)):
            pose = robot.fk(q)
            known = np.vstack([q[None], descended(robot, pose, descents, random)])
            judge(robot, pose, bik.solve_all(robot, pose), distinct(known), count)
    return count


if __name__ == "__main__":
    main()
