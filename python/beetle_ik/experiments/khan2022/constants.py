"""The constants of Algorithm 1: the sign of the gain, and the influence of each constant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import beetle_ik as bik

from ...calls.text import counted
from ...report import BLUE, VERMILION, Claim, Figure, Part, Section, drawing, number
from ..experiment import Context
from .settings import M, Run, follow

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "The constants of Algorithm 1"
_GAIN, _LENGTH, _DELAY = 10.0, 0.1, 10
_UNITS = {"ticks of 1 ms": (1, 100), "ticks of 10 ms": (10, 1000), "seconds": (1, 10_000)}  # delays by unit [ms]
_DELAYS = (1, 3, 10, 30, 100, 200, 300, 500, 1000, 10_000)
_DELAYS_SHORT = (1, 10, 100, 1000, 10_000)
_FACTORS = (0.1, 0.3, 1.0, 3.0, 10.0)
_FACTORS_SHORT = (0.1, 1.0, 10.0)

_TEXT = """
The paper calls α “the core hyper-parameter to determine the performance of the algorithm”, and does not say in what
unit it counts. In ticks of 1 or 10 ms α matters least of its three constants. Over a delay of more than 1/k the state
itself moves, and the motion is mistaken for an antenna: with α = 10 seconds the controller does not converge, and then
nothing matters more than α. The gain of the listing, -10, does not converge in eq. (14) as printed either: it probably
includes the minus sign of the equation.
"""


def constants(context: Context) -> Part:
    """Runs on the M over delay, gain and antenna, and with the gain as printed."""
    delays = context.pick(full=_DELAYS, short=_DELAYS_SHORT)
    factors = context.pick(full=_FACTORS, short=_FACTORS_SHORT)
    seed = context.seed
    by_delay = {float(delay): _late_h(seed, delay=delay) for delay in context.each("khan2022: delay", delays)}
    by_gain = {_GAIN * f: _late_h(seed, gain=_GAIN * f) for f in context.each("khan2022: gain", factors)}
    by_length = {_LENGTH * f: _late_h(seed, length=_LENGTH * f) for f in context.each("khan2022: antenna", factors)}
    reversed_gain = [_follow(seed, gain=-_GAIN) for seed in context.seeds(context.pick(full=3, short=1))]
    section = Section(
        TITLE,
        [
            _TEXT,
            Figure(
                name="constants",
                title="Error on the M from 40 to 50 s over each constant, the other two as printed",
                drawing=_draw(by_delay, by_gain, by_length),
                caption="Orange marks the printed value; the dashed line is a delay of 1/k.",
            ),
        ],
    )
    by_unit = {
        f"α in {unit}": {delay: h for delay, h in by_delay.items() if shortest <= delay <= longest}
        for unit, (shortest, longest) in _UNITS.items()
    }
    return section, [
        core_parameter(by_unit, {"k": by_gain, "λ": by_length}),
        printed_gain([float(run.h[0]) for run in reversed_gain], [float(run.h[-1]) for run in reversed_gain]),
    ]


def core_parameter(delays: Mapping[str, Mapping[float, float]], others: Mapping[str, Mapping[float, float]]) -> Claim:
    """Judges late h (m^2) over each constant from a tenth to ten times its printed value; α by its unit."""
    by_unit, rivals = (
        {name: max(over.values()) / min(over.values()) for name, over in errors.items()} for errors in (delays, others)
    )
    return Claim.judged(
        "α is “the core hyper-parameter to determine the performance of the algorithm”.",
        source="Section 4.1, on limitations",
        rule="From a tenth to ten times the printed value, α changes the mean h(θ) from 40 to 50 s by a larger factor "
        "than k and λ do; in seconds, from the shortest delay tried to the printed one.",
        measured=", ".join(f"{name} by {number(factor)}" for name, factor in (by_unit | rivals).items()),
        holds={unit: factor > max(rivals.values()) for unit, factor in by_unit.items()},
        reason="The paper gives α no unit, and no time step. Beyond 1/k = 0.1 s α ruins the run.",
        section=TITLE,
    )


def printed_gain(first: Sequence[float], last: Sequence[float]) -> Claim:
    """Judges h at the start and at the end of runs with k = -10 (m^2)."""
    return Claim.judged(
        "The gain is k = -10.",
        source="Algorithm 1, line 5, with eq. (14)",
        rule="With k = -10 in eq. (14) as printed, h is lower after 50 s than at the start, in every run.",
        measured=f"h from {number(first[0])} to {number(min(last))} m² or more in {counted(len(last), 'run')}",
        holds=all(end < start for start, end in zip(first, last, strict=True)),
        reason="With k = 10 it converges. The listing's sign takes in the minus of the equation.",
        section=TITLE,
    )


def _follow(seed: int, *, gain: float = _GAIN, length: float = _LENGTH, delay: int = _DELAY) -> Run:
    return follow(M, bik.papers.ZNNBAS(gain=gain, antenna_length=length, delay_steps=delay), seed=seed)


def _late_h(seed: int, *, gain: float = _GAIN, length: float = _LENGTH, delay: int = _DELAY) -> float:
    return _follow(seed, gain=gain, length=length, delay=delay).late_h


def _draw(by_delay: dict[float, float], by_gain: dict[float, float], by_length: dict[float, float]) -> Drawing:
    curves: tuple[tuple[str, Mapping[float, float], float], ...] = (
        ("delay α [ticks of 1 ms]", by_delay, _DELAY),
        ("gain k [1/s]", by_gain, _GAIN),
        ("antenna λ [rad]", by_length, _LENGTH),
    )
    with drawing(3.2) as figure:
        panels = figure.subplots(1, 3, sharey=True)
        for axes, (label, over, printed) in zip(panels, curves, strict=True):
            axes.loglog(list(over), list(over.values()), color=BLUE, marker="o")
            axes.loglog([printed], [over[printed]], color=VERMILION, marker="o", markersize=8, linestyle="none")
            axes.set_xlabel(label)
        panels[0].axvline(1000.0 / _GAIN, color=VERMILION, linestyle="--", label="1/k")
        panels[0].legend(loc="upper left")
        panels[0].set_ylabel("mean h(θ), 40 to 50 s [m²]")
    return figure
