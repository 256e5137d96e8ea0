"""Derivatives of solutions and Jacobians, as the doors to JAX and PyTorch hand them over."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

from .. import arms
from ..attack import Attack, BrokenError, Case

sys.path.insert(0, str(Path(__file__).parents[2] / "python"))

STEP = 1e-5  # rad or m
FOLLOWED = """
from beetle_ik.interop.derivatives.curvature import curvature, require_single_joints
from beetle_ik.interop.derivatives.following import following

ways = following(robot, 6, damping, q, np.ones(len(q)))
try:
    require_single_joints(robot, None)
    bent = curvature(robot, None, q)
except bik.InvalidInputError:
    bent = None
"""


class Followed(Attack):
    name = "followed_targets"
    promise = "Derivatives of solutions are pseudoinverses bounded by the damping, those of Jacobians exact"
    page = "derivatives"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard cases have deformed arms at limits and in singular configurations."""
        joints = arms.arm(random, hard, (1, 9))
        arms.put(joints, random, hard, 3)
        return {"joints": joints, "damping": float(random.choice([1e-4, 1e-2, 0.1]))}

    def program(self, case: Case) -> str:
        return (
            f"{arms.written(case['joints'])}q = np.array({arms.configurations(case['joints']).tolist()})\n"
            f"damping = {case['damping']}\n{FOLLOWED}"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        from oracle import Oracle

        robot, q, damping = left["robot"], left["q"], case["damping"]
        pinocchio = Oracle(arms.urdf(case["joints"]), "l0", f"l{len(case['joints'])}")
        size = 1.0 + sum(np.linalg.norm(joint["xyz"]) for joint in case["joints"])

        def jacobian(row: np.ndarray) -> np.ndarray:
            return np.asarray(pinocchio.fk_and_jacobian(robot.joint_names, row)[1])

        for row, ways in zip(q, left["ways"], strict=True):
            inverse, rest = ways[:, :6], ways[:, 6:]
            if not np.isfinite(ways).all() or np.linalg.norm(inverse, 2) > (1.0 + 1e-9) / damping:
                raise BrokenError("the inverse is not bounded", np.linalg.norm(inverse, 2))
            exact = jacobian(row)
            near = 1e-6 * (1.0 + np.abs(row))
            values = np.linalg.svd(exact, compute_uv=False)
            regular = np.all((values > 1.01 * damping) | (values < 1e-9 * size))
            if not regular or np.any(row <= robot.lower + near) or np.any(row >= robot.upper - near):
                continue
            off = np.abs(exact @ inverse @ exact - exact).max() / size
            off = max(off, np.abs(np.eye(len(row)) - inverse @ exact - rest).max() / (1.0 + size / damping))
            if off > 1e-9 / damping:
                raise BrokenError("it is not the pseudoinverse", off)
        for i, row in enumerate(q if left["bent"] is not None else []):
            for k, unit in enumerate(np.eye(len(row))):
                slope = (jacobian(row + STEP * unit) - jacobian(row - STEP * unit)) / (2.0 * STEP)
                off = np.abs(left["bent"][i, :, :, k] - slope).max(initial=0.0) / size
                if off > 1e-8 * (1.0 + np.abs(row).max()):
                    raise BrokenError("the derivative of the Jacobian differs", off)
        return len(q)


ATTACKS = [Followed()]
