"""Tables 2 and 3: growth of evaluations and time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

import beetle_ik as bik

from ...report import Claim, Column, Part, Section, Table, number
from ..experiment import Context
from .planner import plan_along, plan_between
from .searches import RIVALS, TPBSO
from .settings import ALONG_PATH, END, FROM_END_TO_END, POPULATION, START, THREE_LINKS, arm

TITLE = "Tables 2 and 3"
_REPEATS = 5
_REPEATS_SHORT = 1
_LEFT_OVER = 0.05  # tolerance of proportionality: first generations and unchanged members distort counts
_NO_MORE = 1.1  # multiple of the rivals' evaluations
_ENOUGH = 10**7  # evaluations
_N_P, _N_I = "members, n_p", "iterations, n_i"

_TEXT = """
The paper states orders of growth and measures none. Below, one quantity grows at a time. The verdicts rest on counted
evaluations; times are the shortest of several runs, and depend on the load of the machine. An exponent of 1 means that
time doubles if the quantity doubles.

Two things differ from the paper's tables. Our search uses no output points: extremes come from formulas, so Experiment
I does not depend on their number. And a beetle needs three evaluations where a particle needs one, which orders of
growth do not show.
"""


@dataclass(frozen=True)
class Growth:
    """A search before and after one quantity has grown."""

    search: str
    what: str
    low: int
    high: int
    before: bik.Plan
    after: bik.Plan

    @property
    def of_evaluations(self) -> float:
        """Ratio of the growth of evaluations to the growth of the quantity."""
        return self.after.evaluations / self.before.evaluations / (self.high / self.low)

    @property
    def exponent(self) -> float:
        """Exponent of time: 1 for growth in proportion."""
        return math.log(self.after.elapsed / self.before.elapsed) / math.log(self.high / self.low)


def complexity(context: Context) -> Part:
    """Measures evaluations and time while each quantity grows."""
    repeats = context.pick(full=_REPEATS, short=_REPEATS_SHORT)
    cases = [*_members(), *_iterations(), *_others()]
    grown = [_grow(case, repeats) for case in context.each("wang2019: Tables 2 and 3", cases)]
    claims = [
        grows_in_proportion([growth for growth in grown if growth.what in (_N_P, _N_I)]),
        does_no_more({growth.search: growth for growth in grown if growth.what == _N_P}),
        _OUTPUT_POINTS,
        _MEMORY,
    ]
    return Section(TITLE, [_TEXT, _table(grown)]), claims


def grows_in_proportion(counted: Sequence[Growth]) -> Claim:
    """Judges whether evaluations grow in proportion to members and iterations."""
    ratios = [growth.of_evaluations for growth in counted]
    return Claim.judged(
        "Cost grows in proportion to population and iterations, for TPBSO as for PSO and GA.",
        source="Section IV-D.3, Table 2",
        rule=f"Evaluations grow by the same factor as their cause, to {_LEFT_OVER:g} of it.",
        measured=f"{number(min(ratios), 4)} to {number(max(ratios), 4)} times as much as their cause",
        holds=all(abs(ratio - 1.0) < _LEFT_OVER for ratio in ratios),
        section=TITLE,
    )


def does_no_more(by_members: Mapping[str, Growth]) -> Claim:
    """Judges whether an iteration of the beetle swarm costs no more than an iteration of its rivals."""
    most = by_members[TPBSO].after.evaluations / min(by_members[rival].after.evaluations for rival in RIVALS)
    ratios = [growth.of_evaluations for growth in by_members.values()]
    return Claim.judged(
        "TPBSO plans better “without increasing the computational complexity”: the three algorithms are “not "
        "significantly different”.",
        source="Abstract; section IV-D.3; section V",
        rule=(
            "As an order of growth: evaluations grow with members in proportion for all three. As work: as many "
            f"iterations of as many members take TPBSO at most {_NO_MORE} times the evaluations of the others."
        ),
        measured=(
            f"{number(min(ratios), 4)} to {number(max(ratios), 4)} times as much as the members; "
            f"{number(most, 4)} times the evaluations"
        ),
        holds={
            "as an order of growth": all(abs(ratio - 1.0) < _LEFT_OVER for ratio in ratios),
            "as work": most <= _NO_MORE,
        },
        section=TITLE,
    )


_OUTPUT_POINTS = Claim.judged(
    "An evaluation costs in proportion to the dimension and the number of output points, O(n_d n_o).",
    source="Section IV-D.3, Table 2",
    rule="Time for an evaluation grows in proportion to both.",
    measured="exponents of time for links and points are in the table",
    holds=None,
    reason="Our evaluation has no output points, and times on a shared machine are too uncertain for a verdict.",
    section=TITLE,
)
_MEMORY = Claim.judged(
    "Memory grows as O((n_p + n_o) n_d) and O(n_o + n_in + n_p n_d), alike for all three.",
    source="Section IV-D.3, Table 3",
    rule="Memory grows in proportion to each quantity.",
    measured="",
    holds=None,
    reason="Memory was not measured: it follows from what each program stores, which the paper does not say.",
    section=TITLE,
)


def _table(rows: Sequence[Growth]) -> Table:
    return Table(
        name="tables_2_and_3",
        title="Growth of evaluations and time",
        columns=[
            Column(name="search"),
            Column(name="what grows"),
            Column(name="from"),
            Column(name="to"),
            Column(name="evaluations"),
            Column(name="evaluations then"),
            Column(name="time", unit="ms"),
            Column(name="time then", unit="ms"),
            Column(name="exponent", digits=2),
        ],
        rows=[
            [
                row.search,
                row.what,
                row.low,
                row.high,
                row.before.evaluations,
                row.after.evaluations,
                1e3 * row.before.elapsed,
                1e3 * row.after.elapsed,
                row.exponent,
            ]
            for row in rows
        ],
    )


@dataclass(frozen=True)
class _Case:
    """The quantity that grows, its first and last value, and the run that it makes longer."""

    search: str
    what: str
    low: int
    high: int
    run: Callable[[int], bik.Plan]


def _grow(case: _Case, repeats: int) -> Growth:
    before, after = (_quickest(case, size, repeats) for size in (case.low, case.high))
    return Growth(case.search, case.what, case.low, case.high, before, after)


def _quickest(case: _Case, size: int, repeats: int) -> bik.Plan:
    return min((case.run(size) for _ in range(repeats)), key=lambda plan: plan.elapsed)


_SOLVERS: dict[str, type[bik.papers.BeetleSwarm | bik.papers.PSO | bik.papers.Genetic]] = {
    "TPBSO": bik.papers.BeetleSwarm,
    "PSO": bik.papers.PSO,
    "GA": bik.papers.Genetic,
}


def _members() -> list[_Case]:
    def with_members(name: str) -> Callable[[int], bik.Plan]:
        return lambda members: _plan(4, name, members, 100)

    return [_Case(name, _N_P, 25, 100, with_members(name)) for name in _SOLVERS]


def _iterations() -> list[_Case]:
    def with_iterations(name: str) -> Callable[[int], bik.Plan]:
        return lambda iterations: _plan(4, name, POPULATION, iterations)

    return [_Case(name, _N_I, 50, 200, with_iterations(name)) for name in _SOLVERS]


def _others() -> list[_Case]:
    return [
        _Case("TPBSO", "links (dimension 4 k - 2)", 3, 6, lambda links: _plan(links, "TPBSO", POPULATION, 100)),
        _Case("PSO", "links (dimension 4 k - 2)", 3, 6, lambda links: _plan(links, "PSO", POPULATION, 300)),
        _Case("TPBSO along a path", "points, n_in", 51, 201, _follow),
    ]


def _plan(links: int, name: str, members: int, iterations: int) -> bik.Plan:
    return plan_between(
        arm(links),
        START,
        END,
        "time",
        limits=FROM_END_TO_END,
        solver=_SOLVERS[name](population=members, stall_generations=None),
        stop=bik.Stop(max_iterations=iterations, max_evaluations=_ENOUGH),
    )


def _follow(points: int) -> bik.Plan:
    angle = np.linspace(0.0, 2 * np.pi, points)
    circle = np.column_stack((1.0 + 0.4 * np.cos(angle), 1.0 + 0.4 * np.sin(angle), 0.0 * angle))
    solver = bik.papers.BeetleSwarm(stall_generations=None)
    stop = bik.Stop(max_evaluations=3000)
    return plan_along(THREE_LINKS, circle, "time", limits=ALONG_PATH, accuracy=0.02, solver=solver, stop=stop)
