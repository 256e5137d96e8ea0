"""Tunes the four searches alike: the same number of settings each, on seeds that no reported figure uses.

    python -m beetle_ik.experiments.wang2019.tuning

prints the best of `SETTINGS` settings of each search: its defaults, and settings drawn at random from the ranges below.
They run on the motions of Figures 2 to 9 and are ranked by the geometric mean of their mean costs. The winners are kept
in `searches.py`. The run takes about five minutes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from statistics import fmean

import numpy as np

import beetle_ik as bik

from .planner import Objective, Solver
from .searches import Search
from .settings import each

SETTINGS = 32  # settings of each search, the defaults among them
TRAINING_SEEDS = range(1000, 1010)
# Motions for tuning. With two links all motions without a detour have the same rotation, so time alone is tried.
MOTIONS: tuple[tuple[Objective, int], ...] = (
    ("time", 2),
    ("time", 3),
    ("time", 4),
    ("time", 5),
    ("joint_travel", 3),
    ("joint_travel", 4),
    ("joint_travel", 5),
)
_POPULATIONS = (20, 30, 40, 50, 80)


class _Draw:
    """Random numbers in the ranges of a setting."""

    def __init__(self) -> None:
        self._random = np.random.default_rng(0)

    def between(self, low: float, high: float) -> float:
        """Draws uniformly, in three digits."""
        return float(f"{self._random.uniform(low, high):.3g}")

    def scale(self, low: float, high: float) -> float:
        """Draws uniformly in the logarithm, in three digits."""
        return float(f"{math.exp(self._random.uniform(math.log(low), math.log(high))):.3g}")

    def population(self) -> int:
        """Draws one of a few sizes."""
        return int(self._random.choice(_POPULATIONS))

    def coin(self) -> bool:
        """Draws True or False."""
        return bool(self._random.integers(2))


def _beetles(draw: _Draw) -> Solver:
    return bik.papers.BeetleSwarm(
        population=draw.population(),
        inertia=draw.between(0.4, 0.9),
        c1=draw.between(0.5, 2.5),
        c2=draw.between(0.5, 2.5),
        velocity_limit=draw.scale(0.05, 1.0),
        velocity_share=draw.between(0.3, 1.0),
        step=draw.scale(0.2, 2.0),
        step_decay=draw.between(0.93, 0.995),
        step_over_antennae=draw.scale(1.0, 10.0),
        direction="printed" if draw.coin() else "downhill",
        stall_generations=None,
    )


def _particles(draw: _Draw) -> Solver:
    return bik.papers.PSO(
        population=draw.population(),
        form="inertia",
        inertia=draw.between(0.4, 0.9),
        c1=draw.between(0.5, 2.5),
        c2=draw.between(0.5, 2.5),
        velocity_limit=draw.scale(0.05, 1.0),
        stall_generations=None,
    )


def _genes(draw: _Draw) -> Solver:
    return bik.papers.Genetic(
        population=draw.population(),
        elite_share=draw.between(0.05, 0.2),
        crossover_share=draw.between(0.3, 0.95),
        tournament=2 if draw.coin() else 4,
        mutation_rate=draw.scale(0.1, 1.0),
        mutation_scale=draw.scale(0.02, 0.5),
        mutation_decay=draw.between(0.95, 1.0),
        stall_generations=None,
    )


def _vectors(draw: _Draw) -> Solver:
    return bik.DifferentialEvolution(
        population=draw.population(),
        weight=draw.between(0.4, 0.9),
        crossover_rate=draw.between(0.5, 1.0),
        update="immediate" if draw.coin() else "generation",
        stall_generations=None,
    )


SEARCHES: dict[str, tuple[Solver, Callable[[_Draw], Solver]]] = {
    "TPBSO": (bik.papers.BeetleSwarm(stall_generations=None), _beetles),
    "PSO": (bik.papers.PSO(population=50, stall_generations=None), _particles),
    "GA": (bik.papers.Genetic(population=50, stall_generations=None), _genes),
    "DE": (bik.DifferentialEvolution(population=50, stall_generations=None), _vectors),
}
"""Defaults of each search, and the draw of other settings."""


def score(solver: Solver) -> float:
    """Returns the geometric mean over the motions of the mean cost over the training seeds, penalties included."""
    return float(np.exp(np.mean([np.log(_mean_cost(solver, *motion)) for motion in MOTIONS])))


def _mean_cost(solver: Solver, objective: Objective, links: int) -> float:
    """Returns the mean over the training seeds; infinite if a run found no configuration that reaches the ends."""

    def plan(seed: int) -> bik.Plan:
        return Search("", solver, "").plan(links, objective, seed)

    try:
        return fmean(plan.history[-1, 1] for plan in each(plan, TRAINING_SEEDS))
    except bik.InvalidInputError:
        return math.inf


def main() -> None:
    """Tunes all searches and prints the winners."""
    for name, (default, drawn) in SEARCHES.items():
        draw = _Draw()
        solvers = [default, *(drawn(draw) for _ in range(SETTINGS - 1))]
        scores = [score(solver) for solver in solvers]
        best = int(np.argmin(scores))
        print(f"{name}: {scores[best]:.4f} (defaults: {scores[0]:.4f}, median: {np.median(scores):.4f})")
        print(f"    {solvers[best]!r}", flush=True)


if __name__ == "__main__":
    main()
