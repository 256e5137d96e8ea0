"""Weights of joints: which joints move, not whether a target is reached."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import arms
from ..attack import Attack, BrokenError, Case
from .solving import ROUNDING, TOLERANCE

MOST = 1e8  # ratio of two weights: larger ones count as this

PROGRAM = """solution = bik.solve(robot, target, start_q=start, joint_weights=weights)
plain = bik.solve(robot, target, start_q=start)
limits = bik.Limits(velocity=1.0)
trackers = [bik.Tracker(robot, start, dt=0.01, limits=limits, joint_weights=one) for one in (weights, None)]
ends = []
for tracker in trackers:
    for k in range(1, 1001):
        near = robot.fk(start)[:3, 3] + min(k / 30, 1.0) * np.array(by)
        step = tracker.step(near)
        if k >= 400 and not step.message.startswith("on the way"):  # a way back takes the time that its joints need
            break
    ends.append(step)
"""


class JointWeights(Attack):
    name = "joint_weights"
    promise = "Weights of joints choose which joints move: what is reached without them is reached with them"
    page = "mobile_bases"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard cases have weights from 1e-3 to 1e6, arms that are singular, and configurations at limits."""
        joints = arms.arm(random, False, (3, 9))
        arms.put(joints, random, hard, 2)
        for joint in joints:
            weights = [1e-3, 1.0, 1.0, 10.0, 1e3, 1e6] if hard else [1.0, 1.0, 2.0, 10.0, 100.0]
            joint["weight"] = float(random.choice(weights))
        by = arms.triple(random.normal(size=3) * float(random.choice([1e-3, 0.01, 0.05])))
        return {"joints": joints, "by": by, "pose": bool(random.random() < 0.5)}

    @staticmethod
    def weights(case: Case) -> np.ndarray:
        return np.array([joint["weight"] for joint in arms.free(case["joints"])])

    def program(self, case: Case) -> str:
        start, goal = arms.configurations(case["joints"])
        pose = arms.kinematics(case["joints"], goal[None])[0][0]
        target = pose if case["pose"] else pose[:3, 3]
        return (
            f"{arms.written(case['joints'])}start, by = {start.tolist()}, {list(case['by'])}\n"
            f"target, weights = np.array({target.tolist()}), {self.weights(case).tolist()}\n{PROGRAM}"
        )

    @staticmethod
    def open(case: Case, solution: Any) -> float:
        """How far the tolerance of a target leaves the joints undetermined: far where the arm is nearly singular."""
        jacobian = arms.kinematics(case["joints"], solution.q[None])[1][0]
        least = np.linalg.svd(jacobian if case["pose"] else jacobian[:3], compute_uv=False).min()
        return max(1e-6, min(TOLERANCE / max(least, TOLERANCE), (2.0 * TOLERANCE) ** 0.5))

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        solution, plain, weights = left["solution"], left["plain"], self.weights(case)
        start, goal = arms.configurations(case["joints"])
        lower, upper = arms.bounds(case["joints"])
        if np.maximum(lower - solution.q, solution.q - upper).max() > ROUNDING:
            raise BrokenError("q is outside the limits", solution.q.tolist())
        found, wanted = (arms.kinematics(case["joints"], q[None])[0] for q in (solution.q, goal))
        away, angle = arms.pose_error(found, wanted[0])
        missed = max(away[0], angle[0]) if case["pose"] else away[0]
        if solution.success and missed > TOLERANCE + 10.0 * ROUNDING:
            raise BrokenError("solved, but not within the tolerance", missed)
        if plain.success and not solution.success:
            raise BrokenError("with weights the target is missed", solution.message)
        weights = np.minimum(weights / weights.min(), MOST)
        length, without = (np.linalg.norm(weights * (one.q - start)) for one in (solution, plain))
        most = without * (1.0 + 1e-6) + self.open(case, plain) * weights.max()
        if plain.success and plain.restarts == 0 and length > most:
            raise BrokenError("the solution without weights is nearer by the weights", (length, without))
        weighted, unweighted = left["ends"]
        on_its_way = weighted.message.startswith("nearer")
        if unweighted.success and not (weighted.success or on_its_way) and weighted.position_error > 1e-3:
            raise BrokenError("with weights the tracker stays away", weighted.message)
        return 2

    def judge_refusal(self, case: Case, error: Exception) -> None:
        raise BrokenError("a right input is refused", error)


ATTACKS = [JointWeights()]
