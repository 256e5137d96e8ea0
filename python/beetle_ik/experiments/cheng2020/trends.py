"""Figures 4, 5 and 6: effects of n, c1 and c2."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

from ...calls.text import counted
from ...report import (
    BLUE,
    VERMILION,
    Block,
    Claim,
    Column,
    Figure,
    Part,
    Section,
    Spread,
    Table,
    draw_error,
    draw_velocities_by_joint,
    drawing,
    number,
)
from ..experiment import Context
from .settings import FIVE_LINK, IIWA, STAR, WALKS, Setting, Task, roughness, steps_to_band

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "What n, c₁ and c₂ do"
_SEEDS = 10
_SEEDS_SHORT = 1

_TEXT = """
A pass of the beetle has three parameters: it makes n explorations, with antennae c₁ times as long as the error (in
radians per metre, eq. (12)), and moves by c₂ antenna lengths (eq. (13)). Each is varied here while the others are
fixed, for both readings of the walk.
"""
_TEXT_N = """
**More explorations.** If all explorations of a pass start from the same point (*star*), as eq. (8), (9) and (11) say,
all three statements of the paper hold: the arm enters its band sooner, its velocities oscillate less, and the cost is
higher. The original beetle (*chain*) enters its band sooner too, but oscillates *more* with larger n, because n steps
of a random walk lead farther than one. This is why *star* is our reading.
"""
_TEXT_C1 = """
**Longer antennae.** "Larger c₁: less computation, more oscillation" holds below an optimum, which among the values
tried is {optima}. Above it most steps are too long, and the cost rises again.
"""
_TEXT_C2 = """
**Longer steps.** c₂ behaves like c₁, since with c₁ fixed it only scales the step. In the chain walk only the product
c₁c₂ matters: with the product fixed at {product}, the planar arm needs {costs} evaluations for c₁ = {lengths}.
"""
_LENGTHS = (0.1, 0.3, 1.0)  # c₁, with the product of c₁ and c₂ constant


@dataclass(frozen=True, kw_only=True)
class Sweep:
    """One option of the beetle over a range, the other options fixed."""

    figure: str
    symbol: str
    vary: Callable[[Setting, float], Setting]
    measured: tuple[float, ...]
    drawn: tuple[float, ...]
    short: tuple[float, ...]
    """Values of a quick pass, which decide the claims; the first two are drawn."""
    text: str


_EXPLORATIONS = Sweep(
    figure="figure_4",
    symbol="n",
    vary=lambda setting, n: replace(setting, explorations=int(n)),
    measured=(5, 10, 20, 50, 100, 200),
    drawn=(5, 50, 200),
    short=(5, 200),
    text=_TEXT_N,
)
_ANTENNA = Sweep(
    figure="figure_5",
    symbol="c₁",
    vary=lambda setting, c1: replace(setting, c1=c1),
    measured=(0.3, 0.5, 1, 2, 3, 5),
    drawn=(0.3, 1, 3),
    short=(0.3, 1, 5),
    text=_TEXT_C1,
)
_STEP = Sweep(
    figure="figure_6",
    symbol="c₂",
    vary=lambda setting, c2: replace(setting, c2=c2),
    measured=(0.3, 0.5, 1, 2, 3, 5),
    drawn=(0.3, 1, 3),
    short=(0.3, 1, 5),
    text=_TEXT_C2,
)
_SWEEPS = (_EXPLORATIONS, _ANTENNA, _STEP)


@dataclass(frozen=True)
class Measured:
    """Results for one value of the option: mean and standard deviation over many seeds."""

    value: float
    steps: Spread
    roughness: Spread
    evaluations: Spread


Measurements: TypeAlias = dict[tuple[str, str], list[Measured]]
"""Results by arm and walk, in the order of the option's values."""


def trends(context: Context) -> Part:
    """Measures all three sweeps on both arms, for both readings of the walk."""
    found = {sweep.figure: _measure(context, sweep) for sweep in _SWEEPS}
    numbers = _in_words(found["figure_5"], _seeds(context))
    blocks: list[Block] = [_TEXT]
    for sweep in _SWEEPS:
        runs = _runs(sweep, context.pick(full=sweep.drawn, short=sweep.short[:2]))
        blocks += [sweep.text.format(**numbers), runs, _table(sweep, found[sweep.figure])]
    if not context.short:  # two points of one seed show no trend
        blocks.append(_overview(found, len(_seeds(context))))
    return Section(TITLE, blocks), _claims(found)


def _in_words(by_c1: Measurements, seeds: range) -> dict[str, str]:
    """Returns the numbers of the text."""
    optima = {
        arm: min(rows, key=lambda row: row.evaluations.mean) for (arm, walk), rows in by_c1.items() if walk == "star"
    }
    setting = WALKS["chain"][FIVE_LINK.name]
    product = setting.c1 * setting.c2
    kept = [_run(FIVE_LINK, replace(setting, c1=c1, c2=product / c1), c1, seeds) for c1 in _LENGTHS]
    return {
        "optima": " and ".join(f"c₁ = {row.value:g} for the {arm} (*star*)" for arm, row in optima.items()),
        "product": f"{product:g}",
        "lengths": ", ".join(f"{c1:g}" for c1 in _LENGTHS),
        "costs": ", ".join(number(round(row.evaluations.mean)) for row in kept),
    }


def _seeds(context: Context) -> range:
    return context.seeds(context.pick(full=_SEEDS, short=_SEEDS_SHORT))


def _measure(context: Context, sweep: Sweep) -> Measurements:
    tasks = context.pick(full=(FIVE_LINK, IIWA), short=(FIVE_LINK,))
    found: Measurements = {(task.name, walk): [] for task in tasks for walk in WALKS}
    values = context.pick(full=sweep.measured, short=sweep.short)
    cases = [(task, walk, value) for task in tasks for walk in WALKS for value in values]
    for task, walk, value in context.each(f"cheng2020: {_number_of(sweep)}", cases):
        found[task.name, walk].append(_run(task, sweep.vary(WALKS[walk][task.name], value), value, _seeds(context)))
    return found


def _run(task: Task, setting: Setting, value: float, seeds: range) -> Measured:
    results = [task.track(setting.solver, band=setting.band, seed=seed) for seed in seeds]
    measures = (steps_to_band, roughness, lambda result: result.evaluations)
    return Measured(value, *(Spread.of([measure(result) for result in results]) for measure in measures))


def _claims(found: dict[str, Measurements]) -> list[Claim]:
    return [
        explorations_claim(found["figure_4"]),
        length_claim("c₁", "Section IV-A.3b, Figure 5", found["figure_5"]),
        length_claim("c₂", "Section IV-A.3c, Figure 6", found["figure_6"]),
    ]


def explorations_claim(found: Measurements) -> Claim:
    """Judges the effect of explorations by the fewest and the most."""
    ends = {f"{walk}, {arm}": (rows[0], rows[-1]) for (arm, walk), rows in found.items()}
    return Claim.judged(
        "With more explorations n the error converges faster and the joint velocity oscillates less, at more cost.",
        source="Section IV-A.3a, Figure 4",
        rule="From the fewest to the most explorations: fewer steps to the band, less roughness, more evaluations.",
        measured="; ".join(f"{name}: {_change(*both)}" for name, both in ends.items()),
        holds={
            name: many.steps.mean < few.steps.mean
            and many.roughness.mean < few.roughness.mean
            and many.evaluations.mean > few.evaluations.mean
            for name, (few, many) in ends.items()
        },
        reading="Bands, c₁ and c₂ are ours.",
        reason="Eq. (8) to (11) describe *star*, step vii of Algorithm 1 *chain*.",
        section=TITLE,
    )


def length_claim(symbol: str, source: str, found: Measurements) -> Claim:
    """Judges the effect of a length by the neighbours of 1, below and above."""
    changes = {}
    for (arm, walk), rows in found.items():
        by_value = {row.value: row for row in rows}
        for low, high in ((0.3, 1.0), (1.0, 5.0)):
            if low in by_value and high in by_value:
                changes[f"{walk}, {arm}, {low:g} to {high:g}"] = by_value[low], by_value[high]
    return Claim.judged(
        f"A larger {symbol} reduces the computation and makes the joint velocity oscillate.",
        source=source,
        rule="The larger value needs fewer evaluations and gives more roughness.",
        measured="evaluations and roughness change "
        + "; ".join(
            f"{number(after.evaluations.mean / before.evaluations.mean, 2)} and "
            f"{number(after.roughness.mean / before.roughness.mean, 2)} times ({name})"
            for name, (before, after) in changes.items()
        ),
        holds={
            name: after.evaluations.mean < before.evaluations.mean and after.roughness.mean > before.roughness.mean
            for name, (before, after) in changes.items()
        },
        reading="Bands and the other constants are ours.",
        reason="It holds below an optimum; beyond it the cost rises. The paper's own range is not in our copy.",
        section=TITLE,
    )


def _change(before: Measured, after: Measured) -> str:
    return (
        f"{number(before.steps.mean, 2)} to {number(after.steps.mean, 2)} steps, "
        f"{number(before.roughness.mean, 2)} to {number(after.roughness.mean, 2)} rad/s"
    )


def _number_of(sweep: Sweep) -> str:
    return sweep.figure.replace("_", " ").capitalize()


def _table(sweep: Sweep, found: Measurements) -> Table:
    return Table(
        name=f"{sweep.figure}_trend",
        title=f"Numbers: {sweep.symbol}",
        columns=[
            Column(name="arm"),
            Column(name="walk"),
            Column(name=sweep.symbol),
            Column(name="steps to the band"),
            Column(name="roughness", unit="rad/s"),
            Column(name="evaluations"),
        ],
        rows=[
            [arm, walk, f"{row.value:g}", row.steps, row.roughness, row.evaluations]
            for (arm, walk), rows in found.items()
            for row in rows
        ],
        folded=True,
    )


def _runs(sweep: Sweep, values: tuple[float, ...]) -> Figure:
    """Draws one run of the five-link arm for each value, as in the paper."""
    setting = STAR[FIVE_LINK.name]
    joints = FIVE_LINK.on_path.size
    with drawing(6.0) as figure:
        panels = figure.subplots(
            1 + joints, len(values), sharex=True, sharey="row", height_ratios=[2.5] + [1.0] * joints
        )
        for (error, *strips), value in zip(panels.T, values, strict=True):
            result = FIVE_LINK.track(sweep.vary(setting, value).solver, band=setting.band)
            draw_error(error, result.time, result.position_error, band=setting.band, color=BLUE)
            draw_velocities_by_joint(strips, result)
            error.set_title(f"{sweep.symbol} = {value:g}: {result.evaluations:,} evaluations")
            strips[-1].set_xlabel("time [s]")
        for axes in panels[0, 1:]:
            axes.set_ylabel("")
        panels[joints // 2 + 1, 0].set_ylabel("joint velocity [rad/s]")
    caption = "Five-link arm, star walk. Above: error, with its band dashed. Below: velocities, one strip per joint."
    return Figure(name=sweep.figure, title=f"{_number_of(sweep)}: {sweep.symbol}", drawing=figure, caption=caption)


def _overview(found: dict[str, Measurements], seeds: int) -> Figure:
    return Figure(
        name="trends",
        title="The same for both walks",
        drawing=_draw_trends(found),
        caption=(f"Means over {counted(seeds, 'seed')}. Roughness: rms change of joint velocity from step to step."),
    )


def _draw_trends(found: dict[str, Measurements]) -> Drawing:
    quantities = {"evaluations": "evaluations", "steps": "steps to the band", "roughness": "roughness [rad/s]"}
    with drawing(6.6) as figure:
        panels = figure.subplots(len(quantities), len(_SWEEPS), sharex="col", sharey="row")
        for column, sweep in zip(panels.T, _SWEEPS, strict=True):
            for axes, quantity in zip(column, quantities, strict=True):
                for (arm, walk), measured in found[sweep.figure].items():
                    axes.plot(
                        [row.value for row in measured],
                        [getattr(row, quantity).mean for row in measured],
                        color=BLUE if arm == FIVE_LINK.name else VERMILION,
                        linestyle="-" if walk == "star" else "--",
                        marker="o",
                        markersize=3,
                        label=f"{arm}, {walk}",
                    )
                axes.set(xscale="log", yscale="log")
            values = [row.value for row in measured]
            column[-1].set_xticks(values, [f"{value:g}" for value in values])
            column[-1].tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
            column[-1].set_xlabel(sweep.symbol)
        for axes, label in zip(panels[:, 0], quantities.values(), strict=True):
            axes.set_ylabel(label)
        figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure
