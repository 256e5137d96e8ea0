"""Doors to other libraries: calls in degrees on any arm, and arms led by twists."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import arms
from ..attack import Attack, BrokenError, Case

SLACK = 1e-6  # of a limit
SEEN = 1e-9  # rad or m
MET = 1e-6  # m or rad, the tolerance of the calls

CALLED = """
from beetle_ik.interop.lerobot import RobotKinematics

kinematics = RobotKinematics(urdf, tip, joint_names=names)
target = kinematics.forward_kinematics(goal)
aim = target.copy()
aim[:3, :3] = bik.pose([0, 0, 0], rotvec=turn)[:3, :3] @ aim[:3, :3]
aim[:3, 3] += shift
found = kinematics.inverse_kinematics(current, aim, *weights)
result = kinematics.result
"""

LED = """
from beetle_ik.interop.teleop import TwistTracker

robot = bik.Robot.named(name)
start = robot.clip(robot.random_configurations(1, seed=seed)[0])
jog = TwistTracker(robot, start, dt=dt, frame=frame, limits=bik.Limits(velocity=speed, acceleration=rate))
q = [start]
for twist, count in twists:
    for _ in range(count):
        q.append(jog.step(twist).q)
for _ in range(rest):
    q.append(jog.step(None).q)
lower, upper = robot.lower, robot.upper
"""


class CallsInDegrees(Attack):
    name = "calls_in_degrees"
    promise = "The door of LeRobot keeps limits and other entries, and its result is what the arm has reached"
    page = "doors"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard cases have deformed arms, zero and extreme weights, and poses far out of reach."""
        joints = arms.arm(random, hard, (2, 7))
        arms.put(joints, random, hard, 2)
        weight = [0.0, 0.01, 0.1, 0.5, 1.0, 100.0] if hard else [0.01, 1.0]
        weights = tuple(float(random.choice(weight)) for _ in range(2))
        return {
            "joints": joints,
            "turn": arms.triple(random.choice([0.0, 0.1, np.pi]) * random.normal(size=3)),
            "shift": arms.triple(random.choice([0.0, 0.01, 10.0 if hard else 0.1]) * random.normal(size=3)),
            "weights": weights if any(weights) else (1.0, 0.01),
            "gripper": float(random.choice([0.0, 55.5, -1e9])),
            "order": int(random.integers(100)),
        }

    def program(self, case: Case) -> str:
        free = arms.free(case["joints"])
        names = [f"lj{i}" for i, joint in enumerate(case["joints"]) if joint in free]
        order = np.random.default_rng(case["order"]).permutation(len(names))
        turns = np.array([joint["kind"] != "prismatic" for joint in free])
        current, goal = (np.where(turns, np.degrees(q), q)[order].tolist() for q in arms.configurations(case["joints"]))
        return (
            f'urdf, tip = """{arms.urdf(case["joints"])}""", "l{len(case["joints"])}"\n'
            f"names = {[names[i] for i in order]}\ncurrent, goal = {[*current, case['gripper']]}, {goal}\n"
            f"turn, shift, weights = {case['turn']}, {case['shift']}, {case['weights']}\n{CALLED}"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        found, result = left["found"], left["result"]
        free = arms.free(case["joints"])
        if found[-1] != case["gripper"]:
            raise BrokenError("the gripper is not passed through", found[-1])
        order = np.random.default_rng(case["order"]).permutation(len(free))
        q = np.empty(len(free))
        q[order] = found[:-1]
        q = np.where([joint["kind"] != "prismatic" for joint in free], np.radians(q), q)
        lower, upper = arms.bounds(case["joints"])
        if not (np.all(q >= lower - SEEN) and np.all(q <= upper + SEEN)):
            raise BrokenError("q is outside the limits", q.tolist())
        far = float(np.linalg.norm(arms.kinematics(case["joints"], q[None])[0][0, :3, 3] - left["aim"][:3, 3]))
        # Degrees round the angles, and a long arm enlarges that.
        rounding = SEEN * (1.0 + far) + 1e-15 * np.abs(q).max() * np.linalg.norm(left["aim"][:3, 3])
        if np.isfinite(result.position_error) and abs(far - result.position_error) > rounding:
            raise BrokenError("position_error is not the error", (far, result.position_error))
        if result.success and case["weights"][0] > 0.0 and far > 2.0 * MET:
            raise BrokenError("success without the place", far)
        return 1


class LedByTwists(Attack):
    name = "led_by_twists"
    promise = "An arm led by twists keeps position, velocity and acceleration limits, and stops when nothing comes"
    page = "doors"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard twists are fast, begin and end at once, and lead into limits and singular configurations."""
        sizes = [0.0, 0.1, 1.0, 10.0] if hard else [0.05, 0.2]
        twists = []
        for _ in range(int(random.integers(2, 8))):
            twist = float(random.choice(sizes)) * np.where(random.random(6) < 0.4, random.normal(size=6), 0.0)
            silent = hard and random.random() < 0.2
            twists.append((None if silent else tuple(twist.tolist()), int(random.integers(1, 120))))
        return {
            "name": str(random.choice(["ur5e", "panda", "iiwa14"])),
            "seed": int(random.integers(1000)),
            "dt": float(random.choice([0.004, 0.01, 0.02])),
            "frame": str(random.choice(["base", "tip"])),
            "speed": float(random.choice([0.5, 1.0, 2.0])),
            "rate": float(random.choice([2.0, 5.0, 20.0])),
            "twists": twists,
        }

    def program(self, case: Case) -> str:
        rest = round((0.2 + 2.0 * case["speed"] / case["rate"]) / case["dt"]) + 20
        given = "".join(f"{key} = {value!r}\n" for key, value in case.items())
        return f"{given}rest = {rest}\n{LED}"

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        q = np.array(left["q"])
        qd = np.diff(q, axis=0) / case["dt"]
        qdd = np.diff(qd, axis=0, prepend=0.0) / case["dt"]
        if np.abs(qd).max() > case["speed"] * (1.0 + SLACK):
            raise BrokenError("the velocity is beyond its limit", np.abs(qd).max())
        if np.abs(qdd).max() > case["rate"] * (1.0 + SLACK) + SEEN / case["dt"] ** 2:
            raise BrokenError("the acceleration is beyond its limit", np.abs(qdd).max())
        if np.any(q < left["lower"] - SEEN) or np.any(q > left["upper"] + SEEN):
            raise BrokenError("a command is outside the position limits")
        if np.abs(qd[-1]).max() > SEEN / case["dt"]:
            raise BrokenError("the arm does not stop", qd[-1].tolist())
        return len(q)


ATTACKS = [CallsInDegrees(), LedByTwists()]
