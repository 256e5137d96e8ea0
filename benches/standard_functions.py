"""Solvers on standard functions, beside the same algorithms of mealpy and pyswarms.

    pip install mealpy pyswarms scipy
    python benches/standard_functions.py --out DIR

Sphere, Rosenbrock, Rastrigin and Ackley in ten dimensions, their minima shifted for every seed as the CEC competitions
do; the same population, the same options as far as both have them, the same number of evaluations. The table shows
medians over the seeds and the one-sided rank test (Mann and Whitney) of "ours is worse": p > 0.01 says that the samples
do not show it.
"""

import argparse
import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import mannwhitneyu

import beetle_ik as bik

Array = NDArray[np.float64]
Function = Callable[[Array], Array]
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


FUNCTIONS: dict[str, tuple[Function, float]] = {  # with the half width of the box
    "sphere": (sphere, 100.0),
    "Rosenbrock": (rosenbrock, 30.0),
    "Rastrigin": (rastrigin, 5.12),
    "Ackley": (ackley, 32.0),
}


def mealpy_best(name: str, function: Function, reach: float, evaluations: int, seed: int, **options: Any) -> float:
    """The best value of a solver of mealpy."""
    from mealpy import ABC, DE, FFA, GA, PSO, FloatVar

    classes = {
        "PSO": PSO.OriginalPSO,
        "GA": GA.BaseGA,
        "ABC": ABC.OriginalABC,
        "FFA": FFA.OriginalFFA,
        "DE": DE.OriginalDE,
    }
    problem = {
        "obj_func": lambda x: function(x[None])[0],
        "bounds": FloatVar(lb=[-reach] * DIMENSION, ub=[reach] * DIMENSION),
        "minmax": "min",
        "log_to": None,
    }
    solver = classes[name](epoch=evaluations, pop_size=options.pop("pop_size", POPULATION), **options)
    return float(solver.solve(problem, seed=seed, termination={"max_fe": evaluations}).target.fitness)


def pyswarms_best(function: Function, reach: float, evaluations: int, seed: int, **options: float) -> float:
    """The best value of the global-best swarm of pyswarms."""
    import logging

    logging.disable(logging.CRITICAL)
    from pyswarms.single import GlobalBestPSO

    np.random.seed(seed)  # noqa: NPY002  the only generator that pyswarms knows
    bounds = (np.full(DIMENSION, -reach), np.full(DIMENSION, reach))
    swarm = GlobalBestPSO(POPULATION, DIMENSION, options=options, bounds=bounds)
    return float(swarm.optimize(function, iters=evaluations // POPULATION, verbose=False)[0])


Rival = Callable[[Function, float, int, int], float]


def mealpy(name: str, **options: Any) -> Rival:
    """A solver of mealpy, called as the others."""
    return lambda function, reach, count, seed: mealpy_best(name, function, reach, count, seed, **options)


def pyswarms(**options: float) -> Rival:
    """The swarm of pyswarms, called as the others."""
    return lambda function, reach, count, seed: pyswarms_best(function, reach, count, seed, **options)


SAME = {"population": POPULATION, "stall_generations": None}  # ends with the budget, as the others do
CLERC = pyswarms(c1=1.49445, c2=1.49445, w=0.729)
PAIRS: list[tuple[str, Any, str, Rival]] = [
    (
        "PSO",
        bik.PSO(form="inertia", inertia=0.4, c1=2.05, c2=2.05, accept="improving", **SAME),
        "mealpy PSO",
        mealpy("PSO", c1=2.05, c2=2.05, w=0.4),
    ),
    ("PSO", bik.PSO(form="inertia", **SAME), "pyswarms PSO", CLERC),
    ("QPSO", bik.QPSO(**SAME), "pyswarms PSO", CLERC),
    ("BeetleSwarm", bik.BeetleSwarm(**SAME), "pyswarms PSO", CLERC),
    ("BeetleSwarm", bik.BeetleSwarm(**SAME), "mealpy PSO", mealpy("PSO", c1=2.05, c2=2.05, w=0.4)),
    ("Genetic", bik.Genetic(crossover_share=0.95, **SAME), "mealpy GA", mealpy("GA", pc=0.95, pm=0.025)),
    ("Genetic", bik.Genetic(**SAME), "mealpy GA", mealpy("GA", pc=0.8, pm=0.025)),
    ("BeeColony", bik.BeeColony(limit=25, **SAME), "mealpy ABC", mealpy("ABC", n_limits=25)),
    ("Firefly", bik.Firefly(**SAME), "mealpy FFA", mealpy("FFA", gamma=1.0, beta_base=1.0, alpha=0.2, alpha_damp=0.97)),
    (
        "DifferentialEvolution",
        bik.DifferentialEvolution(**SAME),
        "mealpy DE",
        mealpy("DE", wf=0.5, cr=0.9, strategy=0),
    ),
]


def compare(ours: Any, rival: Rival, name: str, seeds: int, evaluations: int) -> tuple[float, float, float]:
    """The medians of both, and the p of the rank test."""
    function, reach = FUNCTIONS[name]
    values: tuple[list[float], list[float]] = ([], [])
    for seed in range(seeds):
        shift = np.random.default_rng(seed).uniform(-0.5 * reach, 0.5 * reach, DIMENSION)

        def shifted(x: Array, shift: Array = shift) -> Array:
            return function(x - shift)

        box = np.full(DIMENSION, reach)
        stop = bik.Stop(max_evaluations=evaluations)
        values[0].append(bik.minimize(shifted, -box, box, solver=ours, stop=stop, seed=seed, vectorized=True).value)
        values[1].append(rival(shifted, reach, evaluations, seed))
    p = mannwhitneyu(*values, alternative="greater").pvalue
    return float(np.median(values[0])), float(np.median(values[1])), float(p)


def main() -> None:
    """Measure everything and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=25)
    parser.add_argument("--evaluations", type=int, default=10_000)
    parser.add_argument("--out", type=Path, default=Path("target/standard_functions"))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    with (arguments.out / "standard_functions.csv").open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["function", "ours", "rival", "our median", "its median", "p of ours worse", "no worse"])
        for name in FUNCTIONS:
            for label, ours, rival_label, rival in PAIRS:
                mine, its, p = compare(ours, rival, name, arguments.seeds, arguments.evaluations)
                row = [name, label, rival_label, f"{mine:.3e}", f"{its:.3e}", f"{p:.3g}", "yes" if p > 0.01 else "no"]
                table.writerow(row)
                print(" | ".join(row), flush=True)


if __name__ == "__main__":
    main()
