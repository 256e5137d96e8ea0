"""Torque limits of a tracker: targets that jump, payloads that change, limits at what holds the arm, dry friction."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import arms
from ..attack import Attack, BrokenError, Case
from .dynamics import body, urdf

AIMS = 5
TICKS = 60
RELATIVE = 1e-9
RESTS = 1e-12  # rad, m: a joint that moves less in a tick rests, but for rounding

TRACKED = """
hold = np.abs(robot.torques(q[0]))
limits = bik.Limits(velocity=2.0, acceleration={acceleration}, torque=np.maximum({share} * hold, {least}){jerk})
tracker = bik.Tracker(robot, q[0], dt={dt}, limits=limits)
commands, statuses, carried = [q[0], q[0]], [], []
for aim, mass in zip(q[1:], {masses}):
    if mass is not None:
        tracker.robot = robot.with_payload(mass)
    for tick in range({ticks}):
        step = tracker.step(robot.fk(aim) if tick < {fresh} else None)
        commands.append(step.q)
        statuses.append(step.status)
        carried.append(tracker.robot)
for _ in range(round(tracker.stop() / {dt}) + 2):
    step = tracker.step(None)
    commands.append(step.q)
    statuses.append(step.status)
    carried.append(tracker.robot)
"""


class TrackedTorques(Attack):
    """Round limits and others, also those that the arm at rest reaches, and payloads that are too heavy."""

    name = "tracked_torques"
    promise = "Commands of a tracker and the stop after them keep the torque limits at every tick"
    page = "dynamics"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        joints = arms.arm(random, hard, (1, 7))
        for joint in joints:
            joint["body"] = body(random, hard)
            joint["rub"] = tuple(map(float, random.choice([0.0, 0.0, 0.3, 1.0], 2)))
        arms.put(joints, random, hard, AIMS + 1)
        joints[-1]["body"] = body(random, False)
        changes = random.choice([None, None, 0.0, 0.5, 1.0, 3.0, 50.0 if hard else 2.0], AIMS).tolist()
        return {
            "joints": joints,
            "branch": [],
            "share": float(random.choice([1.0, 1.0, 1.1, 1.5, 3.0])),
            "least": float(random.choice([1e-3, 0.5, 1.0, 10.0, 50.0, 1e6])),
            "acceleration": float(random.choice([1.0, 5.0, 20.0, 200.0])),
            "jerk": float(random.choice([0.0, 0.0, 100.0, 2000.0])),
            "dt": float(random.choice([0.001, 0.002, 0.01, 0.02])),
            "masses": changes,
            "fresh": int(random.choice([1, TICKS // 2, TICKS])),
        }

    def program(self, case: Case) -> str:
        joints = case["joints"]
        given = case | {"jerk": f", jerk={case['jerk']}" if case["jerk"] else "", "ticks": TICKS}
        return (
            f'robot = bik.Robot.from_urdf("""{urdf(case)}""", tip="l{len(joints)}")\n'
            f"q = np.array({arms.configurations(joints).tolist()})\n" + TRACKED.format(**given)
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        q, dt, limit = np.array(left["commands"]), case["dt"], left["limits"].torque
        ulps = 32 * np.spacing(np.abs(q).max(axis=1) + 1.0)
        qd = np.diff(q, axis=0) / dt
        # A joint that moves by rounding alone rests: dry friction has no direction there.
        qd[np.abs(qd) <= np.maximum(ulps[1:, None], RESTS) / dt] = 0.0
        qdd = np.diff(qd, axis=0) / dt
        unknown, before = False, left["robot"]
        for i, (status, robot) in enumerate(zip(left["statuses"], left["carried"], strict=True)):
            # A payload may be more than the arm can hold, or stop with; the status says so until it can.
            unknown = (unknown or robot != before) and status.name in ("HELD_BY_TORQUE", "IN_COLLISION")
            before = robot
            if unknown:
                continue
            torques = np.abs(robot.torques(q[i + 2], qd[i + 1], qdd[i]))
            rounding = ulps[i + 2] / dt**2 * np.abs(robot.mass_matrix(q[i + 2])).sum()
            excess = (torques - limit * (1 + RELATIVE) - RELATIVE - rounding).max()
            if not excess <= 0:
                raise BrokenError("a torque is beyond its limit", {"tick": i, "excess": float(excess)})
        return len(q)

    def judge_refusal(self, case: Case, error: Exception) -> None:
        # Limits of no width leave no range, and a file without masses no torques.
        known = ("no dynamics", "moves no mass", "range", "limit", "equal", "joint", "mimic")
        if not any(word in str(error) for word in known):
            raise BrokenError("a right input was refused", error)


ATTACKS = [TrackedTorques()]
