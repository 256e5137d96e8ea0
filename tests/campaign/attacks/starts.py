"""Starts as they are read: a little outside their limits, at whole turns, with their joints in another order."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import arms, typed
from ..attack import Attack, BrokenError, Case

TURNING, SLIDING = np.radians(5.0), 5e-3  # what is led inside, as the page says
ROUNDING = 1e-6  # of the range, which is taken off
KINDS = ("velocity", "acceleration", "jerk")
SLACK = 1e-6  # of a limit of rates
SEEN = 1e-9  # rad or m

PROGRAM = """
def tried(call):
    try:
        return call(), None
    except bik.LimitError as error:
        return None, str(error)

limits = bik.Limits({limits})
target = robot.fk(inside)
solution = bik.solve(robot, target, start_q=start)
tracker, refusal = tried(lambda: bik.Tracker(robot, start, dt={dt}, limits=limits))
tracked = [] if tracker is None else [tracker.q] + [tracker.step(target).q for _ in range({ticks})]
plan, no_plan = tried(lambda: bik.plan_point_to_point(robot, start_q=start, end_q=end, limits=limits))
bare, no_bare = tried(lambda: bik.state_to_state(start, end, limits, robot=robot))
wrapped, no_turn = tried(lambda: robot.wrap(turned))
order = np.random.default_rng(0).permutation(len(start))
named = robot.q_from([robot.joint_names[i] for i in order], np.take(start, order))
"""


class StartsAsRead(Attack):
    name = "starts_as_read"
    promise = (
        "A start a little outside its limits is led inside without a jump; farther out it is refused; turns come off"
    )
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard starts have several joints outside, by round numbers, at the bound of what is taken, or beside it."""
        joints = arms.easy_arm(random, int(random.integers(1, 7)))
        arms.put(joints, random, hard, 2)
        for joint in joints:
            most = SLIDING if joint["kind"] == "prismatic" else TURNING
            share = float(random.choice([0.0, 1e-12, 1e-9, 1e-7, 1e-4, 0.1, 0.5, 1.0 - 1e-9, 1.0 + 1e-6, 1.5, 40.0]))
            beyond = typed.beside(random, share * most) if hard else float(random.uniform(0.0, 0.9)) * most
            is_out = random.random() < (0.5 if hard else 0.3)
            joint["out"] = (float(random.choice([-1.0, 1.0])), beyond) if is_out else None
            joint["rates"] = typed.limits(random, -1, 1) if hard else (1.0, 5.0, 50.0)
            joint["turns"] = int(random.integers(-2, 3)) if joint["kind"] != "prismatic" else 0
        return {"joints": joints, "orders": int(random.integers(2, 4)), "dt": float(random.choice([1e-3, 1e-2]))}

    def program(self, case: Case) -> str:
        joints = case["joints"]
        (inside, end), start = arms.configurations(joints), self.start(case)
        turned = inside + 2 * np.pi * np.array([joint["turns"] for joint in joints])
        limits = ", ".join(f"{kind}={values.tolist()}" for kind, values in self.limits(case).items())
        return (
            f"{arms.written(joints)}inside, end = np.array({inside.tolist()}), np.array({end.tolist()})\n"
            f"start, turned = np.array({start.tolist()}), np.array({turned.tolist()})\n"
            f"{PROGRAM.format(limits=limits, dt=case['dt'], ticks=300)}"
        )

    def start(self, case: Case) -> np.ndarray:
        lower, upper = arms.bounds(case["joints"])
        start = arms.configurations(case["joints"])[0]
        for i, joint in enumerate(case["joints"]):
            if joint["out"] and joint["kind"] != "continuous":
                side, beyond = joint["out"]
                start[i] = upper[i] + beyond if side > 0 else lower[i] - beyond
        return start

    def limits(self, case: Case) -> dict[str, np.ndarray]:
        rates = np.array([joint["rates"] for joint in case["joints"]])
        return dict(zip(KINDS[: case["orders"]], rates.T, strict=False))

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        joints, start = case["joints"], self.start(case)
        lower, upper = arms.bounds(joints)
        rounding = ROUNDING * np.where(np.isfinite(upper - lower), upper - lower, 1.0)
        beyond = np.maximum(np.maximum(lower - start, start - upper), 0.0)
        most = np.where([joint["kind"] == "prismatic" for joint in joints], SLIDING, TURNING)
        if np.any((left["solution"].q < lower) | (left["solution"].q > upper)):
            raise BrokenError("a solution is outside the limits", left["solution"].q.tolist())
        is_taken, is_edge = np.all(beyond <= most), np.any(np.abs(beyond - most) <= rounding + SEEN)
        for call in ("refusal", "no_plan"):
            if not is_edge and (left[call] is None) != is_taken:
                raise BrokenError("a start is taken or refused against what the page says", left[call])
            if left[call] and not ("robot." in left[call] or "inside" in left[call]):
                raise BrokenError("a refusal names no remedy", left[call])
        if left["tracker"] is not None:
            tracked = np.array(left["tracked"])
            self.judge_motion(tracked, (lower, upper, rounding), start, "tracker")
            before = np.concatenate((tracked[:1], tracked[:1], tracked))
            for order, (kind, limit) in enumerate(self.limits(case).items(), 1):
                step = limit * case["dt"] ** order
                excess = (np.abs(np.diff(before, order, axis=0)) - 8 * 2**order * np.finfo(float).eps * 4.0) / step
                if excess.max() > 1.0 + SLACK:
                    raise BrokenError(f"a tick exceeds the {kind} limit on the way inside", excess.max())
        if left["plan"] is not None:
            if not left["plan"].success:
                raise BrokenError("a plan from a start outside breaks limits", left["plan"].message)
            motion = left["plan"].trajectory
            self.judge_motion(
                motion.at(np.linspace(0, motion.duration, 200))[0], (lower, upper, rounding), start, "plan"
            )
        if left["bare"] is not None:
            said = {joint for joint, _, _ in left["bare"].start_outside}
            names = left["robot"].joint_names
            wrong = [j for j, name in enumerate(names) if (name in said) != (beyond[j] > rounding[j])]
            if any(abs(beyond[j] - rounding[j]) > SEEN for j in wrong):
                raise BrokenError("a bare motion does not say what it leads inside", sorted(said))
        self.judge_turns(left, (lower, upper))
        if not np.array_equal(left["named"], start):
            raise BrokenError("values with names come in another order", left["named"].tolist())
        return 4

    def judge_motion(
        self, q: np.ndarray, bounds: tuple[np.ndarray, np.ndarray, np.ndarray], start: np.ndarray, what: str
    ) -> None:
        lower, upper, rounding = bounds
        if np.any(np.abs(q[0] - start) > rounding + SEEN):
            raise BrokenError(f"the {what} does not begin at the reading", (q[0] - start).tolist())
        if np.any((q < np.minimum(lower, start) - SEEN) | (q > np.maximum(upper, start) + SEEN)):
            raise BrokenError(f"the {what} goes farther out than it begins")
        outside = np.maximum(lower - q, q - upper)
        if np.any(np.diff(np.maximum(outside, 0.0), axis=0) > SEEN):
            raise BrokenError(f"the {what} goes outwards again")

    def judge_turns(self, left: dict[str, Any], bounds: tuple[np.ndarray, np.ndarray]) -> None:
        lower, upper = bounds
        wrapped, inside = left["wrapped"], left["inside"]
        if wrapped is None:
            raise BrokenError("a posture inside the limits is not found again by its turns", left["no_turn"])
        if np.any((wrapped < lower) | (wrapped > upper)):
            raise BrokenError("a wrapped posture is outside the limits", wrapped.tolist())
        away = (wrapped - inside) / (2 * np.pi)
        if np.any(np.abs(away - np.round(away)) > SEEN):
            raise BrokenError("a wrapped posture is another one", away.tolist())

    def judge_refusal(self, case: Case, error: Exception) -> None:
        if "same configuration" in str(error):  # start and end are one
            return
        raise BrokenError("a right call is refused", str(error)) from error


ATTACKS: tuple[Attack, ...] = (StartsAsRead(),)
