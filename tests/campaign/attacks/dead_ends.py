"""Streams that lead an arm out of reach and back: joint limits and singular configurations must not keep it there."""

from __future__ import annotations

from typing import Any

import numpy as np

import beetle_ik as bik

from ..attack import Attack, BrokenError, Case

ARMS = ("panda", "iiwa14", "ur5e", "gen3", "ur10")
TIME = 6.0  # s after the target is back
ROUNDING = 1e-6  # relative, of differences of commands
SINGULAR = 0.02  # smallest singular value relative to the largest

# Leads the tip away and back, by the share of the way that the target has gone.
LED = """
def target(t):
    share = min(t / out, 1.0, max(1.0 - (t - out - pause) / back, 0.0))
    made = np.array(bik.pose(home[:3, 3] + share * way, rpy=share * turn))
    made[:3, :3] = made[:3, :3] @ home[:3, :3]
    made[:3, 3] += noise * random.uniform(-1.0, 1.0, 3)
    return made

random, tracker = np.random.default_rng(seed), bik.Tracker(robot, start, dt=dt, limits=limits)
q, said = [start], []
for tick in range(round((out + pause + back + time) / dt)):
    step = tracker.step(target(tick * dt))
    q.append(step.q)
    if np.abs(step.qd).max() < 1e-6:
        said.append(step.message)
end = (out + pause + back + time) + 60.0
settled = 0
# A motion of the joints may take longer, and from its end the arm follows.
while settled * dt < 1.0 and tick * dt < end:
    tick += 1
    step = tracker.step(target(tick * dt))
    settled = 0 if step.message.startswith("on the way") else settled + 1
    q.append(step.q)
q = np.array(q)
"""


class DeadEnds(Attack):
    name = "dead_ends"
    promise = "An arm that is led out of reach and back is on its target again, inside all limits"
    page = "tracking"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A hard stream is noisy, turns the hand, and goes along an axis as often as not."""
        arm = bik.Robot.named(str(random.choice(ARMS)))
        low, high = np.maximum(arm.lower, -3.0), np.minimum(arm.upper, 3.0)
        way = random.normal(size=3)
        if hard and random.random() < 0.5:
            way = np.eye(3)[random.integers(3)] * random.choice([-1.0, 1.0])
        share = random.uniform(-0.8, 0.8, arm.dof)
        if random.random() < 0.3:
            share = random.choice([-0.5, 0.0, 0.5], arm.dof)
        return {
            "arm": arm.name,
            "start": tuple((0.5 * (low + high) + 0.5 * (high - low) * share).tolist()),
            "way": tuple((way / np.linalg.norm(way) * random.choice([0.5, 1.0, 1.3, 2.0])).tolist()),
            "turn": tuple((random.choice([0.0, 0.5] if hard else [0.0]) * random.normal(size=3)).tolist()),
            "times": tuple(random.choice([0.5, 1.0, 2.0, 4.0], 3).tolist()),
            "dt": float(random.choice([0.01, 0.02])),
            "noise": float(random.choice([0.0, 0.001, 0.003] if hard else [0.0])),
            "acceleration": float(random.choice([5.0, np.inf])),
            "jerk": float(random.choice([50.0, np.inf])),
            "seed": int(random.integers(1000)),
        }

    def program(self, case: Case) -> str:
        more = {key: case[key] for key in ("acceleration", "jerk") if np.isfinite(case[key])}
        limits = ", ".join(f"{key}={value}" for key, value in {"velocity": 1.5, **more}.items())
        return (
            f"robot, start = bik.Robot.named('{case['arm']}'), np.array({list(case['start'])})\n"
            f"home, limits = robot.fk(start), bik.Limits({limits})\n"
            f"way, turn = np.array({list(case['way'])}), np.array({list(case['turn'])})\n"
            f"(out, pause, back), time, dt = {case['times']}, {TIME}, {case['dt']}\n"
            f"noise, seed = {case['noise']}, {case['seed']}\n{LED}"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        q, robot, dt = left["q"], left["robot"], case["dt"]
        values = np.linalg.svd(robot.jacobian(q[0]), compute_uv=False)
        # Singular arms enlarge noise and stray for a moment, as the page says: those stay that mostly are, over 4 s.
        enlarged, seconds = (6.0, dt) if values[-1] > SINGULAR * values[0] else (20.0, 4.0)
        last = robot.fk(q[-max(round(seconds / dt), 1) :])[:, :3, 3]
        distances = np.linalg.norm(last - left["home"][:3, 3], axis=1)
        away = min(np.median(distances), distances[-1])
        if away > 1e-3 + enlarged * case["noise"]:
            raise BrokenError("the arm stays away from its target", {"away": away, "said": left["said"][-1:]})
        if any(text.startswith("nearer than in the tick before") for text in left["said"]):
            raise BrokenError("an arm at rest is said to come nearer", left["said"])
        if np.any(q < robot.lower) or np.any(q > robot.upper):
            raise BrokenError("a joint is beyond its position limit", q)
        moves = np.vstack([np.zeros((3, q.shape[1])), np.diff(q, axis=0)])
        for order, limit in enumerate((1.5, case["acceleration"], case["jerk"])):
            most = np.abs(moves).max() / case["dt"] ** (order + 1)
            if most > limit * (1.0 + ROUNDING):
                raise BrokenError(f"a limit of order {order + 1} is broken", {"most": most, "limit": limit})
            moves = np.diff(moves, axis=0)
        return len(q)


ATTACKS = [DeadEnds()]
