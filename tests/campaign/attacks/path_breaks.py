"""Paths of a planar arm through positions that it reaches or not, followed with breaks."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from ..attack import Attack, BrokenError, Case

SAMPLES = 2001
ACCURACY = 2e-3  # m
OFF = 1.01 * ACCURACY
AT_LIMIT = 1e-9


class PathBreaks(Attack):
    """Round and other lengths and limits, points on circles at which a joint is straight or at its limit."""

    name = "path_breaks"
    promise = "Between its breaks a plan follows the path, within its limits, and what can be followed has no break"
    page = "planning"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        count = 2 if hard else int(random.integers(2, 4))
        links = [
            (float(random.choice([0.5, 1.0])), float(random.choice([0.5, 1.0, 2.0, 3.0])) if hard else 3.0)
            for _ in range(count)
        ]
        reach = sum(length for length, _ in links)
        around = [float(a) for a in np.sort(random.uniform(-3.0, 3.0, 6))]
        if random.random() < 0.5:
            around = [round(a * 4 / np.pi) * np.pi / 4 for a in around]
        radii = [float(reach * random.choice([0.5, 0.75, 0.9, 1.0, random.uniform(0.2, 1.1)])) for _ in around]
        return {"links": links, "points": list(zip(radii, around, strict=True)), "jerk": bool(random.random() < 0.3)}

    def program(self, case: Case) -> str:
        points = [[r * float(np.cos(a)), r * float(np.sin(a)), 0.0] for r, a in case["points"]]
        spans = [span for _, span in case["links"]]
        jerk = ", jerk=100.0" if case["jerk"] else ""
        limits = f"bik.Limits(velocity=2.0, acceleration=10.0{jerk}, lower={[-s for s in spans]!r}, upper={spans!r})"
        return "\n".join(
            [
                f"robot = bik.Robot.planar({[length for length, _ in case['links']]!r})",
                f"points = np.array({points!r})",
                f"limits = {limits}",
                f"plan = bik.plan_along_path(robot, points, limits=limits, accuracy={ACCURACY}, breaks=True)",
                "try:",
                f"    plain = bik.plan_along_path(robot, points, limits=limits, accuracy={ACCURACY})",
                "except bik.InvalidInputError:",
                "    plain = None",
            ]
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        plan, plain, points = left["plan"], left["plain"], left["points"]
        if plain is not None and plain.success and plan.breaks:
            raise BrokenError("a path that can be followed has a break", plan.breaks)
        if not plan.success:
            return 0
        motion = plan.trajectory
        t = np.linspace(0.0, motion.duration, SAMPLES)
        q, qd, _ = motion.at(t)
        spans = np.array([span for _, span in case["links"]])
        if (np.abs(q) > spans + AT_LIMIT).any() or (np.abs(qd) > 2.0 + AT_LIMIT).any():
            raise BrokenError("a joint is beyond its limit", np.abs(q).max(axis=0))
        angles = np.cumsum(q, axis=1)
        lengths = np.array([length for length, _ in case["links"]])
        tips = np.stack([np.cos(angles) @ lengths, np.sin(angles) @ lengths], axis=1)
        away = np.zeros(SAMPLES, dtype=bool)
        for each in plan.breaks:
            away |= (each.start < t) & (t < each.end)
            if not each.reason:
                raise BrokenError("a break has no reason", each)
        ends = points[:, :2]
        off = np.min([_distance(tips, a, b) for a, b in itertools.pairwise(ends)], axis=0)
        if off[~away].max(initial=0.0) > OFF:
            raise BrokenError("the tip leaves the path between breaks", float(off[~away].max()))
        return SAMPLES

    def judge_refusal(self, case: Case, error: Exception) -> None:
        if not any(word in str(error) for word in ("cannot be reached", "was not found", "repeats")):
            raise BrokenError("a right input was refused", error)


def _distance(tips: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    way = b - a
    share = np.clip((tips - a) @ way / (way @ way), 0.0, 1.0)
    return np.asarray(np.linalg.norm(tips - a - share[:, None] * way, axis=1))


ATTACKS = [PathBreaks()]
