"""Parameters of an arm with a parallel base and a spherical wrist (Brandstötter, Angerer and Hofbaur, 2014)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from .adapter import Unsupported
from .chain import Chain

PARALLEL = 1e-6


@dataclass(frozen=True)
class OpwArm:
    """Arm in the zero position of the paper, stretched upwards; `lengths` has the names of the paper."""

    lengths: dict[str, float]  # m
    base: np.ndarray  # (4, 4), the arm's frame in that of the chain's base: z along axis 1, y along axis 2
    zero: np.ndarray  # (6,), joint angles of the chain in that position
    signs: np.ndarray  # (6,)


def opw_parameters(chain: Chain) -> OpwArm:
    """Turns the arm joint by joint into the zero position and measures it.

    Raises:
        Unsupported: the arm has another structure.
    """
    if chain.dof != 6:
        raise Unsupported("it takes six joints")
    origins, axes = _joints(chain, np.zeros(6))
    z, y = axes[0], axes[1]
    if abs(z @ y) > PARALLEL or np.linalg.norm(np.cross(y, axes[2])) > PARALLEL:
        raise Unsupported("axis 2 is not perpendicular to axis 1, or not parallel to axis 3")
    base = np.eye(4)
    base[:3, :3] = np.column_stack([np.cross(y, z), y, z])
    base[:3, 3] = origins[0]
    signs = np.array([1.0, 1.0, np.sign(y @ axes[2]), 1.0, 1.0, 1.0])

    zero = np.zeros(6)
    zero[1] = _turn(y, _across(origins[2] - origins[1], y), z)
    for joint, (moved, wanted) in {2: (3, z), 3: (4, y), 4: (5, z)}.items():
        _, axes = _joints(chain, zero)
        zero[joint] = _turn(axes[joint], axes[moved], wanted)
    origins, axes = _joints(chain, zero)
    local = (origins - origins[0]) @ base[:3, :3]
    wrist = _meeting(local[3], local[4], local[5], axes[3:6] @ base[:3, :3])
    forearm = wrist - local[2]
    lengths = {
        "a1": local[1, 0],
        "c1": local[1, 2],
        "c2": local[2, 2] - local[1, 2],
        "a2": forearm[0],
        "c3": forearm[2],
        "b": wrist[1],
        "c4": 0.0,
    }
    return OpwArm({name: float(value) for name, value in lengths.items()}, base, zero, signs)


def _joints(chain: Chain, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Point on each axis and its direction, (6, 3) each."""
    data = chain.model.createData()
    jacobian = pin.computeJointJacobians(chain.model, data, q)
    return np.array([data.oMi[i + 1].translation for i in range(6)]), jacobian[3:].T.copy()


def _across(vector: np.ndarray, axis: np.ndarray) -> np.ndarray:
    return vector - (vector @ axis) * axis


def _turn(axis: np.ndarray, vector: np.ndarray, wanted: np.ndarray) -> float:
    """Angle about the axis that brings the vector to the wanted direction."""
    if np.linalg.norm(_across(vector, axis)) < PARALLEL or np.linalg.norm(_across(wanted, axis)) < PARALLEL:
        raise Unsupported("neighbouring axes are parallel")
    return float(np.arctan2(np.cross(vector, wanted) @ axis, _across(vector, axis) @ _across(wanted, axis)))


def _meeting(p: np.ndarray, q: np.ndarray, r: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Point nearest to three lines; forward kinematics tells later whether they meet."""
    across = [np.eye(3) - np.outer(axis, axis) for axis in axes]
    return np.linalg.solve(sum(across), sum(each @ point for each, point in zip(across, (p, q, r), strict=True)))
