"""Batches of plans on one core and on two."""

from __future__ import annotations

import time
from collections.abc import Callable
from multiprocessing import get_context
from typing import Any

import beetle_ik as bik

from .clear import MotionBenchArm

COLUMNS = ["arm", "problems", "one core, ms a problem", "two cores, ms a problem", "gain", "gain of two empty loops"]
ROUNDS = 5
TURNS = 5_000_000  # of the empty loop


def batch_line(arm: MotionBenchArm, problems: list[dict[str, Any]], acceleration: float) -> list[list[str]]:
    """The line of the table for an arm, the best of several rounds by wall time; none without `plan_batch`."""
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
    """How much more two loops without memory do at once than one alone: what two cores of this machine can give."""
    context = get_context("spawn")
    with context.Pool(2) as pool:
        pool.map(loop, [1, 1])  # both processes are there
        alone = best(lambda: pool.map(loop, [TURNS]))
        both = best(lambda: pool.map(loop, [TURNS, TURNS], chunksize=1))
    return 2.0 * alone / both


def loop(turns: int) -> int:
    """Counts."""
    count = 0
    for _ in range(turns):
        count += 1
    return count


def best(call: Callable[[], object]) -> float:
    """The shortest time (s)."""
    times = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return min(times)
