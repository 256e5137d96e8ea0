"""Two hands, self-motions, paths and plants."""

from __future__ import annotations

from typing import Any

import numpy as np

import beetle_ik as bik

from .. import arms, typed
from ..attack import Attack, BrokenError, Case
from .motion import check_rates
from .solving import ROUNDING, TOLERANCE


class TwoHands(Attack):
    name = "two_hands"
    promise = "Targets of two hands that share a torso are reached both, or it is not said"
    page = "several_tips"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard cases ask for the second hand as seen from the first, or for configurations at limits."""
        shared = arms.easy_arm(random, 1)
        left, right = (arms.easy_arm(random, int(random.integers(3, 7))) for _ in range(2))
        for joints in (shared, left, right):
            arms.put(joints, random, hard)
        return {"shared": tuple(shared), "left": left, "right": right, "pair": bool(hard and random.random() < 0.7)}

    @staticmethod
    def targets(case: Case) -> tuple[np.ndarray, np.ndarray]:
        """The poses of both hands at the configuration of the case."""
        chains = [[*case["shared"], *case[side]] for side in ("left", "right")]
        left, right = (arms.kinematics(chain, arms.configurations(chain))[0][0] for chain in chains)
        return left, right

    def program(self, case: Case) -> str:
        left, right = self.targets(case)
        tips = f"l{1 + len(case['left'])}", f"a{len(case['right'])}"
        second = (tips, np.linalg.inv(left) @ right) if case["pair"] else (tips[1], right)
        branches = [*case["shared"], *case["left"]], case["right"]
        return (
            f"{arms.written(*branches, tips=f', tip={list(tips)}')}"
            f"targets = {{{tips[0]!r}: np.array({left.tolist()}), {second[0]!r}: np.array({second[1].tolist()})}}\n"
            "solution = bik.solve(robot, targets)"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        solution, size = left["solution"], 10.0
        n, q = len(case["left"]), solution.q
        targets, found = self.targets(case), []
        for side, values in (("left", q[: n + 1]), ("right", np.array([q[0], *q[n + 1 :]]))):
            chain = [*case["shared"], *case[side]]
            lower, upper = arms.bounds(chain)
            if np.maximum(lower - values, values - upper).max() > ROUNDING:
                raise BrokenError("q is outside the limits", q.tolist())
            found.append(arms.kinematics(chain, values[None])[0])
        errors = [arms.pose_error(pose, target) for pose, target in zip(found, targets, strict=True)]
        if case["pair"]:
            relative = np.linalg.inv(found[0][0]) @ found[1]
            errors[1] = arms.pose_error(relative, np.linalg.inv(targets[0]) @ targets[1])
        away, angle = (max(float(error[part][0]) for error in errors) for part in (0, 1))
        if abs(away - solution.position_error) > ROUNDING * size:
            raise BrokenError("position_error is not the error", (away, solution.position_error))
        if solution.success and max(away, angle) > TOLERANCE + ROUNDING * size:
            raise BrokenError("solved, but not within the tolerance", (away, angle))
        if solution.status == bik.Status.OUT_OF_REACH:
            raise BrokenError("poses that the arms have are called out of reach", solution.message)
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        raise BrokenError("a right input is refused", error)


class SelfMotions(Attack):
    name = "self_motions"
    promise = "Every configuration of a self-motion reaches the target inside the limits, with no gap between two"
    page = "all_solutions"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Easy arms have a spherical wrist, hard ones no closed form and configurations at limits."""
        joints = arms.easy_arm(random, 7)
        for joint in joints:
            joint.update(kind="revolute", lower=-float(random.uniform(1, 6)), upper=float(random.uniform(1, 6)))
        if not hard:
            joints[5]["xyz"] = joints[6]["xyz"] = (0.0, 0.0, 0.0)
        arms.put(joints, random, hard)
        return {"joints": joints, "spacing": float(random.choice([0.02, 0.05, 0.3]))}

    def program(self, case: Case) -> str:
        target = arms.kinematics(case["joints"], arms.configurations(case["joints"]))[0][0].tolist()
        return (
            f"{arms.written(case['joints'])}target = np.array({target})\n"
            f"curves = bik.self_motion(robot, target, spacing={case['spacing']})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        lower, upper = arms.bounds(case["joints"])
        tried = 1
        for curve in left["curves"]:
            away, angle = arms.pose_error(arms.kinematics(case["joints"], curve.q)[0], left["target"])
            if max(away.max(), angle.max()) > 2e-9 + 1e-8:
                raise BrokenError("a configuration of the curve misses the target", (away.max(), angle.max()))
            if np.maximum(lower - curve.q, curve.q - upper).max() > ROUNDING:
                raise BrokenError("a configuration of the curve is outside the limits")
            steps = np.linalg.norm(np.diff(curve.q, axis=0), axis=1)
            if len(steps) and steps.max() > case["spacing"] * (1 + 1e-9):
                raise BrokenError("the curve has a gap", steps.max())
            tried += len(curve.q)
        return tried


class PathsFollowed(Attack):
    name = "paths_followed"
    promise = (
        "A plan along a path keeps its limits at every instant and stays as near to the path as it says, retimed too"
    )
    page = "planning"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """The path is that of a curve in joint space; a hard one begins or ends at limits, or rests."""
        joints = arms.easy_arm(random, int(random.integers(4, 8)))
        arms.put(joints, random, hard, 2)
        rates = tuple(np.exp(random.uniform(-1, 1, 2)).tolist())
        if random.random() < 0.5:
            rates = typed.number(random, -1, 0), typed.number(random, -1, 1)
        return {
            "joints": joints,
            "points": int(random.integers(3, 40)),
            "rates": rates,
            "far": float(random.uniform(0.05, 0.6)),
        }

    def program(self, case: Case) -> str:
        first, last = arms.configurations(case["joints"])
        share = case["far"] * np.linspace(0.0, 1.0, max(2, case["points"]))[:, None]
        poses = arms.kinematics(case["joints"], first + share * (last - first))[0]
        velocity, acceleration = case["rates"]
        return (
            f"{arms.written(case['joints'])}poses = np.array({poses.tolist()})\n"
            f"limits = bik.Limits(velocity={velocity}, acceleration={acceleration})\n"
            "plan = bik.plan_along_path(robot, poses, limits=limits)\n"
            f"slower = plan.retime(bik.Limits(velocity={velocity / 2}, acceleration={acceleration / 3}))"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        lower, upper = arms.bounds(case["joints"])
        for plan, factors in ((left["plan"], (1.0, 1.0)), (left["slower"], (2.0, 3.0))):
            if not plan.success:
                continue
            motion, (velocity, acceleration) = plan.trajectory, np.array(case["rates"]) / factors
            n = len(lower)
            check_rates(motion, {"velocity": np.full(n, velocity), "acceleration": np.full(n, acceleration)}, 1e-6)
            q = motion.at(np.linspace(0.0, motion.duration, 400))[0]
            if np.maximum(lower - q, q - upper).max() > 1e-7:
                raise BrokenError("the plan leaves the position limits", np.maximum(lower - q, q - upper).max())
            tips = arms.kinematics(case["joints"], q)[0][:, :3, 3]
            away = distance_from_polyline(tips, left["poses"][:, :3, 3]).max()
            if away > plan.accuracy + 1e-7:
                raise BrokenError("the plan is farther from the path than it says", (away, plan.accuracy))
        return 1


def distance_from_polyline(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distances (m,) of points (m, 3) from the lines between corners (k, 3)."""
    a, along = corners[:-1], np.diff(corners, axis=0)
    squared = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip(((points[:, None] - a) * along).sum(axis=2) / squared, 0.0, 1.0)
    return np.linalg.norm(points[:, None] - a - share[:, :, None] * along, axis=2).min(axis=1)


class Plants(Attack):
    name = "plants"
    promise = "Commands without a model keep their limits, and a plant that fails ends the run with its record"
    page = "limits"
    fates = (
        "raise OSError('the cable came off')", "return [nan, 0.0, 0.0]", "return [1.0, 2.0]", "return None",
        "return 'here'", "return [inf, 0.0, 0.0]", "return 10.0**300 * np.ones(3)", "pass", "pass", "pass",
    )  # fmt: skip

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A hard plant is noisy, fails, or answers nonsense after a while."""
        joints = arms.easy_arm(random, int(random.integers(2, 7)))
        arms.put(joints, random, False)
        controller = (
            "bik.BroydenBAS()",
            "bik.papers.ZNNBAS()",
            "bik.papers.ZNNBAS(accept='improving')",
            "bik.BroydenBAS(sensor_delay=1)",
        )
        fate = str(random.choice(self.fates)) if hard else "pass"
        return {
            "joints": joints, "controller": str(random.choice(controller)), "fate": fate,
            "after": int(random.integers(2, 60)), "noise": 1e-3 * bool(hard and random.random() < 0.5),
        }  # fmt: skip

    def program(self, case: Case) -> str:
        q = arms.configurations(case["joints"])[0]
        tip = arms.kinematics(case["joints"], q[None])[0][0, :3, 3]
        lower, upper = (bound.tolist() for bound in arms.bounds(case["joints"]))
        return (
            f"{arms.written(case['joints'])}asked, noise = [], np.random.default_rng(0)\n\n\n"
            f"def plant(q):\n    asked.append(q.copy())\n    if len(asked) > {case['after']}:\n        {case['fate']}\n"
            f"    return robot.fk(q)[:3, 3] + {case['noise']} * noise.normal(size=3)\n\n\n"
            f"path = bik.paths.circle({tip.tolist()}, diameter=0.02, duration=2.0)\n"
            f"limits = bik.Limits(lower={lower}, upper={upper}, velocity=1.0)\n"
            f"given = dict(limits=limits, controller={case['controller']})\n"
            f"found = bik.track_model_free(plant, path, {q.tolist()}, dt=0.02, **given)"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        found, asked = left["found"], np.array(left["asked"])
        lower, upper = arms.bounds(case["joints"])
        if np.maximum(lower - asked, asked - upper).max() > ROUNDING:
            raise BrokenError("a command is outside the position limits")
        if len(found.q) > 1 and np.abs(np.diff(found.q, axis=0)).max() > 0.02 * (1 + 1e-9):
            raise BrokenError("the velocity is beyond its limit", np.abs(np.diff(found.q, axis=0)).max())
        if not np.isfinite(found.q).all():
            raise BrokenError("a command is not finite")
        failed = case["fate"].startswith(("raise", "return [", "return N", "return '")) and len(asked) > case["after"]
        if failed != (found.status == bik.Status.PLANT_FAILED):
            raise BrokenError("a plant that fails is not told from one that works", (case["fate"], found.status))
        return len(asked)

    def judge_refusal(self, case: Case, error: Exception) -> None:
        raise BrokenError("a right input is refused", error)


ATTACKS = [TwoHands(), SelfMotions(), PathsFollowed(), Plants()]
