"""What the paper says of the five methods, and what came out."""

from ..._text import counted
from ...report import Claim, number
from .comparison import Compared
from .methods import BUDGET
from .settings import ROUNDING, STEPS

_FEWER = 3.0  # times, the evaluations that BAS needs
_OUTSIDE = 1e-3  # share of steps that may miss the band, over all tests
_ROUGHER = 3.0  # times the roughness of BAS


def rival_claims(section: str, precise: list[Compared], budgeted: list[Compared]) -> list[Claim]:
    """All of them; `section` shows them. BAS comes first in both lists."""
    return [
        _levels(section, budgeted),
        _cost(section, precise),
        _order(section, precise),
        _oscillations(section, precise),
        _limits(section, [*precise, *budgeted]),
    ]


def _levels(section: str, budgeted: list[Compared]) -> Claim:
    errors = {one.name: one.error.mean for one in budgeted}
    return Claim.judged(
        "In the same running time the error of BAS is at the level of 10⁻⁵ m, that of PSO 10⁻⁴ m, that of GA 10⁻³ m.",
        source="Section IV-A.4a, Figure 7, Table 1",
        rule="BAS at most 1e-5 m; PSO and GA nearest to the power of ten that the paper names.",
        measured="; ".join(f"{name} {number(errors[name], 2)} m" for name in ("BAS", "PSO", "GA")),
        holds=errors["BAS"] <= 1e-5 and _is_level(errors["PSO"], 1e-4) and _is_level(errors["GA"], 1e-3),
        reading=f"{BUDGET} evaluations a step for the running time; without the band that stops BAS at 10⁻⁵ m.",
        section=section,
    )


def _is_level(error: float, level: float) -> bool:
    """Whether this power of ten is the nearest."""
    return level / 10**0.5 <= error <= level * 10**0.5


def _cost(section: str, precise: list[Compared]) -> Claim:
    beetle, *swarms = precise
    ratios = {one.name: one.evaluations.mean / beetle.evaluations.mean for one in swarms}
    missed = sum(one.missed for one in precise)
    return Claim.judged(
        "At the same precision of 1 mm BAS is much faster than the other four methods.",
        source="Section IV-A.4b, Table 2",
        rule=f"Each of the four needs at least {_FEWER:g} times the evaluations of BAS; at most "
        f"{_OUTSIDE:g} of the steps miss the band.",
        measured=(
            f"{_listed(ratios)} times the evaluations of BAS (at least {_FEWER:g} each); "
            f"{counted(missed, 'step')} of all runs outside 1 mm"
        ),
        holds=min(ratios.values()) >= _FEWER and missed <= _OUTSIDE * len(precise) * len(beetle.results) * STEPS,
        reading="Swarms are drawn anew in the whole box of each step. In a small box this does not hold.",
        section=section,
    )


def _order(section: str, precise: list[Compared]) -> Claim:
    order = sorted(precise, key=lambda one: one.evaluations.mean)
    return Claim.judged(
        "From fast to slow: BAS, PSO, QPSO, FA, GA.",
        source="Section IV-A.4b, Table 2",
        rule="The mean evaluations a step are in that order.",
        measured=", ".join(f"{one.name} ({number(round(one.evaluations.mean))})" for one in order),
        reason="The order of the swarms depends on their options, which the paper does not give.",
        holds=None,
        section=section,
    )


def _oscillations(section: str, precise: list[Compared]) -> Claim:
    rough = {one.name: one.roughness.mean for one in precise}
    beetle = rough.pop("BAS")
    return Claim.judged(
        "At 1 mm PSO and GA cannot decrease the oscillations of the joint velocities; BAS stays far below the limits.",
        source="Section IV-A.4b, Figure 8",
        rule=f"The roughness of PSO and of GA is at least {_ROUGHER:g} times that of BAS.",
        measured=f"rms change from step to step: BAS {number(beetle, 2)} rad/s; {_listed(rough)} rad/s",
        holds=all(rough[name] >= _ROUGHER * beetle for name in ("PSO", "GA")),
        section=section,
    )


def _limits(section: str, compared: list[Compared]) -> Claim:
    excess = max(0.0, *(one.excess for one in compared))
    runs = sum(len(one.results) for one in compared)
    return Claim.judged(
        "All five methods work under the same variable joint velocity limit.",
        source="Section IV-A.4",
        rule=f"The largest excess over the limit is at most {number(ROUNDING, 1)} rad/s.",
        measured=f"largest excess in {runs} runs: {number(excess, 2)} rad/s (at most {number(ROUNDING, 1)})",
        holds=excess <= ROUNDING,
        section=section,
    )


def _listed(values: dict[str, float]) -> str:
    return ", ".join(f"{name} {number(value, 2)}" for name, value in values.items())
