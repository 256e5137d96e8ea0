"""Targets that move: jumps, a smooth path, and the same path as a slow, late and noisy stream."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .chain import Chain
from .motion import noisy

JUMP = 0.2  # m
RADIUS, PERIOD = 0.08, 4.0  # of the smooth path, m and s
STREAM_RATE, STREAM_NOISE = 60.0, 1e-3  # Hz, m and rad
STREAM_LATENCY, STREAM_JITTER = 20e-3, 4e-3  # s: smallest delay of a target, and the range of its random part
SEED = 20261


def jumps(chain: Chain, count: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Starts (n,) and goals (4, 4): 0.2 m away, same orientation, well inside reach and limits."""
    import beetle_ik

    robot = beetle_ik.Robot.from_urdf(chain.urdf, base=chain.base, tip=chain.tip)
    random = np.random.default_rng(SEED)
    lower, upper = np.maximum(chain.lower, -np.pi), np.minimum(chain.upper, np.pi)
    middle, half = (lower + upper) / 2.0, (upper - lower) / 2.0
    while count:
        start = middle + 0.6 * half * random.uniform(-1.0, 1.0, chain.dof)
        away = random.standard_normal(3)
        goal = chain.pose(start)
        goal[:3, 3] += JUMP * away / np.linalg.norm(away)
        there = beetle_ik.solve(robot, goal, start_q=start, prefer="nearest")
        inside = np.abs(there.q - middle) < 0.9 * half
        near = np.abs(there.q - start) < 0.7
        regular = min(robot.manipulability(start), robot.manipulability(there.q)) > 0.03
        if there.success and inside.all() and near.all() and regular:
            yield start, goal
            count -= 1


def smooth_path(chain: Chain, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """A start and poses (k, 4, 4): twice round a circle, the speed rising smoothly from zero to a constant."""
    start, goal = next(jumps(chain, 1))
    first = chain.pose(start)
    along = (goal[:3, 3] - first[:3, 3]) / JUMP
    across = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    across /= np.linalg.norm(across)
    time = dt * np.arange(round(2.5 * PERIOD / dt) + 1)
    angle = 2.0 * np.pi / PERIOD * eased(time, PERIOD)
    path = np.tile(first, (len(time), 1, 1))
    path[:, :3, 3] += RADIUS * ((1.0 - np.cos(angle))[:, None] * along + np.sin(angle)[:, None] * across)
    return start, path


def eased(time: np.ndarray, rise: float) -> np.ndarray:
    """Time whose rate rises smoothly from 0 to 1 until `rise` (s)."""
    s = np.minimum(time / rise, 1.0)
    return rise * (s**4 * (2.5 - 3.0 * s + s**2)) + np.maximum(time - rise, 0.0)


def stream(path: np.ndarray, dt: float) -> dict[int, tuple[np.ndarray, float]]:
    """Noisy targets and their times of measurement (s), by the tick in which they arrive."""
    random = np.random.default_rng(SEED)
    measured_at = np.arange(0.0, dt * (len(path) - 1), 1.0 / STREAM_RATE)
    ticks = np.round(measured_at / dt).astype(int)
    targets = noisy(path[ticks], STREAM_NOISE, random)
    arrives = measured_at + STREAM_LATENCY + STREAM_JITTER * random.random(len(ticks))
    return {
        1 + int(late / dt): (target, float(stamp * dt))
        for late, target, stamp in zip(arrives, targets, ticks, strict=True)
    }
