"""Convergence, memory and time: claims on BAS that the paper makes without a figure or a table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

import beetle_ik as bik

from ...report import Claim, Column, Part, Section, Table, number
from ..experiment import Context
from .boxes import WHOLE, ErrorBox, Setting
from .comparison import Compared
from .methods import BEETLE, METHODS, PRECISION
from .settings import DT, IIWA, STEPS
from .tuned import all_tuned
from .tuning import COMMAND

TITLE = "Convergence, memory and time"
_TARGETS = 200
_TARGETS_SHORT = 30
_ENOUGH = 100  # targets needed for a verdict
_PASSES = (200, 2000)
_WALKS: tuple[Literal["star", "chain"], ...] = ("star", "chain")
_C1 = (1.0, 3.0, 10.0)
_NEAR = 1e-4  # m
_BEETLE_HOLDS = 6  # base and best of the pass, present position, direction, two antennae
# Configurations held for each member of a population.
_A_MEMBER = {"GA": 2, "PSO": 3, "FA": 1, "QPSO": 2}

_TEXT = """
**Convergence.** The paper cites a theorem: with properly chosen step sizes, BAS converges with probability 1. The step
sizes of the paper are those of eq. (12) and (13), in proportion to the error. We send the iiwa from a random
configuration to the tip position of another one, {count} times, within the joint limits. The table shows how many
targets are reached to 0.1 mm. {stuck}

**Memory.** A beetle stores its position, the best one, a direction and two antennae. The table counts the
configurations that each method stores at once, in the settings that are the cheapest at 1 mm in the whole box.
"""
_STUCK = """
Ten times as many passes reach hardly more of them: the others end at joint limits or folds, where every configuration
within c₁ times the error is worse.
"""


@dataclass(frozen=True)
class Reached:
    """Random targets that BAS reached."""

    walk: Literal["star", "chain"]
    c1: float
    count: int
    reached: list[int]
    """Targets reached after few passes, and after many."""
    farthest: float
    """Largest final error (m)."""

    @property
    def name(self) -> str:
        """Name of the varied settings."""
        return f"{self.walk}, c₁ = {self.c1:g}"


def resources(context: Context, precise: list[Compared]) -> Part:
    """Judges three claims, and tabulates the data of two of them."""
    count = context.pick(full=_TARGETS, short=_TARGETS_SHORT)
    cases: list[tuple[Literal["star", "chain"], float]] = [(walk, c1) for walk in _WALKS for c1 in _C1]
    reached = [_reach(*case, count, context.seed) for case in context.each("cheng2020: convergence", cases)]
    held = {
        method.name: configurations(method.name, all_tuned()[WHOLE.name, PRECISION, method.name].setting)
        for method in METHODS
    }
    slowest = max(result.elapsed for result in precise[0].results) / STEPS
    stuck = any(one.reached[-1] < one.count for one in reached)
    text = _TEXT.format(count=count, stuck=" ".join(_STUCK.split()) if stuck else "All are.")
    section = Section(TITLE, [text, _reached_table(reached), _memory_table(held)])
    return section, [convergence_claim(reached), memory_claim(held), real_time_claim(slowest)]


def _reach(walk: Literal["star", "chain"], c1: float, count: int, seed: int) -> Reached:
    robot = IIWA.robot
    reached, left = [], np.zeros(count)
    for passes in _PASSES:
        found = bik.solve_batch(
            robot,
            robot.fk(robot.random_configurations(count, seed=seed + 1))[:, :3, 3],
            task=bik.tasks.Position(),
            start_q=robot.random_configurations(count, seed=seed),
            solver=bik.papers.BAS(variant=walk, c1=c1, max_passes=passes),
            position_tolerance=_NEAR,
            seed=seed,
            stop=bik.Stop(max_evaluations=10**6),  # more than the passes need
        )
        reached.append(int(np.sum(found.success)))
        left = found.position_error
    return Reached(walk, c1, count, reached, float(left.max()))


def _reached_table(reached: list[Reached]) -> Table:
    return Table(
        name="convergence",
        title=f"Random targets reached to 0.1 mm, of {reached[0].count}",
        columns=[
            Column(name="walk"),
            Column(name="c₁"),
            *(Column(name=f"within {passes} passes") for passes in _PASSES),
            Column(name="farthest left over", unit="m"),
        ],
        rows=[[one.walk, f"{one.c1:g}", *one.reached, one.farthest] for one in reached],
    )


def _memory_table(held: dict[str, int]) -> Table:
    return Table(
        name="memory",
        title="Configurations stored at once",
        columns=[Column(name="method"), Column(name="configurations"), Column(name="setting")],
        rows=[[name, count, repr(all_tuned()[WHOLE.name, PRECISION, name].setting)] for name, count in held.items()],
        caption="Counted from the algorithms: GA stores parents and children, PSO positions, velocities and bests, "
        "QPSO positions and bests, FA positions.",
        folded=True,
        carried_over=COMMAND,
    )


def configurations(name: str, setting: Setting) -> int:
    """Counts the joint vectors that a method holds at once."""
    if name == BEETLE:
        return _BEETLE_HOLDS
    solver = setting.solver if isinstance(setting, ErrorBox) else setting
    assert not isinstance(solver, bik.papers.BAS)
    return _A_MEMBER[name] * solver.population


def convergence_claim(reached: list[Reached]) -> Claim:
    """Judges the targets reached, by walk and c₁."""
    enough = min(one.count for one in reached) >= _ENOUGH
    return Claim.judged(
        "BAS converges with probability 1, with properly chosen step sizes.",
        source="Section III-C, from Theorem 1 of its reference [38]",
        rule=f"By eq. (12) and (13) every random target is reached to 0.1 mm within {_PASSES[-1]} passes.",
        measured="; ".join(f"{one.name}: {one.reached[-1]} of {one.count}" for one in reached),
        holds={one.name: one.reached[-1] == one.count for one in reached} if enough else None,
        reading="Finitely many passes stand for the limit. The step sizes are those of eq. (12) and (13), with c₁ and "
        "c₂ of ours; which ones are proper, the paper leaves to [38].",
        reason="Ten times fewer passes reach almost as many." if enough else "Too few targets: run without --short.",
        section=TITLE,
    )


def memory_claim(held: dict[str, int]) -> Claim:
    """Judges the configurations held at once, by method."""
    return Claim.judged(
        "BAS has smaller data scales than GA and PSO, and suits platforms with limited storage.",
        source="Section I, contribution 3",
        rule="BAS stores fewer configurations at once than GA and PSO.",
        measured=", ".join(f"{name} {count}" for name, count in held.items()),
        holds=held[BEETLE] < min(held["GA"], held["PSO"]),
        reading="Counted from the algorithms, populations as tuned for 1 mm in the whole box.",
        section=TITLE,
    )


def real_time_claim(slowest: float) -> Claim:
    """Judges the mean time of a step in the slowest run (s)."""
    return Claim.judged(
        "BAS may be feasible for real-time applications.",
        source="Section III",
        rule=f"In the slowest run a step takes less than Ts = {DT} s on average.",
        measured=f"{number(1e6 * slowest, 2)} µs a step at 1 mm",
        holds=slowest < DT,
        reading="Compiled code on the machine of this run; position of the tip only.",
        section=TITLE,
    )
