"""Figures 13 to 16: along a star and along a smooth closed curve."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from statistics import median
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

from ...figures.plan_figure import animate
from ...report import (
    BLUE,
    FORBIDDEN,
    VERMILION,
    Block,
    Check,
    Claim,
    Column,
    Figure,
    Part,
    Section,
    Spread,
    Table,
    Value,
    drawing,
    number,
)
from ..experiment import Context
from .drawing import draw_arm, draw_bound, draw_searches, label, legend_above
from .searches import TOO_FEW, TPBSO, TUNED, Plans, Search, costs, iterations_to_converge, plan_all
from .settings import ALONG_PATH, POPULATION, THREE_LINKS, UNITS, WORDS, Criterion, pentagram, trefoil

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

TITLE = "Along a path"
_SEEDS, _SEEDS_SHORT = 6, 1
_GENERATIONS = 100
_SEARCHES = tuple(search.limited_to(POPULATION * (3 * _GENERATIONS + 1)) for search in TUNED)
_SEARCHES_SHORT = tuple(search for search in _SEARCHES if search.name in (TPBSO, "DE"))
_PATHS: dict[str, tuple[bik.Path | NDArray[np.float64], float]] = {
    "pentagram": (pentagram(), 0.04),
    "closed curve": (trefoil(), 0.02),
}  # accuracy in m
_ALIKE = 2.0  # largest ratio of iterations
_NOT_MUCH = 1.1  # multiple of the fastest timing that uniform timing may take
_ROUNDING = 1e-9  # a plan may use all of the accuracy

_TEXT = f"""
An arm of three links of 1 m follows 51 points of a path. The orientation of the last link is free within a range that
follows from the law of cosines; five numbers between 0 and 1 place it in that range along the path (eq. 7), and a sixth
sets the total time. Splines pass through every second point, each interval takes the same time, and the distance of the
tip from the points between is the accuracy (eq. 24). All searches have equal tuning and may spend
{_SEARCHES[0].evaluations} evaluations, {_GENERATIONS} iterations of TPBSO with {POPULATION} members.

The dashed line is the fastest timing of the joint path of the best plan, from rest to rest (reachability analysis,
`time_optimal`), without equal intervals. The dotted line optimises redundancy and timing together (`method="timed"`),
the library's default.
"""


@dataclass(frozen=True)
class Case:
    """Plans for one path and objective: all searches over all seeds."""

    path: str
    objective: Criterion
    searches: Sequence[Search]
    plans: Plans
    timed: bik.Plan | None
    """Plan of the library's own method; None for rotation."""

    @property
    def accuracy(self) -> float:
        """Required accuracy (m)."""
        return _PATHS[self.path][1]

    @property
    def best(self) -> bik.Plan:
        """Best of all plans."""
        return min(
            (plan for plans in self.plans.values() for plan in plans), key=lambda plan: (not plan.success, plan.cost)
        )

    @cached_property
    def retimed(self) -> float:
        """Duration of the fastest timing of the best plan's joint path (s)."""
        return float(bik.time_optimal(self.best.trajectory.q, ALONG_PATH).duration)


def along_path(context: Context) -> Part:
    """Plans along both paths for both objectives."""
    seeds = context.seeds(context.pick(full=_SEEDS, short=_SEEDS_SHORT))
    searches = context.pick(full=_SEARCHES, short=_SEARCHES_SHORT)
    which = [(path, objective) for path in _PATHS for objective in UNITS]
    cases = [_case(*one, searches, seeds) for one in context.each("wang2019: Figures 13-16", which)]
    blocks: list[Block] = [_TEXT]
    for i, case in enumerate(cases):
        blocks.append(
            Figure(
                name=f"figure_{13 + i}",
                title=f"Figure {13 + i}: {WORDS[case.objective]} along the {case.path}",
                drawing=_draw(case),
                caption=(
                    "Best cost so far, mean over seeds (shaded: the standard deviation of TPBSO); the best of TPBSO's "
                    "plans; the orientation of its last link; the error of the tip."
                ),
            )
        )
    timed = [case for case in cases if case.objective == "time"]
    judged = [*(follows(path, cases) for path in _PATHS), takes_as_many_iterations(cases), spreads_time_evenly(timed)]
    return Section(TITLE, [*blocks, _moving(cases[0]), _table(cases)]), [*judged, _is_twice_as_fast(timed)]


def _case(path: str, objective: Criterion, searches: Sequence[Search], seeds: range) -> Case:
    points, accuracy = _PATHS[path]

    def plan(search: Search, seed: int) -> bik.Plan:
        return search.follow(points, objective, seed, limits=ALONG_PATH, accuracy=accuracy)

    timed = None
    if objective == "time":
        timed = bik.plan_along_path(THREE_LINKS, points, limits=ALONG_PATH, accuracy=accuracy)
    return Case(path, objective, searches, plan_all(searches, plan, seeds), timed)


def follows(path: str, cases: Sequence[Case]) -> Claim:
    """Judges whether every plan of the beetle swarm stays with the points."""
    mine = [plan for case in cases if case.path == path for plan in case.plans[TPBSO]]
    kept, worst = sum(plan.success for plan in mine), max(from_the_points(plan) for plan in mine)
    accuracy = _PATHS[path][1]
    return Claim.judged(
        f"The manipulator follows the given points of the {path} well, in little time or with little rotation.",
        source="Section IV-C.1, Figures 13-14" if path == "pentagram" else "Section IV-C.2, Figures 15-16",
        rule=(
            f"Every plan of TPBSO keeps the limits, and is within {number(1e3 * accuracy, 2)} mm of each point at its "
            "time (eq. 24)."
        ),
        measured=f"{kept} of {len(mine)} plans; at worst {number(1e3 * worst, 4)} mm",
        holds=kept == len(mine) and worst <= accuracy * (1.0 + _ROUNDING),
        reading="Path, links, limits and accuracy are ours; eq. (25) needs weights, which it lacks.",
        section=TITLE,
    )


def takes_as_many_iterations(cases: Sequence[Case]) -> Claim:
    """Judges whether both paths need about as many iterations."""
    swarm = _SEARCHES[0]
    enough = min(len(case.plans[TPBSO]) for case in cases) > 1
    iterations = {
        (case.path, case.objective): int(median(iterations_to_converge(plan, swarm) for plan in case.plans[TPBSO]))
        for case in cases
    }
    ratios = {
        objective: iterations["closed curve", objective] / max(iterations["pentagram", objective], 1)
        for objective in UNITS
    }
    return Claim.judged(
        "“The number of iterations that reach convergence does not differ too much” between the closed curve and the "
        "pentagram.",
        source="Section IV-C.2, Figures 13-16",
        rule=f"Median iterations to within 1 % of the final cost differ by a factor of {_ALIKE:g} at most.",
        measured="; ".join(
            f"{WORDS[objective]}: {iterations['closed curve', objective]} iterations along the curve, "
            f"{iterations['pentagram', objective]} along the pentagram"
            for objective in UNITS
        ),
        holds=all(1.0 / _ALIKE <= ratio <= _ALIKE for ratio in ratios.values()) if enough else None,
        reading="Path, links, limits and constants are ours; the constants are the tuned ones.",
        reason="" if enough else TOO_FEW,
        section=TITLE,
    )


def spreads_time_evenly(timed: Sequence[Case]) -> Claim:
    """Judges whether equal times for all intervals cost little."""
    ratios = {case.path: case.best.cost / case.retimed for case in timed}
    return Claim.judged(
        "“The actual time of each movement is not much different”: one total time with equal intervals is enough.",
        source="Section III-A",
        rule=f"The best plan takes at most {_NOT_MUCH} times as long as the fastest timing of its own joint path.",
        measured=", ".join(f"{number(ratio, 4)} times along the {path}" for path, ratio in ratios.items()),
        holds=max(ratios.values()) <= _NOT_MUCH,
        reading="Paths, links and limits are ours.",
        reason="The fastest timing even starts and ends at rest, which the plan need not.",
        section=TITLE,
    )


def _is_twice_as_fast(timed: Sequence[Case]) -> Check:
    ratios = {case.path: case.best.cost / case.timed.cost for case in timed if case.timed is not None}
    sound = all(case.timed is not None and case.timed.success for case in timed)
    return Check(
        statement="Redundancy and timing found together are about twice as fast as the best plan with equal intervals.",
        rule="At least 1.8 times, on both paths, within the same limits and accuracy.",
        measured=", ".join(f"{number(ratio, 4)} times along the {path}" for path, ratio in ratios.items()),
        holds=sound and min(ratios.values()) >= 1.8,
        section=TITLE,
    )


def _moving(case: Case) -> Figure:
    """Animates the library's own plan of a case in real time."""
    plan = case.timed or case.best
    with drawing(5.0, 5.0) as figure:
        frames = animate(figure, plan)
    return Figure(
        name="moving",
        title=f"The {case.path} in its own time: redundancy and timing together",
        drawing=figure,
        frames=frames,
        caption=f"{number(plan.cost, 4)} s; the tip is within {number(1e3 * plan.accuracy, 4)} mm of the path.",
    )


def _draw(case: Case) -> Drawing:
    shown = min(case.plans[TPBSO], key=lambda plan: (not plan.success, plan.cost))
    with drawing(6.4) as figure:
        (search, space), (redundancy, distance) = figure.subplots(2, 2)
        draw_searches(search, case.searches, case.plans)
        if case.timed is not None:
            draw_bound(search, case.retimed, "best timing, same joint path")
            search.axhline(case.timed.cost, color="black", linestyle=":", label="redundancy and timing together")
        else:
            draw_bound(search, case.best.cost, "best known")
        search.set(ylabel=label(case.objective))
        legend_above(search, columns=3)
        reference = np.asarray(shown.reference)
        space.plot(*reference[:, :2].T, color=VERMILION, marker="x", markersize=4, linestyle="none", label="points")
        draw_arm(space, shown)
        _draw_redundancy(redundancy, shown)
        _draw_distance(distance, shown, case.accuracy)
    return figure


def _draw_redundancy(axes: Axes, plan: bik.Plan) -> None:
    value, lowest, highest = plan.redundancy[:, 0].T
    turns = _whole_turns((lowest + highest) / 2)
    time = np.linspace(0.0, plan.trajectory.duration, len(value))
    axes.fill_between(time, highest + turns, (highest + turns).max() + 0.5, color=FORBIDDEN, linewidth=0)
    axes.fill_between(time, lowest + turns, (lowest + turns).min() - 0.5, color=FORBIDDEN, linewidth=0)
    axes.plot(time, value + turns, color=BLUE, marker=".", label="chosen; shaded: impossible")
    axes.set(xlabel="time [s]", ylabel="orientation of the last link [rad]")
    legend_above(axes, columns=1)


def _whole_turns(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the turns to add to an angle so that it does not jump."""
    turns: NDArray[np.float64] = 2 * np.pi * np.round((np.unwrap(angle) - angle) / (2 * np.pi))
    return turns


def from_the_points(plan: bik.Plan) -> float:
    """Returns the largest distance (m) of the tip from a point at its time, eq. (24)."""
    return float(_distances(plan)[1].max())


def _distances(plan: bik.Plan) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns the times of the points (s), and the distances of the tip from them at these times (m)."""
    reference = np.asarray(plan.reference)
    time = np.linspace(0.0, plan.trajectory.duration, len(reference))
    tip = plan.robot.fk(plan.trajectory.at(time)[0])[:, :3, 3]
    return time, np.linalg.norm(tip - reference, axis=1)


def _draw_distance(axes: Axes, plan: bik.Plan, accuracy: float) -> None:
    time, distance = _distances(plan)
    axes.plot(time, 1e3 * distance, color=BLUE, marker=".", label="distance from the points")
    axes.axhline(1e3 * accuracy, color=VERMILION, linestyle="--", label="required accuracy")
    axes.set(xlabel="time [s]", ylabel="distance [mm]")
    legend_above(axes, columns=2)


def _table(cases: Sequence[Case]) -> Table:
    return Table(
        name="along_path",
        title="Along the two paths",
        columns=[
            Column(name="path"),
            Column(name="objective"),
            Column(name="search"),
            Column(name="cost", unit="s, rad", digits=4),
            Column(name="from the path, at worst", unit="mm", digits=4),
            Column(name="plans that keep all"),
        ],
        rows=[*(row for case in cases for row in _rows(case))],
    )


def _rows(case: Case) -> Iterator[list[Value]]:
    """Yields the searches and, for least time, the best timing and the library's own plan."""
    words = [case.path, WORDS[case.objective]]
    for name, plans in case.plans.items():
        yield [*words, name, Spread.of(costs(plans)), _worst(plans), _kept(plans)]
    if case.timed is not None:
        yield [*words, "best timing of the best joint path", case.retimed, None, None]
        own = [case.timed]
        yield [*words, "redundancy and timing together", case.timed.cost, _worst(own), _kept(own)]


def _worst(plans: Sequence[bik.Plan]) -> float:
    """Returns the largest distance from the path anywhere (mm)."""
    return 1e3 * max(plan.accuracy for plan in plans)


def _kept(plans: Sequence[bik.Plan]) -> str:
    return f"{sum(plan.success for plan in plans)} of {len(plans)}"
