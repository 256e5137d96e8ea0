"""Figures 13 to 16: along a star and along a smooth closed curve."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

import beetle_ik as bik

from ..._plan_figure import animate
from ...report import (
    BLUE,
    FORBIDDEN,
    GREEN,
    VERMILION,
    Block,
    Claim,
    Column,
    Figure,
    Part,
    Section,
    Spread,
    Table,
    drawing,
    number,
)
from ..experiment import Context
from .drawing import draw_arm, draw_bound, draw_search, label, legend_above
from .settings import (
    ALONG_PATH,
    EVOLUTION,
    SCATTER,
    THREE_LINKS,
    UNITS,
    WORDS,
    Criterion,
    Search,
    each,
    pentagram,
    trefoil,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

TITLE = "Along a path"
_SEEDS, _SEEDS_SHORT = 20, 2
_FEW_SEEDS, _FEW_SEEDS_SHORT = 10, 2  # where no claim rests on them
_EVALUATIONS = 50 * (3 * 100 + 1)
_TPBSO, _DE = Search("TPBSO", None, _EVALUATIONS), Search("DE", EVOLUTION, _EVALUATIONS)
_ACCEPTED = {"pentagram": 6.14, "closed curve": 3.72}  # s, mean of TPBSO

_TEXT = """
An arm of three links of 1 m follows 51 points of a path. How the last link stands is free within a range that follows
from the law of cosines; five numbers between 0 and 1 say where in its range it is along the way (eq. 7), and a sixth
how long all takes. Splines lead through every second point, each interval takes the same time, and how far
the tip is from the points between is its accuracy (eq. 24). The table has the largest distance from the path anywhere.

The dashed line is the fastest timing of the very joint path that the best plan takes, from rest to rest (reachability
analysis, `time_optimal`): time need not be spread evenly. The dotted one lets the redundancy be chosen for that timing
(`method="timed"`), which is what the library does unless told otherwise.
"""


@dataclass(frozen=True)
class Case:
    """One path and objective, over all seeds."""

    name: str
    objective: Criterion
    accuracy: float
    plans: list[bik.Plan]
    evolved: list[bik.Plan]
    timed: bik.Plan | None

    @property
    def best(self) -> bik.Plan:
        """The best of all plans."""
        return min([*self.plans, *self.evolved], key=lambda plan: (not plan.success, plan.cost))

    @property
    def retimed(self) -> float:
        """The fastest timing of the best plan's joint path (s)."""
        return float(bik.time_optimal(self.best.trajectory.q, ALONG_PATH).duration)


def along_path(context: Context) -> Part:
    """Plan along both paths for both objectives."""
    seeds: dict[Criterion, range] = {
        "time": context.seeds(context.pick(full=_SEEDS, short=_SEEDS_SHORT)),
        "joint_travel": context.seeds(context.pick(full=_FEW_SEEDS, short=_FEW_SEEDS_SHORT)),
    }
    paths = {"pentagram": (pentagram(), 0.04), "closed curve": (trefoil(), 0.02)}
    which = [(name, objective) for name in paths for objective in UNITS]
    cases = [
        _case(name, objective, *paths[name], seeds[objective])
        for name, objective in context.each("wang2019: Figures 13-16", which)
    ]
    blocks: list[Block] = [_TEXT]
    for i, case in enumerate(cases):
        blocks.append(
            Figure(
                name=f"figure_{13 + i}",
                title=f"Figure {13 + i}: {WORDS[case.objective]} along the {case.name}",
                drawing=_draw(case),
                caption="Best cost so far; the best plan; how its last link stands; how far the tip is off.",
            )
        )
    scatter = context.pick(full=1.0, short=SCATTER)
    claims = [_claim(case, scatter) for case in cases if case.objective == "time"]
    return Section(TITLE, [*blocks, _moving(cases[0]), _table(cases)]), claims


def _case(name: str, objective: Criterion, path: Any, accuracy: float, seeds: range) -> Case:
    def plans(search: Search, seeds: range) -> list[bik.Plan]:
        return each(
            lambda seed: search.follow(path, objective, seed, limits=ALONG_PATH, accuracy=accuracy),
            seeds,
        )

    timed = None
    if objective == "time":
        timed = bik.plan_along_path(THREE_LINKS, path, limits=ALONG_PATH, accuracy=accuracy)
    few = seeds[: max(1, len(seeds) // 4)]
    return Case(name, objective, accuracy, plans(_TPBSO, seeds), plans(_DE, few), timed)


def _moving(case: Case) -> Figure:
    """The library's own plan of a case, in its own time."""
    plan = case.timed or case.best
    with drawing(5.0, 5.0) as figure:
        frames = animate(figure, plan)
    return Figure(
        name="moving",
        title=f"The {case.name} in its own time: redundancy and timing together",
        drawing=figure,
        frames=frames,
        caption=f"{number(plan.cost)} s; the tip is within {number(1e3 * plan.accuracy)} mm of the path everywhere.",
    )


def _draw(case: Case) -> Drawing:
    best = case.best
    with drawing(5.2) as figure:
        (search, space), (redundancy, distance) = figure.subplots(2, 2)
        draw_search(search, case.plans, name="TPBSO", color=BLUE, evaluations=_EVALUATIONS)
        draw_search(search, case.evolved, name="DE", color=GREEN, evaluations=_EVALUATIONS)
        if case.objective == "time":
            draw_bound(search, case.retimed, "same joint path, best timing")
            if case.timed is not None:
                search.axhline(case.timed.cost, color="black", linestyle=":", label="redundancy and timing together")
        else:
            draw_bound(search, best.cost, "best known")
        search.set(ylabel=label(case.objective))
        legend_above(search, columns=2)
        reference = np.asarray(best.reference)
        space.plot(*reference[:, :2].T, color=VERMILION, marker="x", markersize=4, linestyle="none", label="points")
        draw_arm(space, best)
        _draw_redundancy(redundancy, best)
        _draw_distance(distance, best, case.accuracy)
    return figure


def _draw_redundancy(axes: Axes, plan: bik.Plan) -> None:
    value, lowest, highest = plan.redundancy[:, 0].T
    turns = 2 * np.pi * np.round((np.unwrap((lowest + highest) / 2) - (lowest + highest) / 2) / (2 * np.pi))
    time = np.linspace(0.0, plan.trajectory.duration, len(value))
    axes.fill_between(time, highest + turns, (highest + turns).max() + 0.5, color=FORBIDDEN, linewidth=0)
    axes.fill_between(time, lowest + turns, (lowest + turns).min() - 0.5, color=FORBIDDEN, linewidth=0)
    axes.plot(time, value + turns, color=BLUE, marker=".", label="chosen; shaded: impossible")
    axes.set(xlabel="time [s]", ylabel="orientation of the last link [rad]")
    legend_above(axes, columns=1)


def _draw_distance(axes: Axes, plan: bik.Plan, accuracy: float) -> None:
    reference = np.asarray(plan.reference)
    time = np.linspace(0.0, plan.trajectory.duration, len(reference))
    tip = plan.robot.fk(plan.trajectory.at(time)[0])[:, :3, 3]
    axes.plot(
        time, 1e3 * np.linalg.norm(tip - reference, axis=1), color=BLUE, marker=".", label="distance from the points"
    )
    axes.axhline(1e3 * accuracy, color=VERMILION, linestyle="--", label="accuracy asked for")
    axes.set(xlabel="time [s]", ylabel="distance [mm]")
    legend_above(axes, columns=2)


def _table(cases: list[Case]) -> Table:
    return Table(
        name="along_path",
        title="Along the two paths",
        columns=[
            Column(name="path"),
            Column(name="objective"),
            Column(name="TPBSO", unit="s, rad"),
            Column(name="DE", unit="s, rad"),
            Column(name="best timing of the best joint path", unit="s"),
            Column(name="redundancy and timing together", unit="s"),
            Column(name="accuracy reached, at worst", unit="mm"),
            Column(name="plans that keep all"),
        ],
        rows=[
            [
                case.name,
                WORDS[case.objective],
                Spread.of([plan.cost for plan in case.plans]),
                Spread.of([plan.cost for plan in case.evolved]),
                case.retimed if case.objective == "time" else None,
                None if case.timed is None else case.timed.cost,
                1e3 * max(plan.accuracy for plan in case.plans),
                f"{sum(plan.success for plan in case.plans)} of {len(case.plans)}",
            ]
            for case in cases
        ],
    )


def _claim(case: Case, scatter: float) -> Claim:
    mean, bound = sum(plan.cost for plan in case.plans) / len(case.plans), scatter * _ACCEPTED[case.name]
    return Claim.judged(
        f"The manipulator follows the {case.name} in little time.",
        source="Section IV-C, Figure 13" if case.name == "pentagram" else "Section IV-C, Figure 15",
        rule=f"The mean time is at most {number(bound)} s, and every plan is valid.",
        measured=f"{number(mean)} s on average (at most {number(bound)} s), within {number(1e3 * case.accuracy)} mm",
        holds=mean <= bound and all(plan.success for plan in case.plans),
        reading="Path, links and limits are ours; eq. (25) needs weights, which it lacks.",
        section=TITLE,
    )
