"""Robots and scenes of MotionBenchMaker, judged by coal; rejection over solutions of other libraries."""

# ruff: noqa: D107

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import beetle_ik as bik

from . import closed_form
from .adapter import Adapter, load
from .chain import Chain, cut

ARMS = {"panda": "panda_hand", "ur5": "robotiq_85_base_link"}
# Pairs that overlap always, though the SRDF does not list them (README of the data).
ALWAYS_TOUCH = {frozenset(("wrist_2_link", "fts_robotside"))}
SAMPLES = (16, 128, 1024)  # values of the redundant joint that rejection tries

Reject = Callable[[np.ndarray, "CoalScene"], "np.ndarray | None"]


class MotionBenchArm:
    """Arm of the set: the spheres that decide what is valid, and its problems."""

    def __init__(self, data: Path, name: str) -> None:
        folder = data / "robots" / name
        self.name, self.data = name, data
        self.urdf = folder / f"{name}_spherized.urdf"
        robot = bik.Robot.from_urdf(self.urdf, tip=ARMS[name], srdf=folder / f"{name}.srdf")
        pairs = [pair for pair in robot.collision_pairs if frozenset(pair) not in ALWAYS_TOUCH]
        self.robot = robot.with_collision_pairs(pairs)

    def problems(self) -> list[dict[str, Any]]:
        """Problems with a valid goal, each with the name of its scene."""
        scenes = json.loads((self.data / f"{self.name}.json").read_text(encoding="utf-8"))["scenes"]
        return [problem | {"scene": name} for name, each in scenes.items() for problem in each if problem["goal_valid"]]

    def scene(self, problem: dict[str, Any]) -> bik.Scene:
        """Obstacles of a problem."""
        boxes = [bik.obstacles.Box(at[:3, 3], size, at[:3, :3]) for at, size in boxes_of(problem)]
        cylinders = [
            bik.obstacles.Cylinder(at[:3, 3], at[:3, 2], radius, length) for at, radius, length in cylinders_of(problem)
        ]
        return bik.Scene([*boxes, *cylinders])


def boxes_of(problem: dict[str, Any]) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yields the pose (4, 4) and the edges (3,) of each box."""
    for box in problem["boxes"]:
        yield bik.pose(box["position"], xyzw=box["xyzw"]), 2 * np.asarray(box["half_extents"])


def cylinders_of(problem: dict[str, Any]) -> Iterator[tuple[np.ndarray, float, float]]:
    """Yields the pose (4, 4), the radius and the length of each cylinder."""
    for cylinder in problem["cylinders"]:
        yield bik.pose(cylinder["position"], xyzw=cylinder["xyzw"]), cylinder["radius"], cylinder["length"]


class CoalScene:
    """Distances of an arm in a scene by coal: spheres against shapes, and against each other."""

    def __init__(self, arm: MotionBenchArm, problem: dict[str, Any]) -> None:
        import coal

        self.coal, self.robot = coal, arm.robot
        self.request = coal.DistanceRequest()
        self.request.gjk_tolerance = 1e-9
        place = [(coal.Box(*size), coal.Transform3s(at[:3, :3], at[:3, 3])) for at, size in boxes_of(problem)]
        place += [
            (coal.Cylinder(radius, length), coal.Transform3s(at[:3, :3], at[:3, 3]))
            for at, radius, length in cylinders_of(problem)
        ]
        self.things = place
        names = list(arm.robot.all_link_names)
        self.links = np.array([names.index(link) for link, *_ in arm.robot.capsules])
        self.centers = np.array([a for _, a, _, _ in arm.robot.capsules])
        self.radii = np.array([radius for *_, radius in arm.robot.capsules])
        self.spheres = [coal.Sphere(radius) for radius in self.radii]
        # Broad phase as a user would call it: once for all pairs.
        self.scene, self.arm = coal.DynamicAABBTreeCollisionManager(), coal.DynamicAABBTreeCollisionManager()
        self.still = [coal.CollisionObject(shape, at) for shape, at in self.things]
        self.moved = [coal.CollisionObject(sphere) for sphere in self.spheres]
        for manager, objects in ((self.scene, self.still), (self.arm, self.moved)):
            for thing in objects:
                manager.registerObject(thing)
            manager.setup()
        pairs = [(names.index(a), names.index(b)) for a, b in arm.robot.collision_pairs]
        tested = np.zeros((len(names), len(names)), bool)
        tested[tuple(np.transpose(pairs))] = True
        tested |= tested.T
        self.tested = np.triu(tested[np.ix_(self.links, self.links)])

    def placed(self, q: np.ndarray) -> np.ndarray:
        """Centres of the spheres (k, 3)."""
        poses = self.robot.all_link_poses(q)[self.links]
        return np.einsum("kij,kj->ki", poses[:, :3, :3], self.centers) + poses[:, :3, 3]

    def apart(self, centers: np.ndarray) -> float:
        """Smallest distance between two spheres of the arm that must not touch."""
        distances = np.linalg.norm(centers[:, None] - centers[None], axis=2) - self.radii[:, None] - self.radii[None]
        return float(distances[self.tested].min())

    def clearance(self, q: np.ndarray) -> float:
        """Smallest distance of all."""
        centers = self.placed(q)
        least = self.apart(centers)
        for sphere, center in zip(self.spheres, centers, strict=True):
            at = self.coal.Transform3s(np.eye(3), center)
            for shape, place in self.things:
                found = self.coal.distance(sphere, at, shape, place, self.request, self.coal.DistanceResult())
                least = min(least, float(found))
        return least

    def is_clear(self, q: np.ndarray) -> bool:
        """Whether no bodies touch."""
        centers = self.placed(q)
        if self.apart(centers) < 0.0:
            return False
        for moved, center in zip(self.moved, centers, strict=True):
            moved.setTranslation(center)
            moved.computeAABB()
        self.arm.update()
        contact = self.coal.CollisionCallBackDefault()
        self.arm.collide(self.scene, contact)
        return not contact.data.result.isCollision()


def first_clear(solutions: Iterable[np.ndarray], scene: CoalScene) -> np.ndarray | None:
    """Returns the first solution without contact."""
    return next((q for q in solutions if scene.is_clear(q)), None)


def rejections(arm: MotionBenchArm, scratch: Path, notes: list[str]) -> dict[str, Reject]:
    """Methods that take all solutions of a library, or many of them, and test them with coal one by one."""

    def own(target: np.ndarray, scene: CoalScene) -> np.ndarray | None:
        for samples in SAMPLES:
            found = first_clear(bik.solve_all(arm.robot, target, redundancy=samples).q, scene)
            if found is not None or arm.robot.dof < 7:
                return found
        return None

    chain = cut(arm.urdf, None, ARMS[arm.name], scratch)
    adapters, missing = load([closed_form.Ssik, closed_form.Eaik], chain, 1e-6)
    notes += [f"- {arm.name}, {name}: {reason}" for name, reason in missing.items()]
    ways: dict[str, Reject] = {"rejection: beetle-ik solve_all and coal": own}
    return ways | {f"rejection: {each.name} and coal": rejection(chain, each) for each in adapters}


def rejection(chain: Chain, adapter: Adapter) -> Reject:
    """Tests all solutions of a library inside the limits one by one."""
    start = 0.5 * (chain.lower + chain.upper)

    def reject(target: np.ndarray, scene: CoalScene) -> np.ndarray | None:
        found = chain.unwound(adapter.solve_all(target, start))
        return first_clear((q for q in found if (q <= chain.upper).all()), scene)

    return reject
