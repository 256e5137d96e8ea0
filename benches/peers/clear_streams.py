"""Random scenes for tracking among obstacles: a start, a stream of targets, boxes, and a sphere that crosses.

Coal judges the clearance: capsules of the arm against boxes, the sphere, and each other, at the ticks and between them.
"""

# ruff: noqa: D107

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import coal
import numpy as np

import beetle_ik as bik

from .live_targets import eased
from .motion import rotations

SEED = 20262
DT, TICKS = 0.01, 400  # s, and ticks of a scene
MARGIN = 0.01  # m
RADIUS = 0.05  # of the capsules along the links, m
SPEED = 0.2  # of the sphere, m/s
PERIOD = 3.0  # of a turn on a circle, s
HELD = 100  # ticks from jump to jump
APART = 0.05  # m: every obstacle begins at least so far from the arm
FROM_BASE = (
    0.35  # m: nearer to its axis are no targets, nor the sphere, which no joint could get out of the way of there
)
BETWEEN = 5  # judged steps of a tick


@dataclass(frozen=True)
class Thing:
    """Box or sphere by its pose (4, 4) at t = 0, its shape for coal, and its velocity (3,) (m/s)."""

    at: np.ndarray
    shape: coal.Box | coal.Sphere
    velocity: np.ndarray

    @property
    def moves(self) -> bool:
        """Whether the thing is in motion."""
        return bool(self.velocity.any())

    def center(self, time: float) -> np.ndarray:
        """Centre (3,) of the thing at this time (s)."""
        return self.at[:3, 3] + time * self.velocity

    def obstacle(self, time: float) -> bik.obstacles.Obstacle:
        """Converts the thing to an obstacle of this library."""
        if isinstance(self.shape, coal.Sphere):
            return bik.obstacles.Sphere(self.center(time), self.shape.radius)
        return bik.obstacles.Box(self.center(time), 2.0 * self.shape.halfSide, self.at[:3, :3])


@dataclass(frozen=True)
class Scene:
    """Robot with capsules, its start (n,), one target (4, 4) for the end of each tick, and the things around it."""

    number: int
    kind: str
    robot: bik.Robot
    start: np.ndarray
    targets: np.ndarray
    things: list[Thing]


def scene(robot: bik.Robot, number: int) -> Scene:
    """Draws the scene of this number: a circle or jumps, with or without the sphere, by turns."""
    random = np.random.default_rng([SEED, number])
    circling, crossed = number % 2 == 0, number // 2 % 2 == 1
    start, targets = next(streams(robot, random, circling=circling))
    things = list(boxes(robot, start, targets, random))
    if crossed:
        things.append(next(spheres(robot, start, targets, random)))
    kind = f"{'circle' if circling else 'jumps'}, {'sphere' if crossed else 'boxes alone'}"
    return Scene(number, kind, robot, start, targets, things)


def streams(
    robot: bik.Robot, random: np.random.Generator, *, circling: bool
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Starts and targets that can be reached without obstacles."""
    middle, half = (robot.lower + robot.upper) / 2.0, (robot.upper - robot.lower) / 2.0
    while True:
        start = middle + 0.6 * half * random.uniform(-1.0, 1.0, robot.dof)
        if bik.obstacles.clearance(robot, start) < APART or robot.manipulability(start) < 0.03:
            continue
        if circling:
            targets = circle(robot.fk(start), random)
            free = bik.Tracker(robot, start, dt=DT, limits=bik.Limits(velocity=1.0))
            reached = all(free.step(target).success for target in targets)
        else:
            goals = start + random.uniform(-0.6, 0.6, (TICKS // HELD, robot.dof))
            targets = np.repeat(robot.fk(goals), HELD, axis=0)
            reached = bool((np.abs(goals - middle) < 0.9 * half).all())
        if reached and np.linalg.norm(targets[:, :2, 3], axis=1).min() > FROM_BASE:
            yield start, targets


def circle(first: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Poses (k, 4, 4) on a circle in a random plane, from rest at `first`, with constant orientation."""
    along, across = np.linalg.qr(random.standard_normal((3, 2)))[0].T
    angle = 2.0 * np.pi / PERIOD * eased(DT * np.arange(1, TICKS + 1), 1.0)
    path = np.tile(first, (TICKS, 1, 1))
    path[:, :3, 3] += random.uniform(0.08, 0.18) * (
        (1.0 - np.cos(angle))[:, None] * along + np.sin(angle)[:, None] * across
    )
    return path


def boxes(robot: bik.Robot, start: np.ndarray, targets: np.ndarray, random: np.random.Generator) -> Iterator[Thing]:
    """Yields six boxes in random orientations near the targets, clear of the start."""
    count = 0
    while count < 6:
        at = np.eye(4)
        at[:3, :3] = rotations(random.standard_normal((1, 3)))[0]
        at[:3, 3] = targets[random.integers(len(targets)), :3, 3] + 0.25 * random.uniform(-1.0, 1.0, 3)
        box = Thing(at, coal.Box(*random.uniform(0.04, 0.25, 3)), np.zeros(3))
        if bik.obstacles.clearance(robot, start, [box.obstacle(0.0)]) > APART:
            yield box
            count += 1


def spheres(robot: bik.Robot, start: np.ndarray, targets: np.ndarray, random: np.random.Generator) -> Iterator[Thing]:
    """Yields spheres that are near the target at half the time, and never near the base."""
    half = DT * TICKS / 2.0
    while True:
        velocity = random.standard_normal(3)
        velocity *= SPEED / np.linalg.norm(velocity)
        at = np.eye(4)
        at[:3, 3] = targets[TICKS // 2, :3, 3] + 0.15 * random.uniform(-1.0, 1.0, 3) - half * velocity
        sphere = Thing(at, coal.Sphere(random.uniform(0.04, 0.1)), velocity)
        centers = np.array([sphere.center(time) for time in np.linspace(0.0, 2.0 * half, 50)])
        from_base = np.linalg.norm(centers[:, :2], axis=1).min()
        if from_base > FROM_BASE and bik.obstacles.clearance(robot, start, [sphere.obstacle(0.0)]) > APART:
            yield sphere


class Judge:
    """Distances of an arm in a scene by coal."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        robot, names = scene.robot, list(scene.robot.all_link_names)
        self.links = [names.index(link) for link, *_ in robot.capsules]
        self.local = np.array([pose_of_capsule(a, b) for _, a, b, _ in robot.capsules])
        self.capsules = [coal.Capsule(radius, float(np.linalg.norm(b - a))) for _, a, b, radius in robot.capsules]
        apart = {frozenset(pair) for pair in robot.collision_pairs}
        links, count = [link for link, *_ in robot.capsules], len(self.capsules)
        self.shapes = [*self.capsules, *(thing.shape for thing in scene.things)]
        self.reach = np.array([bounding_radius(shape) for shape in self.shapes])
        self.pairs = [(i, j) for j in range(count) for i in range(j) if frozenset((links[i], links[j])) in apart] + [
            (i, j) for i in range(count) for j in range(count, len(self.shapes))
        ]
        self.request = coal.DistanceRequest()
        self.request.gjk_tolerance = 1e-9

    def clearance(self, q: np.ndarray, time: float) -> tuple[float, bool]:
        """Smallest distance, and whether it is to the sphere."""
        poses = list(self.scene.robot.all_link_poses(q)[self.links] @ self.local)
        for thing in self.scene.things:
            at = thing.at.copy()
            at[:3, 3] = thing.center(time)
            poses.append(at)
        places = [coal.Transform3s(at[:3, :3], at[:3, 3]) for at in poses]
        first, second = np.transpose(self.pairs)
        centers = np.array(poses)[:, :3, 3]
        bounds = np.linalg.norm(centers[first] - centers[second], axis=1) - self.reach[first] - self.reach[second]
        least, with_sphere = np.inf, False
        for k in np.argsort(bounds):
            if bounds[k] >= least:
                break
            i, j = self.pairs[k]
            shapes = (self.shapes[i], places[i], self.shapes[j], places[j])
            found = float(coal.distance(*shapes, self.request, coal.DistanceResult()))
            if found < least:
                least, with_sphere = found, isinstance(self.shapes[j], coal.Sphere)
        return least, with_sphere

    def clearances(self, q: np.ndarray, *, smooth: bool) -> tuple[np.ndarray, np.ndarray]:
        """Smallest distance in each tick of `q` (k + 1, n), and whether it is to the sphere.

        The arm moves straight between its commands, or along their cubic B-spline if `smooth`.
        """
        found = []
        for tick in range(len(q) - 1):
            near = [self.clearance(point, DT * (tick + s)) for s, point in between(q, tick, smooth=smooth)]
            found.append(min(near))
        least, with_sphere = zip(*found, strict=True)
        return np.array(least), np.array(with_sphere)


def between(q: np.ndarray, tick: int, *, smooth: bool) -> Iterator[tuple[float, np.ndarray]]:
    """Yields configurations between two rows of `q` and their fractions of the tick, the end included."""
    rows = np.clip(np.arange(tick - 1, tick + 3), 0, len(q) - 1)
    before, here, there, after = q[rows]
    for s in np.arange(1, BETWEEN + 1) / BETWEEN:
        if smooth:
            weights = np.array([(1 - s) ** 3, 3 * s**3 - 6 * s**2 + 4, -3 * s**3 + 3 * s**2 + 3 * s + 1, s**3]) / 6
            yield s, weights @ (before, here, there, after)
        else:
            yield s, here + s * (there - here)


def pose_of_capsule(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Pose (4, 4) of a capsule from `a` to `b`, along its z axis."""
    z = (b - a) / np.linalg.norm(b - a)
    x = np.cross(np.eye(3)[np.argmin(np.abs(z))], z)
    x /= np.linalg.norm(x)
    at = np.eye(4)
    at[:3] = np.column_stack([x, np.cross(z, x), z, (a + b) / 2.0])
    return at


def bounding_radius(shape: coal.Box | coal.Sphere | coal.Capsule) -> float:
    """Radius of a sphere about the centre of the shape that contains it."""
    if isinstance(shape, coal.Box):
        return float(np.linalg.norm(shape.halfSide))
    return float(shape.radius) + (shape.halfLength if isinstance(shape, coal.Capsule) else 0.0)
