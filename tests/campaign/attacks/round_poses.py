"""Poses that an arm surely has: of zeros, right angles, joints at limits or locked, and of nearly structured arms."""

from __future__ import annotations

from typing import Any

import numpy as np

import beetle_ik as bik

from ..arms import Array
from ..attack import Attack, BrokenError, Case

RIGHT = np.pi / 2
NAMES = ("ur5e", "ur10", "kr210", "ur3e", "panda", "fr3", "iiwa14", "iiwa7", "gen3")
WIDTHS = (np.pi, 2 * np.pi, 2.9, 3.14, 6.28)
POSES = 16
# Rows a, d and alpha of standard Denavit-Hartenberg tables.
ARMS = {
    "three parallel": ([0, -0.425, -0.392, 0, 0, 0], [0.16, 0, 0, 0.13, 0.1, 0.1], [RIGHT, 0, 0, RIGHT, -RIGHT, 0]),
    "spherical wrist": ([0.1, 0.5, 0, 0, 0, 0], [0.4, 0, 0.1, 0.5, 0, 0.1], [RIGHT, 0, RIGHT, -RIGHT, RIGHT, 0]),
    "five joints": ([0.03, 0.155, 0.135, 0, 0], [0.147, 0, 0, 0, 0.2175], [RIGHT, 0, 0, RIGHT, 0]),
    "arm angle": ([0] * 7, [0.34, 0, 0.4, 0, 0.4, 0, 0.12], [-RIGHT, RIGHT, RIGHT, -RIGHT, -RIGHT, RIGHT, 0]),
    "spherical shoulder": (
        [0, 0, 0.08, -0.08, 0, 0.088, 0],
        [0.33, 0, 0.316, 0, 0.384, 0, 0.1],
        [-RIGHT, RIGHT, RIGHT, -RIGHT, RIGHT, RIGHT, 0],
    ),
}


def structured(random: np.random.Generator) -> list[list[float]]:
    """Rows a, d, alpha of a table: one of `ARMS`, or random with right angles; half of them off by 1e-16 to 1e-2."""
    if random.random() < 0.7:
        rows = np.array(ARMS[str(random.choice(list(ARMS)))], dtype=float)
    else:
        n = int(random.integers(4, 8))
        lengths = random.uniform(-0.5, 0.5, (2, n)) * (random.random((2, n)) < 0.6)
        rows = np.vstack((lengths, random.choice([0.0, RIGHT, -RIGHT, np.pi], n)))
    if random.random() < 0.5:
        off = random.normal(size=rows.shape) * 10.0 ** random.uniform(-16, -2)
        rows = rows + np.where(random.random(rows.shape) < random.choice([0.1, 0.3, 1.0]), off, 0.0)
    return rows.tolist()


def window(random: np.random.Generator, lower: Array, upper: Array) -> tuple[Array, Array]:
    """Limits within others: 1 to 100 % of their width, often about a round angle; some joints are locked, or nearly."""
    n = len(lower)
    width = (upper - lower) * (random.uniform(0.01, 1.0, n) if random.random() < 0.5 else random.uniform(0.01, 1.0))
    centre = np.where(random.random(n) < 0.5, round_angles(random, n), random.uniform(lower, upper))
    centre = np.clip(centre, lower, upper)
    below = np.where(random.random(n) < 0.2, random.integers(0, 2, n), random.random(n))
    low, high = np.maximum(lower, centre - below * width), np.minimum(upper, centre + (1.0 - below) * width)
    locked = random.random(n) < random.choice([0.0, 0.0, 0.2])
    slack = np.where(random.random(n) < 0.5, 0.0, 10.0 ** random.uniform(-16, -6, n))
    return np.where(locked, centre, low), np.where(locked, np.minimum(centre + slack, upper), high)


def round_angles(random: np.random.Generator, n: int) -> Array:
    """Whole, half and quarter turns (n,), some of them off by 1e-16 to 1e-2."""
    off = random.choice([-1.0, 1.0], n) * 10.0 ** random.uniform(-16, -2, n)
    return random.choice([0.0, RIGHT, -RIGHT, np.pi, -np.pi], n) + np.where(random.random(n) < 0.6, 0.0, off)


class RoundPoses(Attack):
    name = "round_poses"
    promise = (
        "A pose of a configuration inside the limits is not called out of reach, "
        "nor an empty set of its solutions complete"
    )
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """An easy case has configurations anywhere inside the limits, a hard one round angles and joints at limits."""
        name = str(random.choice(NAMES)) if random.random() < 0.6 else None
        rows = None if name else structured(random)
        if name:
            robot = bik.Robot.named(name)
            lower, upper = np.clip(robot.lower, -6.3, 6.3), np.clip(robot.upper, -6.3, 6.3)
        else:
            width = np.full(len(rows[0]), float(random.choice(WIDTHS)))
            lower, upper = -width, width
        if random.random() < 0.7:
            lower, upper = window(random, lower, upper)
        q = random.uniform(lower, upper, (POSES, len(lower)))
        if hard:
            ends = np.where(random.random(q.shape) < 0.5, lower, upper)
            angles = np.array([round_angles(random, len(lower)) for _ in q])
            q = np.choose(random.choice(3, q.shape, p=[0.4, 0.35, 0.25]), [q, np.clip(angles, lower, upper), ends])
        joints = tuple(zip(lower.tolist(), upper.tolist(), strict=True))
        return {"name": name, "rows": tuple(map(tuple, rows or ())), "joints": joints, "q": q.tolist()}

    def program(self, case: Case) -> str:
        lower, upper = (list(ends) for ends in zip(*case["joints"], strict=True))
        if case["name"]:
            made = f"robot = bik.Robot.named({case['name']!r}).with_limits(lower={lower}, upper={upper})\n"
        else:
            a, d, alpha = map(list, case["rows"])
            table = f"a={a}, d={d}, alpha={alpha}, convention='standard'"
            made = f"robot = bik.Robot.from_dh({table}, lower={lower}, upper={upper})\n"
        return (
            f"{made}poses = robot.fk(np.array({case['q']}).reshape(-1, robot.dof))\n"
            "statuses = bik.solve_batch(robot, poses, threads=1).status\n"
            "sets = [bik.solve_all(robot, pose) for pose in poses[:2]]"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        called = np.flatnonzero(np.asarray(left["statuses"]) == bik.Status.OUT_OF_REACH)
        if len(called):
            raise BrokenError("a pose that the arm has is called out of reach", case["q"][called[0]])
        for q, found in zip(case["q"], left["sets"], strict=False):
            if found.complete and len(found) == 0:
                raise BrokenError("an empty set is called complete", q)
        return len(case["q"])


ATTACKS = [RoundPoses()]
