"""Figures 10 to 12: past an oval, with the shortest way of the tip."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import beetle_ik as bik

from ...report import (
    BLUE,
    FORBIDDEN,
    GREEN,
    Block,
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
from .drawing import draw_arm, draw_bound, draw_joints, draw_search, legend_above
from .settings import EVALUATIONS, SAME_EVALUATIONS, TPBSO, Search, each

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "Past an obstacle"
_SEEDS = 6
_SEEDS_SHORT = 1
_LINKS = (3, 4, 5)
_LINKS_SHORT = (3, 5)
_CENTER, _SEMI_AXES = (0.8, 0.8), (0.3, 0.2)  # m; the paper does not state them
_TANGENT = 1.64757  # m: straight to the ellipse, along it, straight on: the shortest way for the tip alone
_ACCEPTED = {3: 1.78, 4: 1.75, 5: 1.75}  # m by links, mean of differential evolution
_EVOLUTION = SAME_EVALUATIONS[2]

_TEXT = f"""
An ellipse stands between the two places, and no link may touch it (eq. 14). The cost is the way of the tip (eq. 10).
Links are lines, as in the paper. Whether a line meets an ellipse needs no sampled points on the line: the map that
makes the ellipse a circle keeps lines straight.

Samples in time are another matter. The best plan grazes the ellipse, and between two of the paper's samples it would
cut through. So the search keeps one hundredth of a metre away, and the plan is then *certified*: a bound on how far
links can move between two looks decides where to look again, until every moment is proven clear.

The dashed line is the shortest way round for the tip alone, {_TANGENT} m.
"""


def obstacle(context: Context) -> Part:
    """Plan past the ellipse with three to five links."""
    seeds = context.seeds(context.pick(full=_SEEDS, short=_SEEDS_SHORT))
    blocks: list[Block] = [_TEXT]
    found: dict[int, dict[str, list[bik.Plan]]] = {}
    for links in context.each("wang2019: Figures 10-12", context.pick(full=_LINKS, short=_LINKS_SHORT)):
        found[links] = {search.name: _plans(search, links, seeds) for search in (TPBSO, _EVOLUTION)}
        blocks.append(
            Figure(
                name=f"figure_{links + 7}",
                title=f"Figure {links + 7}: past an oval with {links} links",
                drawing=_draw(found[links]),
                caption="Left: best cost so far over seeds. Middle and right: the shortest plan.",
            )
        )
    return Section(TITLE, [*blocks, _table(found)]), [_claim(found)]


def _plans(search: Search, links: int, seeds: range) -> list[bik.Plan]:
    oval = bik.obstacles.Ellipse(_CENTER, _SEMI_AXES)
    return each(lambda seed: search.plan(links, "tip_travel", seed, [oval]), seeds)


def _draw(found: dict[str, list[bik.Plan]]) -> Drawing:
    from matplotlib.patches import Ellipse

    sound = [plan for plans in found.values() for plan in plans if plan.success]
    best = min(sound, key=lambda plan: plan.cost)
    with drawing(2.9) as figure:
        search, space, joints = figure.subplots(1, 3, width_ratios=[1.0, 0.8, 1.0])
        for plans, name, color in zip(found.values(), ("TPBSO", "DE"), (BLUE, GREEN), strict=True):
            clear = [plan for plan in plans if plan.success]
            if clear:
                draw_search(search, clear, name=name, color=color, evaluations=EVALUATIONS)
        draw_bound(search, _TANGENT, "shortest way round")
        search.set(ylabel="way of the tip [m]", ylim=(1.5, None))
        legend_above(search, columns=3)
        width, height = (2 * semi_axis for semi_axis in _SEMI_AXES)
        space.add_patch(Ellipse(_CENTER, width, height, color=FORBIDDEN, label="obstacle"))
        draw_arm(space, best)
        draw_joints(joints, best)
    return figure


def _table(found: dict[int, dict[str, list[bik.Plan]]]) -> Table:
    rows: list[list[Value]] = []
    for links, searches in found.items():
        for name, plans in searches.items():
            sound = [plan for plan in plans if plan.success]
            costs = Spread.of([plan.cost for plan in sound]) if sound else None
            clearance = min((plan.clearance for plan in sound), default=math.nan)
            rows.append([links, name, costs, f"{len(sound)} of {len(plans)}", 1e3 * clearance])
    return Table(
        name="obstacle",
        title="Ways of the tip past the obstacle",
        columns=[
            Column(name="links"),
            Column(name="search"),
            Column(name="way of the tip, clear plans", unit="m"),
            Column(name="clear plans"),
            Column(name="smallest certified clearance", unit="mm"),
        ],
        rows=rows,
        caption="Plans that are not clear say so: the swarm sometimes settles where a link cannot leave the ellipse.",
    )


def _claim(found: dict[int, dict[str, list[bik.Plan]]]) -> Claim:
    plans = {links: searches[_EVOLUTION.name] for links, searches in found.items()}
    means = {links: sum(plan.cost for plan in some) / len(some) for links, some in plans.items()}
    clear = all(plan.success and plan.clearance > 0 for some in plans.values() for plan in some)
    return Claim.judged(
        "Manipulators with different link numbers pass the obstacle on a short way.",
        source="Section IV-B, Figures 10-12",
        rule="Every plan is certified clear, and the mean length is at most the bound for its number of links.",
        measured=(
            "means of differential evolution "
            + ", ".join(
                f"{number(mean)} m ({links} links, at most {_ACCEPTED[links]} m)" for links, mean in means.items()
            )
            + ", all certified clear"
        ),
        holds=clear and all(mean <= _ACCEPTED[links] for links, mean in means.items()),
        reading="Ellipse and margin are ours; by TPBSO itself most plans are clear, not all (see the table).",
        section=TITLE,
    )
