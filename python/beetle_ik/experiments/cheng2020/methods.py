"""The five methods of the paper's comparison, and the settings that tuning tries for each.

The paper takes GA and PSO from MATLAB, firefly and QPSO from their authors, and names no options. So every method, BAS
included, is tuned alike: the same number of settings, drawn at random from the ranges below (`tuning.py`).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

import beetle_ik as bik

from ...report import Printed, Spread
from .settings import Solver

PRECISION = 1e-3  # m, the band of Figure 8 and Table 2
BUDGET = 1000  # evaluations a step, of Figure 7 and Table 1
PATIENCE = 4000  # evaluations a step after which a method has missed its band


class Draws:
    """Random options, rounded to two digits."""

    def __init__(self, seed: int) -> None:
        """Starts the draws of one method; the same seed draws the same options."""
        self._random = np.random.default_rng(seed)

    def even(self, low: float, high: float) -> float:
        """Draws uniformly."""
        return float(f"{self._random.uniform(low, high):.2g}")

    def log(self, low: float, high: float) -> float:
        """Draws uniformly in the logarithm."""
        return float(f"{math.exp(self._random.uniform(math.log(low), math.log(high))):.2g}")

    def count(self, low: int, high: int) -> int:
        """Draws a whole number, uniformly in the logarithm."""
        return round(self.log(low, high))

    def chance(self) -> bool:
        """Draws heads or tails."""
        return bool(self._random.random() < 0.5)


@dataclass(frozen=True, kw_only=True)
class Method:
    """A method, the draw of its settings, and the results printed in the paper."""

    name: str
    kind: type[Solver]
    draw: Callable[[Draws, int], Solver]
    """Draws a setting that spends about the given evaluations a step at most."""
    printed_time: Spread
    """Table 2, quoted in section IV-A.4b (s)."""
    printed_level: str | Printed
    """Level of the error in Figure 7, section IV-A.4a."""


def _beetle(draws: Draws, limit: int) -> Solver:
    explorations = draws.count(1, 50)
    return bik.papers.BAS(
        variant="star" if draws.chance() else "chain",
        c1=draws.log(0.3, 5.0),
        c2=draws.log(0.5, 1.5),
        explorations=explorations,
        max_passes=max(limit // (3 * explorations), 1),  # three evaluations each
    )


def _genetic(draws: Draws, limit: int) -> Solver:
    population = draws.count(4, 80)
    return bik.papers.Genetic(
        population=population,
        crossover_share=draws.even(0.4, 0.95),
        tournament=draws.count(2, 4),
        mutation_scale=draws.log(0.03, 0.5),
        mutation_decay=draws.even(0.8, 0.99),
        max_generations=limit // population,
    )


def _particles(draws: Draws, limit: int) -> Solver:
    population, pull = draws.count(2, 60), draws.even(1.0, 2.0)
    return bik.papers.PSO(
        form="inertia",
        population=population,
        inertia=draws.even(0.4, 0.8),
        c1=pull,
        c2=pull,
        velocity_limit=draws.log(0.1, 1.0),
        max_generations=limit // population,
    )


def _fireflies(draws: Draws, limit: int) -> Solver:
    population = draws.count(2, 30)
    return bik.papers.Firefly(
        population=population,
        attractiveness=draws.even(0.4, 1.0),
        absorption=draws.log(0.1, 3.0),
        randomness=draws.log(0.05, 0.6),
        randomness_decay=draws.even(0.85, 0.99),
        # A firefly moves towards every brighter one in each generation.
        max_generations=max(2 * limit // (population * (population - 1)), 1),
    )


def _quantum(draws: Draws, limit: int) -> Solver:
    population = draws.count(2, 80)
    return bik.papers.QPSO(population=population, expansion=draws.even(0.4, 1.0), max_generations=limit // population)


METHODS = (
    Method(name="BAS", kind=bik.papers.BAS, draw=_beetle, printed_time=Spread(0.53, 0.04), printed_level="10⁻⁵ level"),
    Method(
        name="GA", kind=bik.papers.Genetic, draw=_genetic, printed_time=Spread(25.0, 10.2), printed_level="10⁻³ level"
    ),
    Method(name="PSO", kind=bik.papers.PSO, draw=_particles, printed_time=Spread(5.0, 0.7), printed_level="10⁻⁴ level"),
    Method(
        name="FA",
        kind=bik.papers.Firefly,
        draw=_fireflies,
        printed_time=Spread(6.9, 0.6),
        printed_level=Printed.NOT_STATED,
    ),
    Method(
        name="QPSO",
        kind=bik.papers.QPSO,
        draw=_quantum,
        printed_time=Spread(6.1, 0.4),
        printed_level=Printed.NOT_STATED,
    ),
)
BEETLE, *RIVALS = (method.name for method in METHODS)
