"""Batches of plans on one core and on two."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import beetle_ik as bik

from .clear import MotionBenchArm

COLUMNS = ["arm", "problems", "one core, ms a problem", "two cores, ms a problem", "gain", "gain of two empty loops"]
ROUNDS = 5
LOOP = "import time; begin = time.perf_counter()\nfor _ in range(20_000_000): pass\nprint(time.perf_counter() - begin)"


def batch_line(arm: MotionBenchArm, problems: list[dict[str, Any]], acceleration: float) -> list[list[str]]:
    """Measures the line of the table for an arm, the best of several rounds by wall time; none without `plan_batch`."""
    if not hasattr(bik, "plan_batch"):
        return []
    limits = bik.Limits(acceleration=acceleration)
    batch = [
        {"start_q": problem["start"], "end_q": problem["goal"], "obstacles": arm.scene(problem)} for problem in problems
    ]
    one, two = (
        best(lambda threads=threads: bik.plan_batch(arm.robot, batch, limits=limits, threads=threads))
        for threads in (1, 2)
    )
    count = len(problems)
    figures = [f"{1e3 * one / count:.3g}", f"{1e3 * two / count:.3g}", f"{one / two:.2f}", f"{gain_of_loops():.2f}"]
    return [[arm.name, str(count), *figures]]


def gain_of_loops() -> float:
    """Speedup of two loops without memory over one: the most that two cores of this machine can give."""
    alone, both = (min(looped(count) for _ in range(ROUNDS)) for count in (1, 2))
    return 2.0 * alone / both


def looped(count: int) -> float:
    """Time (s) of this many loops at once, each in a process of its own; of the slowest."""
    command = [sys.executable, "-c", LOOP]
    processes = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(count)]
    return max(float(process.communicate()[0]) for process in processes)


def best(call: Callable[[], object]) -> float:
    """Shortest time (s)."""
    times = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return min(times)
