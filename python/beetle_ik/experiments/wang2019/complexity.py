"""Tables 2 and 3: how evaluations and time grow."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import beetle_ik as bik

from ...report import Claim, Column, Part, Section, Table, number
from ..experiment import Context
from .settings import ALONG_PATH, END, FROM_END_TO_END, START, THREE_LINKS, arm

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


def complexity(context: Context) -> Part:
    """Measure by doubling."""
    repeats = context.pick(full=_REPEATS, short=_REPEATS_SHORT)
    swarm = bik.BeetleSwarm(stall_generations=None)
    particles = bik.PSO(population=50, stall_generations=None)
    population: dict[str, Any] = {"TPBSO": bik.BeetleSwarm, "PSO": bik.PSO, "GA": bik.Genetic}
    rows: list[list[str | int | float]] = []

    def add(what: str, low: int, high: int, run: Callable[[int], bik.Plan]) -> None:
        first, second = _shortest(lambda: run(low), repeats), _shortest(lambda: run(high), repeats)
        exponent = np.log(second.elapsed / first.elapsed) / np.log(high / low)
        rows.append(
            [
                what,
                low,
                high,
                first.evaluations,
                second.evaluations,
                1e3 * first.elapsed,
                1e3 * second.elapsed,
                float(exponent),
            ]
        )

    def with_members(name: str) -> Callable[[int], bik.Plan]:
        return lambda members: _plan(4, population[name](population=members, stall_generations=None), 100)

    for name in context.each("wang2019: Tables 2 and 3", list(population)):
        add(f"{name}: members, n_p", 25, 100, with_members(name))
    add("TPBSO: iterations, n_i", 50, 200, lambda generations: _plan(4, swarm, generations))
    add("TPBSO: links (dimension 4 k - 2)", 3, 6, lambda links: _plan(links, swarm, 100))
    add("PSO: links", 3, 6, lambda links: _plan(links, particles, 300))
    add("TPBSO along a path: points, n_in", 51, 201, _follow)
    table = Table(
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
        rows=rows,
    )
    exponents = [float(row[-1]) for row in rows]
    ratios = [_growth(row) for row in rows if "members" in str(row[0]) or "iterations" in str(row[0])]
    claim = Claim.checked(
        "Cost grows in proportion to population and iterations.",
        source="Section IV-D.3, Table 2",
        measured=(
            f"evaluations grow {number(min(ratios))} to {number(max(ratios))} times as much as their cause; no part of "
            f"the verdict: exponents of time between {number(min(exponents), 2)} and {number(max(exponents), 2)}"
        ),
        holds=all(abs(ratio - 1.0) < _LEFT_OVER for ratio in ratios),
        section=TITLE,
    )
    return Section(TITLE, [_TEXT, table]), [claim]


def _growth(row: list[str | int | float]) -> float:
    """How much evaluations grow for what makes them grow."""
    _, low, high, first, second, *_ = row
    return float(second) / float(first) / (float(high) / float(low))


def _shortest(run: Callable[[], bik.Plan], repeats: int) -> bik.Plan:
    return min((run() for _ in range(repeats)), key=lambda plan: plan.elapsed)


def _plan(links: int, solver: bik.BeetleSwarm | bik.PSO | bik.Genetic, iterations: int) -> bik.Plan:
    stop = bik.Stop(max_iterations=iterations, max_evaluations=_ENOUGH)
    return bik.plan_point_to_point(
        arm(links), START, END, method="tpbso", limits=FROM_END_TO_END, solver=solver, stop=stop
    )


def _follow(points: int) -> bik.Plan:
    angle = np.linspace(0.0, 2 * np.pi, points)
    circle = np.column_stack((1.0 + 0.4 * np.cos(angle), 1.0 + 0.4 * np.sin(angle), 0.0 * angle))
    stop = bik.Stop(max_evaluations=3000)
    return bik.plan_along_path(THREE_LINKS, circle, method="tpbso", limits=ALONG_PATH, accuracy=0.02, stop=stop)
