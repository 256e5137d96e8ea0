"""The library's own planner beside the searches, with equal freedom for all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean

import beetle_ik as bik

from ...report import Check, Column, Part, Section, Spread, Table, number
from ..experiment import Context
from .motions import Motion
from .nearest import bang_bang, nearest, nearest_bent_as_in_the_paper
from .searches import TPBSO, TUNED, Search, costs, plan_all
from .settings import LINKS

TITLE = "Nearest configurations instead"
_SEEDS, _SEEDS_SHORT = 5, 1
_LINKS_SHORT = (2, 5)
_ELBOWS = ((1, 1), (1, -1), (-1, 1), (-1, -1))
_POLYNOMIAL = 1.25  # multiple of the bound that one polynomial may take
_VIA = 1.03  # most time of a straight motion over the mean of searches that also place a via point

_TEXT = """
Our own planner does not search over motions. It looks for start and end configurations with the smallest largest joint
displacement, and joins them by a straight line in joint space, timed by one polynomial or by constant speed between
blends. It chooses the elbows at both ends; eq. (1) of the paper does not. So we compare twice, **with the same freedom
for all**: first with all elbows positive; then with free elbows, where each search runs four times, once for each
combination of elbows, with its full number of evaluations, and keeps its best plan.
"""


@dataclass(frozen=True)
class Freedom:
    """Plans of the library and of the searches, for one arm with one freedom."""

    links: int
    elbows: str
    ours: bik.Plan
    found: Mapping[str, Sequence[bik.Plan]]

    @property
    def bound(self) -> float:
        """Least time of any motion between the same configurations (s)."""
        return bang_bang(self.ours)

    @property
    def best_search(self) -> str:
        """Name of the search with the lowest mean."""
        return min(self.found, key=lambda name: fmean(costs(self.found[name])))

    @property
    def best_plan(self) -> float:
        """Duration of the quickest plan of any search (s)."""
        return min(plan.cost for plans in self.found.values() for plan in plans if plan.success)


def freedom(context: Context, motions: Sequence[Motion]) -> Part:
    """Compares the plans with fixed elbows and with free ones."""
    seeds = context.seeds(context.pick(full=_SEEDS, short=_SEEDS_SHORT))
    links = context.pick(full=LINKS, short=_LINKS_SHORT)
    timed = [motion for motion in motions if motion.objective == "time" and motion.links in links]
    held = [
        Freedom(motion.links, "both positive", nearest_bent_as_in_the_paper(motion.links), motion.tuned)
        for motion in timed
    ]
    chosen = [_chosen(links, seeds) for links in context.each("wang2019: free elbows", links)]
    cases = [case for pair in zip(held, chosen, strict=True) for case in pair]
    return Section(TITLE, [_TEXT, _table(cases)]), [_is_near_the_bound(cases), _is_quicker(cases)]


def _chosen(links: int, seeds: range) -> Freedom:
    found = plan_all(TUNED, lambda search, seed: _choosing(search, links, seed), seeds)
    return Freedom(links, "chosen by all", nearest(links), found)


def _choosing(search: Search, links: int, seed: int) -> bik.Plan:
    """Returns the best plan over all elbows."""
    plans = [search.plan(links, "time", seed, elbows=elbows) for elbows in _ELBOWS]
    return min(plans, key=lambda plan: (not plan.success, plan.cost))


def _is_near_the_bound(cases: Sequence[Freedom]) -> Check:
    ratios = [case.ours.cost / case.bound for case in cases]
    return Check(
        statement="Nearest configurations joined straight come close to the least possible time.",
        rule=f"At most {_POLYNOMIAL} times the bang-bang bound of the same configurations, for each arm and freedom.",
        measured=f"{number(min(ratios))} to {number(max(ratios))} times the bound",
        holds=max(ratios) <= _POLYNOMIAL,
        section=TITLE,
    )


def _is_quicker(cases: Sequence[Freedom]) -> Check:
    ratios = [fmean(costs(case.found[case.best_search])) / case.ours.cost for case in cases]
    longer = [f"{case.links} links, elbows {case.elbows}" for case in cases if case.best_plan < case.ours.cost]
    return Check(
        statement="With the same freedom for all, they beat the mean of the best search, or nearly reach it.",
        rule=f"Ours takes at most {_VIA} times the lowest mean of the searches, for each arm and freedom.",
        measured=(
            f"the lowest mean is {number(min(ratios), 4)} to {number(max(ratios), 4)} times ours; the best single plan "
            f"of any search is faster than ours for {'; '.join(longer) or 'no arm'}"
        ),
        holds=min(ratios) >= 1.0 / _VIA,
        section=TITLE,
    )


def _table(cases: Sequence[Freedom]) -> Table:
    return Table(
        name="nearest",
        title="Least time: nearest configurations, joined straight, beside the searches",
        columns=[
            Column(name="links"),
            Column(name="elbows"),
            Column(name="bound", unit="s", digits=4),
            Column(name="ours", unit="s", digits=4),
            Column(name="TPBSO", unit="s", digits=4),
            Column(name="best search"),
            Column(name="its mean", unit="s", digits=4),
            Column(name="best plan of any", unit="s", digits=4),
        ],
        rows=[
            [
                case.links,
                case.elbows,
                case.bound,
                case.ours.cost,
                Spread.of(costs(case.found[TPBSO])),
                case.best_search,
                Spread.of(costs(case.found[case.best_search])),
                case.best_plan,
            ]
            for case in cases
        ],
        caption=(
            "The bound is that of the configurations found: nothing proves that no nearer ones exist (with 2 links "
            "none do). All searches have equal tuning."
        ),
    )
