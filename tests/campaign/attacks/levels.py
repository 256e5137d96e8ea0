"""Targets of two tips of different levels that cannot both be met."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import minimize

import beetle_ik as bik

from .. import arms
from ..attack import Attack, BrokenError, Case
from .solving import ROUNDING, TOLERANCE

MET = 1e-6  # error (m, rad) of a level that counts as met, and by which a lower level may be worse than alone
GAIN = 2e-2  # relative decrease of a higher level's error that a descent may still find

PARTS = {"Pose": slice(0, 6), "Position": slice(0, 3), "Orientation": slice(3, 6)}


class Levels(Attack):
    name = "levels"
    promise = "Of two tips of different levels the lower is as near as alone, the higher as near as a descent finds"
    page = "several_tips"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard cases begin at joint limits, have offsets of round numbers, and a tip with few joints of its own."""
        shared = arms.easy_arm(random, 1)
        left, right = (arms.easy_arm(random, int(random.integers(1 if hard else 3, 7))) for _ in range(2))
        for joints in (shared, left, right):
            arms.put(joints, random, hard)
        offsets = random.normal(0.0, 0.3, (2, 3))
        if hard:
            offsets = random.choice([0.0, 0.5, -1.0, 1e-4], (2, 3))
        if random.random() < 0.6:
            offsets[0] = 0.0
        return {
            "shared": tuple(shared),
            "left": left,
            "right": right,
            "offsets": tuple(arms.triple(offset) for offset in offsets),
            "kinds": tuple(str(kind) for kind in random.choice(list(PARTS), 2)),
            "levels": tuple(map(int, random.choice([[0, 1], [0, 7], [3, 4]]))),
            "begin": bool(random.random() < 0.5),
        }

    @staticmethod
    def chains(case: Case) -> list[list[arms.Joint]]:
        return [[*case["shared"], *case[side]] for side in ("left", "right")]

    def targets(self, case: Case) -> list[np.ndarray]:
        """The poses of both tips at the configuration of the case, moved by the offsets."""
        poses = [arms.kinematics(chain, arms.configurations(chain))[0][0] for chain in self.chains(case)]
        for pose, offset in zip(poses, case["offsets"], strict=True):
            pose[:3, 3] += offset
        return poses

    def program(self, case: Case) -> str:
        tips = f"l{1 + len(case['left'])}", f"a{len(case['right'])}"
        poses = zip(tips, self.targets(case), strict=True)
        given = ", ".join(f"{tip!r}: np.array({pose.tolist()})" for tip, pose in poses)
        tasks = ", ".join(
            f"{tip!r}: bik.tasks.{kind}(level={level})"
            for tip, kind, level in zip(tips, case["kinds"], case["levels"], strict=True)
        )
        start = ", start_q=np.clip(np.zeros(robot.dof), robot.lower, robot.upper)" if case["begin"] else ""
        branches = [*case["shared"], *case["left"]], case["right"]
        return (
            f"{arms.written(*branches, tips=f', tip={list(tips)}')}"
            f"targets, tasks = {{{given}}}, {{{tasks}}}\n"
            f"solution = bik.solve(robot, targets, task=tasks{start})\n"
            f"alone = bik.solve(robot, {{{tips[0]!r}: targets[{tips[0]!r}]}}, task=tasks[{tips[0]!r}]{start})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        solution, wanted, chains = left["solution"], self.targets(case), self.chains(case)
        n = len(case["left"])

        columns = [list(range(n + 1)), [0, *range(n + 1, len(solution.q))]]

        def linearized(side: int, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            """The residual of one tip, position and rotation vector or its part, and its Jacobian at a small one."""
            poses, own = arms.kinematics(chains[side], q[columns[side]][None])
            jacobian = np.zeros((6, len(q)))
            jacobian[:, columns[side]] = own[0]
            rows = PARTS[case["kinds"][side]]
            return _residual(poses[0], wanted[side])[rows], jacobian[rows]

        def error(side: int, q: np.ndarray) -> np.ndarray:
            return linearized(side, q)[0]

        def squared(q: np.ndarray) -> tuple[float, np.ndarray]:
            """The squared residual of the higher level, and its gradient: a rotation vector is its own along it."""
            residual, jacobian = linearized(1, q)
            return float(residual @ residual), 2 * residual @ jacobian

        bounds = [np.concatenate([one, two[1:]]) for one, two in zip(*map(arms.bounds, chains), strict=True)]
        if np.maximum(bounds[0] - solution.q, solution.q - bounds[1]).max() > ROUNDING:
            raise BrokenError("q is outside the limits", solution.q.tolist())
        errors = [float(np.linalg.norm(error(side, solution.q))) for side in (0, 1)]
        met = [_within(error(side, solution.q), case["kinds"][side]) for side in (0, 1)]
        if solution.success and not all(met):
            raise BrokenError("solved, but not within the tolerance", errors)
        if solution.status == bik.Status.LEVEL_GIVEN_UP and not met[0]:
            raise BrokenError("the lowest level is not met", errors)
        alone = float(np.linalg.norm(error(0, left["alone"].q)))
        if errors[0] > alone + MET and not met[0]:
            raise BrokenError("the lower level is worse for the higher one", (errors[0], alone))
        if solution.success or not met[0]:
            return 1
        box = list(zip(*bounds, strict=True))
        held = {"type": "eq", "fun": lambda q: error(0, q), "jac": lambda q: linearized(0, q)[1]}
        found = minimize(
            squared,
            solution.q,
            jac=True,
            method="SLSQP",
            bounds=box,
            constraints=[held],
            options={"maxiter": 100, "ftol": 1e-12},
        )
        nearer = float(np.linalg.norm(error(1, np.clip(found.x, *bounds))))
        kept = float(np.linalg.norm(error(0, np.clip(found.x, *bounds))))
        if kept < MET and nearer < errors[1] * (1 - GAIN) - 1e-3:
            raise BrokenError("a descent finds the higher level nearer", (errors[1], nearer))
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        raise BrokenError("a right input is refused", error)


def _within(residual: np.ndarray, kind: str) -> bool:
    parts = [residual[:3], residual[3:]] if kind == "Pose" else [residual]
    return all(float(np.linalg.norm(part)) <= TOLERANCE + 10 * ROUNDING for part in parts)


def _residual(pose: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Difference of a pose from the one wanted: of position, and the rotation vector in the base frame."""
    turn = pose[:3, :3] @ wanted[:3, :3].T
    skew = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    sine, cosine = 0.5 * np.linalg.norm(skew), 0.5 * (np.trace(turn) - 1.0)
    angle = np.arctan2(sine, cosine)
    axis = skew / (2 * sine) if sine > 1e-12 else _half_turn(turn, angle)
    return np.concatenate([pose[:3, 3] - wanted[:3, 3], angle * axis])


def _half_turn(turn: np.ndarray, angle: float) -> np.ndarray:
    """Axis of a rotation by nothing or by half a turn."""
    if angle < 1.0:
        return np.zeros(3)
    column = (turn + np.eye(3))[:, int(np.argmax(np.diag(turn)))]
    return column / np.linalg.norm(column)


ATTACKS = (Levels(),)
