"""Definitions 1 and 2 and Theorem 1: monotone decrease, and convergence to zero."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import beetle_ik as bik

from ...report import BLUE, VERMILION, Check, Claim, Column, Figure, Part, Section, Table, drawing, number
from ..experiment import Context
from .settings import ADAPTIVE, PUBLISHED, Array, M, Run, circle, follow

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "Theorem 1 and Definition 2"
_POINT = np.array([0.1, 0.4, 0.3])  # the middle of the M
_STILL = 10.0  # s
_LONG, _LONG_SHORT = 200.0, 60.0  # s; four times the paper's
_ROUND = 25.0  # s, duration of the circle that a long run repeats
_ZERO = 1e-10  # m^2
_CONSTANT, _ADAPTED = "constant, printed", "eq. (16), k = 100"
_STATE, _SENT = "θ", "θ′"

_TEXT = """
Theorem 1 says that the objective decreases monotonically: the algorithm “will only update the joint-state … if the
objective function value decreases”, and “otherwise it will bring the manipulator back to its previous joint-state”. Eq.
(14) and (15) do not do that: they move in every tick, in a direction that depends on the sign of the change. We ran
both: `accept="always"` is the equations, `accept="improving"` the algorithm of the proof, which stays at an antenna if
it is better and goes back otherwise. It needs neither gain nor delay.

For a fixed target the proof is correct for its own algorithm, and wrong for the published one. For a moving target
neither decreases monotonically, since the target itself can move away.

Definition 2 says that the tool approaches the reference as time goes to infinity. With a constant antenna it cannot:
the arm is always sent λ away. Runs four times as long as the paper's end with the error that they had after a quarter
of the time.
"""


@dataclass(frozen=True, kw_only=True)
class Pair:
    """Runs of one algorithm with a fixed target, and on the M."""

    point: Run
    letter: Run


def theorem(context: Context) -> Part:
    """Runs both algorithms on a point and on the M, and long runs with both antennae."""
    variants = {
        "always: eq. (14), (15)": PUBLISHED,
        "improving: the proof": bik.papers.ZNNBAS(gain=10.0, antenna_length=0.1, delay_steps=10, accept="improving"),
    }
    point = bik.paths.from_function(lambda _: _POINT, _STILL)
    runs = {
        name: Pair(
            point=follow(point, variants[name], seed=context.seed), letter=follow(M, variants[name], seed=context.seed)
        )
        for name in context.each("khan2022: Theorem 1", list(variants))
    }
    always, improving = runs.values()
    duration = context.pick(full=_LONG, short=_LONG_SHORT)
    ends = _long_runs(duration, context)
    section = Section(
        TITLE,
        [
            _TEXT,
            Figure(
                name="theorem_1_still",
                title="The objective for a fixed target",
                drawing=_draw({name: run.point for name, run in runs.items()}),
                caption="From home to the middle of the M, printed antenna; the first second on the right.",
            ),
            Table(
                name="theorem_1",
                title="How often the objective rises",
                columns=[
                    Column(name="algorithm"),
                    Column(name="ticks in which h(θ) rises, still target", unit="%", digits=4),
                    Column(name="on the M", unit="%", digits=4),
                    Column(name="h below 10⁻³ on the M", unit="s", digits=4),
                    Column(name="h, 40 to 50 s", unit="m²", digits=4),
                ],
                rows=[
                    [name, rises(run.point.h), rises(run.letter.h), run.letter.arrival(1e-3), run.letter.late_h]
                    for name, run in runs.items()
                ],
                caption="Printed constants, ticks of 1 ms.",
            ),
            _long_table(ends, duration),
        ],
    )
    published = {
        f"target {target}, h({at})": values for (antenna, target, at), values in ends.items() if antenna == _CONSTANT
    }
    return section, [
        monotone({"while the target stands still": rises(always.point.h), "on the M": rises(always.letter.h)}),
        goes_back(moved_uphill(always.point)),
        converges(published, ends[_ADAPTED, "still", _SENT][1], duration),
        proof_holds(rises(improving.point.h)),
    ]


def monotone(rising: Mapping[str, float]) -> Claim:
    """Judges the fraction of ticks in which h rises (%), by motion of the target."""
    return Claim.judged(
        "The objective decreases monotonically.",
        source="Definition 1 and Theorem 1",
        rule="By eq. (14) and (15) h(θ) rises in no tick.",
        measured="it rises in " + ", ".join(f"{number(share)} % of the ticks {when}" for when, share in rising.items()),
        holds={when: share == 0.0 for when, share in rising.items()},
        section=TITLE,
    )


def goes_back(share: float) -> Claim:
    """Judges the fraction of ticks with a rise of h in which the state moved all the same (%)."""
    return Claim.judged(
        "The joint state is updated only if the objective decreases; otherwise the arm is brought back.",
        source="Proof of Theorem 1",
        rule="By eq. (14) and (15) θ does not move in a tick whose measured h is larger than the one α ticks before.",
        measured=f"θ moves in {number(share)} % of these ticks, with a fixed target",
        holds=share == 0.0,
        reason="The sign function reverses the step; it does not omit it. The proof describes a different algorithm.",
        section=TITLE,
    )


def converges(ends: Mapping[str, tuple[float, float]], adaptive: float, duration: float) -> Claim:
    """Judges h (m^2) at a quarter and at the end of runs of `duration` (s), by target and place, printed constants.

    `adaptive` is h at the end with the antenna of eq. (16) and a fixed target.
    """
    return Claim.judged(
        "As time goes to infinity the tool traces the reference: x̂(t) → x_r(t).",
        source="Definition 2, eq. (18)",
        rule=f"With the printed constants the mean of h over the last tenth of {duration:g} s is below "
        f"{number(_ZERO, 1)} m².",
        measured="; ".join(
            f"{name}: {number(first)} m² after {duration / 4:g} s, {number(last)} m² after {duration:g} s"
            for name, (first, last) in ends.items()
        ),
        holds={name: last < _ZERO for name, (_, last) in ends.items()},
        reason=f"With the antenna of eq. (16) a fixed target is reached, {number(adaptive, 2)} m²; a moving one is "
        "followed at a distance.",
        section=TITLE,
    )


def proof_holds(share: float) -> Check:
    """Checks the fraction of ticks in which h rises by the proof's algorithm with a fixed target (%)."""
    return Check(
        statement='`ZNNBAS(accept="improving")`, the algorithm of the proof, never lets h rise for a fixed target.',
        rule="h(θ) rises in no tick.",
        measured=f"in {number(share)} % of the ticks",
        holds=share == 0.0,
        section=TITLE,
    )


def rises(h: Array) -> float:
    """Returns the fraction of ticks after which h is larger than before (%)."""
    return 100.0 * float(np.mean(np.diff(h) > 0.0))


def moved_uphill(run: Run) -> float:
    """Returns the fraction of ticks with a rise of measured h over the delay in which theta moved all the same (%)."""
    delay = PUBLISHED.delay_steps
    h, q = run.sent_h, run.result.q
    rose = h[delay + 1 :] > h[1:-delay]
    moved = np.any(np.diff(q, axis=0)[delay:] != 0.0, axis=1)
    return 100.0 * float(np.mean(moved[rose]))


def _long_runs(duration: float, context: Context) -> dict[tuple[str, str, str], tuple[float, float]]:
    """Returns the mean of h (m^2) at a quarter of a long run and at its end, each over a tenth of the run.

    Keys are antenna, target, and place: the state θ, or θ′, where the arm is.
    """
    one = circle(_ROUND)
    targets = {"still": lambda _: _POINT, "on a circle": lambda t: one.position(t % _ROUND)}
    antennae = {_CONSTANT: PUBLISHED, _ADAPTED: ADAPTIVE}
    ends = {}
    for name, target in context.each("khan2022: Definition 2", list(targets.items())):
        path = bik.paths.from_function(target, duration)
        for antenna, controller in antennae.items():
            run = follow(path, controller, seed=context.seed)
            for at, h in ((_STATE, run.h), (_SENT, run.sent_h)):
                quarter, tenth = len(h) // 4, len(h) // 10
                ends[antenna, name, at] = float(h[quarter - tenth : quarter].mean()), float(h[-tenth:].mean())
    return ends


def _long_table(ends: dict[tuple[str, str, str], tuple[float, float]], duration: float) -> Table:
    return Table(
        name="definition_2",
        title=f"Definition 2: mean of h over {duration / 10:g} s, at the state θ and at θ′, where the arm is",
        columns=[
            Column(name="antenna"),
            Column(name="target"),
            Column(name="h at"),
            Column(name=f"to {duration / 4:g} s", unit="m²", digits=4),
            Column(name=f"to {duration:g} s", unit="m²", digits=4),
        ],
        rows=[[antenna, target, at, *values] for (antenna, target, at), values in ends.items()],
        caption="Ticks of 1 ms. A round of the circle of 0.2 m takes 25 s.",
    )


def _draw(runs: dict[str, Run]) -> Drawing:
    with drawing(3.0) as figure:
        both = figure.subplots(1, 2, sharey=True)
        for (name, run), colour in zip(runs.items(), (BLUE, VERMILION), strict=True):
            for axes in both:
                axes.semilogy(run.time, run.h, color=colour, linewidth=0.9, label=name)
        both[0].set(xlabel="time [s]", ylabel="objective h(θ) [m²]", xlim=(0.0, _STILL))
        both[1].set(xlabel="time [s]", xlim=(0.0, 1.0))
        both[0].legend(loc="upper right")
    return figure
