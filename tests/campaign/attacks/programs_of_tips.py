"""Programs of moves for two arms on one joint, judged at samples of the timed motion by numpy alone."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import arms
from ..attack import Attack, BrokenError, Case
from .programs import ACCELERATION, JERK, OFF_PATH, SAMPLES, Array, distances, followed

REACHED = 1e-5
"""Distance (m) from the end of a move."""
STILL = 1e-12
"""Joint motion (rad, m) of an arm that stays; beside a blend that moves all joints its tip stays as near as lines."""


def _tip(joints: list[arms.Joint], q: Array) -> Array:
    """The position of the tip of one chain at q (n,)."""
    return arms.kinematics(joints, q[None])[0][0, :3, 3]


class ProgramsOfTips(Attack):
    """Lines, joint moves and waits of two arms that share a joint; hard ones begin at limits and zeros, along axes."""

    name = "programs_of_tips"
    promise = "A move of one of several tips leads that tip as asked, while all others stay, or is refused by its name"
    page = "several_tips"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        shared = arms.easy_arm(random, 1)
        left, right = (arms.easy_arm(random, int(random.integers(5 if hard else 6, 8))) for _ in range(2))
        for joints in (shared, left, right):
            arms.put(joints, random, hard)
        n = 1 + len(left) + len(right)
        return {
            "shared": tuple(shared),
            "left": left,
            "right": right,
            "moves": [self._drawn(random, hard, n) for _ in range(random.integers(1, 6))],
            "jerk": bool(random.random() < 0.3),
            "position": bool(random.random() < 0.2),
        }

    def _drawn(self, random: np.random.Generator, hard: bool, n: int) -> dict[str, Any]:
        size = float(random.choice([0.01, 0.05, 0.1]))
        way = size * (np.eye(3)[random.integers(3)] if hard else random.normal(size=3))
        return {
            "kind": str(random.choice(["line", "line", "line", "to", "joints", "wait"])),
            "tip": int(random.integers(2)),
            "way": tuple(way.tolist()),
            "turn": float(random.choice([0.0, 0.0, 0.2])),
            "speed": [None, 0.05][random.integers(2)],
            "blend": float(random.choice([0.0, 0.0, 0.3 * size])),
            "q": tuple((0.1 * random.normal(size=n)).tolist()),
        }

    @staticmethod
    def chains(case: Case) -> list[list[arms.Joint]]:
        return [[*case["shared"], *case[side]] for side in ("left", "right")]

    @staticmethod
    def columns(case: Case) -> list[list[int]]:
        """The entries of q that are the joints of each chain."""
        n = len(case["left"])
        return [list(range(n + 1)), [0, *range(n + 1, n + 1 + len(case["right"]))]]

    def start(self, case: Case) -> Array:
        parts = [arms.configurations(joints)[0] for joints in (case["shared"], case["left"], case["right"])]
        return np.concatenate(parts)

    def program(self, case: Case) -> str:
        tips = [f"l{1 + len(case['left'])}", f"a{len(case['right'])}"]
        branches = [*case["shared"], *case["left"]], case["right"]
        lines = [
            arms.written(*branches, tips=f", tip={tips}"),
            f"q, program = np.array({self.start(case).tolist()!r}), []",
            "poses = list(robot.fk(q))",
        ]
        for i, move in enumerate(case["moves"]):
            name, blend, tip = f"name='m{i}'", f"blend={move['blend']!r}", move["tip"]
            if move["kind"] == "wait":
                lines.append(f"program.append(bik.moves.Wait(0.1, {name}))")
            elif move["kind"] == "joints":
                lines.append(
                    f"goal = np.clip(q + {move['q']!r}, robot.lower, robot.upper)\nposes = list(robot.fk(goal))\n"
                    f"program.append(bik.moves.Joints(goal, {blend}, {name}))"
                )
            else:
                call = f"Line(pose, speed={move['speed']!r}" if move["kind"] == "line" else "Joints(pose"
                lines.append(
                    f"pose = poses[{tip}] @ bik.pose((0, 0, 0), rpy=({move['turn']!r}, 0, 0))\n"
                    f"pose[:3, 3] = poses[{tip}][:3, 3] + {move['way']!r}\nposes[{tip}] = pose\n"
                    f"program.append(bik.moves.{call}, {blend}, tip={tips[tip]!r}, {name}))"
                )
        jerk = f", jerk={JERK}" if case["jerk"] else ""
        task = f"{{{tips[0]!r}: bik.tasks.Position()}}" if case["position"] else "None"
        lines.append(
            f"limits = bik.Limits(acceleration={ACCELERATION}{jerk})\n"
            f"plan = bik.plan_moves(robot, program, start_q=q, limits=limits, task={task})\n"
            "reports, motion = plan.moves, plan.trajectory"
        )
        return "\n".join(lines)

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        plan, motion, chains = left["plan"], left["motion"], self.chains(case)
        if not plan.success:
            raise BrokenError("a program that was planned breaks a limit", plan.message)
        t = np.linspace(0.0, motion.duration, SAMPLES)
        q, qd, qdd = motion.at(t)
        limits = [arms.bounds(chain) for chain in chains]
        lower, upper = (np.concatenate([limits[0][side], limits[1][side][1:]]) for side in (0, 1))
        if (q < lower - 1e-9).any() or (q > upper + 1e-9).any():
            raise BrokenError("a joint is outside its limits", (q.min(axis=0), q.max(axis=0)))
        if np.abs(qd).max() > 1.0 + 1e-9 or np.abs(qdd).max() > ACCELERATION * (1.0 + 1e-9):
            raise BrokenError("a joint is faster than its limits", (np.abs(qd).max(), np.abs(qdd).max()))
        columns = self.columns(case)
        paths = [arms.kinematics(chain, q[:, own])[0][:, :3, 3] for chain, own in zip(chains, columns, strict=True)]
        ends = motion.at(np.array([report.end for report in left["reports"]]))[0]
        at, before = [path[0] for path in paths], 0.0
        for i, (move, report) in enumerate(zip(case["moves"], left["reports"], strict=True)):
            blend = move["blend"] if i + 1 < len(case["moves"]) and move["kind"] != "wait" else 0.0
            side, begin = move["tip"], before
            before = blend
            if move["kind"] == "wait":
                continue
            if move["kind"] == "joints":
                goal = np.clip(self.start(case) + move["q"], lower, upper)
                at = [_tip(chain, goal[own]) for chain, own in zip(chains, columns, strict=True)]
                continue
            start, at[side] = at[side], at[side] + move["way"]
            on = (t >= report.start) & (t <= report.end)
            near = [np.linalg.norm(paths[side] - place, axis=1) for place in (start, at[side])]
            on &= (near[0] >= begin) & (near[1] >= blend)
            if move["kind"] == "line" and (off := distances(paths[side][on], start, move).max(initial=0.0)) > OFF_PATH:
                raise BrokenError("a move leaves its path", (i, off))
            missed = np.linalg.norm(_tip(chains[side], ends[i, columns[side]]) - at[side])
            if blend == 0.0 and missed > REACHED:
                raise BrokenError("a move does not end where it is asked to", (i, missed))
            others = np.setdiff1d(np.arange(q.shape[1]), columns[side][1:])
            still = paths[1 - side][on]
            moved = np.ptp(q[on][:, others], axis=0).max() if on.any() else 0.0
            if begin == blend == 0.0 and moved > STILL:
                raise BrokenError("a joint of the other tip moves", (i, moved))
            if on.any() and (apart := np.linalg.norm(np.ptp(still, axis=0))) > 2.0 * OFF_PATH:
                raise BrokenError("the other tip moves", (i, apart))
        return SAMPLES

    def judge_refusal(self, case: Case, error: Exception) -> None:
        if "'m" not in str(error) and "takes no time" not in str(error):
            raise BrokenError("a program is refused, and no move is named", error)
        if "was not found" not in str(error) and "cannot be reached" not in str(error):
            return
        q, limits = self.start(case), [arms.bounds(chain) for chain in self.chains(case)]
        lower, upper = (np.concatenate([limits[0][side], limits[1][side][1:]]) for side in (0, 1))
        for move in case["moves"]:
            if move["blend"] > 0.0 or move["kind"] == "to":
                return  # a judge that chooses no configurations cannot tell
            if move["kind"] == "joints":
                q = np.clip(self.start(case) + move["q"], lower, upper)
            elif move["kind"] == "line":
                own = self.columns(case)[move["tip"]]
                reached = followed(self.chains(case)[move["tip"]], q[own], move, held=1)
                if reached is None:
                    return
                q = q.copy()
                q[own] = reached
        raise BrokenError("a program that can be followed is refused", error)


ATTACKS = [ProgramsOfTips()]
