"""Limits of the speed, acceleration and turn speed of tips, judged at samples by the kinematics of numpy."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import arms, typed
from ..attack import Attack, BrokenError, Case

KINDS = ("tip_speed", "tip_acceleration", "tip_turn_speed")
SAMPLES = 2000
RATED = (
    "velocity=1.0, acceleration=4.0",
    "velocity=2.0, acceleration=1.0, jerk=20.0",
    "velocity=5.0, acceleration=100.0",
)
CALLS = {
    "plan": "motion = bik.plan_point_to_point(robot, start_q=q[0], end_q=q[1], limits=limits).trajectory",
    "retime": "plan = bik.plan_point_to_point(robot, start_q=q[0], end_q=q[1], limits=free)\n"
    "motion = plan.retime(limits).trajectory",
    "timing": "motion = bik.time_optimal(q, limits, robot=robot)",
}
RELATIVE = 1e-7  # rounding of Jacobians by numpy
CHANGE = 1e-4  # of differences, at jumps of the acceleration
SLOWER = 1.02  # a looser limit may take this much longer


class TipLimits(Attack):
    """Round limits and others, of speeds that the motion has and of those that it never reaches."""

    name = "tip_limits"
    promise = "Limits of tips hold at every instant of plans and timings, and looser ones are not slower"
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        joints = arms.arm(random, hard, (2, 7))
        arms.put(joints, random, hard, 3)
        reach = 1.0 + max(float(np.abs(joint["xyz"]).max()) for joint in joints)
        scale = reach if hard else 1.0
        limits = [
            (
                str(kind),
                scale * (typed.number(random, -2, 1) if random.random() < 0.5 else float(random.uniform(0.05, 2.0))),
            )
            for kind in random.choice(KINDS, random.integers(1, 3), replace=False)
        ]
        call = str(random.choice(list(CALLS)))
        return {"joints": joints, "limits": limits, "call": call, "rated": int(random.integers(len(RATED)))}

    def program(self, case: Case) -> str:
        tips, looser = (
            ", ".join(f"{kind}={factor * limit!r}" for kind, limit in case["limits"]) for factor in (1.0, 2.0)
        )
        rated = RATED[case["rated"]]
        return "\n".join(
            [
                arms.written(case["joints"]),
                f"q = np.array({arms.configurations(case['joints']).tolist()!r})",
                f"free = bik.Limits({rated})",
                f"limits = bik.Limits({rated}, {looser})",
                CALLS[case["call"]],
                "faster = motion.duration",
                f"limits = bik.Limits({rated}, {tips})" if tips else "limits = free",
                CALLS[case["call"]],
            ]
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        motion = left["motion"]
        t = motion.duration * (np.arange(SAMPLES) + 0.5) / SAMPLES
        step = 1e-3 * motion.duration / SAMPLES
        here, before, after = (self._twists(case, motion, t + by) for by in (0.0, -step, step))
        found = {
            "tip_speed": np.linalg.norm(here[:, :3], axis=1).max(),
            "tip_acceleration": np.linalg.norm((after - before)[:, :3], axis=1).max() / (2 * step),
            "tip_turn_speed": np.linalg.norm(here[:, 3:], axis=1).max(),
        }
        for kind, limit in case["limits"]:
            slack = CHANGE if kind == "tip_acceleration" else RELATIVE
            if not found[kind] <= limit * (1.0 + slack):
                raise BrokenError("a tip is beyond its limit", (kind, float(found[kind]), limit))
        if left["faster"] > SLOWER * motion.duration:
            raise BrokenError("a looser limit is slower", (left["faster"], motion.duration))
        return SAMPLES

    def _twists(self, case: Case, motion: Any, t: np.ndarray) -> np.ndarray:
        q, qd, _ = motion.at(t)
        jacobians = arms.kinematics(case["joints"], q)[1]
        return np.einsum("mij,mj->mi", jacobians, qd)

    def judge_refusal(self, case: Case, error: Exception) -> None:
        # A joint that follows another may not fit its limits.
        known = ("same", "limit", "differ", "infinite", "duration", "long", "mimic joint")
        if not any(word in str(error) for word in known):
            raise BrokenError("a right input was refused", error)


ATTACKS = [TipLimits()]
