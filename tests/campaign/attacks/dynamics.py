"""Torques, mass matrices and accelerations of random trees against Pinocchio."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

from .. import arms
from ..attack import Attack, BrokenError, Case

sys.path.insert(0, str(Path(__file__).parents[2] / "python"))

_STATES = 4


class Torques(Attack):
    name = "torques"
    promise = "Torques, mass matrices and accelerations are those of the URDF, as Pinocchio reads it"
    page = "dynamics"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        joints = arms.arm(random, hard, (1, 9))
        branch = arms.arm(random, hard, (0, 3)) if hard else []
        for joint in [*joints, *branch]:
            joint["body"] = body(random, hard)
            joint["rub"] = tuple(map(float, random.choice([0.0, 0.0, 0.3, 1.0], 2)))
        arms.put(joints, random, hard, _STATES)
        for joint in joints:
            joint["rates"] = [
                arms.triple(random.choice([0.0, 0.0, 1.0, -1.0, random.normal()], 3)) for _ in range(_STATES)
            ]
        # The last link has a mass, so that no joint moves none.
        joints[-1]["body"] = body(random, False)
        return {"joints": joints, "branch": branch}

    def program(self, case: Case) -> str:
        joints = case["joints"]
        rates = np.array([joint["rates"] for joint in arms.free(joints)]).transpose(1, 2, 0)
        return (
            f'robot = bik.Robot.from_urdf("""{urdf(case)}""", tip="l{len(joints)}")\n'
            f"q = np.array({arms.configurations(joints).tolist()})\n"
            f"qd, qdd = np.array({rates[:, 0].tolist()}), np.array({rates[:, 1].tolist()})\n"
            "torques, masses, holding = robot.torques(q, qd, qdd), robot.mass_matrix(q), robot.torques(q)"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        from dynamics_oracle import DynamicsOracle

        robot, q = left["robot"], left["q"]
        pinocchio = DynamicsOracle(urdf(case), robot)
        size = 1.0 + sum(np.linalg.norm(joint["xyz"]) for joint in [*case["joints"], *case["branch"]])
        for i, row in enumerate(q):
            qd, qdd = left["qd"][i], left["qdd"][i]
            speed = 1.0 + np.abs(qd).sum() ** 2 + np.abs(qdd).sum()
            pairs = (
                ("torques", left["torques"][i], pinocchio.torques(row, qd, qdd), speed),
                ("holding torques", left["holding"][i], pinocchio.torques(row, 0 * qd, 0 * qd), 1.0),
                ("mass matrix", left["masses"][i], pinocchio.mass_matrix(row), 1.0),
            )
            for what, found, right, scale in pairs:
                off = np.abs(found - right).max() / (np.abs(right).max() + size**2 * scale)
                if not off < 1e-10:
                    raise BrokenError(f"{what} differ" if what != "mass matrix" else f"{what} differs", off)
        return len(q)


def body(random: np.random.Generator, hard: bool) -> tuple[float, Any, Any] | None:
    """Draws mass, centre and three arms of pairs of points; None for a link without mass."""
    if hard and random.random() < 0.3:
        return None
    mass = float(random.choice([1.0, 0.1, 5.0, 1e-3 if hard else 2.0]))
    center = random.choice([0.0, 0.1, -0.2, random.normal()], 3)
    points = random.normal(size=(3, 3)) * 0.1 * random.integers(0, 2, (3, 1))
    return mass, arms.triple(center), [arms.triple(point) for point in points]


def urdf(case: Case) -> str:
    joints, branch = case["joints"], case["branch"]
    text = arms.urdf(joints, branch)
    for name, side in (("l", joints), ("a", branch)):
        for i, joint in enumerate(side):
            damping, friction = joint["rub"]
            rub = f"<dynamics damping='{damping}' friction='{friction}'/>"
            head = f"<joint name='{name}j{i}' type='{joint['kind']}'>"
            text = text.replace(head, head + rub)
            if joint["body"] is not None:
                link = f"<link name='{name}{i + 1}'"
                text = text.replace(f"{link}/>", f"{link}>{_inertial(*joint['body'])}</link>")
    return text


def _inertial(mass: float, center: Any, points: Any) -> str:
    arms_of = np.array(points)
    matrix = mass * (np.eye(3) * np.sum(arms_of**2) - arms_of.T @ arms_of)
    places = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    tensor = " ".join(f"{name}='{float(matrix[place])!r}'" for name, place in places.items())
    at = " ".join(map(repr, center))
    return f"<inertial><origin xyz='{at}'/><mass value='{mass!r}'/><inertia {tensor}/></inertial>"


ATTACKS = [Torques()]
