"""Figures 7 and 8, Tables 1 and 2: beetle antennae search beside four swarms."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import fmean
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
from .boxes import BANDS, SCALED, WHOLE, ErrorBox, Followed, Setting, follow_in_error_boxes, track
from .comparison import Compared
from .methods import BUDGET, METHODS, PATIENCE, PRECISION, RIVALS, Method
from .rival_claims import ErrorBoxes, rival_claims
from .settings import IIWA
from .tuned import BUDGETED, all_tuned
from .tuning import COMMAND, FINALISTS, NO_BAND, SEEDS, TRIED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

TITLE = "The beetle beside four swarms"
_TESTS = 25  # tests of Table 2
_TESTS_SHORT = 2
_FEW = 3  # tests of the swarms in boxes as wide as the error

_TEXT = """
The paper gives five methods the same task, the iiwa's circle, and compares them twice. In each step all of them search
the box of joint positions that the velocity limit allows, which at 2 rad/s and 0.2 s is 0.8 rad wide in each joint. In
every step a swarm starts with a new random population in that box, as in a plain port; the present configuration is one
of its members. The arm starts on the circle.

The paper names no options of any method. Here all are tuned alike, the beetle included, once for equal precision and
once for an equal budget: {tried} settings each, drawn at random from fixed ranges, run on one seed, and the best
{finalists} of them on {seeds} seeds, which are used for nothing else. The {tests} tests below use other seeds.
"""
_TEXT_PRECISION = """
**The same precision, 1 mm.** In each step every method searches until it is within a millimetre of the target, and is
tuned to need few evaluations for that.
"""
_TEXT_BUDGET = """
**The same budget.** The paper gives each method about 15 s. We give each up to {budget} evaluations per step, which
unlike seconds depend neither on the machine nor on the implementation, and tune each for a small error within that
budget. A step ends earlier only if its error is below that of the step before (line 16 of Algorithm 1). There is no
error band here, so the beetle's error is far below the published one, which follows from its band. In boxes as long as
the error, as in the next section but one, the four swarms get below half of the beetle's error within the same budget.
"""


@dataclass(frozen=True)
class Comparison:
    """Runs of all methods, BAS first, at equal precision and at equal budget."""

    precise: list[Compared]
    budgeted: list[Compared]
    error_boxes: ErrorBoxes


def compare(context: Context) -> Comparison:
    """Runs all methods at equal precision and at equal budget, each with the settings tuned for it."""
    seeds = context.seeds(context.pick(full=_TESTS, short=_TESTS_SHORT))
    precise = [
        _runs(method, all_tuned()[WHOLE.name, PRECISION, method.name].setting, seeds, PRECISION)
        for method in context.each("cheng2020: Figure 8 and Table 2", METHODS)
    ]
    budgeted = [
        _runs(method, all_tuned()[BUDGETED, BUDGET, method.name].setting, seeds, NO_BAND)
        for method in context.each("cheng2020: Figure 7 and Table 1", METHODS)
    ]
    few = seeds[: context.pick(full=_FEW, short=1)]
    names = context.each("cheng2020: swarms in boxes as long as the error", RIVALS)
    near = 0.5 * budgeted[0].error.mean  # a rival may stop at half the beetle's error
    boxed = {name: _in_error_boxes(name, few, near) for name in names}
    return Comparison(precise, budgeted, boxed)


def _in_error_boxes(name: str, seeds: range, near: float) -> tuple[float, float]:
    """Returns the mean error (m) with the budget of Table 1, and the roughness (rad/s) at the precision of Table 2."""

    def runs(band: float, tuned_for: float, most: int) -> list[Followed]:
        setting = all_tuned()[SCALED.name, tuned_for, name].setting
        assert isinstance(setting, ErrorBox)
        return [follow_in_error_boxes(IIWA, setting, seed=seed, band=band, most=most) for seed in seeds]

    return (
        fmean(run.error for run in runs(near, BANDS[-1], BUDGET)),
        fmean(run.roughness for run in runs(PRECISION, PRECISION, PATIENCE)),
    )


def _runs(method: Method, setting: Setting, seeds: range, band: float) -> Compared:
    assert not isinstance(setting, ErrorBox), "the whole box is searched by the methods themselves"
    return Compared(method, [track(IIWA, setting, seed=seed, band=band) for seed in seeds])


def rivals(comparison: Comparison) -> Part:
    """Repeats the comparison of the paper."""
    precise, budgeted = comparison.precise, comparison.budgeted
    blocks: list[Block] = [
        _TEXT.format(tried=TRIED, finalists=FINALISTS, seeds=len(SEEDS), tests=len(precise[0].results)),
        _tuning_table(),
        _TEXT_PRECISION,
        Figure(
            name="figure_8",
            title="Figure 8: within 1 mm, one run each",
            drawing=_draw_precise(precise),
            caption="Left: error, the band dashed. Right: joint velocities. The swarms jump about the box.",
        ),
        _table_2(precise),
        _TEXT_BUDGET.format(budget=BUDGET),
        Figure(
            name="figure_7",
            title=f"Figure 7: up to {BUDGET} evaluations a step, one run each",
            drawing=_draw_budgeted(budgeted),
            caption="Left: error, on a logarithmic scale. Right: joint velocities.",
        ),
        _table_1(budgeted),
    ]
    return Section(TITLE, blocks), rival_claims(TITLE, precise, budgeted, comparison.error_boxes)


def _tuning_table() -> Table:
    goals = {(WHOLE.name, PRECISION): "1 mm", (BUDGETED, BUDGET): f"{BUDGET} evaluations"}
    return Table(
        name="tuning",
        title=f"The settings, the best of {TRIED} each, and what they needed on the tuning seeds",
        columns=[
            Column(name="tuned for"),
            Column(name="method"),
            Column(name="evaluations a step"),
            Column(name="setting"),
        ],
        rows=[
            [goals[box, goal], name, tuned.evaluations, repr(tuned.setting)]
            for (box, goal, name), tuned in all_tuned().items()
            if (box, goal) in goals
        ],
        folded=True,
        carried_over=COMMAND,
    )


def _table_2(compared: list[Compared]) -> Table:
    beetle = compared[0]
    return Table(
        name="table_2",
        title=f"Table 2: the same precision, 1 mm; mean and standard deviation over {len(beetle.results)} tests",
        columns=[
            Column(name="method"),
            Column(name="time", unit="s", compared=True),
            Column(name="time over BAS", compared=True),
            Column(name="evaluations a step"),
            Column(name="over BAS"),
            Column(name="steps outside"),
            Column(name="roughness", unit="rad/s"),
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
            *(Column(name=f"along {axis}", unit="m", compared=True) for axis in "xyz"),
            Column(name="mean error", unit="m", compared=True),
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
    with drawing(8.0) as figure:
        for axes, one in zip(_draw_runs(figure, compared), compared, strict=True):
            result = one.results[0]
            axes.plot(result.time[1:], 1e3 * result.position_error[1:], color=BLUE, linewidth=0.9)
            axes.axhline(1e3 * PRECISION, color=VERMILION, linestyle="--", linewidth=1.0)
            axes.set(ylim=(0.0, 1.2), ylabel=f"{one.name}\nerror [mm]")
    return figure


def _draw_budgeted(compared: list[Compared]) -> Drawing:
    with drawing(8.0) as figure:
        panels = _draw_runs(figure, compared)
        for axes, one in zip(panels, compared, strict=True):
            draw_error(axes, one.results[0].time[1:], one.results[0].position_error[1:], color=BLUE, linewidth=0.9)
            axes.set_ylabel(f"{one.name}\nerror [m]")
            axes.sharey(panels[0])
    return figure


def _draw_runs(figure: Drawing, compared: list[Compared]) -> list[Axes]:
    """Draws joint velocities of one run of each method, one below another; returns the axes left of them."""
    panels = figure.subplots(len(compared), 2, sharex=True)
    for (_, velocity), one in zip(panels, compared, strict=True):
        result = one.results[0]
        draw_velocities(velocity, result.time[1:], result.qd[1:], result.velocity_limit[1:, 0], linewidth=0.6)
        velocity.set(xlim=(0.0, result.time[-1]), ylabel="velocity [rad/s]")
    for axes in panels[-1]:
        axes.set_xlabel("time [s]")
    return list(panels[:, 0])
