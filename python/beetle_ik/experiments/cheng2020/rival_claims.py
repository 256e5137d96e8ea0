"""Claims about the five methods."""

from collections.abc import Mapping
from typing import TypeAlias

from ...calls.text import counted
from ...report import Check, Claim, not_given, number
from .comparison import Compared
from .methods import BEETLE, BUDGET
from .settings import PARAMETERS, ROUNDING

ErrorBoxes: TypeAlias = Mapping[str, tuple[float, float]]
"""Swarms in boxes as wide as the error, by name: mean error (m) at the budget, roughness (rad/s) at the precision."""
_IN_WHOLE, _IN_ERROR_BOXES = "swarms search the whole box of each step", "swarms search a box as long as the error"
_ROUGHER = 2.0  # times the roughness of BAS
_PRINTED_ORDER = ("BAS", "PSO", "QPSO", "FA", "GA")
_PRINTED_LEVELS = {"BAS": 1e-5, "PSO": 1e-4, "GA": 1e-3}  # m


def rival_claims(
    section: str, precise: list[Compared], budgeted: list[Compared], boxed: ErrorBoxes
) -> list[Claim | Check]:
    """Returns all claims and checks on the methods, for the given section. BAS comes first in both lists."""
    errors = {one.name: one.error.mean for one in budgeted}
    return [
        more_accurate_claim(section, errors, {name: error for name, (error, _) in boxed.items()}),
        levels_claim(section, errors),
        order_claim(section, {one.name: one.evaluations.mean for one in precise}),
        oscillations_claim(
            section,
            {one.name: one.roughness.mean for one in precise},
            {name: roughness for name, (_, roughness) in boxed.items()},
        ),
        _limits(section, [*precise, *budgeted]),
    ]


def more_accurate_claim(section: str, errors: dict[str, float], boxed: dict[str, float]) -> Claim:
    """Judges the order of the errors (m) of Figure 7, by method; `boxed` are errors in boxes as wide as the error."""
    return Claim.judged(
        "In the same running time BAS is more accurate than GA, PSO, FA and QPSO.",
        source="Section IV-A.4a, Table 1",
        rule="The mean error of BAS is the smallest of the five.",
        measured=f"{_listed(errors)} m; in boxes as long as the error {_listed(boxed)} m",
        holds={
            _IN_WHOLE: all(errors[BEETLE] < error for name, error in errors.items() if name != BEETLE),
            _IN_ERROR_BOXES: all(errors[BEETLE] < error for error in boxed.values()),
        },
        reading=f"{BUDGET} evaluations a step for the running time; all methods are tuned alike.",
        reason="The paper does not say which box its swarms search.",
        section=section,
    )


def levels_claim(section: str, errors: dict[str, float]) -> Claim:
    """Judges the levels of the errors (m)."""
    return Claim.judged(
        "In the same running time the error of BAS is at the level of 10⁻⁵ m, that of PSO 10⁻⁴ m, that of GA 10⁻³ m.",
        source="Section IV-A.4a, Figure 7",
        rule="The named power of ten is the nearest to the mean error, for each of the three.",
        measured=f"with {BUDGET} evaluations a step: {_listed({name: errors[name] for name in _PRINTED_LEVELS})} m",
        holds=all(is_level(errors[name], level) for name, level in _PRINTED_LEVELS.items()),
        missing=not_given({name: PARAMETERS[name] for name in ("error band", "evaluations in 15 s")}),
        section=section,
    )


def is_level(error: float, level: float) -> bool:
    """Whether `level` is the power of ten nearest to the error."""
    return level / 10**0.5 <= error <= level * 10**0.5


def order_claim(section: str, evaluations: dict[str, float]) -> Claim:
    """Judges the order from fast to slow, by the evaluations of a step."""
    found = sorted(evaluations, key=evaluations.__getitem__)
    return Claim.judged(
        "From fast to slow: BAS, PSO, QPSO, FA, GA.",
        source="Section IV-A.4b, Table 2",
        rule="The mean evaluations a step are in that order.",
        measured=", ".join(f"{name} {number(round(evaluations[name]))}" for name in found),
        holds=tuple(found) == _PRINTED_ORDER,
        missing=not_given({name: PARAMETERS[name] for name in ("options of the swarms",)}),
        reason="With equal tuning the order is the one measured here.",
        section=section,
    )


def oscillations_claim(section: str, roughness: dict[str, float], boxed: dict[str, float]) -> Claim:
    """Judges the rms change of joint velocities from step to step (rad/s), by method, also of swarms in boxes."""
    beetle = roughness[BEETLE]
    return Claim.judged(
        "At 1 mm PSO and GA cannot decrease the oscillations of the joint velocities; BAS stays far below the limits.",
        source="Section IV-A.4b, Figure 8",
        rule="The joint velocities of PSO and of GA change from step to step at least "
        f"{_ROUGHER:g} times as much as those of BAS.",
        measured=f"rms change: {_listed(roughness)} rad/s; in boxes as long as the error {_listed(boxed)} rad/s",
        holds={
            box: all(of[name] >= _ROUGHER * beetle for name in ("PSO", "GA"))
            for box, of in ((_IN_WHOLE, roughness), (_IN_ERROR_BOXES, boxed))
        },
        reading="All methods are tuned alike.",
        reason="The paper does not say which box its swarms search.",
        section=section,
    )


def _limits(section: str, compared: list[Compared]) -> Check:
    excess = max(0.0, *(one.excess for one in compared))
    runs = sum(len(one.results) for one in compared)
    return Check(
        statement="No method violates the variable velocity limit.",
        rule=f"The largest excess over the limit is at most {number(ROUNDING, 1)} rad/s.",
        measured=f"{shown_excess(excess)} in {counted(runs, 'run')}",
        holds=excess <= ROUNDING,
        section=section,
    )


def shown_excess(excess: float) -> str:
    """Formats an excess over a limit (rad/s); anything below the spacing of doubles counts as none."""
    return "none" if excess <= 2.3e-16 else f"{number(excess, 2)} rad/s"


def _listed(values: dict[str, float]) -> str:
    return ", ".join(f"{name} {number(value, 2)}" for name, value in values.items())
