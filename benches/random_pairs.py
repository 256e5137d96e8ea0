"""Distances of random pairs of shapes against coal: is any of them larger than the true distance?

    python benches/random_pairs.py --pairs 1000000 --seed 0

A Panda carries a body of every convex kind past an obstacle of every convex kind, 1,000 configurations for each two.
No distance may be above coal's by more than coal's own error. Where two shapes overlap, both must say so.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import coal
import numpy as np

import beetle_ik as bik

EXACT = 1e-6  # m: what coal is exact to
POSES = 1000  # of each two shapes
LINK = "flange"
ARM = bik.Robot.named("panda")

Made = tuple[
    bik.obstacles.Obstacle, object, np.ndarray, np.ndarray
]  # the shape, coal's, and its place: (3,) and (3, 3)


@dataclass
class Outcome:
    """Pairs of two kinds of shapes, and differences of distances from coal's (m)."""

    pairs: int = 0
    overlapping: int = 0
    above: float = -np.inf
    below: float = -np.inf
    disagreeing: int = 0  # one says that they overlap, the other that they are more than EXACT apart


def main() -> None:
    """Compares the pairs and prints a line for each two kinds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=1_000_000, help="pairs in all (default: 1,000,000)")
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    outcomes = run(arguments.pairs, arguments.seed)
    for kinds, outcome in outcomes.items():
        print(
            f"{kinds}: {outcome.pairs} pairs, {outcome.overlapping} overlap; at most {outcome.above:.1e} m above and "
            f"{outcome.below:.1e} m below; {outcome.disagreeing} disagree"
        )
    largest = max(outcome.above for outcome in outcomes.values())
    print(f"{sum(outcome.pairs for outcome in outcomes.values())} pairs, at most {largest:.1e} m above coal")
    if largest > EXACT or any(outcome.disagreeing for outcome in outcomes.values()):
        raise SystemExit(1)


def run(pairs: int, seed: int) -> dict[str, Outcome]:
    """Compares at least this many pairs, and returns the outcomes by the names of the two kinds."""
    outcomes: dict[str, Outcome] = {}
    rng, kinds = np.random.default_rng(seed), list(each_two())
    for number in range(-(-pairs // POSES)):
        name, own, other = kinds[number % len(kinds)]
        compare(own(rng, 0.1, 0.15), other(rng, 0.6, 0.4), rng, outcomes.setdefault(name, Outcome()))
    return outcomes


def each_two() -> Iterator[tuple[str, Maker, Maker]]:
    """Pairs of every kind of body with every kind of obstacle."""
    for own in MAKERS:
        for other in MAKERS:
            yield f"{own.__name__} and {other.__name__}", own, other


def compare(body: Made, obstacle: Made, rng: np.random.Generator, outcome: Outcome) -> None:
    """Compares the distances of two shapes at random configurations."""
    (shape, model, center, turn), (thing, other, there, twist) = body, obstacle
    robot = ARM.with_attached(LINK, shape)
    q = robot.random_configurations(POSES, seed=int(rng.integers(2**32)))
    place, request = coal.Transform3s(twist, there), coal.DistanceRequest()
    request.gjk_tolerance = 1e-9  # the default gives errors above 1e-6
    tips = robot.fk(q, link=LINK)
    found = bik.obstacles.clearance(robot.with_collision_pairs([]), q, [thing])
    for tip, distance in zip(tips, found, strict=True):
        at = coal.Transform3s(tip[:3, :3] @ turn, tip[:3, :3] @ center + tip[:3, 3])
        exact = float(coal.distance(model, at, other, place, request, coal.DistanceResult()))
        outcome.pairs += 1
        if exact <= 0.0 or distance <= 0.0:
            outcome.overlapping += 1
            outcome.disagreeing += max(exact, distance) > EXACT
        else:
            outcome.above = max(outcome.above, distance - exact)
            outcome.below = max(outcome.below, exact - distance)


def placed(rng: np.random.Generator, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Draws a random position within `reach` (m) along each axis, and a rotation."""
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    return rng.uniform(-reach, reach, 3), turn * np.sign(np.linalg.det(turn))


def sphere(rng: np.random.Generator, reach: float, size: float) -> Made:
    """Draws a sphere."""
    (center, turn), radius = placed(rng, reach), float(rng.uniform(0.1, 0.5) * size)
    return bik.obstacles.Sphere(center, radius), coal.Sphere(radius), center, turn


def capsule(rng: np.random.Generator, reach: float, size: float) -> Made:
    """Draws a capsule along its z axis."""
    (center, turn), (radius, length) = placed(rng, reach), rng.uniform((0.05, 0.2), (0.3, 1.0)) * size
    half = turn[:, 2] * length / 2
    return bik.obstacles.Capsule(center - half, center + half, radius), coal.Capsule(radius, length), center, turn


def box(rng: np.random.Generator, reach: float, size: float) -> Made:
    """Draws a box."""
    (center, turn), edges = placed(rng, reach), rng.uniform(0.1, 1.0, 3) * size
    return bik.obstacles.Box(center, edges, turn), coal.Box(*edges), center, turn


def cylinder(rng: np.random.Generator, reach: float, size: float) -> Made:
    """Draws a cylinder along its z axis."""
    (center, turn), (radius, length) = placed(rng, reach), rng.uniform(0.1, 0.7, 2) * size
    return bik.obstacles.Cylinder(center, turn[:, 2], radius, length), coal.Cylinder(radius, length), center, turn


def ellipsoid(rng: np.random.Generator, reach: float, size: float) -> Made:
    """Draws an ellipsoid."""
    (center, turn), axes = placed(rng, reach), rng.uniform(0.1, 0.6, 3) * size
    return bik.obstacles.Ellipsoid(center, axes, turn), coal.Ellipsoid(*axes), center, turn


def hull(rng: np.random.Generator, reach: float, size: float) -> Made:
    """Draws the convex hull of 8 to 40 points."""
    (center, turn), corners = placed(rng, reach), rng.uniform(-0.6, 0.6, (rng.integers(8, 40), 3)) * size
    points = coal.StdVec_Vec3s()
    points.extend(corners)
    model = coal.Convex.convexHull(points, False, "Qt")
    return bik.obstacles.ConvexMesh(corners @ turn.T + center), model, center, turn


Maker = Callable[[np.random.Generator, float, float], Made]
MAKERS: list[Maker] = [hull, box, cylinder, ellipsoid, capsule, sphere]

if __name__ == "__main__":
    main()
