"""Judge of planned motions: spheres against boxes, cylinders and spheres, on samples at most 1 mm apart.

It shares no code with any planner. A motion is *kept* if on no sample two spheres that must not touch do so, no sphere
is inside an obstacle, the ends are those of the problem, and no joint leaves its range.
"""

# ruff: noqa: D107

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from .sphere_arm import SphereArm

APART = 1e-3  # m: no sphere moves farther from sample to sample
TOUCHING = 1e-9  # m: rounding
AT_END = 1e-6  # rad
COARSE = 16  # every so many samples all distances are computed
CHUNK = 256  # samples at once, so that arrays stay in the cache


@dataclass(frozen=True)
class Obstacle:
    """Box, cylinder or sphere by its pose."""

    rotation: np.ndarray  # (3, 3)
    center: np.ndarray  # (3,)
    half: np.ndarray  # box: half edges (3,); cylinder: radius and half length (2,); sphere: radius (1,)

    def distances(self, points: np.ndarray) -> np.ndarray:
        """Signed distances of points (..., 3) from the surface: negative inside."""
        if len(self.half) == 1:
            return np.linalg.norm(points - self.center, axis=-1) - self.half[0]
        local = (points - self.center) @ self.rotation
        if len(self.half) == 2:
            local = np.stack([np.hypot(local[..., 0], local[..., 1]), local[..., 2]], axis=-1)
        beyond = np.abs(local) - self.half
        return np.linalg.norm(np.maximum(beyond, 0.0), axis=-1) + np.minimum(beyond.max(axis=-1), 0.0)


def obstacles_of(problem: dict[str, Any]) -> Iterator[Obstacle]:
    """Yields the obstacles of a problem of MotionBenchMaker."""
    for box in problem["boxes"]:
        yield Obstacle(turn(box["xyzw"]), np.array(box["position"]), np.array(box["half_extents"]))
    for cylinder in problem["cylinders"]:
        half = np.array([cylinder["radius"], 0.5 * cylinder["length"]])
        yield Obstacle(turn(cylinder["xyzw"]), np.array(cylinder["position"]), half)
    for sphere in problem["spheres"]:
        yield Obstacle(np.eye(3), np.array(sphere["position"]), np.array([sphere["radius"]]))


def turn(xyzw: list[float]) -> np.ndarray:
    """Rotation (3, 3) of a quaternion."""
    x, y, z, w = np.array(xyzw) / np.linalg.norm(xyzw)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


@dataclass(frozen=True)
class Motion:
    """Planned motion as input of the judge."""

    at: Callable[[np.ndarray], np.ndarray]  # configurations (m, n) at times (m,) from 0 to `duration`
    duration: float  # s
    spacing: float  # s between the samples from which rates are computed


@dataclass(frozen=True)
class Verdict:
    """Verdict on a motion."""

    clearance: float  # the least on all samples, m
    off_ends: float  # rad
    outside: float  # by how much a joint leaves its range, rad
    length: float  # in joint space, Euclidean, rad
    speed: float  # largest velocity over its limit
    acceleration: float  # the same

    @property
    def kept(self) -> bool:
        """Whether the motion solves the problem, whatever its velocities."""
        return self.clearance >= -TOUCHING and self.off_ends <= AT_END and self.outside <= TOUCHING


class SphereJudge:
    """Arm in the scene of one problem."""

    def __init__(self, arm: SphereArm, problem: dict[str, Any]) -> None:
        self.arm, self.obstacles = arm, list(obstacles_of(problem))
        self.start, self.goal = np.array(problem["start"]), np.array(problem["goal"])

    def clearances(self, q: np.ndarray) -> np.ndarray:
        """Smallest distance of all (m,) at configurations (m, n)."""
        return self._all_distances(self.arm.centers(q)).min(axis=1)

    def judge(self, motion: Motion, acceleration: float) -> Verdict:
        """Judges a motion; `acceleration` is the limit of every joint (rad/s²)."""
        q, centers = dense(self.arm.centers, motion)
        ends = np.abs(q[[0, -1]] - [self.start, self.goal]).max()
        outside = max(0.0, np.maximum(self.arm.lower - q, q - self.arm.upper).max())
        length = np.linalg.norm(np.diff(q, axis=0), axis=1).sum()
        speed, rise = rates(motion)
        speed, rise = (speed / self.arm.velocity).max(), (rise / acceleration).max()
        return Verdict(self._least(centers), float(ends), float(outside), float(length), float(speed), float(rise))

    def _least(self, centers: np.ndarray) -> float:
        """Smallest distance on all samples: of all pairs on few, of those that can be nearest on all."""
        coarse = self._all_distances(np.concatenate([centers[::COARSE], centers[-1:]]))
        least = coarse.min()
        # Bound on the change between coarse samples: COARSE // 2 + 1 steps, by both spheres of a pair.
        near = np.flatnonzero(coarse.min(axis=0) < least + 2 * APART * (COARSE // 2 + 1))
        for chunk in np.array_split(centers, -(-len(centers) // CHUNK)):
            least = min(least, self._distances(chunk, near).min())
        return float(least)

    def _all_distances(self, centers: np.ndarray) -> np.ndarray:
        count = centers.shape[1] * len(self.obstacles) + len(self.arm.pairs)
        return self._distances(centers, np.arange(count))

    def _distances(self, centers: np.ndarray, wanted: np.ndarray) -> np.ndarray:
        """Distances (m, w): sphere k from obstacle o has the number o * spheres + k, then come the pairs of spheres."""
        radii, spheres = self.arm.radii, centers.shape[1]
        found = []
        for number, obstacle in enumerate(self.obstacles):
            those = wanted[wanted // spheres == number] - number * spheres
            found.append(obstacle.distances(centers[:, those]) - radii[those])
        first, second = self.arm.pairs[
            wanted[wanted >= len(self.obstacles) * spheres] - len(self.obstacles) * spheres
        ].T
        apart = centers[:, first] - centers[:, second]
        found.append(np.sqrt(np.einsum("mki,mki->mk", apart, apart)) - radii[first] - radii[second])
        return np.concatenate(found, axis=1)


def dense(points: Callable[[np.ndarray], np.ndarray], motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Configurations (m, n) along a motion, and points of the arm (m, k, 3), at most `APART` from row to row."""
    times = np.linspace(0.0, motion.duration, 257)
    while True:
        q = motion.at(times)
        found = points(q)
        moved = np.linalg.norm(np.diff(found, axis=0), axis=2).max(axis=1)
        parts = np.maximum(1, np.ceil(moved / APART)).astype(int)
        if (parts == 1).all():
            return q, found
        starts, steps = np.repeat(times[:-1], parts), np.repeat(np.diff(times) / parts, parts)
        within = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
        times = np.append(starts + within * steps, times[-1])


def rates(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Largest difference quotients of first and second order (n,): never above the true velocity and acceleration.

    Before and after the motion the arm is at rest.
    """
    step = motion.spacing
    steps = np.arange(-1, np.ceil(motion.duration / step) + 2)
    q = motion.at(np.clip(step * steps, 0.0, motion.duration))
    first, second = np.diff(q, axis=0) / step, np.diff(q, n=2, axis=0) / step**2
    return np.abs(first).max(axis=0), np.abs(second).max(axis=0)
