"""Random scenes for plans from point to point, and their judge: coal, on dense samples.

Boxes, spheres, cylinders, capsules and half-spaces are around an arm with capsules, most of them between its two ends.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

import coal
import numpy as np

import beetle_ik as bik

from .clear_streams import pose_of_capsule
from .sphere_judge import Motion, dense, rates

SEED = 20263
ARMS = {
    name: bik.Robot.named(name).with_capsules(radius=radius)
    for name, radius in (("panda", 0.05), ("ur5e", 0.04), ("iiwa14", 0.06))
}
MARGINS = (None, 0.0, 0.01)
DEFAULT_MARGIN = 1e-3  # m
BESIDE = (0.0005, 0.005, 0.05)  # m beyond the margin: no obstacle begins nearer to the ends
TOLERANCE = 1e-6  # m: what coal is exact to
AT_END = 1e-7  # rad
AT_POSE = 2e-6  # m: the tolerance of `solve`, in both directions
RATE = 1e-6  # of a limit
ACCELERATION = 5.0  # rad/s^2

Thing = tuple[bik.obstacles.Obstacle, object, coal.Transform3s]  # ours, coal's, and its place


@dataclass(frozen=True)
class Scene:
    """Scene with two ends and obstacles; `to_pose`: only the pose of the end is given."""

    number: int
    robot: bik.Robot
    start: np.ndarray
    end: np.ndarray
    to_pose: bool
    margin: float | None
    things: list[Thing]

    @property
    def kept(self) -> float:
        """Margin (m)."""
        return DEFAULT_MARGIN if self.margin is None else self.margin

    def plan(self, stop: bik.Stop | None = None) -> bik.Plan:
        """Plans from start to end; with a budget the plan is improved until it is spent."""
        end = {"end": self.robot.fk(self.end)} if self.to_pose else {"end_q": self.end}
        return bik.plan_point_to_point(
            self.robot,
            start_q=self.start,
            **end,
            limits=bik.Limits(acceleration=ACCELERATION),
            obstacles=[thing for thing, *_ in self.things],
            margin=self.margin,
            stop=stop,
        )


def scene(number: int) -> Scene:
    """Draws the scene of this number."""
    random = np.random.default_rng([SEED, number])
    robot = list(ARMS.values())[number % len(ARMS)]
    margin = MARGINS[number // len(ARMS) % len(MARGINS)]
    kept = DEFAULT_MARGIN if margin is None else margin
    ends = np.array([next(clear_configurations(robot, kept + BESIDE[0], random)) for _ in range(2)])
    beside = kept + float(random.choice(BESIDE))
    count, things = int(random.integers(2, 9)), []
    while len(things) < count:
        thing = MAKERS[random.integers(len(MAKERS))](between(robot, ends, random), random)
        if bik.obstacles.clearance(robot.with_collision_pairs([]), ends, [thing[0]]).min() > beside:
            things.append(thing)
    return Scene(number, robot, *ends, bool(random.random() < 0.3), margin, things)


def clear_configurations(robot: bik.Robot, beside: float, random: np.random.Generator) -> Iterator[np.ndarray]:
    """Yields configurations at which the links are apart."""
    while True:
        q = random.uniform(robot.lower, robot.upper)
        if bik.obstacles.clearance(robot, q) > beside:
            yield q


def between(robot: bik.Robot, ends: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Draws a position near a link on the straight motion between the ends."""
    q = ends[0] + random.uniform() * (ends[1] - ends[0])
    near = robot.link_poses(q)[random.integers(2, robot.dof + 1), :3, 3]
    return near + random.normal(0.0, 0.12, 3)


def box(center: np.ndarray, random: np.random.Generator) -> Thing:
    """Draws a box."""
    turn, edges = turned(random), random.uniform(0.03, 0.5, 3)
    return bik.obstacles.Box(center, edges, turn), coal.Box(*edges), coal.Transform3s(turn, center)


def sphere(center: np.ndarray, random: np.random.Generator) -> Thing:
    """Draws a sphere."""
    radius = float(random.uniform(0.02, 0.2))
    return bik.obstacles.Sphere(center, radius), coal.Sphere(radius), coal.Transform3s(np.eye(3), center)


def cylinder(center: np.ndarray, random: np.random.Generator) -> Thing:
    """Draws a cylinder along its z axis."""
    turn, radius, length = turned(random), float(random.uniform(0.02, 0.15)), float(random.uniform(0.05, 0.8))
    place = coal.Transform3s(turn, center)
    return bik.obstacles.Cylinder(center, turn[:, 2], radius, length), coal.Cylinder(radius, length), place


def capsule(center: np.ndarray, random: np.random.Generator) -> Thing:
    """Draws a capsule along its z axis."""
    turn, radius, length = turned(random), float(random.uniform(0.02, 0.12)), float(random.uniform(0.05, 0.8))
    half, place = 0.5 * length * turn[:, 2], coal.Transform3s(turn, center)
    return bik.obstacles.Capsule(center - half, center + half, radius), coal.Capsule(radius, length), place


def half_space(center: np.ndarray, random: np.random.Generator) -> Thing:
    """Draws a half-space that ends at `center`."""
    normal = turned(random)[:, 2]
    offset = float(normal @ center)
    return bik.obstacles.HalfSpace(normal, offset), coal.Halfspace(normal, offset), coal.Transform3s.Identity()


def turned(random: np.random.Generator) -> np.ndarray:
    """Draws a random rotation (3, 3)."""
    turn, _ = np.linalg.qr(random.standard_normal((3, 3)))
    return turn * np.sign(np.linalg.det(turn))


MAKERS: list[Callable[[np.ndarray, np.random.Generator], Thing]] = [box, sphere, cylinder, capsule, half_space]


def judge(scene: Scene, trajectory: bik.Trajectory) -> list[str]:
    """Returns the faults of a motion that was reported as clear; empty if there are none."""
    robot, wrong = scene.robot, []
    motion = Motion(lambda times: trajectory.at(times)[0], trajectory.duration, spacing=1e-3)
    q, ends = dense(lambda q: capsule_ends(robot, q), motion)
    least = least_distance(scene, q, ends)
    if least < scene.kept - TOLERANCE:
        wrong.append(f"clearance {1e3 * least:.6g} mm of {1e3 * scene.kept:g} mm")
    if np.abs(q[0] - scene.start).max() > AT_END or not at_end(scene, q[-1]):
        wrong.append(f"from {q[0]} to {q[-1]}, not from {scene.start} to {scene.end}")
    outside = np.maximum(robot.lower - q, q - robot.upper).max()
    if outside > AT_END:
        wrong.append(f"a joint is {outside:.2g} rad outside its range")
    speed, rise = rates(motion)
    excess = max((speed / robot.velocity_limit).max(), (rise / ACCELERATION).max())
    if excess > 1.0 + RATE:
        wrong.append(f"{excess:.6g} of a limit")
    return wrong


def at_end(scene: Scene, q: np.ndarray) -> bool:
    """Whether the last configuration (n,) is the end, or has its pose."""
    if not scene.to_pose:
        return bool(np.abs(q - scene.end).max() <= AT_END)
    return bool(np.abs(scene.robot.fk(q) - scene.robot.fk(scene.end)).max() <= AT_POSE)


def capsule_ends(robot: bik.Robot, q: np.ndarray) -> np.ndarray:
    """Both ends of each capsule (m, 2 k, 3) at configurations (m, n)."""
    poses = poses_of_links(robot, q)
    return np.stack(
        [poses[link][:, :3, :3] @ end + poses[link][:, :3, 3] for link, a, b, _ in robot.capsules for end in (a, b)],
        axis=1,
    )


def poses_of_links(robot: bik.Robot, q: np.ndarray) -> dict[str, np.ndarray]:
    """Poses (m, 4, 4) of the links with capsules at configurations (m, n)."""
    return {link: robot.fk(q, link=link) for link in {link for link, *_ in robot.capsules}}


def least_distance(scene: Scene, q: np.ndarray, ends: np.ndarray) -> float:
    """Smallest distance on samples (m, n) if it is below the margin; otherwise one above it."""
    capsules, request = scene.robot.capsules, coal.DistanceRequest()
    request.gjk_tolerance = 1e-9
    bodies = [coal.Capsule(radius, float(np.linalg.norm(b - a))) for _, a, b, radius in capsules]
    poses = poses_of_links(scene.robot, q)
    places = [poses[link] @ pose_of_capsule(a, b) for link, a, b, _ in capsules]
    moved = np.linalg.norm(np.diff(ends, axis=0), axis=2)
    moved = np.maximum(moved[:, ::2], moved[:, 1::2])  # no point of a capsule moves farther than both ends
    apart = {frozenset(pair) for pair in scene.robot.collision_pairs}

    def place(i: int, sample: int) -> coal.Transform3s:
        return coal.Transform3s(places[i][sample, :3, :3], places[i][sample, :3, 3])

    def distance(i: int, sample: int, other: object, at: coal.Transform3s) -> float:
        return float(coal.distance(bodies[i], place(i, sample), other, at, request, coal.DistanceResult()))

    least = np.inf
    for i, (link, *_) in enumerate(capsules):
        for _, thing, at in scene.things:
            found = least_along(lambda k, i=i, t=thing, at=at: distance(i, k, t, at), moved[:, i], scene.kept)
            least = min(least, found)
        for j in range(i):
            if frozenset((link, capsules[j][0])) in apart:
                found = least_along(
                    lambda k, i=i, j=j: distance(i, k, bodies[j], place(j, k)), moved[:, i] + moved[:, j], scene.kept
                )
                least = min(least, found)
    return least


def least_along(distance: Callable[[int], float], moved: np.ndarray, enough: float) -> float:
    """Smallest distance of two bodies on the samples where it is below `enough`.

    A distance changes by no more than the bodies move: samples on which it cannot be below `enough` are left out.
    """
    way, sample, least = np.concatenate([[0.0], np.cumsum(moved)]), 0, np.inf
    while sample < len(way):
        found = distance(sample)
        least = min(least, found)
        sample = max(sample + 1, int(np.searchsorted(way, way[sample] + found - enough)))
    return least


@dataclass
class Outcome:
    """Outcome of many scenes."""

    scenes: int = 0
    solved: int = 0
    wrong: list[str] = field(default_factory=list)  # called clear, and not


def run(numbers: Iterable[int], stop: bik.Stop | None = None) -> Outcome:
    """Plans in the scenes of these numbers and judges every plan that is reported as solved."""
    outcome = Outcome()
    for number in numbers:
        each = scene(number)
        plan = each.plan(stop)
        outcome.scenes += 1
        if plan.success:
            outcome.solved += 1
            outcome.wrong += [f"scene {number}: {wrong}" for wrong in judge(each, plan.trajectory)]
    return outcome
