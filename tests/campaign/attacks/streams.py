"""Streams of targets that lose packets: the deviation of the tip from the path that the targets were taken from."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..attack import Attack, BrokenError, Case

STARTS = {
    "panda": [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8],
    "iiwa14": [0.2, 0.6, 0.0, -1.4, 0.0, 0.9, 0.3],
    "ur5e": [0.3, -1.2, 1.6, -1.9, -1.5, 0.4],
}
KNOWN = 2.0  # s: until then the tracker learns how noisy the stream is
# Times the deviation without losses plus the way in the longest gap; 1.1 in 1,986 of 2,000 cases.
ALLOWED = 2.0

# `run` returns the largest distance of the tip from the path, and of the path from where it was in the last packet.
FOLLOWED = """
def pose(t):
    made = home.copy()
    made[:3, 3] += extent * np.sin(frequency * t)
    turn = bik.pose([0, 0, 0], rpy=0.2 * np.sin(0.7 * frequency * t))
    made[:3, :3] = turn[:3, :3] @ made[:3, :3]
    return made

def run(kept):
    random, tracker = np.random.default_rng(seed), bik.Tracker(robot, start, dt=dt, limits=limits)
    worst, longest, sent, last = 0.0, 0.0, 0, 0.0
    for tick in range(1, round(8.0 / dt) + 1):
        t, packet = tick * dt, None
        if t * rate >= sent + 1:
            sent += 1
            shift = noise * random.normal(size=3)
            if kept[sent % len(kept)] or t < 0.5:
                packet, last = pose(t), t
                packet[:3, 3] += shift
        q = tracker.step(packet).q
        if t > known:
            clean = pose(t)[:3, 3]
            worst = max(worst, np.linalg.norm(robot.fk(q)[:3, 3] - clean))
        if t > 0.5:  # what a gap before has left may last
            longest = max(longest, np.linalg.norm(pose(last)[:3, 3] - pose(t)[:3, 3]))
    return worst, longest

lossless, lossy = run([True]), run(kept)
"""


class LossyStreams(Attack):
    name = "lossy_streams"
    promise = "Lost packets of a stream cost no more than the way of the target during the longest gap"
    page = "tracking"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A hard stream is noisy and loses up to half of its packets, up to ten in a row."""
        burst = int(random.choice([1, 2, 3, 5, 10] if hard else [1, 2]))
        starts = random.random(240) < random.choice([0.05, 0.1, 0.2, 0.5] if hard else [0.05, 0.1]) / burst
        lost = np.convolve(starts, np.ones(burst))[: len(starts)] > 0
        return {
            "arm": str(random.choice(list(STARTS))),
            "dt": float(random.choice([0.004, 0.01, 0.02])),
            "rate": float(random.choice([15.0, 30.0, 60.0, 120.0])),
            "noise": float(random.choice([0.0, 0.0005, 0.001, 0.002, 0.005] if hard else [0.0, 0.001])),
            "extent": tuple(random.uniform(0.02, 0.1, 3).tolist()),
            "frequency": tuple(random.uniform(0.6, 1.8, 3).tolist()),
            "jerk": float(random.choice([50.0, np.inf])),
            "kept": (~lost).tolist(),
            "seed": int(random.integers(1000)),
        }

    def program(self, case: Case) -> str:
        jerk = "" if np.isinf(case["jerk"]) else f", jerk={case['jerk']}"
        return (
            f"robot, start = bik.Robot.named('{case['arm']}'), np.array({STARTS[case['arm']]})\n"
            f"home, limits = robot.fk(start), bik.Limits(velocity=1.5, acceleration=5.0{jerk})\n"
            f"extent, frequency = np.array({list(case['extent'])}), np.array({list(case['frequency'])})\n"
            f"dt, rate, noise, seed, known = {case['dt']}, {case['rate']}, {case['noise']}, {case['seed']}, {KNOWN}\n"
            f"kept = {case['kept']}\n{FOLLOWED}"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        (without, _), (worst, gap) = left["lossless"], left["lossy"]
        if worst > ALLOWED * (without + gap) + 1e-3:
            raise BrokenError("losses cost more than the gap", {"worst": worst, "without": without, "gap": gap})
        return round(8.0 / case["dt"])


ATTACKS = [LossyStreams()]
