"""Arms of four and five joints, with the tip on and off the last axis, and what scipy makes of their targets."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

import beetle_ik as bik

Array = NDArray[np.float64]
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
Joint = tuple[tuple[float, float, float], tuple[float, float, float], float, float]


def serial(joints: list[Joint], tip: tuple[float, float, float], name: str = "arm") -> bik.Robot:
    """Returns the arm of these revolute joints: origin (m), axis and limits (rad) of each."""
    text = f"<robot name='{name}'><link name='l0'/>"
    for i, (xyz, axis, lower, upper) in enumerate(joints):
        text += (
            f"<link name='l{i + 1}'/><joint name='j{i}' type='revolute'><parent link='l{i}'/>"
            f"<child link='l{i + 1}'/><origin xyz='{xyz[0]} {xyz[1]} {xyz[2]}'/>"
            f"<axis xyz='{axis[0]} {axis[1]} {axis[2]}'/>"
            f"<limit lower='{lower}' upper='{upper}' velocity='3' effort='1'/></joint>"
        )
    text += (
        f"<link name='tip'/><joint name='f' type='fixed'><parent link='l{len(joints)}'/><child link='tip'/>"
        f"<origin xyz='{tip[0]} {tip[1]} {tip[2]}'/></joint></robot>"
    )
    return bik.Robot.from_urdf(text, tip="tip")


PAN_TO_FLEX: list[Joint] = [
    ((0.04, 0, 0.06), Z, -1.9, 1.9),
    ((0.03, 0, 0.055), Y, -1.75, 1.75),
    ((0.03, 0, 0.115), Y, -1.7, 1.7),
    ((0.135, 0, 0), Y, -1.65, 1.65),
]
ROLL: Joint = ((0.06, 0, 0), X, -2.7, 2.8)
HOBBY = serial([*PAN_TO_FLEX, ROLL], (0.1, 0, 0), "hobby")
OFF_AXIS = serial([*PAN_TO_FLEX, ROLL], (0.1, 0.02, 0.01), "off_axis")
FOUR = serial(PAN_TO_FLEX, (0.1, 0, 0), "four")
ROUND = serial(
    [
        ((0, 0, 0), Z, -3, 3),
        ((0, 0, 0), Y, -3, 3),
        ((0.5, 0, 0), Y, -3, 3),
        ((0.5, 0, 0), Y, -3, 3),
        ((0, 0, 0), X, -3, 3),
    ],
    (0, 0, 0),
    "round",
)
ARMS = {"hobby": HOBBY, "off_axis": OFF_AXIS, "four": FOUR, "round": ROUND}


def turned(pose: Array, vector: Array) -> Array:
    """Returns the pose turned by a rotation vector (rad)."""
    pose = pose.copy()
    pose[:3, :3] = Rotation.from_rotvec(vector).as_matrix() @ pose[:3, :3]
    return pose


def errors(robot: bik.Robot, q: Array, target: Array) -> tuple[float, float]:
    """Returns distance (m) and angle (rad)."""
    pose = robot.fk(q)
    angle = Rotation.from_matrix(pose[:3, :3].T @ target[:3, :3]).magnitude()
    return float(np.linalg.norm(pose[:3, 3] - target[:3, 3])), float(angle)


def least_angle(robot: bik.Robot, target: Array, tries: int, seed: int = 0) -> float:
    """Returns the least angle that scipy finds with the tip at the place, by growing weights; inf if none."""
    random = np.random.default_rng(seed)
    least = np.inf
    for _ in range(tries):
        q = random.uniform(robot.lower, robot.upper)
        for weight in (10.0, 300.0, 1e4, 3e5):

            def residual(q: Array, weight: float = weight) -> Array:
                pose = robot.fk(q)
                turn = Rotation.from_matrix(pose[:3, :3].T @ target[:3, :3]).as_rotvec()
                return np.r_[weight * (pose[:3, 3] - target[:3, 3]), turn]

            inside = np.clip(q, robot.lower + 1e-9, robot.upper - 1e-9)
            q = least_squares(residual, inside, bounds=(robot.lower, robot.upper), max_nfev=60).x
        away, angle = errors(robot, q, target)
        least = min(least, angle) if away < 1e-6 else least
    return least
