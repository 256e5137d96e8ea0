"""Figure 17: the beetle swarm beside a particle swarm, a genetic algorithm and differential evolution."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import fmean

import numpy as np

from ...report import Block, Claim, Column, Figure, Part, Printed, Section, Spread, Table, drawing, line, number
from ..experiment import Context
from .drawing import label
from .motions import CONTESTS, EQUAL_EVALUATIONS, EQUAL_ITERATIONS, EQUAL_TUNING, Motion
from .searches import OURS, RIVALS, TOO_FEW, TPBSO, TUNED, USUAL, best_so_far, is_lower
from .settings import GENERATIONS, LINKS, POPULATION, UNITS, WORDS

TITLE = "Beside PSO and GA"
_COMMAND = "python -m beetle_ik.experiments.wang2019.tuning"
_CLOSE = 1.1  # times the mean of TPBSO
_RIVAL_OF = {"time": "PSO", "joint_travel": "GA"}  # rival that the paper calls close

_TEXT = f"""
The paper states neither the budget of each algorithm nor its constants. A beetle evaluates three times per iteration, a
particle once. So we compare three times:

- **{EQUAL_ITERATIONS}**: {GENERATIONS} iterations of {POPULATION} members each; TPBSO spends three times the
  evaluations of the others;
- **{EQUAL_EVALUATIONS}**: the others may spend as many evaluations;
- **{EQUAL_TUNING}**: in addition, each search uses its best of 32 settings, found on seeds that are not used here.

Differential evolution, which the paper does not have, is part of the last comparison. A search counts as better if its
mean is lower by more than two standard errors of the difference. Least rotation with two links is left out: every
motion without a detour turns the joints by the same amount.
"""


def comparison(_context: Context, motions: Sequence[Motion]) -> Part:
    """Compares the searches on all motions."""
    blocks: list[Block] = [_TEXT, _figure_17(motions), _table(motions), _settings()]
    claims = [is_best(motions), is_close_where_said(motions), is_fast(motions)]
    return Section(TITLE, blocks), claims


def is_best(motions: Sequence[Motion]) -> Claim:
    """Judges whether no rival beats the beetle swarm on any motion."""
    beaten = {contest: list(_beaten(motions, contest)) for contest in CONTESTS}
    enough = _several(motions)
    return Claim.judged(
        "“Whether in the comparison of execution time or joint rotation, TPBSO shows the best performance among three "
        "algorithms.”",
        source="Section IV-D.1, Figure 17; abstract; section V",
        rule="Neither PSO nor GA has a lower mean than TPBSO on any motion, by more than two standard errors.",
        measured="; ".join(f"{contest}: {_told(who)}" for contest, who in beaten.items()) if enough else "",
        holds={contest: not who for contest, who in beaten.items()} if enough else None,
        reading=OURS,
        reason="" if enough else TOO_FEW,
        section=TITLE,
    )


def _beaten(motions: Sequence[Motion], contest: str) -> list[str]:
    """Lists the rivals that beat the swarm, with the motions."""
    found = []
    for motion in motions:
        costs = motion.costs(contest)
        found += [
            f"{rival} on {WORDS[motion.objective]} with {motion.links} links ({number(fmean(costs[rival]))} "
            f"against {number(fmean(costs[TPBSO]))} {UNITS[motion.objective]})"
            for rival in RIVALS
            if motion.is_a_task and is_lower(costs[rival], costs[TPBSO])
        ]
    return found


def _told(who: Sequence[str]) -> str:
    return f"beaten by {', '.join(who)}" if who else "unbeaten"


def _several(motions: Sequence[Motion]) -> bool:
    """Whether every search ran more than once on every motion."""
    return min(len(some) for motion in motions for contest in CONTESTS for some in motion.costs(contest).values()) > 1


def is_close_where_said(motions: Sequence[Motion]) -> Claim:
    """Judges whether PSO is close in time alone, and GA in rotation alone."""
    over = {
        contest: {
            (rival, objective): _over_the_swarm(motions, contest, rival, objective)
            for rival in RIVALS
            for objective in UNITS
        }
        for contest in CONTESTS
    }
    return Claim.judged(
        "“PSO has a close performance with TPBSO in minimum execution time planning but has a poor performance in "
        "minimum joint rotation planning, and GA is just the opposite.”",
        source="Section IV-D.1, Figure 17",
        rule=(
            f"Averaged over the arms, PSO's mean time and GA's mean rotation are at most {_CLOSE} times TPBSO's, PSO's "
            "mean rotation and GA's mean time are more."
        ),
        measured="times TPBSO's: "
        + "; ".join(
            f"{contest}: "
            + ", ".join(
                f"{rival} {number(ratio)} in {WORDS[objective][6:]}" for (rival, objective), ratio in ratios.items()
            )
            for contest, ratios in over.items()
        ),
        holds={
            contest: all(
                (ratio <= _CLOSE) == (_RIVAL_OF[objective] == rival) for (rival, objective), ratio in ratios.items()
            )
            for contest, ratios in over.items()
        },
        reading=f"“Close” is at most {_CLOSE} times. {OURS}",
        section=TITLE,
    )


def _over_the_swarm(motions: Sequence[Motion], contest: str, rival: str, objective: str) -> float:
    """Returns the geometric mean, over the arms, of a rival's mean cost over the swarm's."""
    tasks = [motion.costs(contest) for motion in motions if motion.objective == objective and motion.is_a_task]
    return float(np.exp(np.mean([np.log(fmean(costs[rival]) / fmean(costs[TPBSO])) for costs in tasks])))


def is_fast(motions: Sequence[Motion]) -> Claim:
    """Judges whether the swarm comes near its result before its rivals do."""
    tasks = [motion for motion in motions if motion.is_a_task]
    enough = _several(tasks)
    firsts = {
        "counted in iterations, usual constants": [_first(motion, per_iteration=True) for motion in tasks],
        "counted in evaluations, equal tuning": [_first(motion, per_iteration=False) for motion in tasks],
    }
    return Claim.judged(
        "The algorithm has “a relatively faster computational speed”, “fast optimization speed”.",
        source="Abstract; sections I-B and III-C",
        rule=f"TPBSO's mean cost is the first to come within {_CLOSE} times its final value, on every motion.",
        measured="; ".join(f"{how}: first on {firsts[how].count(TPBSO)} of {len(tasks)} motions" for how in firsts),
        holds={how: all(name == TPBSO for name in names) for how, names in firsts.items()} if enough else None,
        reading=OURS,
        reason="" if enough else TOO_FEW,
        section=TITLE,
    )


def _first(motion: Motion, *, per_iteration: bool) -> str:
    """Returns the paper's search that first comes near the swarm's final mean; the swarm, if several do."""
    searches, plans = (USUAL, motion.usual) if per_iteration else (TUNED[:3], motion.tuned)
    goal = _CLOSE * fmean(motion.costs(EQUAL_EVALUATIONS if per_iteration else EQUAL_TUNING)[TPBSO])
    reached = {}
    for search in searches:
        counts = np.arange(POPULATION, search.evaluations + 1, POPULATION)
        mean = best_so_far(plans[search.name], counts).mean(axis=0)
        spent = counts[np.argmax(mean <= goal)] if mean[-1] <= goal else np.inf
        reached[search.name] = spent / (3 if per_iteration and search.name == TPBSO else 1)
    return min(reached, key=lambda name: reached[name])


def _figure_17(motions: Sequence[Motion]) -> Figure:
    rows = (EQUAL_ITERATIONS, EQUAL_TUNING)
    with drawing(6.0) as figure:
        panels = figure.subplots(len(rows), len(UNITS), sharex=True)
        for contest, of_contest in zip(rows, panels, strict=True):
            for axes, objective in zip(of_contest, UNITS, strict=True):
                mine = [motion for motion in motions if motion.objective == objective]
                searches = TUNED if contest == EQUAL_TUNING else USUAL
                for i, search in enumerate(searches):
                    spreads = [Spread.of(motion.costs(contest)[search.name]) for motion in mine]
                    axes.errorbar(
                        np.array(LINKS) + 0.12 * (i - 1.5),
                        [spread.mean for spread in spreads],
                        [spread.std for spread in spreads],
                        marker="o",
                        markersize=4,
                        label=search.name,
                        **line(i) | {"color": search.color, "linestyle": "none"},
                    )
                axes.plot(
                    LINKS, [motion.bound[0] for motion in mine], "k_", markersize=30, label="bound, or best known"
                )
                axes.set(title=contest, xticks=LINKS, ylabel=label(objective))
        for axes in panels[-1]:
            axes.set(xlabel="links")
        figure.legend(*panels[-1][0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return Figure(
        name="figure_17",
        title="Figure 17: the searches on the eight motions",
        drawing=figure,
        caption="Mean and standard deviation. Black: the bound for times, the best known rotation.",
    )


def _table(motions: Sequence[Motion]) -> Table:
    return Table(
        name="point_to_point",
        title="The numbers behind Figure 17",
        columns=[
            Column(name="contest"),
            Column(name="objective"),
            Column(name="links"),
            Column(name="search"),
            Column(name="cost", unit="s, rad", compared=True, digits=4),
            Column(name="over the bound", digits=4),
        ],
        rows=[
            [
                contest,
                WORDS[motion.objective],
                motion.links,
                name,
                (Printed.NOT_IN_COPY, Spread.of(costs)),
                fmean(costs) / motion.bound[0],
            ]
            for contest in CONTESTS
            for motion in motions
            for name, costs in motion.costs(contest).items()
        ],
        folded=True,
    )


def _settings() -> Table:
    return Table(
        name="settings",
        title="The settings of equal tuning: the best of 32 of each search, its defaults among them",
        columns=[Column(name="search"), Column(name="setting")],
        rows=[[search.name, f"`{_short(repr(search.solver))}`"] for search in TUNED],
        folded=True,
        carried_over=_COMMAND,
    )


def _short(solver: str) -> str:
    """Removes the options common to all solvers."""
    return solver.replace(", max_generations=None, stall_generations=None", "")
