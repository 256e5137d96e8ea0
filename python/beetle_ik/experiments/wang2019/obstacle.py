"""Figures 10 to 12: past an oval, with the shortest path of the tip."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from statistics import fmean
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

import beetle_ik as bik

from ...report import (
    FORBIDDEN,
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
from .drawing import draw_arm, draw_bound, draw_positions, draw_searches, draw_velocities, legend_above
from .searches import OURS, RIVALS, TOO_FEW, TPBSO, TUNED, Plans, Search, costs, is_lower, plan_all
from .settings import POPULATION, REACH

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "Past an obstacle"
_SEEDS, _SEEDS_SHORT = 5, 1
_LINKS, _LINKS_SHORT = (3, 4, 5), (3,)
_EVALUATIONS = POPULATION * (3 * 100 + 1)
_SEARCHES = tuple(search.limited_to(_EVALUATIONS) for search in TUNED)
_CENTER, _SEMI_AXES = (0.8, 0.8), (0.3, 0.2)  # m; the paper does not state them
_TANGENT = 1.64757  # m: tangent, arc, tangent around the ellipse, the shortest path of the tip alone
_SHORT_WAY = 1.25  # multiple of the shortest path
_TIMES, _PER_LINK = 400, 40  # samples that test the certificate

Found: TypeAlias = Mapping[int, Plans]
"""Plans of all searches, by the number of links."""

_TEXT = f"""
An ellipse lies between the two places, and no link may touch it (eq. 14). The cost is the path length of the tip (eq.
10). Links are line segments, as in the paper. Testing a segment against an ellipse needs no sampled points: the linear
map that makes the ellipse a circle keeps segments straight.

Samples in time are not enough. The best plan grazes the ellipse, and could cut through it between two of the paper's
samples. So the search keeps a distance of 1 cm, and the plan is then *certified*: a bound on how far the links can move
between two samples decides where to sample again, until the whole motion is proven clear.

All searches have equal tuning and may spend {_EVALUATIONS} evaluations, 100 iterations of TPBSO with 50 members. The
dashed line is the shortest way round for the tip alone, {_TANGENT} m.
"""


def obstacle(context: Context) -> Part:
    """Plans past the ellipse with three to five links."""
    seeds = context.seeds(context.pick(full=_SEEDS, short=_SEEDS_SHORT))
    blocks: list[Block] = [_TEXT]
    found: dict[int, Plans] = {}
    for links in context.each("wang2019: Figures 10-12", context.pick(full=_LINKS, short=_LINKS_SHORT)):
        found[links] = plan_all(_SEARCHES, partial(_past_the_oval, links), seeds)
        blocks.append(
            Figure(
                name=f"figure_{links + 7}",
                title=f"Figure {links + 7}: past an oval with {links} links",
                drawing=_draw(found[links]),
                caption=(
                    "Best cost so far, mean over the plans that came out clear (shaded: the standard deviation of "
                    "TPBSO); the shortest clear plan of TPBSO, its joint positions and velocities."
                ),
            )
        )
    return Section(TITLE, [*blocks, _table(found)]), [passes(found), is_robust(found), _is_certified(found)]


def _past_the_oval(links: int, search: Search, seed: int) -> bik.Plan:
    return search.plan(links, "tip_travel", seed, obstacles=[bik.obstacles.Ellipse(_CENTER, _SEMI_AXES)])


def _clear(plans: Sequence[bik.Plan]) -> list[bik.Plan]:
    return [plan for plan in plans if plan.success]


def _draw(found: Plans) -> Drawing:
    from matplotlib.patches import Ellipse

    clear = {name: _clear(plans) for name, plans in found.items()}
    shown = clear[TPBSO] or [plan for plans in clear.values() for plan in plans]
    best = min(shown, key=lambda plan: plan.cost)
    with drawing(6.0) as figure:
        (search, space), (positions, velocities) = figure.subplots(2, 2, height_ratios=[1.3, 1.0])
        draw_searches(search, [one for one in _SEARCHES if clear[one.name]], clear)
        draw_bound(search, _TANGENT, "shortest way round")
        search.set(ylabel="path length of the tip [m]", ylim=(1.5, None))
        legend_above(search, columns=5)
        width, height = (2 * semi_axis for semi_axis in _SEMI_AXES)
        space.add_patch(Ellipse(_CENTER, width, height, color=FORBIDDEN, label="obstacle"))
        draw_arm(space, best)
        draw_positions(positions, best)
        draw_velocities(velocities, best, np.pi)
    return figure


def _table(found: Found) -> Table:
    rows: list[list[Value]] = []
    for links, searches in found.items():
        for name, plans in searches.items():
            clear = _clear(plans)
            ways = Spread.of(costs(clear)) if clear else None
            clearance = min((plan.clearance for plan in clear), default=math.nan)
            rows.append([links, name, ways, f"{len(clear)} of {len(plans)}", 1e3 * clearance])
    return Table(
        name="obstacle",
        title="Path lengths of the tip past the obstacle",
        columns=[
            Column(name="links"),
            Column(name="search"),
            Column(name="path length of the tip, clear plans", unit="m", digits=4),
            Column(name="clear plans"),
            Column(name="smallest certified clearance", unit="mm", digits=4),
        ],
        rows=rows,
        caption="Plans that are not clear say so: a search sometimes ends where a link cannot leave the ellipse.",
    )


def passes(found: Found) -> Claim:
    """Judges whether the beetle swarm gets past the obstacle with each arm."""
    plans = {links: searches[TPBSO] for links, searches in found.items()}
    clear = {links: _clear(some) for links, some in plans.items()}
    shortest = {links: min(costs(some), default=math.inf) for links, some in clear.items()}
    enough = min(map(len, plans.values())) > 1
    return Claim.judged(
        "TPBSO plans past an oval obstacle with arms of different link numbers, on a short path of the tip.",
        source="Section IV-B, Figures 10-12",
        rule=(
            f"For each arm at least half of the plans are certified clear, and the shortest of them is at most "
            f"{_SHORT_WAY} times the shortest way round."
        ),
        measured="; ".join(
            f"{links} links: {len(clear[links])} of {len(plans[links])} plans clear, "
            f"{number(shortest[links], 4)} m ({number(shortest[links] / _TANGENT, 4)} times)"
            for links in plans
        ),
        holds=all(
            2 * len(clear[links]) >= len(plans[links]) and shortest[links] <= _SHORT_WAY * _TANGENT for links in plans
        )
        if enough
        else None,
        reading="Ellipse, margin and limits are ours. The paper shows one plan of each arm.",
        reason="" if enough else TOO_FEW,
        section=TITLE,
    )


def is_robust(found: Found) -> Claim:
    """Judges whether the beetle swarm meets the constraint better than its rivals, and at all."""
    everyone = {name: [plan for searches in found.values() for plan in searches[name]] for name in (TPBSO, *RIVALS)}
    clear = {name: len(_clear(plans)) for name, plans in everyone.items()}
    ways = {name: costs(_clear(plans)) for name, plans in everyone.items()}
    shorter = [rival for rival in RIVALS if is_lower(ways[rival], ways[TPBSO])]
    failed = {name: [float(not plan.success) for plan in plans] for name, plans in everyone.items()}
    more_often = [rival for rival in RIVALS if is_lower(failed[rival], failed[TPBSO])]
    enough = min(map(len, everyone.values())) > 1
    return Claim.judged(
        "BSO has “good robustness” and “exhibits higher performance when dealing with nonlinear constraints”.",
        source="Section III-C",
        rule=(
            "Past the obstacle not fewer plans of TPBSO are clear than of PSO and of GA, and neither's tip paths are "
            "shorter on average, by more than two standard errors."
        ),
        measured=", ".join(
            f"{name}: {clear[name]} of {len(everyone[name])} plans clear, {number(fmean(ways[name]), 4)} m on average"
            for name in everyone
            if ways[name]
        ),
        holds=not shorter and not more_often if enough else None,
        reading=f"Equal evaluations and equal tuning; the ellipse is ours. {OURS}",
        reason="" if enough else TOO_FEW,
        section=TITLE,
    )


def _is_certified(found: Found) -> Check:
    clear = [plan for searches in found.values() for plans in searches.values() for plan in _clear(plans)]
    lowest = min((plan.clearance for plan in clear), default=math.nan)
    nearest = min((_nearest_sample(plan) for plan in clear), default=math.nan)
    return Check(
        statement="Plans that are certified clear are clear.",
        rule=f"At none of {_TIMES} moments is any of {_PER_LINK} points on each link inside the ellipse.",
        measured=(
            f"{len(clear)} plans, certified clear by {number(1e3 * lowest, 4)} mm or more; the nearest sample is on an "
            f"ellipse {number(nearest, 4)} times as large"
        ),
        holds=nearest > 1.0,
        section=TITLE,
    )


def _nearest_sample(plan: bik.Plan) -> float:
    """Returns the scale of the smallest similar ellipse that a point of the arm touches; 1 is the obstacle."""
    q = plan.trajectory.at(np.linspace(0.0, plan.trajectory.duration, _TIMES))[0]
    angle = np.cumsum(q, axis=1)
    length = REACH / q.shape[1]
    corners = np.zeros((_TIMES, q.shape[1] + 1, 2))
    corners[:, 1:] = np.cumsum(length * np.stack((np.cos(angle), np.sin(angle)), axis=2), axis=1)
    share = np.linspace(0.0, 1.0, _PER_LINK)[:, None, None, None]
    points = corners[:, :-1] + share * np.diff(corners, axis=1)
    return float(np.linalg.norm((points - _CENTER) / _SEMI_AXES, axis=-1).min())
