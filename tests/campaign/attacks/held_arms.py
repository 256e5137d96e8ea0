"""Arms whose way to a target that stands still is full of obstacles: they reach it, or come to rest."""

from __future__ import annotations

from typing import Any

import numpy as np

import beetle_ik as bik

from ..attack import Attack, BrokenError, Case

ARMS = ("panda", "iiwa14", "ur5e", "gen3")
RESTS_AFTER = 6.0  # s, and the time for which it then rests
RESTS_FOR = 4.0
REST = 1e-3  # rad/s
MARGIN = 0.005

HELD = """
obstacles = [bik.obstacles.Box(center=c, size=s) if s[0] > s[1] else
             bik.obstacles.Sphere(center=c, radius=s[0]) for c, s in zip(centers, sizes)]
tracker = bik.Tracker(robot, start, dt=dt, limits=limits, obstacles=obstacles,
                      margin=margin, self_collision=self_collision)
rates, statuses, clearances, way_back = [], [], [], 0
for tick in range(round(time / dt)):
    if again:
        tracker.obstacles = list(obstacles)
    step = tracker.step(target)
    rates.append(np.abs(step.qd).max())
    if rates[-1] > rest and step.message.startswith("on the way"):
        way_back = tick
    statuses.append(step.status)
    clearances.append(step.clearance)
"""


class HeldArms(Attack):
    name = "held_arms"
    promise = "An arm that is kept from a target at rest reaches it or comes to rest, and keeps the margin"
    page = "scenes"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A hard scene has round numbers, more obstacles, and is given again in every tick."""
        arm = bik.Robot.named(str(random.choice(ARMS)))
        low, high = np.maximum(arm.lower, -3.0), np.minimum(arm.upper, 3.0)
        start, end = random.uniform(low, high), random.uniform(low, high)
        count = int(random.integers(2, 12 if hard else 7))
        centers = random.uniform(-0.8, 0.8, (count, 3)) + np.array([0.0, 0.0, 0.5])
        sizes = random.uniform(0.05, 0.4, (count, 3))
        if hard and random.random() < 0.5:
            start, end, centers, sizes = (np.round(values, 1) for values in (start, end, centers, sizes + 0.05))
        kind = int(random.integers(3))
        return {
            "arm": arm.name,
            "start": tuple(np.clip(start, arm.lower, arm.upper).tolist()),
            "end": tuple(np.clip(end, arm.lower, arm.upper).tolist()),
            "obstacles": list(zip(map(tuple, centers.tolist()), map(tuple, sizes.tolist()), strict=True)),
            "position": bool(random.random() < 0.5),
            "limits": tuple({"velocity": 2.0, "acceleration": 10.0, "jerk": 100.0}.items())[: kind + 1],
            "dt": float(random.choice([0.002, 0.004, 0.01, 0.02, 1 / 30])),
            "self_collision": bool(random.random() < 0.3),
            "again": bool(hard and random.random() < 0.5),
        }

    def program(self, case: Case) -> str:
        limits = ", ".join(f"{name}={value}" for name, value in case["limits"])
        target = "robot.fk(end)[:3, 3]" if case["position"] else "robot.fk(end)"
        return (
            f"robot = bik.Robot.named('{case['arm']}').with_capsules(radius=0.05)\n"
            f"start, end = {case['start']}, {case['end']}\n"
            f"target, limits, margin, dt = {target}, bik.Limits({limits}), {MARGIN}, {case['dt']}\n"
            f"centers = {[center for center, _ in case['obstacles']]}\n"
            f"sizes = {[size for _, size in case['obstacles']]}\n"
            f"time, rest, again = {RESTS_AFTER + RESTS_FOR}, {REST}, {case['again']}\n"
            f"self_collision = {case['self_collision']}\n{HELD}"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        rates, statuses = np.array(left["rates"]), left["statuses"]
        if statuses[0] == bik.Status.IN_COLLISION:
            return 0  # it has to move out
        late = rates[left["way_back"] + round(RESTS_AFTER / case["dt"]) :]  # a way back takes its time
        if statuses[-1] != bik.Status.SOLVED and late.max(initial=0.0) > REST:
            raise BrokenError("a held arm moves on", {"rate": late.max(), "last": statuses[-1]})
        begun, nearest = left["clearances"][0], min(left["clearances"])
        if nearest < min(MARGIN, begun) - 1e-6:
            raise BrokenError("the margin is not kept", nearest)
        return len(rates)


ATTACKS = [HeldArms()]
