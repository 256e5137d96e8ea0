"""Singular configurations: along the motions, and as the start of searches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import beetle_ik as bik

from ...report import VERMILION, Claim, Figure, Part, Section, drawing, line, number
from ..experiment import Context
from .published import BUDGET, MOTIONS, Array
from .task import ROBOT, TOLERANCE, Motion, reach

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "Singularities"
_SINGULAR = ("I-1", "5-6")  # singular motions by the paper
_BY_APPS, _STRAIGHT = "while APPS runs", "on the straight way between the ends in joint space"
_RARE = 5.0  # percentile of random configurations that counts as near a singularity
_AS_MANY = 5.0  # percentage points by which fractions of targets may differ
_EVERY = 2  # iterations between samples: the passage of a singularity is short
_WRIST = 4  # row of the fifth joint, whose zero aligns the fourth with the sixth

_TEXT = """
The paper calls the motions I-1 and 5-6 singular. We measure the distance from a singularity by the smallest singular
value of the Jacobian. Its 5th percentile over {count} random configurations is {rare}. While APPS runs, it falls to
{first} in I-1, where the fifth joint passes zero and the wrist is stretched; in 5-6, where that joint stays near 34°,
it stays above {other}. It falls below the percentile in {near}.
"""


@dataclass(frozen=True)
class Approach:
    """Approach of a motion to a singularity."""

    name: str
    smallest: Array
    """Smallest singular value, by iteration."""
    solved: bool


def singularities(context: Context, runs: list[Motion]) -> Part:
    """Computes singular values along the motions, and runs searches that start at a singularity."""
    approaches = [_approach(run) for run in runs]
    count = context.pick(full=2000, short=200)
    random = ROBOT.random_configurations(count, seed=context.seed)
    rare = float(np.percentile([_smallest(q) for q in random], _RARE))
    by_name = {one.name: float(one.smallest.min()) for one in approaches}
    straight_way = {run.name: min(_smallest(q) for q in np.linspace(run.start, run.solution.q, 101)) for run in runs}
    text = _TEXT.format(
        count=count,
        rare=number(rare, 2),
        first=number(by_name["I-1"], 2),
        other=number(by_name["5-6"], 2),
        near=" and ".join(name for name, smallest in by_name.items() if smallest < rare),
    )
    figure = Figure(
        name="singularities",
        title="Smallest singular value of the Jacobian while APPS runs",
        drawing=_draw(approaches, rare),
        caption=f"Below the dashed line are {_RARE:g} % of random configurations.",
    )
    goals = ROBOT.fk(ROBOT.random_configurations(count, seed=context.seed + 1))
    straight = random.copy()
    straight[:, _WRIST] = 0.0
    shares = _share(goals, random), _share(goals, straight)
    solved = {one.name: one.solved for one in approaches}
    return Section(TITLE, [text, figure]), [
        *(passed_claim(name, {_BY_APPS: by_name[name], _STRAIGHT: straight_way[name]}, rare) for name in _SINGULAR),
        *(solved_claim(name, solved=solved[name]) for name in _SINGULAR),
        start_claim(*shares),
    ]


def passed_claim(name: str, smallest: Mapping[str, float], rare: float) -> Claim:
    """Judges the smallest singular values along a motion against a low percentile of random configurations."""
    return Claim.judged(
        f"A singularity exists in the process of motion {name}.",
        source="Text on Table 6",
        rule=f"The smallest singular value falls below the {_RARE:g}th percentile of random configurations.",
        measured="; ".join(f"{way} {number(value, 2)}" for way, value in smallest.items())
        + f" (percentile: {number(rare, 2)})",
        holds={way: value < rare for way, value in smallest.items()},
        section=TITLE,
    )


def solved_claim(name: str, *, solved: bool) -> Claim:
    """Judges whether APPS solves a motion that the paper calls singular."""
    return Claim.judged(
        f"APPS performs well in motion {name}.",
        source="Text on Table 6",
        rule="APPS solves the motion.",
        measured="solved" if solved else "not solved",
        holds=solved,
        reading="η and E₀ as for the seven motions.",
        reason="Where the motion passes no singularity, this says nothing about singularities.",
        section=TITLE,
    )


def start_claim(elsewhere: float, straight: float) -> Claim:
    """Judges the fractions of targets (%) that converge from random starts, and from these with a stretched wrist."""
    return Claim.judged(
        "Since APPS does not involve the Jacobian, it converges even when a singularity exists.",
        source="Introduction",
        rule=f"From starts with a stretched wrist as many random targets converge within {BUDGET} iterations as from "
        f"others, to {_AS_MANY:g} percentage points.",
        measured=f"{number(straight, 3)} % against {number(elsewhere, 3)} %",
        holds=straight >= elsewhere - _AS_MANY,
        reading="The automatic learning rate. Its gradient is the transposed Jacobian times the error; only no inverse "
        "is needed.",
        section=TITLE,
    )


def _approach(run: Motion) -> Approach:
    ends = range(0, run.solution.iterations + 1, _EVERY)
    ways = [run.start, *(reach(run.goal, run.start, bik.papers.APPS.paper(), budget=end).q for end in ends[1:])]
    return Approach(run.name, np.array([_smallest(q) for q in ways]), run.solution.success)


def _smallest(q: Array) -> float:
    return float(np.linalg.svd(ROBOT.jacobian(q), compute_uv=False)[-1])


def _share(goals: Array, starts: Array) -> float:
    found = bik.solve_batch(
        ROBOT,
        goals,
        start_q=starts,
        solver=bik.papers.APPS(),
        limits=bik.Limits(lower=-np.inf, upper=np.inf),
        position_tolerance=TOLERANCE,
        rotation_tolerance=TOLERANCE,
        stop=bik.Stop(max_iterations=BUDGET, max_evaluations=2 * BUDGET),
    )
    return 100.0 * float(np.mean(found.success))


def _draw(approaches: list[Approach], rare: float) -> Drawing:
    with drawing(3.2) as figure:
        axes = figure.subplots()
        for i, one in enumerate(approaches):
            iterations = _EVERY * np.arange(len(one.smallest))
            axes.semilogy(iterations, one.smallest, label=MOTIONS[i], **line(i))
        axes.axhline(rare, color=VERMILION, linestyle="--", linewidth=1.0)
        axes.set(xlabel="iteration", ylabel="smallest singular value")
        axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure
