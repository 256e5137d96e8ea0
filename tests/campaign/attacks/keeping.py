"""What a tracker keeps: errors of tasks between ticks and during stops, judged by kinematics of its own."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import arms
from ..attack import Attack, BrokenError, Case

SAMPLES = 50  # of each tick
ROUNDING = 1e-9  # of a tolerance, and m or rad
KINDS = ("velocity", "acceleration", "jerk")
TASKS = {
    "tilt": "Pointing(tolerance=[inf, inf, inf, {0}])",
    "plane": "Position(tolerance=[inf, inf, {0}])",
    "place": "Position(tolerance=[{0}, {1}, {0}])",
    "corridor": "Pose(tolerance=[{0}, inf, {1}, inf, inf, inf])",
    "turn": "Orientation(tolerance=[{0}, {1}, {0}])",
    "free turn": "Orientation(tolerance=[{0}, {1}, 7.0])",
    "pose": "Pose(tolerance=[{0}, {0}, {0}, {1}, {1}, {1}])",
}

# Sends the tip to targets, and stops it now and then.
LIFE = """
q, held, solved = [start], 0, 0
for target, ticks, stops in life:
    for _ in range(ticks):
        step = tracker.step(np.array(target))
        q.append(step.q)
        held += step.status == bik.Status.HELD_BY_CONSTRAINT
        solved += step.success
    if stops:
        for _ in range(round(tracker.stop() / dt) + 2):
            q.append(tracker.step(None).q)
q = np.array(q)
"""


class Keeps(Attack):
    name = "tracker_keeps"
    promise = (
        "What a tracker keeps holds at every instant, between ticks and during stops too, under limits of any order"
    )
    page = "tracking"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A hard case begins at a tolerance, or has narrow ones; it has targets out of reach and round numbers."""
        joints = arms.easy_arm(random, int(random.integers(3, 8)))
        arms.put(joints, random, hard, 4)
        rates = tuple(np.exp(random.uniform(np.log([0.3, 1.0, 10.0]), np.log([3.0, 20.0, 500.0]))).tolist())
        if hard and random.random() < 0.5:
            rates = (1.0, float(random.choice([1.0, 10.0])), 100.0)
        least = 1e-3 if hard else 0.02
        keeps = [
            {
                "kind": str(random.choice(list(TASKS))),
                "tolerance": arms.triple(np.exp(random.uniform(np.log(least), np.log(0.5), 3))),
                "beside": float(random.choice([0.0, 0.5, 1.0 - 1e-9])) if hard else float(random.uniform(0.0, 0.8)),
            }
            for _ in range(int(random.integers(1, 4)))
        ]
        life = [
            {
                "to": int(random.integers(4)),
                "shift": arms.triple(random.normal(size=3) * random.choice([0.0, 0.01, 0.1, 3.0 if hard else 0.3])),
                "ticks": int(random.integers(1, 50)),
                "stops": bool(random.random() < 0.3),
            }
            for _ in range(int(random.integers(1, 8)))
        ]
        return {
            "joints": joints, "keeps": keeps, "life": life, "rates": rates, "orders": int(random.integers(1, 4)),
            "pose": bool(random.random() < 0.7), "dt": float(random.choice([1e-3, 4e-3, 0.01, 0.033])),
        }  # fmt: skip

    def program(self, case: Case) -> str:
        at = arms.configurations(case["joints"])
        poses = arms.kinematics(case["joints"], at)[0]
        keeps, life = [], []
        for keep, target in zip(case["keeps"], self.targets(case), strict=True):
            keeps.append(f"bik.Keep({target.tolist()}, bik.tasks.{TASKS[keep['kind']].format(*keep['tolerance'])})")
        for event in case["life"]:
            target = poses[event["to"]].copy()
            target[:3, 3] += event["shift"]
            life.append(((target if case["pose"] else target[:3, 3]).tolist(), event["ticks"], event["stops"]))
        rates = zip(KINDS[: case["orders"]], case["rates"], strict=False)
        return (
            f"{arms.written(case['joints'])}dt, start, life = {case['dt']}, {at[0].tolist()}, {life!r}\n"
            f"keep = [{', '.join(keeps)}]\n"
            f"limits = bik.Limits({', '.join(f'{kind}={rate}' for kind, rate in rates)})\n"
            f"tracker = bik.Tracker(robot, start, dt=dt, limits=limits, keep=keep){LIFE}"
        )

    def targets(self, case: Case) -> list[np.ndarray]:
        """The targets of all that is kept: from them the start is off by some of the smallest tolerance."""
        home = arms.kinematics(case["joints"], arms.configurations(case["joints"])[:1])[0][0]
        targets = []
        for keep in case["keeps"]:
            target, off = home.copy(), keep["beside"] * min(keep["tolerance"][:2])
            if keep["kind"] in ("plane", "place", "corridor"):
                target[:3, 3] += off * home[:3, 0] if keep["kind"] == "corridor" else (0.0, 0.0, off)
            else:
                target[:3, :3] = home[:3, :3] @ arms.turn(np.eye(3)[0], np.array([off]))[0]
            targets.append(target)
        return targets

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        curve = executed(left["q"], spline=case["orders"] > 1)
        poses = arms.kinematics(case["joints"], curve)[0]
        for keep, target in zip(case["keeps"], self.targets(case), strict=True):
            errors, tolerances = errors_of(keep, target, poses)
            beyond = (errors - tolerances * (1.0 + ROUNDING) - ROUNDING).max()
            if beyond > 0.0:
                raise BrokenError("what is kept does not hold", (keep["kind"], float(beyond)))
        return len(left["q"])

    def judge_refusal(self, case: Case, error: Exception) -> None:
        # A start at a tolerance may be beyond it by rounding.
        at_edge = any(keep["beside"] > 0.9 for keep in case["keeps"])
        if not (at_edge and "is to be kept" in str(error)) and "limit" not in str(error):
            raise error


def executed(q: np.ndarray, *, spline: bool) -> np.ndarray:
    """Samples of what the drives execute: lines between commands, or the uniform cubic B-spline that they control."""
    s = np.arange(SAMPLES)[:, None] / SAMPLES
    if not spline:
        lines = q[:-1, None] * (1.0 - s) + q[1:, None] * s
        return lines.reshape(-1, q.shape[1])
    q = np.concatenate([q[:1], q[:1], q])
    basis = ((1.0 - s) ** 3, 3.0 * s**3 - 6.0 * s**2 + 4.0, 3.0 * (1.0 - s) ** 3 - 6.0 * (1.0 - s) ** 2 + 4.0, s**3)
    curve = sum(q[k : len(q) - 3 + k, None] * weight for k, weight in enumerate(basis)) / 6.0
    return np.asarray(curve).reshape(-1, q.shape[1])


def errors_of(keep: dict[str, Any], target: np.ndarray, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Errors (m, k) at poses (m, 4, 4), and their tolerances (k,)."""
    one, two, _ = keep["tolerance"]
    apart = poses[:, :3, 3] - target[:3, 3]
    match keep["kind"]:
        case "tilt":
            axes, axis = poses[:, :3, 2], target[:3, 2]
            tilt = np.arctan2(np.linalg.norm(np.cross(axes, axis), axis=1), axes @ axis)
            return tilt[:, None], np.array([one])
        case "plane":
            return np.abs(apart[:, 2:]), np.array([one])
        case "place":
            return np.abs(apart), np.array([one, two, one])
        case "corridor":
            return np.abs(apart @ target[:3, :3])[:, [0, 2]], np.array([one, two])
    turned = np.abs(rotation_vectors(np.swapaxes(target[:3, :3], 0, 1) @ poses[:, :3, :3]))
    match keep["kind"]:
        case "turn":
            return turned, np.array([one, two, one])
        case "free turn":
            return turned[:, :2], np.array([one, two])
    return np.hstack([np.abs(apart @ target[:3, :3]), turned]), np.array([one] * 3 + [two] * 3)


def rotation_vectors(rotations: np.ndarray) -> np.ndarray:
    """Rotation vectors (m, 3) of rotations (m, 3, 3), by unit quaternions."""
    k, trace = rotations, np.trace(rotations, axis1=1, axis2=2)
    # The quaternion is the eigenvector of the largest eigenvalue of a symmetric matrix (Bar-Itzhack 2000).
    matrix = np.zeros((len(k), 4, 4))
    matrix[:, :3, :3] = k + np.swapaxes(k, 1, 2) - trace[:, None, None] * np.eye(3)
    vector = np.stack([k[:, 2, 1] - k[:, 1, 2], k[:, 0, 2] - k[:, 2, 0], k[:, 1, 0] - k[:, 0, 1]], axis=1)
    matrix[:, :3, 3] = matrix[:, 3, :3] = vector
    matrix[:, 3, 3] = trace
    quaternion = np.linalg.eigh(matrix)[1][:, :, -1]
    quaternion *= np.where(quaternion[:, 3:] < 0.0, -1.0, 1.0)
    sine = np.linalg.norm(quaternion[:, :3], axis=1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, quaternion[:, 3:])
    return np.where(sine > 0.0, quaternion[:, :3] * angle / np.where(sine > 0.0, sine, 1.0), 0.0)


ATTACKS = [Keeps()]
