"""Figures 7 and 8, Tables 1 and 2: the beetle beside four swarms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...report import (
    BLUE,
    VERMILION,
    Block,
    Column,
    Figure,
    Part,
    Printed,
    Section,
    Table,
    draw_error,
    draw_velocities,
    drawing,
    number,
)
from ..experiment import Context
from .comparison import Compared
from .methods import BUDGET, METHODS, PRECISION, WHOLE, Tuned, tune
from .rival_claims import rival_claims

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

TITLE = "The beetle beside four swarms"
_TESTS = 25  # as Table 2
_TESTS_SHORT = 2
_NO_BAND = 1e-14  # m: out of reach

_TEXT = """
The paper gives five methods the same task, the iiwa's circle, and compares them twice. All of them search, in each
step, the box that the velocity limit lets the arm reach, which at 2 rad/s and 0.2 s is 0.8 rad wide in each joint. A
swarm is drawn anew in that box in every step, as a plain port of a swarm does; where the arm stands is one of its
members. The arm starts on the circle.

The paper names no options of any method. Here each is tuned alike, the beetle included: eight candidates, four sizes
with two sets of options each, on ten seeds that are used for nothing else. The cheapest that ends every
step within a millimetre is compared.
"""
_TEXT_PRECISION = """
**The same precision, 1 mm.** Every method works in each step until it is within a millimetre of the target. The
beetle is first and the genetic algorithm last, as published. The order of the three in between is not as published,
and changes with the tuning.
"""
_TEXT_BUDGET = """
**The same budget.** The paper gives each method about 15 s. We give each up to {budget} evaluations a step, which
unlike seconds depend neither on the machine nor on who wrote the code. A step is over before that if it beats the
step before (line 16 of Algorithm 1), and only then: there is no error band here, and so the beetle's error is far
below the published one, which *is* its band.
"""


@dataclass(frozen=True)
class Comparison:
    """All methods, BAS first: how they were tuned, and their runs at equal precision and at equal budget."""

    tuned: dict[str, list[Tuned]]
    precise: list[Compared]
    budgeted: list[Compared]


def compare(context: Context) -> Comparison:
    """Tunes all methods, and runs them at equal precision and at equal budget."""
    tuned = {
        method.name: tune(method, WHOLE, short=context.short)
        for method in context.each("cheng2020: tuning five methods", METHODS)
    }
    seeds = context.seeds(context.pick(full=_TESTS, short=_TESTS_SHORT))
    precise = [
        Compared(method, [WHOLE.track(tuned[method.name][0].solver, seed=seed) for seed in seeds])
        for method in context.each("cheng2020: Figure 8 and Table 2", METHODS)
    ]
    budgeted = [
        Compared(method, [WHOLE.track(method.with_budget, seed=seed, band=_NO_BAND) for seed in seeds])
        for method in context.each("cheng2020: Figure 7 and Table 1", METHODS)
    ]
    return Comparison(tuned, precise, budgeted)


def rivals(comparison: Comparison) -> Part:
    """The comparison as the paper makes it."""
    precise, budgeted = comparison.precise, comparison.budgeted
    blocks: list[Block] = [
        _TEXT,
        _tuning_table(comparison.tuned),
        _TEXT_PRECISION,
        Figure(
            name="figure_8",
            title="Figure 8: within 1 mm, one run each",
            drawing=_draw_precise(precise),
            caption="Above: error, the band dashed. Below: joint velocities. The swarms jump about the box.",
        ),
        _table_2(precise),
        _TEXT_BUDGET.format(budget=BUDGET),
        Figure(
            name="figure_7",
            title=f"Figure 7: up to {BUDGET} evaluations a step, one run each",
            drawing=_draw_budgeted(budgeted),
            caption="Above: error, on a logarithmic scale. Below: joint velocities.",
        ),
        _table_1(budgeted),
    ]
    return Section(TITLE, blocks), rival_claims(TITLE, precise, budgeted)


def _tuning_table(tuned: dict[str, list[Tuned]]) -> Table:
    return Table(
        name="tuning",
        title="How the methods were tuned: candidates, cheapest first",
        columns=[
            Column(name="method"),
            Column(name="candidate"),
            Column(name="evaluations a step"),
        ],
        rows=[
            [name, repr(one.solver), "outside 1 mm" if one.evaluations is None else one.evaluations]
            for name, tried in tuned.items()
            for one in tried
        ],
        folded=True,
    )


def _table_2(compared: list[Compared]) -> Table:
    beetle = compared[0]
    return Table(
        name="table_2",
        title=f"Table 2: the same precision, 1 mm; mean and standard deviation over {len(beetle.results)} tests",
        columns=[
            Column(name="method"),
            Column(name="time", unit="s", compared=True),
            Column(name="time over BAS", compared=True, digits=2),
            Column(name="evaluations a step"),
            Column(name="over BAS", digits=2),
            Column(name="steps outside"),
            Column(name="roughness", unit="rad/s", digits=2),
        ],
        rows=[
            [
                one.name,
                (one.method.printed_time, one.time),
                (
                    round(one.method.printed_time.mean / beetle.method.printed_time.mean, 1),
                    one.time.mean / beetle.time.mean,
                ),
                one.evaluations,
                one.evaluations.mean / beetle.evaluations.mean,
                one.missed,
                one.roughness,
            ]
            for one in compared
        ],
        caption=(
            "Times of 150 steps; the printed ones are MATLAB's, quoted in section IV-A.4b. Printed ratios are those of "
            "the printed means. Roughness: rms change of joint velocity from step to step."
        ),
    )


def _table_1(compared: list[Compared]) -> Table:
    return Table(
        name="table_1",
        title=f"Table 1: the same budget; mean errors of the second half over {len(compared[0].results)} tests",
        columns=[
            Column(name="method"),
            *(Column(name=f"along {axis}", unit="m", compared=True, digits=2) for axis in "xyz"),
            Column(name="mean error", unit="m", compared=True, digits=2),
        ],
        rows=[
            [
                one.name,
                *((Printed.NOT_IN_COPY, error) for error in one.axis_errors),
                (one.method.printed_level, one.error),
            ]
            for one in compared
        ],
        caption=(
            "The levels are those of section IV-A.4a; the cells of the table itself are missing in our copy. "
            f"Evaluations a step: {', '.join(f'{one.name} {number(round(one.evaluations.mean))}' for one in compared)}."
        ),
    )


def _draw_precise(compared: list[Compared]) -> Drawing:
    with drawing(4.0) as figure:
        errors = _draw_runs(figure, compared)
        for axes, one in zip(errors, compared, strict=True):
            result = one.results[0]
            axes.plot(result.time[1:], 1e3 * result.position_error[1:], color=BLUE, linewidth=0.9)
            axes.axhline(1e3 * PRECISION, color=VERMILION, linestyle="--", linewidth=1.0)
            axes.set_ylim(0.0, 1.2)
        errors[0].set_ylabel("position error [mm]")
    return figure


def _draw_budgeted(compared: list[Compared]) -> Drawing:
    with drawing(4.0) as figure:
        errors = _draw_runs(figure, compared)
        for axes, one in zip(errors, compared, strict=True):
            draw_error(axes, one.results[0].time[1:], one.results[0].position_error[1:], color=BLUE, linewidth=0.9)
        for axes in errors[1:]:
            axes.set_ylabel("")
    return figure


def _draw_runs(figure: Drawing, compared: list[Compared]) -> list[Axes]:
    """Titles and joint velocities of one run of each method, side by side; the axes above them, for the errors."""
    panels = figure.subplots(2, len(compared), sharex=True, sharey="row")
    for (error, velocity), one in zip(panels.T, compared, strict=True):
        result = one.results[0]
        draw_velocities(velocity, result.time[1:], result.qd[1:], result.velocity_limit[1:, 0], linewidth=0.6)
        error.set_title(one.name)
        velocity.set(xlabel="time [s]", xlim=(0.0, result.time[-1]))
    for axes in panels[1, 1:]:
        axes.set_ylabel("")
    return list(panels[0])
