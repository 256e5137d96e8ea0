"""Torques, mass matrices and accelerations of random trees, and postures of little torque, against Pinocchio."""

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


class CheapPostures(Attack):
    name = "cheap_postures"
    promise = "The goal LeastTorque leaves the tip in place and never raises the torque, as Pinocchio has it"
    page = "dynamics"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        case = Torques().draw(random, hard)
        scale = random.choice([1.0, 10.0, 1e-3 if hard else 5.0, np.inf, random.uniform(1, 100)], 9)
        scale[0] = min(scale[0], 10.0)
        weight = float(random.choice([1.0, 1e-6 if hard else 2.0, 1e6 if hard else 0.5]))
        gravity = arms.triple(random.choice([0.0, -9.81, random.normal()], 3))
        return case | {"scale": list(map(float, scale)), "weight": weight, "gravity": gravity}

    def program(self, case: Case) -> str:
        joints, count = case["joints"], len(arms.free(case["joints"]))
        scale = ", ".join("np.inf" if np.isinf(value) else repr(value) for value in case["scale"][:count])
        return (
            f'robot = bik.Robot.from_urdf("""{urdf(case)}""", tip="l{len(joints)}").with_gravity({case["gravity"]})\n'
            f"qs = robot.clip(np.array({arms.configurations(joints).tolist()}))\n"
            f"goal = bik.goals.LeastTorque(relative_to=[{scale}], weight={case['weight']!r})\n"
            "task, places = bik.tasks.Position(), robot.fk(qs)[:, :3, 3]\n"
            "found = [bik.solve(robot, p, task=task, start_q=q, goals=goal) for p, q in zip(places, qs)]"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        from dynamics_oracle import DynamicsOracle

        robot = left["robot"]
        pinocchio = DynamicsOracle(urdf(case), robot)
        scale, rest = np.array(case["scale"][: robot.dof]), np.zeros(robot.dof)
        for q, place, found in zip(left["qs"], left["places"], left["found"], strict=True):
            if not found.success:
                raise BrokenError("a start on its target is left for no solution", found.message)
            off = np.linalg.norm(robot.fk(found.q)[:3, 3] - place)
            if not off < 2e-6:
                raise BrokenError("the tip left its place", off)
            before, after = (np.sum((pinocchio.torques(x, rest, rest) / scale) ** 2) for x in (q, found.q))
            if not after <= before * (1 + 1e-9) + 1e-12:
                raise BrokenError("the torque rose", after / before - 1)
        return len(left["qs"])


class CentersOfMass(Attack):
    name = "centers_of_mass"
    promise = "A target of the centre of mass is met where it is said to be, by the errors that Pinocchio finds"
    page = "several_tips"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        shared = arms.easy_arm(random, 1)
        left, right = (arms.easy_arm(random, int(random.integers(1 if hard else 3, 7))) for _ in range(2))
        for joint in (*shared, *left, *right):
            joint["body"], joint["rub"] = body(random, hard), (0.0, 0.0)
        for joints in (shared, left, right):
            joints[-1]["body"] = body(random, False)
            arms.put(joints, random, hard)
        weights = random.choice([1.0, 1.0, 0.0, 0.3], 3)
        weights[2] = max(weights[2], float(not weights.any()))
        return {
            "joints": [*shared, *left],
            "branch": right,
            "offset": arms.triple(random.choice([0.0, 0.0, 0.1, 1.0, random.normal()], 3)),
            "weights": arms.triple(weights),
            "level": int(random.choice([0, 1])),
            "begin": bool(random.random() < 0.5),
        }

    def program(self, case: Case) -> str:
        tips = [f"l{len(case['joints'])}", f"a{len(case['branch'])}"]
        q = np.concatenate([arms.configurations(joints)[0] for joints in (case["joints"], case["branch"])])
        start = "q" if case["begin"] else "0.9 * q"
        return (
            f'robot = bik.Robot.from_urdf("""{urdf(case)}""", tip={tips})\n'
            f"q = robot.clip(np.array({q.tolist()}))\n"
            f"center = robot.center_of_mass(q) + np.array({list(case['offset'])})\n"
            f"task = {{'center_of_mass': bik.tasks.Position(weights={case['weights']}, level={case['level']})}}\n"
            f"targets = {{{tips[0]!r}: robot.fk(q)[0, :3, 3], 'center_of_mass': center}}\n"
            f"found = bik.solve(robot, targets, task=task, start_q=robot.clip({start}))"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        from dynamics_oracle import DynamicsOracle

        found, robot, weights = left["found"], left["robot"], np.array(case["weights"])
        away = DynamicsOracle(urdf(case), robot).center_of_mass(found.q) - left["center"]
        error = float(np.linalg.norm(away[weights > 0.0]))
        if not abs(error - found.errors["center_of_mass"][0]) < 1e-8 * (1 + error):
            raise BrokenError("the error of the centre differs", (error, found.errors["center_of_mass"][0]))
        if found.success and not error < 1e-6 + 1e-8:
            raise BrokenError("solved, but the centre is elsewhere", error)
        if case["begin"] and not any(case["offset"]) and not found.success:
            raise BrokenError("a start on its targets is left for no solution", found.message)
        return 1


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


ATTACKS = [Torques(), CheapPostures(), CentersOfMass()]
