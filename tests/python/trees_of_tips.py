"""Robots with several tips for tests: two arms on a torso, and a humanoid that stands on one foot."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

import beetle_ik as bik

Array = np.ndarray

X, Y, Z = "1 0 0", "0 1 0", "0 0 1"


def limb(name: str, parent: str, tip: str, joints: list[tuple[str, tuple[float, float, float]]], most: float) -> str:
    """Returns the URDF of a chain of revolute joints, each an axis and its place after the one before."""
    parts = []
    for i, (axis, (x, y, z)) in enumerate(joints):
        link = tip if i + 1 == len(joints) else f"{name}_{i}"
        parts.append(
            f"<link name='{link}'/><joint name='{name}_{i}' type='revolute'>"
            f"<parent link='{parent}'/><child link='{link}'/><origin xyz='{x} {y} {z}'/><axis xyz='{axis}'/>"
            f"<limit lower='{-most}' upper='{most}' velocity='2'/></joint>"
        )
        parent = link
    return "".join(parts)


def two_arms() -> bik.Robot:
    """Returns two arms of seven joints on a torso that lifts and turns: 16 joints."""
    torso = (
        "<link name='floor'/><link name='column'/><joint name='lift' type='prismatic'><parent link='floor'/>"
        "<child link='column'/><origin xyz='0 0 0.5'/><axis xyz='0 0 1'/>"
        "<limit lower='0' upper='0.4' velocity='0.5'/></joint>" + limb("yaw", "column", "chest", [(Z, (0, 0, 0))], 1.0)
    )
    steps = [(Y, 0.1), (Z, 0.2), (Y, 0.2), (Z, 0.2), (Y, 0.2), (Z, 0.1)]
    arms = (
        limb(side, "chest", side, [(Z, (0, y, 0.1)), *((axis, (0, 0, step)) for axis, step in steps)], 2.8)
        for side, y in (("left", 0.3), ("right", -0.3))
    )
    return bik.Robot.from_urdf(f"<robot name='pair'>{torso}{''.join(arms)}</robot>", tip=["left", "right"])


def humanoid() -> bik.Robot:
    """Returns a body that stands on its right foot, with the left foot, a hand and the head as tips: 22 joints."""
    o = (0, 0, 0)
    right = [(X, (0, 0, 0.1)), (Y, o), (Y, (0, 0, 0.4)), (Y, (0, 0, 0.4)), (X, o), (Z, (0, 0, 0.05))]
    left = [(Z, (0, 0.2, 0)), (X, (0, 0, -0.05)), (Y, o), (Y, (0, 0, -0.4)), (Y, (0, 0, -0.4)), (X, o)]
    waist = [(Z, (0, 0.1, 0.1)), (Y, (0, 0, 0.1))]
    arm = [(Y, (0, 0.2, 0.3)), (X, o), *((axis, (0, 0, -0.15)) for axis in (Z, Y, Z)), (Y, (0, 0, -0.1))]
    body = (
        limb("right", "right_foot", "pelvis", right, 2.0)
        + limb("left", "pelvis", "left_foot", left, 2.0)
        + limb("waist", "pelvis", "chest", waist, 1.5)
        + limb("arm", "chest", "hand", arm, 2.0)
        + limb("neck", "chest", "head", [(Z, (0, 0, 0.4)), (Y, (0, 0, 0.1))], 1.0)
    )
    urdf = f"<robot name='body'><link name='right_foot'/>{body}</robot>"
    return bik.Robot.from_urdf(urdf, tip=["left_foot", "hand", "head"])


def residual(frame: Array, target: Array, part: str = "pose") -> Array:
    """Returns the difference of a frame from its target: position and rotation vector, or one of them."""
    turn = Rotation.from_matrix(frame[:3, :3] @ target[:3, :3].T).as_rotvec()
    whole = np.concatenate([frame[:3, 3] - target[:3, 3], turn])
    return {"pose": whole, "position": whole[:3], "orientation": whole[3:]}[part]


@dataclass(frozen=True)
class Level:
    """What tips of a robot have to reach together: (tip, target, part) each."""

    robot: bik.Robot
    tasks: tuple[tuple[str, Array, str], ...]

    def residual(self, q: Array) -> Array:
        frames = self.robot.fk(q)
        return np.concatenate([residual(frames[self.robot.tips.index(tip)], to, part) for tip, to, part in self.tasks])

    def jacobian(self, q: Array) -> Array:
        """Returns derivatives of `residual`, of rotations those at a small one."""
        each = self.robot.jacobian(q)
        rows = {"pose": slice(0, 6), "position": slice(0, 3), "orientation": slice(3, 6)}
        return np.vstack([each[self.robot.tips.index(tip)][rows[part]] for tip, _, part in self.tasks])

    def error(self, q: Array) -> float:
        return float(np.linalg.norm(self.residual(q)))

    def squared(self, q: Array) -> float:
        return self.error(q) ** 2

    def slope(self, q: Array) -> Array:
        """Returns the gradient of `squared`, exact since a rotation vector is its own along its axis."""
        return 2 * self.residual(q) @ self.jacobian(q)


def nested(levels: list[Level], starts: list[Array]) -> list[float]:
    """Returns the least error of each level by nested descents of scipy (SLSQP), those below held at their least."""
    robot = levels[0].robot
    box = list(zip(robot.lower, robot.upper, strict=True))
    best: list[float] = []
    for start in starts:
        q, held = start, []
        for level in levels:
            options = {"maxiter": 200, "ftol": 1e-13}
            found = minimize(
                level.squared, q, jac=level.slope, method="SLSQP", bounds=box, constraints=held, options=options
            )
            q = np.clip(found.x, robot.lower, robot.upper)
            least = level.squared(q)
            if least < 1e-10:
                held.append({"type": "eq", "fun": level.residual, "jac": level.jacobian})
            else:
                room = partial(_room, level, least * (1 + 1e-9))
                held.append({"type": "ineq", "fun": room, "jac": lambda q, level=level: -10 * level.slope(q)})
        errors = [level.error(q) for level in levels]
        if not best or [round(error, 5) for error in errors] < [round(error, 5) for error in best]:
            best = errors
    return best


def _room(level: Level, most: float, q: Array) -> float:
    return 10 * (most - level.squared(q))
