"""The eight motions of Figures 2 to 9, planned by all searches and used in several sections."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import beetle_ik as bik

from ..experiment import Context
from .nearest import bang_bang, nearest_bent_as_in_the_paper
from .searches import RIVALS, TPBSO, TUNED, USUAL, Plans, Search, best_so_far, costs, plan_all
from .settings import LINKS, ONE_EACH, UNITS, Criterion

_SEEDS = 20  # seeds, as in the paper
_SEEDS_SHORT = 1
EQUAL_ITERATIONS = "equal iterations, usual constants"
EQUAL_EVALUATIONS = "equal evaluations, usual constants"
EQUAL_TUNING = "equal evaluations, equal tuning"
CONTESTS = (EQUAL_ITERATIONS, EQUAL_EVALUATIONS, EQUAL_TUNING)
"""Readings of "performance": the paper says neither how much each algorithm may spend nor how it was set."""


@dataclass(frozen=True)
class Motion:
    """Plans for one objective and number of links: all searches over all seeds, with the elbows of the paper."""

    objective: Criterion
    links: int
    usual: Plans
    tuned: Plans

    @property
    def best(self) -> float:
        """Lowest cost found by any search."""
        plans = [plan for found in (*self.usual.values(), *self.tuned.values()) for plan in found]
        return min(plan.cost for plan in plans if plan.success)

    @property
    def bound(self) -> tuple[float, str]:
        """Lower bound of the cost, or the best known cost, and its name."""
        if self.objective == "time":
            return bang_bang(nearest_bent_as_in_the_paper(self.links)), "bang-bang bound"
        return self.best, "best known"

    @property
    def is_a_task(self) -> bool:
        """Whether plans differ: with two links, any motion without a detour has the same joint rotation."""
        return self.objective == "time" or self.links > 2

    def costs(self, contest: str) -> Mapping[str, Sequence[float]]:
        """Returns the costs of each search over the runs of a contest."""
        if contest == EQUAL_TUNING:
            return {name: costs(plans) for name, plans in self.tuned.items()}
        found = {name: costs(plans) for name, plans in self.usual.items()}
        if contest == EQUAL_ITERATIONS:  # the rivals stop at as many generations, a third of the evaluations
            found |= {name: [*best_so_far(self.usual[name], [ONE_EACH])[:, 0]] for name in RIVALS}
        return found

    def swarm(self, contest: str) -> Sequence[bik.Plan]:
        """Returns the beetle swarm's plans in a contest."""
        return (self.tuned if contest == EQUAL_TUNING else self.usual)[TPBSO]


def plan_motions(context: Context) -> list[Motion]:
    """Plans all eight motions by all searches."""
    seeds = context.seeds(context.pick(full=_SEEDS, short=_SEEDS_SHORT))
    which = [(objective, links) for objective in UNITS for links in LINKS]
    return [_motion(*one, seeds) for one in context.each("wang2019: Figures 2-9", which)]


def _motion(objective: Criterion, links: int, seeds: range) -> Motion:
    def plan(search: Search, seed: int) -> bik.Plan:
        return search.plan(links, objective, seed)

    usual = plan_all(USUAL, plan, seeds)
    tuned = plan_all([search for search in TUNED if search not in USUAL], plan, seeds)
    return Motion(objective, links, usual, {search.name: (usual | tuned)[search.name] for search in TUNED})
