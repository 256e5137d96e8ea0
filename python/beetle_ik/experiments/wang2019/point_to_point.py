"""Figures 2 to 9: motions between two positions, in least time or with least rotation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import fmean, median
from typing import TYPE_CHECKING

import numpy as np

from ...report import Block, Claim, Figure, Part, Section, drawing, number
from ..experiment import Context
from .drawing import draw_arm, draw_bound, draw_positions, draw_searches, draw_velocities, label, legend_above
from .motions import CONTESTS, Motion
from .searches import OURS, TPBSO, TUNED, USUAL, iterations_to_converge
from .settings import GENERATIONS, LINKS, UNITS, WORDS, Criterion

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

    import beetle_ik as bik

TITLE = "From place to place"
_DRAWN_SHORT = (5,)  # links
_WELL = 1.25  # multiple of the best known cost
_SOON = 10  # iterations of 200

_TEXT = """
The tip goes from (1, 0) to (0.5, 1.5), at rest at both ends, through a via point that the search chooses: one
polynomial of fourth order before it and one of fifth order after it (eq. 3-6). With more than two links the search also
chooses the orientation of the last links at both ends. The paper states no limits; ours are half a turn per second for
velocity, and one turn per second squared for acceleration. Violations cost a penalty (eq. 15); we compare the *exact*
extremes of velocity and acceleration, roots of quadratics, with the limits, where the paper uses samples.

All searches use the elbows that the arccosine of eq. (1) gives: both positive. The dashed line is a bound for the same
elbows: the least time of *any* motion within the limits between the nearest two configurations found, with full
acceleration and full braking.
"""


def point_to_point(context: Context, motions: Sequence[Motion]) -> Part:
    """Draws the eight motions, and judges the paper's claims on them."""
    blocks: list[Block] = [_TEXT, *_figures(motions, context.pick(full=LINKS, short=_DRAWN_SHORT))]
    claims = [*(planned(objective, motions) for objective in UNITS), converges_well(motions), is_easy(motions)]
    return Section(TITLE, blocks), claims


def _figures(motions: Sequence[Motion], drawn: Sequence[int]) -> Iterator[Figure]:
    """Yields the figures of the arms with the numbers of links in `drawn`."""
    for i, motion in enumerate(motions):
        if motion.links in drawn:
            yield Figure(
                name=f"figure_{i + 2}",
                title=f"Figure {i + 2}: {WORDS[motion.objective]} with {motion.links} links",
                drawing=_draw(motion),
                caption=(
                    "Best cost so far, mean over seeds, from where all of them keep the limits (shaded: the standard "
                    "deviation of TPBSO); the best of TPBSO's plans, its joint positions and velocities."
                ),
            )


def _draw(motion: Motion) -> Drawing:
    best = min(motion.tuned[TPBSO], key=lambda plan: plan.cost)
    bound, name = motion.bound
    with drawing(6.0) as figure:
        (search, space), (positions, velocities) = figure.subplots(2, 2, height_ratios=[1.3, 1.0])
        draw_searches(search, TUNED, motion.tuned)
        draw_bound(search, bound, name)
        search.set(ylabel=label(motion.objective), ylim=(0.8 * bound, None))
        legend_above(search, columns=5)
        draw_arm(space, best)
        draw_positions(positions, best)
        draw_velocities(velocities, best, np.pi)
    return figure


def planned(objective: Criterion, motions: Sequence[Motion]) -> Claim:
    """Judges whether every plan keeps its limits."""
    plans = [plan for motion in motions if motion.objective == objective for plan in _of_the_swarm(motion)]
    kept = sum(plan.success for plan in plans)
    return Claim.judged(
        f"TPBSO plans motions of {WORDS[objective]} for arms of 2 to 5 links, within all limits.",
        source="Section IV-A, Figures 2-5" if objective == "time" else "Section IV-A, Figures 6-9",
        rule="The exact extremes of velocity and acceleration keep the limits in every plan.",
        measured=f"{kept} of {len(plans)} plans keep them all",
        holds=kept == len(plans),
        reading="Limits, reach and the swarm's constants are ours: the paper states none.",
        section=TITLE,
    )


def converges_well(motions: Sequence[Motion]) -> Claim:
    """Judges whether the swarm comes close to the best plan known for every number of links."""
    timed = [motion for motion in motions if motion.objective == "time"]

    def over_the_best(contest: str) -> list[float]:
        return [fmean(motion.costs(contest)[TPBSO]) / motion.best for motion in timed]

    shown = {contest: over_the_best(contest) for contest in (CONTESTS[0], CONTESTS[-1])}
    over_the_bound = [fmean(motion.costs(CONTESTS[-1])[TPBSO]) / motion.bound[0] for motion in timed]
    return Claim.judged(
        "“As the number of links grows, the TPBSO can converge well.”",
        source="Section IV-A.1, Figures 2-5",
        rule=f"TPBSO's mean time is at most {_WELL} times the best plan known with the same elbows, for 2 to 5 links.",
        measured=(
            "with 2 to 5 links "
            f"{'; '.join(f'{_listed(ratios)} times ({_constants(contest)})' for contest, ratios in shown.items())}; "
            f"tuned, {_listed(over_the_bound)} times the bang-bang bound"
        ),
        holds={_constants(contest): max(ratios) <= _WELL for contest, ratios in shown.items()},
        reading=f"“Well” is at most {_WELL} times the best plan known. {OURS}",
        reason="With these the search stalls more, not less, as links are added.",
        section=TITLE,
    )


def is_easy(motions: Sequence[Motion]) -> Claim:
    """Judges whether rotation with two links takes few iterations."""
    iterations = {
        motion.links: median(iterations_to_converge(plan, USUAL[0]) for plan in motion.usual[TPBSO])
        for motion in motions
        if motion.objective == "joint_travel"
    }
    others = ", ".join(f"{count:g} with {links}" for links, count in iterations.items() if links > 2)
    return Claim.judged(
        "With 2 links and least rotation, the number of iterations to convergence is very small: the task is simple.",
        source="Section IV-A.2, Figure 6(a)",
        rule=f"The median run is within 1 % of its final cost after at most {_SOON} of {GENERATIONS} iterations.",
        measured=f"{iterations[2]:g} iterations; {others} links",
        holds=iterations[2] <= _SOON,
        reading="Constants are ours. With two links every motion without a detour turns the joints by the same amount.",
        section=TITLE,
    )


def _of_the_swarm(motion: Motion) -> list[bik.Plan]:
    return [*motion.usual[TPBSO], *motion.tuned[TPBSO]]


def _constants(contest: str) -> str:
    return "tuned constants" if contest == CONTESTS[-1] else "usual constants"


def _listed(ratios: Sequence[float]) -> str:
    return ", ".join(number(ratio) for ratio in ratios)
