"""Forward kinematics against Pinocchio."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

from .. import arms
from ..attack import Attack, BrokenError, Case

sys.path.insert(0, str(Path(__file__).parents[2] / "python"))


class Poses(Attack):
    name = "poses"
    promise = "Poses, link poses and Jacobians are those of the URDF, as Pinocchio reads it"
    page = "concepts"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        joints = arms.arm(random, hard, (1, 9))
        arms.put(joints, random, hard, 4)
        return {"joints": joints}

    def program(self, case: Case) -> str:
        return (
            f"{arms.written(case['joints'])}q = np.array({arms.configurations(case['joints']).tolist()})\n"
            "poses, jacobians, links = robot.fk(q), robot.jacobian(q), [robot.link_poses(row) for row in q]"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        from oracle import Oracle

        robot, q, tip = left["robot"], left["q"], f"l{len(case['joints'])}"
        pinocchio = Oracle(arms.urdf(case["joints"]), "l0", tip)
        for row, pose, jacobian, links in zip(q, left["poses"], left["jacobians"], left["links"], strict=True):
            expected, derivative = pinocchio.fk_and_jacobian(robot.joint_names, row)
            places = pinocchio.link_poses(robot.link_names, dict(zip(robot.joint_names, row, strict=True)))
            size = 1.0 + sum(np.linalg.norm(joint["xyz"]) for joint in case["joints"])
            for what, found, right in (
                ("pose", pose, expected),
                ("jacobian", jacobian, derivative),
                ("links", links, places),
            ):
                off = np.abs(found - right).max(initial=0.0) / size
                if not off < 1e-12 * (1 + np.abs(row).max(initial=0.0)):
                    raise BrokenError(f"{what} differs", off)
        return len(q)


ATTACKS = [Poses()]
