"""Origin of the published gap: the size of the search box, at three accuracies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from ...report import Block, Check, Claim, Column, Figure, Part, Section, Spread, Table, drawing, line, number
from ..experiment import Context
from .boxes import BANDS, BOXES, PLANAR, SCALED, TRUST, WHOLE, Box
from .methods import BEETLE, METHODS, RIVALS
from .tuned import BUDGETED, all_tuned
from .tuning import COMMAND, FINALISTS, SEEDS, TRIED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

TITLE = "The lead depends on the search box"
_SEEDS = 10
_SEEDS_SHORT = 1
_DRAWN = (WHOLE, TRUST, SCALED)
_FASTER = 2.0  # times the evaluations of BAS: "much faster"
_LEAD, _LEVEL = 1.5, 1.25  # times the evaluations of BAS
_WORDS = {1e-3: "1 mm", 1e-4: "0.1 mm", 1e-5: "10 µm"}


@dataclass(frozen=True)
class Spent:
    """Evaluations of a method until every step ends within the band, over many seeds."""

    evaluations: Spread
    """Evaluations of a step."""
    missed: int
    """Steps that ended outside the band."""


Costs: TypeAlias = dict[tuple[str, float, str], Spent]
"""Cost by box, band (m) and method."""

_TEXT = """
Does the beetle itself explain Table 2? By eq. (12) its antennae are c₁ times as long as the distance from tip to
target: **the beetle ignores the rest of the box, and the region it searches shrinks with the error.** A swarm that
starts in the whole box has to find that region first.

So all methods search three boxes, at three accuracies:

- the *whole box*: all that the velocity limit allows, 0.4 rad to either side of each joint;
- a *trust box*: 0.02 rad to either side of the present joint positions, all that the circle requires in a step;
- a *box as long as the error*: centred on the best configuration so far, its half width a constant (rad/m) times the
  error, and redrawn after a few generations. It gives a swarm what eq. (12) gives the beetle, and nothing else.

For each box and accuracy each method is tuned separately, BAS included: {tried} settings each on one seed, and the best
{finalists} of them on {seeds} seeds that nothing else uses. The five-link arm is a fourth case: its velocity limit is
so tight that the box of a step is small anyway.

{finding}
"""


def search_box(context: Context, whole: dict[str, Spent]) -> Part:
    """Compares the methods in all boxes; `whole` are their costs in the whole box at 1 mm."""
    costs: Costs = {(WHOLE.name, BANDS[0], name): spent for name, spent in whole.items()}
    cases = [(box, band) for box in BOXES for band in (BANDS if box is not PLANAR else BANDS[:1])]
    seeds = context.seeds(context.pick(full=_SEEDS, short=_SEEDS_SHORT))
    for box, band in context.each("cheng2020: boxes and accuracies", cases):
        for method in METHODS:
            if (box.name, band, method.name) not in costs:
                costs[box.name, band, method.name] = _spent(box, band, method.name, seeds)
    blocks: list[Block] = [
        _TEXT.format(tried=TRIED, finalists=FINALISTS, seeds=len(SEEDS), finding=_finding(costs)),
        Figure(
            name="search_box",
            title="Evaluations per step until every step is within the accuracy, for each search box",
            drawing=_draw(costs),
            caption="Lower is cheaper. In the right panel all methods need about as many as the beetle.",
        ),
        _table(costs),
        _settings_table(),
    ]
    return Section(TITLE, blocks), [*lead_claims(costs), *_checks(costs)]


def _spent(box: Box, band: float, name: str, seeds: range) -> Spent:
    runs = [box.run(all_tuned()[box.name, band, name].setting, seed, band) for seed in seeds]
    return Spent(Spread.of([run.evaluations for run in runs]), sum(run.missed for run in runs))


def over_beetle(costs: Costs, box: Box, band: float) -> dict[str, float]:
    """Returns the evaluations of each rival divided by those of the beetle."""
    beetle = costs[box.name, band, BEETLE].evaluations.mean
    return {name: costs[box.name, band, name].evaluations.mean / beetle for name in RIVALS}


def _span(ratios: dict[str, float]) -> str:
    low, high = min(ratios, key=ratios.__getitem__), max(ratios, key=ratios.__getitem__)
    return f"{number(ratios[low], 2)} ({low}) to {number(ratios[high], 2)} ({high})"


def _spans(costs: Costs, box: Box) -> str:
    return ", ".join(f"{_span(over_beetle(costs, box, band))} at {_WORDS[band]}" for band in BANDS)


def _finding(costs: Costs) -> str:
    return (
        f"As multiples of the evaluations of BAS, the four need {_spans(costs, WHOLE)} in the whole box; "
        f"{_spans(costs, TRUST)} in the trust box; {_spans(costs, SCALED)} in a box as long as the error; and "
        f"{_span(over_beetle(costs, PLANAR, BANDS[0]))} on the five-link arm at 1 mm. **A small "
        "box removes most of the lead at 1 mm and little of it at 10 µm; a box that shrinks with the error removes it "
        "at all three.** A swarm in such a box is little more than a few random points per generation, so the box must "
        "do the work. The strength of the beetle is eq. (12), and all four rivals do about as well once they have it."
    )


def lead_claims(costs: Costs) -> list[Claim]:
    """Judges both claims of the paper over the four rivals at equal precision."""
    return [
        Claim.judged(
            "At the same precision of 1 mm BAS is much faster than GA, PSO, FA and QPSO (9 to 47 times).",
            source="Section IV-A.4b, Table 2",
            rule=f"At 1 mm each of the four needs at least {_FASTER:g} times the evaluations of BAS.",
            measured="; ".join(f"{box.name}: {_span(over_beetle(costs, box, BANDS[0]))} times" for box in _DRAWN),
            holds={
                box.name: min(over_beetle(costs, box, BANDS[0]).values()) >= _FASTER for box in (WHOLE, TRUST, SCALED)
            },
            reading="All five methods are tuned alike; the paper gives no options.",
            reason="The paper does not say which box its swarms search.",
            section=TITLE,
        ),
        Claim.judged(
            "BAS has a stronger solving ability than GA, PSO, FA and QPSO.",
            source="Sections IV-A.4 and V",
            rule="Each of the four needs more evaluations than BAS for the same accuracy: at 1 mm, 0.1 mm and 10 µm.",
            measured="; ".join(f"{box.name}: {_spans(costs, box)}" for box in _DRAWN),
            holds={
                f"{box.name}, {_WORDS[band]}": min(over_beetle(costs, box, band).values()) > 1.0
                for box in _DRAWN
                for band in BANDS
            },
            reading="All five methods are tuned alike; the paper gives no options.",
            reason="The lead comes from the box: it vanishes where the box shrinks with the error.",
            section=TITLE,
        ),
    ]


def _checks(costs: Costs) -> list[Check]:
    """Checks the statements that this section makes on the boxes."""
    fine, scaled = over_beetle(costs, TRUST, BANDS[-1]), [over_beetle(costs, SCALED, band) for band in BANDS]
    return [
        Check(
            statement="In the trust box BAS keeps its lead at 10 µm.",
            rule=f"Each of the four needs at least {_LEAD:g} times its evaluations.",
            measured=f"{_span(fine)} times",
            holds=min(fine.values()) >= _LEAD,
            section=TITLE,
        ),
        Check(
            statement="In a box as long as the error BAS has no lead.",
            rule=f"Each of the four needs at most {_LEVEL:g} times its evaluations, at all three accuracies.",
            measured=f"{_spans(costs, SCALED)} times",
            holds=max(max(ratios.values()) for ratios in scaled) <= _LEVEL,
            section=TITLE,
        ),
    ]


def _table(costs: Costs) -> Table:
    return Table(
        name="search_box_costs",
        title="Evaluations a step, over those of BAS, and steps that ended outside",
        columns=[
            Column(name="box"),
            Column(name="accuracy", unit="m"),
            Column(name="method"),
            Column(name="evaluations a step"),
            Column(name="over BAS"),
            Column(name="steps outside"),
        ],
        rows=[
            [
                box,
                band,
                name,
                spent.evaluations,
                spent.evaluations.mean / costs[box, band, BEETLE].evaluations.mean,
                spent.missed,
            ]
            for (box, band, name), spent in costs.items()
        ],
        folded=True,
    )


def _settings_table() -> Table:
    return Table(
        name="tuned",
        title=f"The settings, the best of {TRIED} each, and what they needed on the tuning seeds",
        columns=[
            Column(name="box"),
            Column(name="accuracy", unit="m"),
            Column(name="method"),
            Column(name="evaluations a step"),
            Column(name="steps outside"),
            Column(name="setting"),
        ],
        rows=[
            [box, band, name, tuned.evaluations, tuned.missed, repr(tuned.setting)]
            for (box, band, name), tuned in all_tuned().items()
            if box != BUDGETED
        ],
        caption="All of them are run in this report, on other seeds.",
        folded=True,
        carried_over=COMMAND,
    )


def _draw(costs: Costs) -> Drawing:
    """Draws a panel for each box, and a line for each method."""
    with drawing(3.6) as figure:
        panels = figure.subplots(1, len(_DRAWN), sharex=True, sharey=True)
        for axes, box in zip(panels, _DRAWN, strict=True):
            _draw_box(axes, costs, box)
        panels[0].set_ylabel("evaluations a step")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=len(METHODS))
    return figure


def _draw_box(axes: Axes, costs: Costs, box: Box) -> None:
    for i, method in enumerate(METHODS):
        means = [costs[box.name, band, method.name].evaluations.mean for band in BANDS]
        thick = {"linewidth": 3.0, "zorder": 1} if method.name == BEETLE else {}
        axes.plot(range(len(BANDS)), means, marker="o", markersize=4, label=method.name, **line(i) | thick)
    axes.set_xticks(range(len(BANDS)), list(_WORDS.values()))
    axes.set(yscale="log", title=box.name, xlabel="accuracy of every step")
