"""Programs of moves, judged at samples of the timed motion by numpy alone."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import arms
from ..attack import Attack, BrokenError, Case

Array = NDArray[np.float64]
SAMPLES = 2000
OFF_PATH = 1e-5
SPEED, JERKY, SLOWER = 1e-3, 2e-3, 1.5e-3
ACCELERATION, JERK = 4.0, 80.0
TURNED, TOLERANCE = 1e-4, 0.1
"""Largest angle beyond the task (rad), and tolerance of some tasks."""
TASKS = {
    None: "None",
    "spin": "bik.tasks.Pointing(axis=(0, 0, 2))",
    "cone": f"bik.tasks.Pointing(tolerance=(1, 1, 1, {TOLERANCE}))",
    "band": f"bik.tasks.Pose(tolerance=(1, 1, 1, {TOLERANCE}, {TOLERANCE}, {TOLERANCE}))",
    "position": "bik.tasks.Position()",
}
MET, LARGEST_STEP, ROOM = 1e-9, 0.1, 0.02
"""Of the judge's own steps along a line: error (m, rad), largest change of a joint, and its distance from limits."""


def distances(points: Array, start: Array, move: dict[str, Any]) -> Array:
    """Distances (m,) of points (m, 3) from a line, or from the circle of an arc."""
    end = start + move["way"]
    if move["kind"] == "line":
        way = end - start
        part = np.clip((points - start) @ way / (way @ way), 0.0, 1.0)
        return np.linalg.norm(points - start - part[:, None] * way, axis=1)
    via = start + move["via"]
    normal = np.cross(via - start, end - start)
    rows = np.array([via - start, end - start, normal])
    right = [(via @ via - start @ start) / 2, (end @ end - start @ start) / 2, normal @ start]
    centre = np.linalg.solve(rows, right)
    normal = normal / np.linalg.norm(normal)
    above = (points - centre) @ normal
    outward = np.linalg.norm(points - centre - above[:, None] * normal, axis=1) - np.linalg.norm(start - centre)
    return np.hypot(above, outward)


def beyond(task: str | None, tips: Array, due: Array) -> Array:
    """Angles (m,) of orientations (m, 3, 3) from those due, beyond what the task leaves free."""
    if task == "position":
        return np.zeros(len(tips))
    if task in ("spin", "cone"):
        apart = np.linalg.norm(tips[:, :, 2] - due[:, :, 2], axis=1)
        angles = 2.0 * np.arcsin(np.clip(0.5 * apart, 0.0, 1.0))
        return np.maximum(angles - (TOLERANCE if task == "cone" else 0.0), 0.0)
    relative = np.swapaxes(due, 1, 2) @ tips
    # The rotations here are small, or else they are wrong by more than the sine loses.
    skew = 0.5 * (relative - np.swapaxes(relative, 1, 2))
    sines = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1)
    size = np.linalg.norm(sines, axis=1, keepdims=True)
    angle = np.arctan2(size, 0.5 * (np.trace(relative, axis1=1, axis2=2)[:, None] - 1.0))
    vectors = sines * np.where(size > 0.0, angle / np.maximum(size, 1e-300), 1.0)
    return np.linalg.norm(np.maximum(np.abs(vectors) - (TOLERANCE if task == "band" else 0.0), 0.0), axis=1)


def followed(joints: list[dict[str, Any]], q: Array, move: dict[str, Any], held: int = 0) -> Array | None:
    """Joint positions at the end of a line from q, by small Newton steps; None where one is large or near a limit.

    The first `held` joints stay.
    """
    lower, upper = arms.bounds(joints)
    start = arms.kinematics(joints, q[None])[0][0]
    steps = int(np.ceil(max(np.linalg.norm(move["way"]) / 0.004, move["turn"] / 0.02, 1.0)))
    for part in np.arange(1, steps + 1) / steps:
        turned = arms.turn(start[:3, 0], np.array([part * move["turn"]]))[0] @ start[:3, :3]
        before = q
        for _ in range(20):
            poses, jacobians = arms.kinematics(joints, q[None])
            relative = turned @ poses[0, :3, :3].T
            skew = 0.5 * (relative - relative.T)
            missing = np.r_[
                start[:3, 3] + part * np.array(move["way"]) - poses[0, :3, 3], skew[2, 1], skew[0, 2], skew[1, 0]
            ]
            if np.linalg.norm(missing) < MET:
                break
            jacobian = jacobians[0]
            jacobian[:, :held] = 0.0
            q = q + np.linalg.pinv(jacobian, rcond=1e-6) @ missing
        moved = np.abs(q - before).max()
        if (
            np.linalg.norm(missing) > MET
            or moved > LARGEST_STEP
            or (q < lower + ROOM)[held:].any()
            or (q > upper - ROOM)[held:].any()
        ):
            return None
    return q


class Programs(Attack):
    """Lines, arcs, waits and joint moves from one configuration on; round numbers, ties and corners of every angle."""

    name = "programs"
    promise = "Each move of a program is made as asked, within the limits, or refused by its name"
    page = "moves"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        joints = arms.arm(random, hard, (6, 7))
        arms.put(joints, random, hard)
        return {
            "joints": joints,
            "moves": [self._drawn(random, hard, len(arms.free(joints))) for _ in range(random.integers(1, 6))],
            "jerk": bool(random.random() < 0.3),
            "task": [None, *TASKS][random.integers(len(TASKS) + 1)],
        }

    def _drawn(self, random: np.random.Generator, hard: bool, n: int) -> dict[str, Any]:
        kind = str(random.choice(["line", "line", "arc", "wait", "joints"]))
        size = float(random.choice([0.01, 0.05, 0.1]))
        axes = [*np.eye(3), -np.eye(3)[0], np.zeros(3)] if hard else [random.normal(size=3)]
        way = size * axes[random.integers(len(axes))]
        return {
            "kind": kind,
            "way": tuple(way.tolist()),
            "via": tuple((0.5 * way + size * axes[random.integers(len(axes))]).tolist()),
            "turn": float(random.choice([0.0, 0.0, 0.2])),
            "speed": [None, 0.01, 0.1, 10.0, 0.0][random.integers(5 if hard else 4)],
            "blend": [0.0, 0.2 * size, 0.5 * size, 2.0 * size][random.integers(4 if hard else 3)],
            "seconds": float(random.choice([0.0, 0.1])),
            "q": tuple((0.1 * random.normal(size=n)).tolist()),
        }

    def program(self, case: Case) -> str:
        lines = [
            arms.written(case["joints"]),
            f"q = np.array({arms.configurations(case['joints'])[0].tolist()!r})",
            "pose, program = robot.fk(q), []",
        ]
        for i, move in enumerate(case["moves"]):
            blend, name = move["blend"], f"name='m{i}'"
            if move["kind"] == "wait":
                lines.append(f"program.append(bik.moves.Wait({move['seconds']!r}, {name}))")
                continue
            if move["kind"] == "joints":
                lines.append(
                    f"goal = np.clip(q + {move['q']!r}, robot.lower, robot.upper)\npose = robot.fk(goal)\n"
                    f"program.append(bik.moves.Joints(goal, blend={blend!r}, {name}))"
                )
                continue
            given = f"pose, speed={move['speed']!r}, blend={blend!r}, {name}"
            via = f"pose[:3, 3] + {move['via']!r}, " if move["kind"] == "arc" else ""
            lines.append(
                f"before, pose = pose, pose @ bik.pose((0, 0, 0), rpy=({move['turn']!r}, 0, 0))\n"
                f"pose[:3, 3] = before[:3, 3] + {move['way']!r}\n"
                f"program.append(bik.moves.{move['kind'].capitalize()}({via.replace('pose', 'before')}{given}))"
            )
        jerk = f", jerk={JERK}" if case["jerk"] else ""
        lines.append(
            f"limits = bik.Limits(acceleration={ACCELERATION}{jerk})\n"
            f"task = {TASKS[case.get('task')]}\n"
            "plan = bik.plan_moves(robot, program, start_q=q, limits=limits, task=task)\n"
            "reports, motion, whole = plan.moves, plan.trajectory, None"
        )
        if case.get("task") is not None:
            lines.append(
                "try:\n"
                "    whole = bik.plan_moves(robot, program, start_q=q, limits=limits).trajectory.duration\n"
                "except bik.InvalidInputError:\n"
                "    pass  # whole poses may be out of reach"
            )
        return "\n".join(lines)

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        plan, motion, reports = left["plan"], left["motion"], left["reports"]
        if not plan.success:
            raise BrokenError("a program that was planned breaks a limit", plan.message)
        t = np.linspace(0.0, motion.duration, SAMPLES)
        q, qd, qdd = motion.at(t)
        lower, upper = arms.bounds(case["joints"])
        if (q < lower - 1e-9).any() or (q > upper + 1e-9).any():
            raise BrokenError("a joint is outside its limits", (q.min(axis=0), q.max(axis=0)))
        if np.abs(qd).max() > 1.0 + 1e-9 or np.abs(qdd).max() > ACCELERATION * (1.0 + 1e-9):
            raise BrokenError("a joint is faster than its limits", (np.abs(qd).max(), np.abs(qdd).max()))
        poses, jacobians = arms.kinematics(case["joints"], q)
        if left["whole"] is not None and motion.duration > left["whole"]:
            raise BrokenError("a program is slower than with whole poses", (motion.duration, left["whole"]))
        tips, turned = poses[:, :3, 3], poses[0, :3, :3]
        speeds = np.linalg.norm(np.einsum("mij,mj->mi", jacobians[:, :3], qd), axis=1)
        at, before = tips[0], 0.0
        for i, (move, report) in enumerate(zip(case["moves"], reports, strict=True)):
            on = (t >= report.start) & (t <= report.end)
            blend = move["blend"] if i + 1 < len(case["moves"]) else 0.0
            if move["kind"] == "wait":
                before = 0.0
                continue
            if move["kind"] == "joints":
                goal = np.clip(arms.configurations(case["joints"])[0] + move["q"], lower, upper)
                reached = arms.kinematics(case["joints"], goal[None])[0][0]
                at, turned, before = reached[:3, 3], reached[:3, :3], blend
                continue
            end = at + move["way"]
            clear = on & (np.linalg.norm(tips - at, axis=1) >= before) & (np.linalg.norm(tips - end, axis=1) >= blend)
            if np.linalg.norm(move["way"]) > 1e-9:
                off = distances(tips, at, move)[clear].max(initial=0.0)
                if off > OFF_PATH:
                    raise BrokenError("a move leaves its path", (i, off))
            if move["kind"] == "line" and np.linalg.norm(move["way"]) > 1e-9:
                part = (tips - at) @ np.array(move["way"]) / np.dot(move["way"], move["way"])
                due = arms.turn(turned[:, 0], np.clip(part, 0.0, 1.0) * move["turn"]) @ turned
                angle = beyond(case.get("task"), poses[:, :3, :3], due)[clear].max(initial=0.0)
                if angle > TURNED:
                    raise BrokenError("a move turns the tip beyond its task", (i, angle))
            turned = arms.turn(turned[:, 0], np.array([move["turn"]]))[0] @ turned
            asked = move["speed"]
            in_blends = before + blend if move["kind"] == "line" else 0.0
            if asked is not None and np.linalg.norm(move["way"]) > in_blends + 1e-9:
                said = np.zeros(SAMPLES, bool)
                for bound in report.bound_by:
                    said |= (t >= bound.start) & (t <= bound.end)
                if (speeds[clear] > asked * (1.0 + (JERKY if case["jerk"] else SPEED))).any():
                    raise BrokenError("a move is faster than asked for", (i, speeds[clear].max(), asked))
                if (speeds[clear & ~said] < asked * (1.0 - SLOWER)).any():
                    raise BrokenError("a move is slower than asked for, and nothing says why", (i, asked))
            at, before = end, blend
        return SAMPLES

    def judge_refusal(self, case: Case, error: Exception) -> None:
        if "mimic joint" in str(error):
            return  # its limits leave no room for the joint that it follows
        if "'m" not in str(error) and "takes no time" not in str(error):
            raise BrokenError("a program is refused, and no move is named", error)
        if "was not found" in str(error) or "cannot be reached" in str(error):
            self._judge_unfollowed(case, error)

    def _judge_unfollowed(self, case: Case, error: Exception) -> None:
        """A program of lines without blends that the judge follows may not be refused."""
        joints = case["joints"]
        q = start = arms.configurations(joints)[0]
        lower, upper = arms.bounds(joints)
        for move in case["moves"]:
            if move["kind"] == "arc" or move["blend"] > 0.0:
                return
            if move["kind"] == "joints":
                q = np.clip(start + move["q"], lower, upper)
            elif move["kind"] == "line":
                reached = followed(joints, q, move)
                if reached is None:
                    return
                q = reached
        raise BrokenError("a program that can be followed is refused", error)


ATTACKS = [Programs()]
