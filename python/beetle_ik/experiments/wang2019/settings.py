"""Arms, limits, searches and paths of the experiment. The paper states none of the limits: they are ours."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

Criterion: TypeAlias = Literal["time", "joint_travel"]

UNITS: dict[Criterion, str] = {"time": "s", "joint_travel": "rad"}
WORDS: dict[Criterion, str] = {"time": "least time", "joint_travel": "least rotation"}

START, END = (1.0, 0.0, 0.0), (0.5, 1.5, 0.0)  # section IV-A.1
REACH = 2.0  # m; the paper does not state it
LINKS = (2, 3, 4, 5)
POPULATION, GENERATIONS = 50, 200
EVALUATIONS = POPULATION * (3 * GENERATIONS + 1)  # each beetle looks at two antennae and at where it goes
ONE_EACH = POPULATION * (GENERATIONS + 1)  # of a swarm that looks only at where it goes


def limits(acceleration: float) -> bik.Limits:
    """Half a turn a second; joints turn as far as they like."""
    return bik.Limits(lower=-np.inf, upper=np.inf, velocity=np.pi, acceleration=acceleration)


SCATTER = 1.4  # times a bound for means of 20 seeds: what the mean of a quick pass's few may come to

FROM_END_TO_END = limits(2 * np.pi)
ALONG_PATH = limits(4 * np.pi)


THREE_LINKS = bik.Robot.planar([1.0, 1.0, 1.0])  # of the motions along a path


def arm(links: int) -> bik.Robot:
    """An arm of equal links."""
    return bik.Robot.planar([REACH / links] * links)


@dataclass(frozen=True)
class Search:
    """A search and the evaluations that it may spend."""

    name: str
    solver: bik.BeetleSwarm | bik.PSO | bik.Genetic | bik.DifferentialEvolution | None
    evaluations: int

    def plan(
        self,
        links: int,
        objective: Criterion | Literal["tip_travel"],
        seed: int,
        obstacles: Sequence[bik.obstacles.Ellipse] = (),
    ) -> bik.Plan:
        """The motion of the paper's section IV-A for an arm of so many links."""
        return bik.plan_point_to_point(
            arm(links),
            START,
            END,
            method=bik.TPBSO(solver=self.solver),
            objective=objective,
            limits=FROM_END_TO_END,
            obstacles=obstacles,
            stop=bik.Stop(max_evaluations=self.evaluations),
            seed=seed,
        )

    def follow(
        self,
        path: bik.Path | NDArray[np.float64],
        objective: Criterion,
        seed: int,
        *,
        limits: bik.Limits,
        accuracy: float,
    ) -> bik.Plan:
        """A path of the paper's section IV-C, by three links of 1 m."""
        return bik.plan_along_path(
            THREE_LINKS,
            path,
            method=bik.TPBSO(solver=self.solver),
            objective=objective,
            limits=limits,
            accuracy=accuracy,
            stop=bik.Stop(max_evaluations=self.evaluations),
            seed=seed,
        )


TPBSO = Search("TPBSO", None, EVALUATIONS)
PSO = bik.PSO(population=POPULATION, stall_generations=None)
GENETIC = bik.Genetic(population=POPULATION, stall_generations=None)
# Smaller and quicker to take over a better vector: with POPULATION vectors and five links the budget ends too early.
# The best of 17 settings on 20 seeds of least time; on 20 others it did as well.
EVOLUTION = bik.DifferentialEvolution(population=40, update="immediate", stall_generations=None)
SAME_ITERATIONS = (Search("PSO", PSO, ONE_EACH), Search("GA", GENETIC, ONE_EACH))
SAME_EVALUATIONS = (
    Search("PSO, equal evaluations", PSO, EVALUATIONS),
    Search("GA, equal evaluations", GENETIC, EVALUATIONS),
    Search("DE, equal evaluations", EVOLUTION, EVALUATIONS),
)


@cache
def nearest(links: int) -> bik.Plan:
    """The library's own planner on the same motion."""
    return bik.plan_point_to_point(arm(links), START, END, limits=FROM_END_TO_END)


@cache
def bang_bang(links: int) -> float:
    """The least time (s) in which any motion within the limits can join the nearest configurations of the ends."""
    q = nearest(links).trajectory.q
    return max(_least_time(abs(way), np.pi, 2 * np.pi) for way in q[-1] - q[0])


def _least_time(way: float, velocity: float, acceleration: float) -> float:
    """Full acceleration, then full deceleration, with full speed between them where it is reached."""
    if way <= velocity**2 / acceleration:
        return 2.0 * math.sqrt(way / acceleration)
    return way / velocity + velocity / acceleration


def best_so_far(plans: Sequence[bik.Plan], evaluations: NDArray[np.float64]) -> NDArray[np.float64]:
    """The best cost of each plan's search after so many evaluations (plans, evaluations)."""
    rows = []
    for plan in plans:
        at = np.searchsorted(plan.history[:, 0], evaluations, side="right") - 1
        rows.append(plan.history[np.maximum(at, 0), 1])
    return np.array(rows)


def each(plan: Callable[[int], bik.Plan], seeds: Sequence[int]) -> list[bik.Plan]:
    """The plans of all seeds, on all cores: planning leaves the interpreter to others."""
    with ThreadPoolExecutor() as pool:
        return list(pool.map(plan, seeds))


def pentagram() -> bik.Path:
    """A star about (1, 1) with its points 0.5 m away."""
    return bik.paths.pentagram((1.0, 1.0, 0.0), 1.0, radius=0.5)


def trefoil() -> NDArray[np.float64]:
    """A smooth closed curve of three lobes about (1, 1): 51 points."""
    angle = np.linspace(0.0, 2 * np.pi, 51)
    radius = (1.0 + 0.35 * np.cos(3 * angle)) * 0.6 / 1.35
    return np.column_stack((1.0 + radius * np.cos(angle), 1.0 + radius * np.sin(angle), 0.0 * angle))
