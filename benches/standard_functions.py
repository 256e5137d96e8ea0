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
    """Sphere function, with its minimum at z = 0."""
    return np.sum(z**2, axis=1)


def rosenbrock(z: Array) -> Array:
    """Rosenbrock function, with its minimum at z = 0, at the end of a bent valley."""
    y = z + 1.0
    return np.sum(100.0 * (y[:, 1:] - y[:, :-1] ** 2) ** 2 + (1.0 - y[:, :-1]) ** 2, axis=1)


def rastrigin(z: Array) -> Array:
    """Rastrigin function, with its minimum at z = 0, among many local minima."""
    return np.sum(z**2 - 10.0 * np.cos(2.0 * np.pi * z) + 10.0, axis=1)


def ackley(z: Array) -> Array:
    """Ackley function, with its minimum at z = 0, in a funnel of local minima."""
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
    """Function with its minimum shifted, in its box."""

    name: str
    seed: int

    @property
    def reach(self) -> float:
        """Half the width of the box."""
        return FUNCTIONS[self.name][1]

    @functools.cached_property
    def shift(self) -> Array:
        """Position of the minimum: in the inner half of the box."""
        return np.random.default_rng(self.seed).uniform(-0.5 * self.reach, 0.5 * self.reach, DIMENSION)

    def __call__(self, x: Array) -> Array:
        """Values of the rows of x."""
        return FUNCTIONS[self.name][0](x - self.shift)


@dataclass(frozen=True)
class Mealpy:
    """Solver of mealpy and its options."""

    name: str
    options: dict[str, Any] = field(hash=False)

    def __str__(self) -> str:
        """Name in the table."""
        return f"mealpy {self.name}({_listed(self.options)})"

    def best(self, case: Case, evaluations: int) -> float:
        """Returns the best value found."""
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
    """Global-best swarm of pyswarms and its options."""

    options: dict[str, float] = field(hash=False)

    def __str__(self) -> str:
        """Name in the table."""
        return f"pyswarms GlobalBestPSO({_listed(self.options)})"

    def best(self, case: Case, evaluations: int) -> float:
        """Returns the best value found."""
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
    """Solver of ours, the name of its row, and its rival."""

    label: str
    ours: Any
    rival: Mealpy | Pyswarms


SAME: dict[str, Any] = {"population": POPULATION, "stall_generations": None}  # ends with the budget, as the others do
CLERC = Pyswarms({"c1": 1.49445, "c2": 1.49445, "w": 0.729})
GREEDY = Mealpy("OriginalPSO", {"c1": 2.05, "c2": 2.05, "w": 0.4})
GA = Mealpy("BaseGA", {"pc": 0.95, "pm": 0.025})
ABC = Mealpy("OriginalABC", {"n_limits": 25})
FFA = Mealpy("OriginalFFA", {"gamma": 0.999, "beta_base": 1.0, "alpha": 0.2, "alpha_damp": 0.97})
DE = Mealpy("OriginalDE", {"wf": 0.5, "cr": 0.9, "strategy": 0})
IMPROVING: dict[str, Any] = {
    "form": "inertia",
    "inertia": 0.4,
    "c1": 2.05,
    "c2": 2.05,
    "accept": "improving",
    **SAME,
}
SEPARABLE: dict[str, Any] = {
    "crossover_share": 0.5,
    "mutation_rate": 0.1,
    "mutation_scale": 0.2,
    "mutation_decay": 0.98,
}
PAIRS = [
    Pair("PSO", bik.papers.PSO(form="inertia", **SAME), CLERC),
    Pair("QPSO", bik.papers.QPSO(**SAME), CLERC),
    # Beetles take three evaluations a generation: a third of the particles, for as many generations.
    Pair("BeetleSwarm, 17 beetles", bik.papers.BeetleSwarm(**{**SAME, "population": 17}), CLERC),
    Pair("BeetleSwarm, 50 beetles", bik.papers.BeetleSwarm(**SAME), CLERC),
    # Options as in mealpy: coordinates outside the box are redrawn in it, and nothing limits a velocity.
    Pair(
        'PSO, accept="improving", walls="random"',
        bik.papers.PSO(walls="random", velocity_limit=np.inf, **IMPROVING),
        GREEDY,
    ),
    Pair('PSO, accept="improving", walls="absorbing"', bik.papers.PSO(**IMPROVING), GREEDY),
    Pair("Genetic, single coordinates mutated", bik.papers.Genetic(**SEPARABLE, **SAME), GA),
    Pair("Genetic, its defaults", bik.papers.Genetic(**SAME), GA),
    # Karaboga's colony of 50 bees is 25 employed at 25 sources, and 25 onlookers.
    Pair("BeeColony, 25 sources", bik.papers.BeeColony(limit=25, **{**SAME, "population": 25}), ABC),
    Pair("BeeColony, 50 sources", bik.papers.BeeColony(limit=25, **SAME), ABC),
    Pair("Firefly", bik.papers.Firefly(absorption=0.999, **SAME), FFA),
    Pair('DifferentialEvolution, update="immediate"', bik.DifferentialEvolution(update="immediate", **SAME), DE),
    Pair('DifferentialEvolution, update="generation"', bik.DifferentialEvolution(**SAME), DE),
]


def our_best(solver: Any, case: Case, evaluations: int) -> float:
    """Returns the best value that a solver of ours finds."""
    box, stop = np.full(DIMENSION, case.reach), bik.Stop(max_evaluations=evaluations)
    return bik.minimize(case, -box, box, solver=solver, stop=stop, seed=case.seed, vectorized=True).value


def rivals_best(seeds: int, evaluations: int) -> dict[tuple[str, str], list[float]]:
    """Returns the results of each rival on each function over the seeds, in two processes."""
    rivals = list({str(pair.rival): pair.rival for pair in PAIRS}.values())
    jobs = [(rival, name, seed) for rival in rivals for name in FUNCTIONS for seed in range(seeds)]
    found: dict[tuple[str, str], list[float]] = {}
    with ProcessPoolExecutor(max_workers=2) as pool:
        futures = [pool.submit(rival.best, Case(name, seed), evaluations) for rival, name, seed in jobs]
        for (rival, name, _), future in zip(jobs, futures, strict=True):
            found.setdefault((str(rival), name), []).append(future.result())
    return found


def page(rivals: dict[tuple[str, str], list[float]], seeds: int, evaluations: int) -> str:
    """Returns the settings and the table, in Markdown."""
    lines = [
        "# Solvers on standard functions",
        "",
        f"Ten dimensions, {seeds} seeds, {evaluations} evaluations each; minima shifted for every seed within the",
        "inner half of the box (half widths: "
        + ", ".join(f"{name} {reach:g}" for name, (_, reach) in FUNCTIONS.items())
        + ").",
        f"mealpy {version('mealpy')}, pyswarms {version('pyswarms')}, numpy {version('numpy')}; written by",
        f"`benches/standard_functions.py`. Populations of {POPULATION} unless the row says otherwise.",
        "",
        'p is the p-value of the one-sided rank test (Mann and Whitney) of "ours is worse"; **worse** marks p < 0.01.',
        "",
        "| ours | rival | function | our median | its median | p |",
        "|---|---|---|---|---|---|",
    ]
    for pair in PAIRS:
        for name in FUNCTIONS:
            ours = [our_best(pair.ours, Case(name, seed), evaluations) for seed in range(seeds)]
            its = rivals[str(pair.rival), name]
            p = float(mannwhitneyu(ours, its, alternative="greater").pvalue)
            medians = f"{np.median(ours):.2g} | {np.median(its):.2g}"
            rival = str(pair.rival).split("(")[0]
            lines.append(f"| {pair.label} | {rival} | {name} | {medians} | {p:.2g}{'' if p > 0.01 else ' **worse**'} |")
    lines += ["", "Options, where they are not the defaults:", ""]
    lines += [f"- {pair.label}: `{pair.ours!r}` beside `{pair.rival}`" for pair in PAIRS]
    return "\n".join([*lines, "", *NOTES, ""])


NOTES = (
    "How the settings were chosen: an option that both solvers have takes the rival's value, which is its default",
    "or, for pyswarms, Clerc's. An option that only ours has takes our default, unless it describes how the rival",
    "works (for example, how it treats a coordinate that leaves the box): then it is set to match. Exceptions are",
    "named below.",
    "",
    "What the rows say:",
    "",
    '- `accept="improving"`: a particle that returns to its best place. It is worse on Rastrigin with absorbing',
    "  walls, but not with mealpy's walls and velocities: the difference is how a coordinate that leaves the box is",
    "  treated. The row without a **worse** was set to match mealpy before it was run.",
    "- Where another solver appears twice, the row with a **worse** came first. The settings of the other row were",
    "  chosen to mend it, on these functions and seeds: they show what the algorithm can do, not what to expect on",
    "  others.",
    "- A beetle takes three evaluations per generation and a bee's source two: with populations as large as a",
    "  swarm's, the budget allows fewer generations.",
    "- Differential evolution as published replaces vectors after the generation, so that all trials are evaluated",
    '  together; mealpy replaces them at once, as ours does with `update="immediate"`.',
    "- The genetic algorithms share the scheme, not the operators: ours are MATLAB's, which move all coordinates of",
    "  a mutant; mealpy's replaces each coordinate with probability pm by a random one.",
    "- mealpy's firefly algorithm is a different one of the same name: it multiplies differences by a random",
    "  matrix, and adds random points. Its bee colony moves all coordinates at once; ours moves one, as published.",
)


def main() -> None:
    """Measures everything and writes the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=25)
    parser.add_argument("--evaluations", type=int, default=10_000)
    parser.add_argument("--out", type=Path, default=Path("target/standard_functions.md"))
    arguments = parser.parse_args()
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    rivals = rivals_best(arguments.seeds, arguments.evaluations)
    arguments.out.write_text(page(rivals, arguments.seeds, arguments.evaluations), encoding="utf-8")


if __name__ == "__main__":
    main()
