"""Arms, constraints and ends of motions that keep them; and their errors by numpy and scipy alone."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pair_of_pandas import PANDA
from scipy.spatial.transform import Rotation

import beetle_ik as bik

sys.path.insert(0, str(Path(__file__).parents[1]))

from campaign import arms as plain

Array = NDArray[np.float64]
INF = np.inf


def _joint(xyz: Any, rpy: Any, lower: float, upper: float) -> plain.Joint:
    return {
        "kind": "revolute",
        "xyz": tuple(map(float, xyz)),
        "rpy": tuple(map(float, rpy)),
        "axis": (0.0, 0.0, 1.0),
        "lower": lower,
        "upper": upper,
        "follows": None,
        "at": (0.0,),
    }


def _by_table(rows: list[tuple[float, float, float]], limit: float) -> list[plain.Joint]:
    """Returns an arm by its Denavit-Hartenberg table (a, d, alpha); its tip is the frame of the last joint."""
    before = [((0, 0, 0), (0, 0, 0)), *(((a, 0, d), (alpha, 0, 0)) for a, d, alpha in rows[:-1])]
    return [_joint(xyz, rpy, -limit, limit) for xyz, rpy in before]


UR5E = [(0, 0.1625, pi / 2), (-0.425, 0, 0), (-0.3922, 0, 0), (0, 0.1333, pi / 2), (0, 0.0997, -pi / 2), (0, 0, 0)]
IIWA = [
    (0, 0.36, -pi / 2),
    (0, 0, pi / 2),
    (0, 0.42, pi / 2),
    (0, 0, -pi / 2),
    (0, 0.4, -pi / 2),
    (0, 0, pi / 2),
    (0, 0, 0),
]
ARMS = {
    "panda": [_joint(xyz, (roll, 0, 0), lower, upper) for xyz, roll, lower, upper in PANDA],
    "ur5e": _by_table(UR5E, 2 * pi),
    "iiwa14": _by_table(IIWA, 2.0),
}


@dataclass(frozen=True)
class Arm:
    """An arm of the library, and its joints as plain data."""

    robot: bik.Robot
    joints: list[plain.Joint]

    def poses(self, q: Array) -> Array:
        """Poses of the tip (m, 4, 4) at q (m, n), by numpy."""
        return plain.kinematics(self.joints, q)[0]


def arm(name: str, random: np.random.Generator, bodies: bool = False) -> Arm:
    """Returns one of `ARMS`, or a random arm of as many joints as the name says."""
    joints = ARMS[name] if name in ARMS else plain.easy_arm(random, int(name))
    robot = bik.Robot.from_urdf(plain.urdf(joints))
    if bodies:
        robot = robot.with_capsules(radius=0.03)
    return Arm(robot, joints)


def angle_between(one: Array, other: Array) -> Array:
    """Angles (m,) between vectors (m, 3), exact for small ones too."""
    return np.arctan2(np.linalg.norm(np.cross(one, other), axis=-1), np.sum(one * other, axis=-1))


def errors(keep: bik.Keep, poses: Array) -> Array:
    """Errors (m, entries) of a constraint at poses of its tip (m, 4, 4); NaN for free ones, and beside a region inf."""
    target, task = np.asarray(keep.target), keep.task
    frame = target if target.shape == (4, 4) else bik.pose(target)
    offset = (poses[:, :3, 3] - frame[:3, 3]) @ frame[:3, :3]
    if target.shape == (3,) and task is None:
        return np.linalg.norm(offset, axis=1)[:, None]
    turn = Rotation.from_matrix(np.einsum("ji,mjk->mik", frame[:3, :3], poses[:, :3, :3])).as_rotvec()
    if task is None:
        return np.stack([np.linalg.norm(offset, axis=1), np.linalg.norm(turn, axis=1)], axis=1)
    kind = type(task).__name__
    if kind == "Pointing":
        axis = np.asarray(task.axis)
        tilt = angle_between(poses[:, :3, :3] @ axis, frame[:3, :3] @ axis)
        found = np.column_stack([np.abs(offset), tilt])
    else:
        parts = {"Position": [np.abs(offset)], "Orientation": [np.abs(turn)], "Pose": [np.abs(offset), np.abs(turn)]}
        found = np.hstack(parts[kind])
    if task.region is not None:
        below, above = task.region[0] - poses[:, :3, 3], poses[:, :3, 3] - task.region[1]
        found[np.maximum(below, above).max(axis=1) > 1e-9] = INF
    return found


def allowed(keep: bik.Keep) -> Array:
    """Tolerance of each entry (entries,)."""
    if keep.task is None or keep.task.tolerance is None:
        count = len(errors(keep, np.eye(4)[None])[0])
        return np.full(count, 1e-6)
    return np.broadcast_to(keep.task.tolerance, (len(errors(keep, np.eye(4)[None])[0]),)).astype(float)


def samples(plan: bik.Plan, count: int = 5000) -> Array:
    """Configurations of the timed motion (count + 1, n)."""
    return np.array([plan.trajectory.at(t)[0] for t in np.linspace(0.0, plan.trajectory.duration, count + 1)])


KINDS = ("upright", "plane", "region", "yaw_free", "box", "whole")


def constraint(
    kind: str, pose: Array, tolerance: float, random: np.random.Generator, *, at_limit: bool = False
) -> bik.Keep:
    """Returns a constraint that holds at a pose of the tip; `at_limit`: just so, its error is the tolerance."""
    beside = 1.0 if at_limit else float(random.choice([0.0, 0.5, random.random()]))
    normal = [(1, 0, 0), (0, 1, 0), (0, 0, 1)][random.integers(3)] if random.random() < 0.5 else random.normal(size=3)
    normal = np.asarray(normal) / np.linalg.norm(normal)
    length = min(tolerance, 0.5)
    if kind == "upright":
        axis = np.eye(3)[random.integers(3)]
        points = pose[:3, :3] @ axis
        side = np.cross(points, [0.6, 0.48, 0.64])
        direction = Rotation.from_rotvec(beside * tolerance * side / np.linalg.norm(side)).apply(points)
        target = np.eye(4)
        target[:3, :3] = _turning(axis, direction)
        return bik.Keep(target, bik.tasks.Pointing(axis=axis, tolerance=[INF, INF, INF, tolerance]))
    if kind == "plane":
        target = np.eye(4)
        target[:3, :3] = _turning(np.array([0.0, 0.0, 1.0]), normal)
        target[:3, 3] = pose[:3, 3] + beside * length * normal
        free = [INF] * 3
        return bik.Keep(target, bik.tasks.Pose(tolerance=[INF, INF, length, *free]))
    if kind == "region":
        size = length * (1.0 + random.random((2, 3)))
        corners = [pose[:3, 3] - size[0], pose[:3, 3] + size[1]]
        return bik.Keep(pose[:3, 3], bik.tasks.Position(tolerance=[INF] * 3, region=corners))
    if kind == "yaw_free":
        target = np.eye(4)
        target[:3, :3] = pose[:3, :3] @ Rotation.from_rotvec([0, beside * tolerance, 0]).as_matrix().T
        return bik.Keep(target, bik.tasks.Orientation(tolerance=[tolerance, tolerance, INF]))
    if kind == "box":
        tolerances = np.array([length, 2.0 * length, INF])
        place = pose[:3, 3] + beside * length * np.array([1.0, 0.0, 0.0])
        return bik.Keep(place, bik.tasks.Position(tolerance=tolerances))
    target = pose.copy()
    target[:3, 3] += beside * length * normal
    return bik.Keep(target, bik.tasks.Pose(tolerance=[length] * 3 + [tolerance] * 3))


def _turning(axis: Array, direction: Array) -> Array:
    """The rotation by the least angle that turns one unit vector into another."""
    cross, cosine = np.cross(axis, direction), float(axis @ direction)
    if cosine < -1.0 + 1e-12:
        side = np.cross(axis, np.roll(axis, 1))
        return Rotation.from_rotvec(pi * side / np.linalg.norm(side)).as_matrix()
    angle = np.arctan2(np.linalg.norm(cross), cosine)
    return Rotation.from_rotvec(angle * cross / max(np.linalg.norm(cross), 1e-300)).as_matrix()


def holds(keep: bik.Keep, poses: Array, slack: float = 1e-9) -> Array:
    """Whether a constraint holds at poses (m,)."""
    return (errors(keep, poses) <= np.minimum(allowed(keep), 1e9) + slack).all(axis=1)


def end_of(arm: Arm, keeps: list[bik.Keep], start: Array, random: np.random.Generator) -> Array | None:
    """Returns a configuration away from the start at which all constraints hold, by scipy; None if none was found."""
    from scipy.optimize import least_squares

    lower, upper = (np.clip(bound, -3.0, 3.0) for bound in plain.bounds(arm.joints))

    def beyond(q: Array) -> Array:
        pose = arm.poses(q[None])
        rows = []
        for keep in keeps:
            most = allowed(keep)
            limited = np.isfinite(most)
            rows.append(np.maximum(errors(keep, pose)[0][limited] - 0.7 * most[limited], 0.0))
            if keep.task is not None and keep.task.region is not None:
                place, inset = pose[0, :3, 3], 0.1 * (keep.task.region[1] - keep.task.region[0])
                below, above = keep.task.region[0] + inset - place, place - keep.task.region[1] + inset
                rows = [np.maximum(below, 0.0) + np.maximum(above, 0.0), *rows[:-1]]
        return np.concatenate(rows)

    for reach in (1.5, 1.5, 0.8, 0.8, 0.4, 0.2, 0.1):
        first = np.clip(start + random.uniform(-reach, reach, len(start)), lower, upper)
        q = least_squares(beyond, first, bounds=(lower - 1e-9, upper + 1e-9), max_nfev=60).x
        q = np.clip(q, lower, upper)
        if all(holds(keep, arm.poses(q[None]), 0.0)[0] for keep in keeps):
            return q
    return None
