"""The compared searches, and statistics of their costs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from statistics import fmean, stdev

import numpy as np
from numpy.typing import ArrayLike, NDArray

import beetle_ik as bik

from ...report import BLUE, GREEN, PURPLE, VERMILION
from .planner import PAPERS_ELBOWS, Objective, Solver, plan_along, plan_between
from .settings import END, EVALUATIONS, FROM_END_TO_END, POPULATION, START, THREE_LINKS, Criterion, arm, each

STANDARD_ERRORS = 2.0  # standard errors by which a mean has to be lower
_CLOSE = 1.01  # multiple of the final cost that counts as converged


@dataclass(frozen=True)
class Search:
    """A search, its budget of evaluations, and the colour of its lines."""

    name: str
    solver: Solver
    color: str
    evaluations: int = EVALUATIONS

    def limited_to(self, evaluations: int) -> Search:
        """Returns the same search with another budget."""
        return replace(self, evaluations=evaluations)

    def plan(
        self,
        links: int,
        objective: Objective,
        seed: int,
        *,
        elbows: tuple[int, int] = PAPERS_ELBOWS,
        obstacles: Sequence[bik.obstacles.Ellipse] = (),
    ) -> bik.Plan:
        """Plans the motion of the paper's section IV-A for an arm of `links` links."""
        return plan_between(
            arm(links),
            START,
            END,
            objective,
            limits=FROM_END_TO_END,
            solver=self.solver,
            stop=bik.Stop(max_evaluations=self.evaluations),
            seed=seed,
            elbows=elbows,
            obstacles=obstacles,
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
        """Plans along a path of the paper's section IV-C, with three links of 1 m."""
        return plan_along(
            THREE_LINKS,
            path,
            objective,
            limits=limits,
            accuracy=accuracy,
            solver=self.solver,
            stop=bik.Stop(max_evaluations=self.evaluations),
            seed=seed,
        )


# The library's defaults. The paper prints no constants of its swarm: the defaults were chosen on these motions, among
# some 150 settings. PSO has the constants of Clerc and Kennedy, the genetic algorithm mostly MATLAB's.
USUAL = (
    Search("TPBSO", bik.papers.BeetleSwarm(stall_generations=None), BLUE),
    Search("PSO", bik.papers.PSO(population=POPULATION, stall_generations=None), VERMILION),
    Search("GA", bik.papers.Genetic(population=POPULATION, stall_generations=None), PURPLE),
)
# Winners printed by `python -m beetle_ik.experiments.wang2019.tuning`.
TUNED = (
    Search(
        "TPBSO",
        bik.papers.BeetleSwarm(
            population=40,
            inertia=0.808,
            c1=0.505,
            c2=2.21,
            velocity_limit=0.0553,
            velocity_share=0.811,
            step=0.3,
            step_decay=0.986,
            step_over_antennae=3.48,
            stall_generations=None,
        ),
        BLUE,
    ),
    Search("PSO", bik.papers.PSO(population=50, stall_generations=None), VERMILION),  # default options
    Search(
        "GA",
        bik.papers.Genetic(
            population=80,
            elite_share=0.186,
            crossover_share=0.328,
            tournament=4,
            mutation_rate=0.665,
            mutation_scale=0.0762,
            mutation_decay=0.991,
            stall_generations=None,
        ),
        PURPLE,
    ),
    Search("DE", bik.DifferentialEvolution(population=50, stall_generations=None), GREEN),  # default options
)
TPBSO, RIVALS = "TPBSO", ("PSO", "GA")
"""The paper's own search, and the rivals that the paper compares; differential evolution is our addition."""

Plans = Mapping[str, Sequence[bik.Plan]]
"""Plans of each search by its name, one for each seed."""


def plan_all(
    searches: Sequence[Search], plan: Callable[[Search, int], bik.Plan], seeds: Sequence[int]
) -> dict[str, list[bik.Plan]]:
    """Plans with each search and seed."""
    return {search.name: each(partial(plan, search), seeds) for search in searches}


def best_so_far(plans: Sequence[bik.Plan], evaluations: ArrayLike) -> NDArray[np.float64]:
    """Returns the best cost of each plan's search at these evaluations (plans, evaluations), penalties included."""
    rows = []
    for plan in plans:
        at = np.searchsorted(plan.history[:, 0], evaluations, side="right") - 1
        rows.append(plan.history[np.maximum(at, 0), 1])
    return np.array(rows)


def iterations_to_converge(plan: bik.Plan, swarm: Search) -> int:
    """Returns the first iteration of a beetle swarm, of three evaluations a beetle, within 1 % of the final cost."""
    iterations = swarm.evaluations // (3 * swarm.solver.population)
    history = best_so_far([plan], swarm.solver.population * (3 * np.arange(iterations + 1) + 1))[0]
    return int(np.argmax(history <= _CLOSE * history[-1]))


def costs(plans: Sequence[bik.Plan]) -> list[float]:
    """Returns the costs of the plans."""
    return [plan.cost for plan in plans]


TOO_FEW = "One run of each search decides nothing: run without --short."
OURS = "Reach, limits and the constants of the searches are ours: the paper states none."


def is_lower(one: Sequence[float], other: Sequence[float]) -> bool:
    """Whether the mean of `one` is lower than that of `other`, by more than two standard errors of the difference.

    The result is False if one of them has no value.
    """
    if not one or not other:
        return False
    if min(len(one), len(other)) < 2:
        return fmean(one) < fmean(other)
    error = (stdev(one) ** 2 / len(one) + stdev(other) ** 2 / len(other)) ** 0.5
    return bool(fmean(other) - fmean(one) > STANDARD_ERRORS * error)
