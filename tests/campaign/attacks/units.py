"""Degrees and millimetres, and honest values that are as large as those of machines get."""

from __future__ import annotations

from typing import Any

import numpy as np

import beetle_ik as bik

from ..attack import Attack, BrokenError, Case

NAMES = ("ur5e", "ur10", "kr210", "panda", "fr3", "iiwa14", "hydraulic3")
TURN = 2 * np.pi
FAR = 40.0  # degrees outside the limits that no joint is by turns
RIGHT_ANGLES = (0.0, 45.0, 90.0, -90.0, 180.0, -180.0, 30.0, -60.0, 120.0)


class Units(Attack):
    name = "units"
    promise = "Degrees for radians and millimetres for metres warn once, and honest values do not"
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A hard case has round values, such as right angles and joints at their limits."""
        name = str(random.choice(NAMES))
        robot = bik.Robot.named(name)
        lower, upper = np.clip(robot.lower, -TURN, TURN), np.clip(robot.upper, -TURN, TURN)
        q = random.uniform(lower, upper)
        if hard:
            ends = np.where(random.random(len(q)) < 0.5, lower, upper)
            right = np.clip(np.radians(random.choice(RIGHT_ANGLES, len(q))), lower, upper)
            q = np.choose(random.choice(3, len(q)), [ends, right, q])
        wrong = bool(random.random() < 0.5)
        kind = str(random.choice(["q", "target", "rpy", "rotvec", "obstacle"]))
        return {"name": name, "kind": kind, "wrong": wrong, "call": _call(random, robot, q, kind, wrong, hard)}

    def program(self, case: Case) -> str:
        return (
            f"import warnings\n\nrobot = bik.Robot.named({case['name']!r}).with_capsules(radius=0.05)\n"
            "with warnings.catch_warnings(record=True) as caught:\n"
            "    warnings.simplefilter('always')\n"
            f"    {case['call']}\n"
            "said = [str(each.message) for each in caught if each.category is bik.UnitsWarning]"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        said = left["said"]
        if case["wrong"] and len(said) != 1:
            raise BrokenError("a value in another unit does not warn once", case["call"])
        if not case["wrong"] and said:
            raise BrokenError("an honest value warns", said)
        return 1


def _call(random: np.random.Generator, robot: bik.Robot, q: np.ndarray, kind: str, wrong: bool, hard: bool) -> str:
    """Returns a call with a value of this kind, in the wrong unit or not."""
    place = robot.fk(q)[:3, 3]
    reach = float(np.linalg.norm(robot.fk(np.zeros(len(q)))[:3, 3])) + 0.5
    away = random.normal(size=3)
    away /= np.linalg.norm(away)
    match kind:
        case "q" if wrong:
            degrees = np.degrees(q).round(0 if hard else 2)
            joint = int(random.integers(len(q)))
            degrees[joint] = np.ceil(np.degrees(max(robot.upper[joint], 0.0)) + FAR)
            return f"robot.fk({degrees.tolist()})"
        case "q":
            turns = TURN * random.integers(-2, 3, len(q)) if hard else 0.0
            return f"robot.fk({(q + turns).tolist()})"
        case "target":
            beyond = random.uniform(0, 3.0) * (reach if hard else 1.0)
            target = 1e3 * np.add(place, (0.0, 0.0, 0.3)) if wrong else place + beyond * away
            if wrong and np.linalg.norm(target) < 200.0 * max(reach, 1.0):
                target = np.array([0.0, 500.0 * max(reach, 1.0), 0.0])
            return f"bik.solve(robot, {target.tolist()}, stop=bik.Stop(max_evaluations=50))"
        case "obstacle":
            near = place + (reach + random.uniform(0, 10)) * away
            center = np.array([0.0, 800.0 * max(reach, 1.0), 0.0]) if wrong else near
            sphere = f"bik.obstacles.Sphere({tuple(center.tolist())}, {50.0 if wrong else 0.05})"
            return f"bik.obstacles.clearance(robot, {q.tolist()}, [{sphere}])"
        case _:
            if wrong:
                angles = random.choice(RIGHT_ANGLES, 3)
                angles[int(random.integers(3))] = float(random.choice([90.0, 180.0, -45.0]))
            else:
                angles = random.uniform(-np.pi, np.pi, 3)
                if hard:
                    angles = np.array([*np.radians(random.choice(RIGHT_ANGLES, 2)), random.uniform(-100, 100)])
                    angles = angles / 3.0 if kind == "rotvec" else angles
            return f"bik.pose([0, 0, 0], {kind}={angles.tolist()})"


ATTACKS = [Units()]
