"""Tables 2 and 3: how evaluations and time grow."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

import beetle_ik as bik

from ...report import Claim, Column, Part, Section, Table, number
from ..experiment import Context
from .settings import ALONG_PATH, END, FROM_END_TO_END, PSO, START, THREE_LINKS, arm

TITLE = "Tables 2 and 3"
_REPEATS = 5
_REPEATS_SHORT = 1
_LEFT_OVER = 0.05  # by which counts may miss proportion: a first generation, members that are kept as they are
_ENOUGH = 10**7  # evaluations

_TEXT = """
The paper states orders of growth and measures none. Below, each quantity grows while the others stay. Evaluations are
counted, and the claim rests on them; times are the shortest of several runs, and depend on what else the machine does.
An exponent of 1 means that time doubles with what grows.

Two things differ from the paper's tables. Our search looks at no output points: extremes come from formulas, so that
Experiment I does not depend on their number at all. And a beetle needs three evaluations where a particle needs one,
which orders of growth do not show.

Memory is that of the swarm: place, velocity, best place and two antennae of each member, 5 numbers for each of its
dimensions (3 for a particle, 2 for evolution), and for Experiment II one spline value and one curvature a joint and
point. It was counted, not measured: all of it is less than a megabyte.
"""


@dataclass(frozen=True)
class Growth:
    """A search before and after something has grown."""

    what: str
    low: int
    high: int
    before: bik.Plan
    after: bik.Plan

    @property
    def of_evaluations(self) -> float:
        """How much they grow for what makes them grow."""
        return self.after.evaluations / self.before.evaluations / (self.high / self.low)

    @property
    def exponent(self) -> float:
        """Of time: 1 where it grows in proportion."""
        return math.log(self.after.elapsed / self.before.elapsed) / math.log(self.high / self.low)


def complexity(context: Context) -> Part:
    """Measure by doubling."""
    repeats = context.pick(full=_REPEATS, short=_REPEATS_SHORT)
    proportional = [
        _grow(*one, repeats) for one in context.each("wang2019: Table 2, population and iterations", _PROPORTIONAL)
    ]
    others = [_grow(*one, repeats) for one in context.each("wang2019: Tables 2 and 3", _OTHERS)]
    return Section(TITLE, [_TEXT, _table([*proportional, *others])]), [_claim(proportional, others)]


def _claim(proportional: list[Growth], others: list[Growth]) -> Claim:
    ratios = [growth.of_evaluations for growth in proportional]
    exponents = [growth.exponent for growth in (*proportional, *others)]
    return Claim.judged(
        "Cost grows in proportion to population and iterations.",
        source="Section IV-D.3, Table 2",
        rule=f"Evaluations grow by the same factor as their cause, to {_LEFT_OVER:g} of it.",
        measured=(
            f"evaluations grow {number(min(ratios))} to {number(max(ratios))} times as much as their cause; no part of "
            f"the verdict: exponents of time between {number(min(exponents), 2)} and {number(max(exponents), 2)}"
        ),
        holds=all(abs(ratio - 1.0) < _LEFT_OVER for ratio in ratios),
        section=TITLE,
    )


def _table(rows: list[Growth]) -> Table:
    return Table(
        name="tables_2_and_3",
        title="Growth of evaluations and time",
        columns=[
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


def _grow(what: str, low: int, high: int, run: Callable[[int], bik.Plan], repeats: int) -> Growth:
    return Growth(what, low, high, _shortest(lambda: run(low), repeats), _shortest(lambda: run(high), repeats))


def _shortest(run: Callable[[], bik.Plan], repeats: int) -> bik.Plan:
    return min((run() for _ in range(repeats)), key=lambda plan: plan.elapsed)


def _plan(links: int, solver: bik.BeetleSwarm | bik.PSO | bik.Genetic, iterations: int) -> bik.Plan:
    stop = bik.Stop(max_iterations=iterations, max_evaluations=_ENOUGH)
    return bik.plan_point_to_point(
        arm(links), START, END, method=bik.TPBSO(solver=solver), limits=FROM_END_TO_END, stop=stop
    )


def _follow(points: int) -> bik.Plan:
    angle = np.linspace(0.0, 2 * np.pi, points)
    circle = np.column_stack((1.0 + 0.4 * np.cos(angle), 1.0 + 0.4 * np.sin(angle), 0.0 * angle))
    stop = bik.Stop(max_evaluations=3000)
    return bik.plan_along_path(THREE_LINKS, circle, method="tpbso", limits=ALONG_PATH, accuracy=0.02, stop=stop)


def _with_members(search: type[bik.BeetleSwarm | bik.PSO | bik.Genetic]) -> Callable[[int], bik.Plan]:
    return lambda members: _plan(4, search(population=members, stall_generations=None), 100)


_Doubling: TypeAlias = tuple[str, int, int, Callable[[int], bik.Plan]]
"""What grows, from where, to where, and the search that it makes longer."""
_SWARM = bik.BeetleSwarm(stall_generations=None)
_PROPORTIONAL: tuple[_Doubling, ...] = (
    ("TPBSO: members, n_p", 25, 100, _with_members(bik.BeetleSwarm)),
    ("PSO: members, n_p", 25, 100, _with_members(bik.PSO)),
    ("GA: members, n_p", 25, 100, _with_members(bik.Genetic)),
    ("TPBSO: iterations, n_i", 50, 200, lambda generations: _plan(4, _SWARM, generations)),
)
_OTHERS: tuple[_Doubling, ...] = (
    ("TPBSO: links (dimension 4 k - 2)", 3, 6, lambda links: _plan(links, _SWARM, 100)),
    ("PSO: links", 3, 6, lambda links: _plan(links, PSO, 300)),
    ("TPBSO along a path: points, n_in", 51, 201, _follow),
)
