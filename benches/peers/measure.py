"""Timing and judging."""

from __future__ import annotations

import gc
from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter_ns
from typing import Any

import numpy as np
import pinocchio as pin

from .adapter import Adapter
from .chain import Chain

LIMIT_SLACK = 1e-9  # rad or m: what a library may lose in rounding at a limit


@dataclass(frozen=True)
class Times:
    """Times of one library on one robot and task."""

    solved: int  # calls, of all below
    calls: int
    median: float  # µs, as the next two; failures count with the time that they took
    mean: float
    p99: float


Solver = Callable[[np.ndarray, np.ndarray], Any]
Choice = Callable[[Any], np.ndarray | None]


@dataclass(frozen=True)
class Calls:
    """Times and answers of one library: `times` (rounds, targets) in µs, `answers` one list a round."""

    times: np.ndarray
    answers: list[list[Any]]


def interleave(
    solvers: dict[str, Solver], targets: np.ndarray, starts: np.ndarray, *, in_a_row: int, rounds: int
) -> dict[str, Calls]:
    """Makes every call of every solver, `in_a_row` targets by one before the next solver gets the same.

    With 1, each call comes after other work and finds the caches cold; with more, the caches are its own. The order is
    drawn anew each time, so that none always follows the same other. A busy machine hurts long calls more than short
    ones, which fit between two interruptions.
    """
    calls = {
        name: Calls(np.empty((rounds, len(targets))), [[None] * len(targets) for _ in range(rounds)])
        for name in solvers
    }
    order = np.random.default_rng(0)
    gc.collect()
    gc.disable()
    for a_round in range(rounds):
        for first in range(0, len(targets), in_a_row):
            for name in order.permutation(list(solvers)):
                solve, times, answers = solvers[name], calls[name].times[a_round], calls[name].answers[a_round]
                if in_a_row > 1:
                    solve(targets[first - 1], starts[first - 1])  # not timed: the call that finds the caches cold
                for i in range(first, min(first + in_a_row, len(targets))):
                    target, start = targets[i], starts[i]
                    begin = perf_counter_ns()
                    q = solve(target, start)
                    times[i] = (perf_counter_ns() - begin) * 1e-3
                    answers[i] = q
    gc.enable()
    return calls


def judge(chain: Chain, targets: np.ndarray, calls: Calls, tolerance: float, chosen: Choice) -> Times:
    """Judges answers: solved means within the tolerance by Pinocchio and inside the limits, in every round.

    `chosen` takes the configuration from an answer.

    Of a target's calls the median counts: it leaves out what interrupted one of them, a short call and a long one
    alike, and rewards no library for the luckiest of its random restarts, as the quickest call would.
    """
    solved = [
        (q := chosen(answer)) is not None and _reaches(chain, q, target, tolerance)
        for answers in calls.answers
        for answer, target in zip(answers, targets, strict=True)
    ]
    times = np.median(calls.times, axis=0)
    return Times(sum(solved), len(solved), *map(float, (np.median(times), times.mean(), np.quantile(times, 0.99))))


def _reaches(chain: Chain, q: np.ndarray, target: np.ndarray, tolerance: float) -> bool:
    if not (np.all(q >= chain.lower - LIMIT_SLACK) and np.all(q <= chain.upper + LIMIT_SLACK)):
        return False
    pose = chain.pose(np.asarray(q))
    if target.shape == (3,):
        return bool(np.linalg.norm(pose[:3, 3] - target) <= tolerance)
    rotation = np.linalg.norm(pin.log3(target[:3, :3].T @ pose[:3, :3]))
    return bool(np.linalg.norm(pose[:3, 3] - target[:3, 3]) <= tolerance and rotation <= tolerance)


def per_call(functions: dict[str, Callable[[np.ndarray], object]], configurations: np.ndarray) -> dict[str, float]:
    """Measures nanoseconds a call of each function, its best of five interleaved passes over the configurations."""
    rows = list(configurations)
    best = dict.fromkeys(functions, np.inf)
    for _ in range(5):
        for name, function in functions.items():
            begin = perf_counter_ns()
            for q in rows:
                function(q)
            best[name] = min(best[name], (perf_counter_ns() - begin) / len(rows))
    return best


def batch_rate(adapter: Adapter, targets: np.ndarray, threads: int) -> float:
    """Measures poses a second of beetle-ik's `solve_batch`, best of three."""
    import beetle_ik

    rates = []
    for _ in range(3):
        begin = perf_counter_ns()
        beetle_ik.solve_batch(adapter.robot, targets, threads=threads)
        rates.append(len(targets) / (perf_counter_ns() - begin) * 1e9)
    return max(rates)
