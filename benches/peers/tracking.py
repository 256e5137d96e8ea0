"""Circle followed from Python, each point from the configuration before: `track` and `Tracker` beside the others."""

from __future__ import annotations

import gc
from collections.abc import Iterable
from dataclasses import dataclass
from time import perf_counter_ns

import numpy as np

from .adapter import Adapter
from .chain import Chain
from .restarting import BeetleIk

ROBOT = "iiwa14"
# Circle of Cheng et al. (2020), 0.2 m across, in 30 s, from a configuration on it.
CENTER, RADIUS, DURATION = np.array([0.3, 0.3, 1.0]), 0.1, 30.0
START = np.array([0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.6179441060, 0.0])
TOLERANCE = 1e-6  # m, at every point
STEPS = (150, 1500)
ROUNDS = 10


class BeetleIkTracker(BeetleIk):
    """Loop of the arm in Python."""

    name = "beetle-ik, Tracker.step"
    settings = "defaults, one call a point"

    def follow(self, points: np.ndarray, start: np.ndarray) -> list[np.ndarray]:
        """Follows as in `Adapter`."""
        import beetle_ik

        tracker = beetle_ik.Tracker(self.robot, start, dt=DURATION / len(points), position_tolerance=TOLERANCE)
        return [tracker.step(point).q for point in points]


class BeetleIkTrack(BeetleIk):
    """Whole path in one call."""

    name = "beetle-ik, track"
    settings = "defaults, one call for the path"

    def follow(self, points: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Follows as in `Adapter`."""
        import beetle_ik

        step = DURATION / len(points)
        path = beetle_ik.paths.from_samples(step * np.arange(1 + len(points)), np.vstack([points[-1], points]))
        return beetle_ik.track(self.robot, path, start, dt=step, position_tolerance=TOLERANCE).q[1:]


@dataclass(frozen=True)
class Followed:
    """Result of one library on one number of steps."""

    library: str
    steps: int
    milliseconds: float  # its quickest round
    missed: int  # points that it gave up, or missed by more than the tolerance
    largest_error: float  # m, at the others


def circle(steps: int) -> np.ndarray:
    """Points (steps, 3) once round, the last one at the start of the arm."""
    angle = 2.0 * np.pi * np.arange(1, steps + 1) / steps
    return CENTER + RADIUS * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(steps)])


def compare_tracking(chain: Chain, adapters: Iterable[Adapter]) -> list[Followed]:
    """Runs every library round the circle, in rounds, so that a busy machine hurts all alike."""
    adapters = list(adapters)
    rows = []
    for steps in STEPS:
        points = circle(steps)
        best = dict.fromkeys((adapter.name for adapter in adapters), np.inf)
        followed = {}
        gc.collect()
        gc.disable()
        for _ in range(ROUNDS):
            for adapter in adapters:
                begin = perf_counter_ns()
                followed[adapter.name] = adapter.follow(points, START)
                best[adapter.name] = min(best[adapter.name], (perf_counter_ns() - begin) * 1e-6)
        gc.enable()
        for name, configurations in followed.items():
            errors = _errors(chain, points, configurations)
            reached = errors <= TOLERANCE
            rows.append(
                Followed(
                    name,
                    steps,
                    best[name],
                    int(np.count_nonzero(~reached)),
                    float(np.max(errors, where=reached, initial=0.0)),
                )
            )
    return rows


def _errors(chain: Chain, points: np.ndarray, configurations: Iterable[np.ndarray | None]) -> np.ndarray:
    """Errors by Pinocchio's forward kinematics, in m; NaN if the library gave up."""
    distances = [
        np.nan if q is None else np.linalg.norm(chain.pose(np.asarray(q, dtype=float))[:3, 3] - point)
        for q, point in zip(configurations, points, strict=True)
    ]
    return np.array(distances)
