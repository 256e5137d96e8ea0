"""What a plan keeps on the way, judged at samples of the timed motion by numpy and scipy."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import arms
from ..attack import Attack, BrokenError, Case

Array = NDArray[np.float64]
KINDS = ("tilt", "place", "turn", "region")
LIMITS = ("velocity=1.0", "velocity=1.0, acceleration=4.0", "velocity=1.0, acceleration=4.0, jerk=40.0")
SAMPLES = 1000
LEAST = 1e-3  # tolerance (rad, m) of what both ends have in common
ROUNDING = 1e-7


def measured(keep: dict[str, Any], poses: Array) -> Array:
    """Errors (m, entries) of a constraint at poses (m, 4, 4)."""
    target = np.reshape(keep["pose"], (4, 4))
    if keep["kind"] == "tilt":
        one, other = poses[:, :3, :3] @ keep["axis"], target[:3, :3] @ keep["axis"]
        angle = np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), one @ other)
        return angle[:, None]
    if keep["kind"] == "turn":
        from scipy.spatial.transform import Rotation

        turned = np.einsum("ji,mjk->mik", target[:3, :3], poses[:, :3, :3])
        return np.abs(Rotation.from_matrix(turned).as_rotvec())
    return np.abs((poses[:, :3, 3] - target[:3, 3]) @ (np.eye(3) if keep["kind"] == "region" else target[:3, :3]))


class KeptMotions(Attack):
    """Constraints about the start of a motion; the end is within them, just so, or a little outside."""

    name = "kept_motions"
    promise = "What a plan keeps holds at every instant, and the errors that it tells are bounds"
    page = "what_must_hold"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        joints = arms.arm(random, hard, (2, 7))
        arms.put(joints, random, hard, 2)
        poses = arms.kinematics(joints, arms.configurations(joints))[0]
        keeps = [self._drawn(random, poses) for _ in range(random.integers(1, 4))]
        return {
            "joints": joints,
            "keeps": keeps,
            "limits": int(random.integers(3)),
            "retime": bool(random.random() < 0.3),
        }

    def _drawn(self, random: np.random.Generator, poses: Array) -> dict[str, Any]:
        axis = np.eye(3)[random.integers(3)] if random.random() < 0.5 else random.normal(size=3)
        keep: dict[str, Any] = {
            "kind": str(random.choice(KINDS)),
            "pose": tuple(poses[0].ravel().tolist()),
            "axis": arms.triple(axis / np.linalg.norm(axis)),
            "free": tuple(bool(free) for free in random.random(3) < 0.3),
        }
        at_end = measured(keep, poses[1:])[0]
        factor = float(random.choice([1.0, 1.0 + 1e-8, 1.1, 2.0, 0.9]))
        keep["tolerance"] = tuple(np.maximum(factor * at_end, LEAST).tolist())
        return keep

    def program(self, case: Case) -> str:
        lines = [
            arms.written(case["joints"]),
            f"q = np.array({arms.configurations(case['joints']).tolist()!r})",
            "keeps = []",
        ]
        for keep in case["keeps"]:
            entries = [
                np.inf if free else most for free, most in zip(keep["free"], keep["tolerance"] * 3, strict=False)
            ]
            target = f"np.reshape({keep['pose']!r}, (4, 4))"
            if keep["kind"] == "tilt":
                most = [np.inf] * 3 + [min(keep["tolerance"][0], float(np.pi))]
                task = f"bik.tasks.Pointing(axis={keep['axis']!r}, tolerance={most!r})"
            elif keep["kind"] == "turn":
                task = f"bik.tasks.Orientation(tolerance={entries!r})"
            elif keep["kind"] == "place":
                task = f"bik.tasks.Pose(tolerance={[*entries, np.inf, np.inf, np.inf]!r})"
            else:
                place, size = np.reshape(keep["pose"], (4, 4))[:3, 3], np.array(keep["tolerance"])
                corners = [(place - size).tolist(), (place + size).tolist()]
                task = f"bik.tasks.Position(tolerance=[inf] * 3, region={corners!r})"
            lines.append(f"keeps.append(bik.Keep({target}, {task}))")
        lines.append(
            f"limits, stop = bik.Limits({LIMITS[case['limits']]}), bik.Stop(max_evaluations=20000)\n"
            "given = dict(start_q=q[0], end_q=q[1], keep=keeps, limits=limits, stop=stop)\n"
            "plan = bik.plan_point_to_point(robot, self_collision=False, **given)"
        )
        if case["retime"]:
            lines.append("plan = plan.retime(bik.Limits(velocity=0.5, acceleration=2.0)) if plan.success else plan")
        lines.append("told = [largest for _, largest in plan.kept]")
        return "\n".join(lines)

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        plan = left["plan"]
        if len(left["told"]) != len(case["keeps"]):
            raise BrokenError("a constraint is missing", left["told"])
        if plan.success and plan.violations:
            raise BrokenError("a plan that breaks something is called a success", plan.violations)
        if not plan.success:
            if "impossible" in plan.message:
                raise BrokenError("a plan that was not found is called impossible", plan.message)
            return 1
        motion = plan.trajectory
        poses = arms.kinematics(case["joints"], motion.at(np.linspace(0.0, motion.duration, SAMPLES))[0])[0]
        size = 1.0 + np.abs(poses[:, :3, 3]).max()
        for keep, told in zip(case["keeps"], left["told"], strict=True):
            found, most = measured(keep, poses).max(axis=0), np.array(keep["tolerance"])
            limited = ~np.array(keep["free"]) if keep["kind"] in ("turn", "place") else np.ones(len(found), bool)
            if keep["kind"] == "tilt":
                most, said = np.minimum(most[:1], np.pi), told[3:]
            else:
                said = told[:3]
            beyond = found - most * (1.0 + 1e-6) - ROUNDING * size
            if (beyond[limited] > 0.0).any():
                raise BrokenError("a plan leaves its tolerance", (keep["kind"], found.tolist(), most.tolist()))
            if keep["kind"] != "region" and (said[limited] < found[limited] - ROUNDING * size).any():
                raise BrokenError("the largest error is more than told", (keep["kind"], found.tolist(), said.tolist()))
        return SAMPLES

    def judge_refusal(self, case: Case, error: Exception) -> None:
        known = (
            "does not hold there",
            "infinite",
            "allows its master",
            "limit",
            "nothing would be kept",
            "region",
            "same configuration",
        )
        if not any(word in str(error) for word in known):
            raise BrokenError("a right input was refused", error)


ATTACKS = [KeptMotions()]
