"""Figures of a motion commanded tick by tick."""

from __future__ import annotations

import gc
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from time import perf_counter_ns

import numpy as np

from .chain import Chain
from .mover import Mover

SETTLED = 2e-3  # m
SETTLED_DEVIATIONS = 3.0  # of the noise


@dataclass(frozen=True)
class Commanded:
    """Commands of one library: `q` (k + 1, n) from the start on, `times` (k,) in µs."""

    q: np.ndarray
    times: np.ndarray


def drive(
    movers: Sequence[Mover], start: np.ndarray, targets: np.ndarray, *, in_a_row: int = 1
) -> dict[str, Commanded]:
    """Gives all libraries the same targets (k, 4, 4), `in_a_row` ticks to one library before the next.

    With 1, each tick comes after other work and finds the caches cold, as in a loop that also does something else.
    """
    commanded = {
        mover.name: Commanded(np.tile(start, (len(targets) + 1, 1)), np.empty(len(targets))) for mover in movers
    }
    for mover in movers:
        mover.begin(start)
    gc.collect()
    gc.disable()
    for first in range(0, len(targets), in_a_row):
        for mover in movers:
            step, mine = mover.step, commanded[mover.name]
            for i in range(first, min(first + in_a_row, len(targets))):
                target = targets[i]
                begin = perf_counter_ns()
                q = step(target)
                mine.times[i] = (perf_counter_ns() - begin) * 1e-3
                mine.q[i + 1] = q
    gc.enable()
    return commanded


def tips(chain: Chain, q: np.ndarray) -> np.ndarray:
    """Tip positions (k, 3) by Pinocchio."""
    return np.array([chain.pose(each)[:3, 3] for each in q])


def settling_time(distances: np.ndarray, dt: float, noise: float) -> float:
    """Time (s) after which the tip stays near the goal; NaN if it is not near it at the end."""
    near = distances <= max(SETTLED, SETTLED_DEVIATIONS * noise)
    if not near[-1]:
        return np.nan
    outside = np.flatnonzero(~near)
    return dt * (outside[-1] + 1 if len(outside) else 0)


def off_the_line(points: np.ndarray, start: np.ndarray, goal: np.ndarray) -> float:
    """Largest distance (m) of the points from the segment between start and goal."""
    along = goal - start
    share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
    return float(np.linalg.norm(points - start - share[:, None] * along, axis=1).max())


def lag(points: np.ndarray, path: np.ndarray, dt: float) -> float:
    """Delay (s) of the points behind the path, both (k, 3): least-squares fit along the velocity of the path."""
    velocity = np.gradient(path, dt, axis=0)
    return float(((path - points) * velocity).sum() / (velocity**2).sum())


def delayed(path: np.ndarray, ticks: float) -> np.ndarray:
    """Delays the path (k, 3) by `ticks`."""
    time = np.arange(len(path))
    return np.column_stack([np.interp(time - ticks, time, axis) for axis in path.T])


def rms_rate(q: np.ndarray, order: int, dt: float) -> float:
    """Root mean square over ticks and joints of a finite difference: 2 for acceleration, 3 for jerk."""
    return float(np.sqrt(np.mean(np.diff(q, order, axis=0) ** 2))) / dt**order


def excess(q: np.ndarray, order: int, dt: float, limit: float) -> float:
    """Largest finite difference of a joint relative to its limit; at most 1, within rounding, if the limit is kept."""
    return float(np.abs(np.diff(q, order, axis=0)).max()) / dt**order / limit


def noisy(poses: np.ndarray, deviation: float, random: np.random.Generator) -> np.ndarray:
    """Poses (k, 4, 4) with normal noise of this standard deviation on each coordinate (m) and about each axis (rad)."""
    moved = poses.copy()
    moved[:, :3, 3] += deviation * random.standard_normal((len(poses), 3))
    turns = deviation * random.standard_normal((len(poses), 3))
    moved[:, :3, :3] = rotations(turns) @ poses[:, :3, :3]
    return moved


def rotations(vectors: np.ndarray) -> np.ndarray:
    """Rotation matrices (k, 3, 3) of rotation vectors (k, 3)."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    x, y, z = vectors.T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    return np.eye(3) + np.sinc(angle / np.pi) * cross + 0.5 * np.sinc(angle / (2.0 * np.pi)) ** 2 * (cross @ cross)


def median(values: Iterable[float]) -> float:
    """Median with NaN as infinite; an infinite median is returned as NaN."""
    finite = np.nan_to_num(np.fromiter(values, float), nan=np.inf)
    middle = float(np.median(finite))
    return middle if np.isfinite(middle) else np.nan
