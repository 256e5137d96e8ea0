"""What `solve`, `solve_all` and `solve_batch` say of a target, against kinematics by numpy."""

from __future__ import annotations

from typing import Any

import numpy as np

import beetle_ik as bik

from .. import arms
from ..attack import Attack, BrokenError, Case

TOLERANCE = 1e-6  # m and rad, of `solve`
ROUNDING = 1e-9  # of errors, relative to the size of the arm
TURN = 2.0 * np.pi
SELDOM = 0.05  # share of descents


def size(case: Case) -> float:
    """A length that the arm does not exceed by much (m), and at least 1."""
    return 1.0 + sum(
        float(np.linalg.norm(joint["xyz"])) + abs(joint["upper"]) * (joint["kind"] == "prismatic")
        for joint in case["joints"]
    )


def wanted(case: Case) -> np.ndarray:
    """The target (4, 4): the pose of the arm at its first configuration, displaced by `scale` and `shift` (m)."""
    pose = arms.kinematics(case["joints"], arms.configurations(case["joints"])[:1])[0][0]
    pose[:3, 3] = pose[:3, 3] * case.get("scale", 1.0) + np.array(case.get("shift", (0.0, 0.0, 0.0)))
    return pose


def check_solution(case: Case, solution: bik.Solution, target: np.ndarray, *, rotation: bool) -> None:
    """Checks limits, errors and the verdict of a solution."""
    lower, upper = arms.bounds(case["joints"])
    q = solution.q
    if not np.isfinite(q).all():
        raise BrokenError("q is not finite", q)
    beyond = np.maximum(lower - q, q - upper).max(initial=0.0)
    if beyond > ROUNDING * max(1.0, np.abs(q).max(initial=0.0)):
        raise BrokenError("q is outside the limits", beyond)
    away, angle = (float(part[0]) for part in arms.pose_error(arms.kinematics(case["joints"], q[None])[0], target))
    slack = ROUNDING * size(case) * max(1.0, np.abs(q).max(initial=0.0))
    if abs(away - solution.position_error) > slack:
        raise BrokenError("position_error is not the error", (away, solution.position_error))
    if rotation and abs(angle - solution.rotation_error) > slack + 1e-8:
        raise BrokenError("rotation_error is not the error", (angle, solution.rotation_error))
    if solution.success and (away > TOLERANCE + slack or (rotation and angle > TOLERANCE + slack)):
        raise BrokenError("solved, but not within the tolerance", (away, angle))


class Solved(Attack):
    name = "solved"
    promise = (
        "A target is reached inside limits if that is said, and is not called out of reach if the arm can be there"
    )
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        joints = arms.arm(random, hard, (2, 8))
        arms.put(joints, random, hard, 2)
        start = random.random() < 0.5
        nearest = start and random.random() < 0.4
        return {"joints": joints, "position": bool(random.random() < 0.3), "start": start, "nearest": nearest}

    def program(self, case: Case) -> str:
        options = f", start_q={arms.configurations(case['joints'])[1].tolist()}" if case.get("start") else ""
        options += ", prefer='nearest'" if case.get("nearest") else ""
        return (
            f"{arms.written(case['joints'])}target = np.array({wanted(case).tolist()})"
            f"{'[:3, 3]' if case['position'] else ''}\n"
            f"solution = bik.solve(robot, target{options})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        solution = left["solution"]
        check_solution(case, solution, wanted(case), rotation=not case["position"])
        if solution.status == bik.Status.OUT_OF_REACH:
            raise BrokenError("a pose that the arm has is called out of reach", solution.message)
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        refuse_only_locked(case, error)


def refuse_only_locked(case: Case, error: Exception) -> None:
    """A right arm and target are refused only if followers leave a joint nothing, or no joint is left to move."""
    lower, upper = arms.bounds(case["joints"])
    if (lower <= upper).all():
        raise BrokenError("a right input is refused", error)


class OutOfReach(Attack):
    name = "out_of_reach"
    promise = "OUT_OF_REACH is said only of a target that is provably out of reach"
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """An easy target is anywhere about the arm, a hard one is just off a pose that is reached."""
        joints = arms.easy_arm(random, int(random.integers(2, 8)))
        arms.put(joints, random, hard)
        scale = 1.0 + 10.0 ** random.uniform(-7, -1) * random.choice([-1.0, 1.0]) if hard else 1.0
        shift = (0.0, 0.0, 0.0) if hard else arms.triple(random.normal(0.0, 0.5, 3))
        position, starts = bool(random.random() < 0.5), int(random.integers(2**31))
        return {"joints": joints, "scale": float(scale), "shift": shift, "position": position, "starts": starts}

    def program(self, case: Case) -> str:
        return Solved().program(case)

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        solution, target = left["solution"], wanted(case)
        check_solution(case, solution, target, rotation=not case["position"])
        if solution.status == bik.Status.OUT_OF_REACH:
            lower, upper = (np.clip(bound, -TURN, TURN) for bound in arms.bounds(case["joints"]))
            starts = np.random.default_rng(case["starts"]).uniform(lower, upper, (60, len(lower)))
            q = inside(case["joints"], arms.descended(case["joints"], target, starts, rotation=not case["position"]))
            away, angle = arms.pose_error(arms.kinematics(case["joints"], q)[0], target)
            reached = (away < 0.5 * TOLERANCE) & ((angle < 0.5 * TOLERANCE) | case["position"])
            if reached.any():
                raise BrokenError("out of reach, but a search reaches it", q[reached][0].tolist())
        return 1


class PlaceFirst(Attack):
    name = "place_first"
    promise = "An arm of few joints comes to a place that it has, and no configuration there is nearer in orientation"
    page = "solving"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A hard turn is of round numbers, and its configuration at limits, a hair inside them, and at zero."""
        joints = arms.easy_arm(random, int(random.integers(3, 6)))
        arms.put(joints, random, hard)
        for joint in joints:
            if hard and random.random() < 0.3:
                joint["at"] = (joint["at"][0] + 10.0 ** random.uniform(-6.0, -1.0) * random.choice([-1.0, 1.0]),)
        vector = (
            random.choice(np.array([0.0, 0.5, -0.5, 1.0, 1e-9, 1e-5]) * np.pi, 3)
            if hard
            else random.normal(0.0, 0.7, 3)
        )
        return {"joints": joints, "turn": arms.triple(vector), "starts": int(random.integers(2**31))}

    def program(self, case: Case) -> str:
        return (
            f"{arms.written(case['joints'])}target = np.array({turned(case).tolist()})\n"
            "solution = bik.solve(robot, target)"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        solution, target = left["solution"], turned(case)
        check_solution(case, solution, target, rotation=True)
        if solution.position_error > TOLERANCE:
            raise BrokenError("the arm has the place, and is not there", solution.message)
        if solution.status not in (bik.Status.SOLVED, bik.Status.ROTATION_GIVEN_UP):
            raise BrokenError("the place is met, and the status does not say so", solution.message)
        lower, upper = (np.clip(bound, -TURN, TURN) for bound in arms.bounds(case["joints"]))
        starts = np.random.default_rng(case["starts"]).uniform(lower, upper, (200, len(lower)))
        found = inside(case["joints"], arms.descended(case["joints"], target, starts, rotation=False))
        # The pose was that of the first, before the turn.
        q = np.vstack((arms.configurations(case["joints"])[:1], found))
        away, angle = arms.pose_error(arms.kinematics(case["joints"], q)[0], target)
        nearer = (away < 0.1 * TOLERANCE) & (angle < solution.rotation_error - 1e-3)
        # Arms with sliding joints search by descents, which may miss a corner that few starts lead to.
        turning = all(joint["kind"] in arms.TURNED for joint in arms.free(case["joints"]))
        if nearer.sum() > (0 if turning else SELDOM * len(starts)):
            raise BrokenError("a configuration at the place is nearer in orientation", q[nearer][0].tolist())
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        refuse_only_locked(case, error)


def turned(case: Case) -> np.ndarray:
    """The pose of the arm at its first configuration, turned by a rotation vector."""
    pose, vector = wanted(case), np.array(case["turn"])
    angle = np.linalg.norm(vector)
    if angle > 0.0:
        pose[:3, :3] = arms.turn(vector / angle, np.array([angle]))[0] @ pose[:3, :3]
    return pose


def inside(joints: list[arms.Joint], q: np.ndarray) -> np.ndarray:
    """Those of the configurations (m, n) that are inside the limits, after whole turns."""
    lower, upper = arms.bounds(joints)
    turns = np.array([joint["kind"] in arms.TURNED for joint in arms.free(joints)])
    low = np.where(np.isfinite(lower), lower, -np.pi)
    q = np.where(turns, low + np.mod(q - low, TURN), q)
    return q[((q >= lower) & (q <= upper)).all(axis=1)]


ATTACKS = [Solved(), OutOfReach(), PlaceFirst()]
