"""Timing and judging."""

from __future__ import annotations

import gc
from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter_ns

import numpy as np
import pinocchio as pin

from .adapter import Adapter
from .chain import Chain

LIMIT_SLACK = 1e-9  # rad or m: what a library may lose in rounding at a limit


@dataclass(frozen=True)
class Times:
    """One library on one robot and task."""

    solved: float  # percent of the targets
    median: float  # µs, as the next two; failures count with the time that they took
    mean: float
    p99: float


Solver = Callable[[np.ndarray, np.ndarray], np.ndarray | None]


def interleave(
    solvers: dict[str, Solver], targets: np.ndarray, starts: np.ndarray, rounds: int
) -> dict[str, tuple[np.ndarray, list[np.ndarray | None]]]:
    """Times in µs and answers of each solver in its quickest round.

    All solvers get a target before any gets the next, in an order drawn anew each time: a busy machine then hurts all
    alike, and none always follows the one that leaves it the caches warm. A round counts as a whole, since the best of
    several calls would hide restarts.
    """
    names = list(solvers)
    order = np.random.default_rng(0)
    best: dict[str, tuple[np.ndarray, list[np.ndarray | None]]] = {}
    gc.collect()
    gc.disable()
    for _ in range(rounds):
        times = {name: np.empty(len(targets)) for name in names}
        answers: dict[str, list[np.ndarray | None]] = {name: [] for name in names}
        for i, (target, start) in enumerate(zip(targets, starts, strict=True)):
            for name in order.permutation(names):
                solve = solvers[name]
                begin = perf_counter_ns()
                q = solve(target, start)
                times[name][i] = (perf_counter_ns() - begin) * 1e-3
                answers[name].append(q)
        for name in names:
            if name not in best or times[name].mean() < best[name][0].mean():
                best[name] = times[name], answers[name]
    gc.enable()
    return best


def judge(chain: Chain, targets: np.ndarray, times: np.ndarray, answers: list, tolerance: float) -> Times:
    """Solved means within the tolerance by Pinocchio's forward kinematics and inside the limits."""
    solved = [
        q is not None and _reaches(chain, q, target, tolerance) for q, target in zip(answers, targets, strict=True)
    ]
    return Times(
        100.0 * float(np.mean(solved)), *map(float, (np.median(times), times.mean(), np.quantile(times, 0.99)))
    )


def _reaches(chain: Chain, q: np.ndarray, target: np.ndarray, tolerance: float) -> bool:
    if not (np.all(q >= chain.lower - LIMIT_SLACK) and np.all(q <= chain.upper + LIMIT_SLACK)):
        return False
    pose = chain.pose(np.asarray(q))
    if target.shape == (3,):
        return bool(np.linalg.norm(pose[:3, 3] - target) <= tolerance)
    rotation = np.linalg.norm(pin.log3(target[:3, :3].T @ pose[:3, :3]))
    return bool(np.linalg.norm(pose[:3, 3] - target[:3, 3]) <= tolerance and rotation <= tolerance)


def per_call(functions: dict[str, Callable[[np.ndarray], object]], configurations: np.ndarray) -> dict[str, float]:
    """Nanoseconds a call of each function, its best of five interleaved passes over the configurations."""
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
    """Poses a second of beetle-ik's `solve_batch`, best of three."""
    import beetle_ik

    rates = []
    for _ in range(3):
        begin = perf_counter_ns()
        beetle_ik.solve_batch(adapter.robot, targets, threads=threads)
        rates.append(len(targets) / (perf_counter_ns() - begin) * 1e9)
    return max(rates)
