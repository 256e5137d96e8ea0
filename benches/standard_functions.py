"""Solvers on standard functions, beside the same algorithms of mealpy and pyswarms.

    pip install -r benches/requirements.txt
    python benches/standard_functions.py --out docs/standard_functions.md

Sphere, Rosenbrock, Rastrigin and Ackley in ten dimensions, their minima shifted for every seed as the CEC competitions
do; the same population, the same options as far as both have them, the same number of evaluations. The table shows
medians over the seeds and the one-sided rank test (Mann and Whitney) of "ours is worse": p > 0.01 says that the samples
do not show it.
"""

import argparse
import functools
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import mannwhitneyu

import beetle_ik as bik

Array = NDArray[np.float64]
DIMENSION = 10
POPULATION = 50


def sphere(z: Array) -> Array:
    """Least at z = 0."""
    return np.sum(z**2, axis=1)


def rosenbrock(z: Array) -> Array:
    """Least at z = 0, at the end of a bent valley."""
    y = z + 1.0
    return np.sum(100.0 * (y[:, 1:] - y[:, :-1] ** 2) ** 2 + (1.0 - y[:, :-1]) ** 2, axis=1)


def rastrigin(z: Array) -> Array:
    """Least at z = 0, among many local minima."""
    return np.sum(z**2 - 10.0 * np.cos(2.0 * np.pi * z) + 10.0, axis=1)


def ackley(z: Array) -> Array:
    """Least at z = 0, in a funnel of local minima."""
    root, cosines = np.sqrt(np.mean(z**2, axis=1)), np.mean(np.cos(2.0 * np.pi * z), axis=1)
    return -20.0 * np.exp(-0.2 * root) - np.exp(cosines) + 20.0 + np.e


FUNCTIONS: dict[str, tuple[Callable[[Array], Array], float]] = {  # with the half width of the box
    "sphere": (sphere, 100.0),
    "Rosenbrock": (rosenbrock, 30.0),
    "Rastrigin": (rastrigin, 5.12),
    "Ackley": (ackley, 32.0),
}


@dataclass(frozen=True)
class Case:
    """One function with its minimum shifted, in its box."""

    name: str
    seed: int

    @property
    def reach(self) -> float:
        """Half the width of the box."""
        return FUNCTIONS[self.name][1]

    @functools.cached_property
    def shift(self) -> Array:
        """Where the minimum is: in the inner half of the box."""
        return np.random.default_rng(self.seed).uniform(-0.5 * self.reach, 0.5 * self.reach, DIMENSION)

    def __call__(self, x: Array) -> Array:
        """The values of the rows of x."""
        return FUNCTIONS[self.name][0](x - self.shift)


@dataclass(frozen=True)
class Mealpy:
    """A solver of mealpy and its options."""

    name: str
    options: dict[str, Any] = field(hash=False)

    def __str__(self) -> str:
        """As the table shows it."""
        return f"mealpy {self.name}({_listed(self.options)})"

    def best(self, case: Case, evaluations: int) -> float:
        """The best value that it finds."""
        from mealpy import ABC, DE, FFA, GA, PSO, FloatVar

        classes = {kind.__name__: kind for kind in (PSO.OriginalPSO, GA.BaseGA, ABC.OriginalABC, FFA.OriginalFFA)}
        classes["OriginalDE"] = DE.OriginalDE
        problem = {
            "obj_func": lambda x: case(x[None])[0],
            "bounds": FloatVar(lb=[-case.reach] * DIMENSION, ub=[case.reach] * DIMENSION),
            "minmax": "min",
            "log_to": None,
        }
        solver = classes[self.name](epoch=evaluations, pop_size=POPULATION, **self.options)
        return float(solver.solve(problem, seed=case.seed, termination={"max_fe": evaluations}).target.fitness)


@dataclass(frozen=True)
class Pyswarms:
    """The global-best swarm of pyswarms and its options."""

    options: dict[str, float] = field(hash=False)

    def __str__(self) -> str:
        """As the table shows it."""
        return f"pyswarms GlobalBestPSO({_listed(self.options)})"

    def best(self, case: Case, evaluations: int) -> float:
        """The best value that it finds."""
        import logging

        logging.disable(logging.CRITICAL)
        from pyswarms.single import GlobalBestPSO

        np.random.seed(case.seed)  # noqa: NPY002  the only generator that pyswarms knows
        bounds = (np.full(DIMENSION, -case.reach), np.full(DIMENSION, case.reach))
        swarm = GlobalBestPSO(POPULATION, DIMENSION, options=self.options, bounds=bounds)
        return float(swarm.optimize(case, iters=evaluations // POPULATION, verbose=False)[0])


def _listed(options: dict[str, Any]) -> str:
    return ", ".join(f"{name}={value}" for name, value in options.items())


@dataclass(frozen=True)
class Pair:
    """A solver of ours, what its row is called, and its rival."""

    label: str
    ours: Any
    rival: Mealpy | Pyswarms


SAME = {"population": POPULATION, "stall_generations": None}  # ends with the budget, as the others do
CLERC = Pyswarms({"c1": 1.49445, "c2": 1.49445, "w": 0.729})
GREEDY = Mealpy("OriginalPSO", {"c1": 2.05, "c2": 2.05, "w": 0.4})
GA = Mealpy("BaseGA", {"pc": 0.95, "pm": 0.025})
ABC = Mealpy("OriginalABC", {"n_limits": 25})
FFA = Mealpy("OriginalFFA", {"gamma": 0.999, "beta_base": 1.0, "alpha": 0.2, "alpha_damp": 0.97})
DE = Mealpy("OriginalDE", {"wf": 0.5, "cr": 0.9, "strategy": 0})
PAIRS = [
    Pair("PSO", bik.PSO(form="inertia", inertia=0.4, c1=2.05, c2=2.05, accept="improving", **SAME), GREEDY),
    Pair("PSO", bik.PSO(form="inertia", **SAME), CLERC),
    Pair("QPSO", bik.QPSO(**SAME), CLERC),
    # A beetle takes three evaluations a generation: a third of the particles for equal generations.
    Pair("BeetleSwarm", bik.BeetleSwarm(**{**SAME, "population": POPULATION // 3 + 1}), CLERC),
    Pair(
        "Genetic",
        bik.Genetic(crossover_share=0.5, mutation_rate=0.1, mutation_scale=0.2, mutation_decay=0.98, **SAME),
        GA,
    ),
    Pair("BeeColony", bik.BeeColony(limit=25, **SAME), ABC),
    Pair("Firefly", bik.Firefly(absorption=0.999, **SAME), FFA),
    Pair("DifferentialEvolution", bik.DifferentialEvolution(update="immediate", **SAME), DE),
]
