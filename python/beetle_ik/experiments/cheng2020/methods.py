"""The five methods of the paper's comparison, and how each was tuned.

The paper takes GA and PSO from MATLAB, firefly and QPSO from their authors, and names no options. Each method here,
the beetle included, has a grid of eight candidates, four sizes with two sets of options each; the cheapest on the
tuning seeds is the one that is compared.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import beetle_ik as bik

from ...report import Printed, Spread
from .settings import FIVE_LINK, IIWA, Run, Solver, Task

PRECISION = 1e-3  # m, the band of Figure 8 and Table 2
BUDGET = 1000  # evaluations a step, of Figure 7 and Table 1
TUNING_SEEDS = range(1001, 1011)  # none of those that are compared


@dataclass(frozen=True, kw_only=True)
class Method:
    """A method with the candidates for its options, and what the paper prints."""

    name: str
    candidates: Sequence[Solver]
    usual: Solver
    """What tuning chooses on the iiwa: for a quick pass, which does not tune."""
    with_budget: Solver
    """Spends about 1000 evaluations a step where nothing ends it earlier."""
    printed_time: Spread
    """Table 2, quoted in section IV-A.4b (s)."""
    printed_level: str | Printed
    """Level of the error in Figure 7, section IV-A.4a."""


@dataclass(frozen=True)
class Tuned:
    """A candidate on the tuning seeds."""

    solver: Solver
    evaluations: float | None
    """A step, on average; None for one that is out, because a step of it ended outside the band."""


@dataclass(frozen=True, kw_only=True)
class SetUp:
    """A task, and the box that a step searches: what the velocity limit lets the arm reach."""

    name: str
    task: Task
    limits: bik.Limits

    def track(self, solver: Solver | None, *, seed: int, band: float = PRECISION) -> bik.TrackResult:
        """Follow the circle from a start on it."""
        return self.task.track(solver, band=band, seed=seed, start=self.task.on_path, limits=self.limits)


WHOLE = SetUp(name="iiwa 14, whole box", task=IIWA, limits=IIWA.limits)
# A swarm that stays within 0.02 rad of where the arm stands: the circle asks for no more than that.
TRUST = SetUp(name="iiwa 14, trust box", task=IIWA, limits=bik.Limits(velocity=0.1))
PLANAR = SetUp(name="five-link arm", task=FIVE_LINK, limits=FIVE_LINK.limits)


def tune(method: Method, set_up: SetUp, *, short: bool) -> list[Tuned]:
    """All candidates, the chosen one first; in short only the usual one, on one seed."""
    if short:
        return [_try(method.usual, set_up, TUNING_SEEDS[:1])]
    tried = [_try(solver, set_up, TUNING_SEEDS) for solver in method.candidates]
    return sorted(tried, key=lambda one: math.inf if one.evaluations is None else one.evaluations)


def _try(solver: Solver, set_up: SetUp, seeds: range) -> Tuned:
    spent = []
    for seed in seeds:
        result = set_up.track(solver, seed=seed)
        if missed_steps(result):
            return Tuned(solver, None)
        spent.append(evaluations_a_step(result))
    return Tuned(solver, sum(spent) / len(spent))


def evaluations_a_step(result: Run) -> float:
    """On average."""
    return result.evaluations / (len(result.time) - 1)


def missed_steps(result: bik.TrackResult) -> int:
    """Steps that ended outside the band."""
    return int((result.position_error[1:] > result.position_tolerance).sum())


# Explorations of a pass, or members of a population; with fewer, swarms miss the band now and then.
_SIZES = (10, 20, 40, 70)

METHODS = (
    Method(
        name="BAS",
        candidates=[bik.BAS(variant="chain", c1=c1, explorations=size) for c1 in (1.0, 0.3) for size in _SIZES],
        usual=bik.BAS(variant="chain", c1=1.0, explorations=10),
        with_budget=bik.BAS(variant="chain", explorations=10, max_passes=BUDGET // 30),  # three evaluations each
        printed_time=Spread(0.53, 0.04),
        printed_level="10⁻⁵ level",
    ),
    Method(
        name="GA",
        candidates=[bik.Genetic(population=size, mutation_decay=decay) for decay in (0.9, 0.97) for size in _SIZES],
        usual=bik.Genetic(population=20, mutation_decay=0.9),
        with_budget=bik.Genetic(population=40, mutation_decay=0.9, max_generations=BUDGET // 40),
        printed_time=Spread(25.0, 10.2),
        printed_level="10⁻³ level",
    ),
    Method(
        name="PSO",  # Trelea's (2003) two sets
        candidates=[
            bik.PSO(form="inertia", inertia=inertia, c1=c, c2=c, population=size)
            for inertia, c in ((0.6, 1.7), (0.729, 1.494))
            for size in _SIZES
        ],
        usual=bik.PSO(form="inertia", inertia=0.6, c1=1.7, c2=1.7, population=10),
        with_budget=bik.PSO(form="inertia", inertia=0.6, c1=1.7, c2=1.7, population=20, max_generations=BUDGET // 20),
        printed_time=Spread(5.0, 0.7),
        printed_level="10⁻⁴ level",
    ),
    Method(
        name="FA",
        candidates=[
            bik.Firefly(population=size, randomness=randomness, randomness_decay=decay)
            for randomness, decay in ((0.5, 0.95), (0.2, 0.97))
            for size in _SIZES
        ],
        usual=bik.Firefly(population=10, randomness=0.5, randomness_decay=0.95),
        # In a generation each of the ten moves towards every brighter one: about 45 evaluations.
        with_budget=bik.Firefly(population=10, randomness=0.5, randomness_decay=0.95, max_generations=BUDGET // 45),
        printed_time=Spread(6.9, 0.6),
        printed_level=Printed.NOT_STATED,
    ),
    Method(
        name="QPSO",
        candidates=[bik.QPSO(population=size, expansion=expansion) for expansion in (0.5, 0.75) for size in _SIZES],
        usual=bik.QPSO(population=40, expansion=0.5),
        with_budget=bik.QPSO(population=20, expansion=0.5, max_generations=BUDGET // 20),
        printed_time=Spread(6.1, 0.4),
        printed_level=Printed.NOT_STATED,
    ),
)
