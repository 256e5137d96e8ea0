"""Claims of the paper on postures and on its swarm, each with the rule that judges it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...report import Check, Claim, number

SECTION = "Postures: Tables 2 and 3, Figures 6 and 7"
SMALL = 15.0  # degrees
_GAP = 1e-3
_OFF = 0.01
_MOST_BALANCED = 0.95
_SINGULAR = 1e-6  # m
_OWN_GAP = 1e-5


@dataclass(frozen=True, kw_only=True)
class PosturesAt:
    """Joint angles (rad) of the best postures for one length of the links."""

    tip: tuple[float, ...]
    overall: tuple[float, ...]
    tip_in_quadrant: tuple[float, ...]


def least_sine(q: Sequence[float]) -> float:
    """Returns the smallest |sin q| of q2 and q3: zero for a straight or folded joint."""
    return float(np.abs(np.sin(q[1:])).min())


def evenness(q: Sequence[float]) -> float:
    """Returns the smallest over the largest |q| of all joints."""
    return float(np.abs(q).min() / np.abs(q).max())


def found_best(gaps: Mapping[str, float], runs: int) -> Claim:
    """Judges the gap between the best of `runs` runs and the optimum, by reading (a fraction)."""
    return Claim.judged(
        "Ten generations of five particles find the best SM₃ and the best SM.",
        source="Sections 2.5 and 3.1, Tables 2 and 3",
        rule=f"The best of {runs} runs is less than {100 * _GAP:g} % below the optimum of a dense scan.",
        measured=f"at most {number(100 * max(gaps.values()))} % below, in {len(gaps)} readings",
        holds={name: gap < _GAP for name, gap in gaps.items()},
        reading="Links of three lengths, joint points anywhere or in the first quadrant; Vm = 0.2 m. The paper gives "
        "neither length nor Vm.",
        section=SECTION,
    )


def printed_optima(overall: Mapping[str, tuple[float, float]], printed: float) -> Claim:
    """Judges SM at the length (m) that gives the printed SM3, by region of the joints, against the printed SM."""
    return Claim.judged(
        "SM₃ = 6.9278 and SM = 10.8003 at E = (0.5, 0.5).",
        source="Tables 2 and 3, eq. (15) and (16)",
        rule=f"With the length that gives the printed SM₃, SM is within {100 * _OFF:g} % of the printed one.",
        measured="; ".join(
            f"joint points {place}: links of {number(length, 4)} m, SM = {number(index, 4)}"
            for place, (length, index) in overall.items()
        ),
        holds={
            f"joint points {place}": abs(index - printed) <= _OFF * printed for place, (_, index) in overall.items()
        },
        reason="The paper does not give the length, and no length gives both.",
        section=SECTION,
    )


def text_and_tables(optima: Mapping[str, tuple[float, float]]) -> Claim:
    """Judges the optimum of the text against that of the table, for each index."""
    return Claim.judged(
        "The text and the tables give the same optima.",
        source="Section 3.1, Tables 2 and 3",
        rule="Text and table agree to the last digit that the text prints.",
        measured="; ".join(f"{name}: text {text:g}, table {table:g}" for name, (text, table) in optima.items()),
        holds=all(abs(text - table) < 1e-3 for text, table in optima.values()),
        reason="Both differ by the same 0.112.",
        section=SECTION,
    )


def best_so_far(printed: Mapping[str, Sequence[float]]) -> Claim:
    """Judges the printed values over the generations."""
    falls = {name: float(np.diff(values).min()) for name, values in printed.items()}
    return Claim.judged(
        "Tables 2 and 3 give the best index of each generation.",
        source="Tables 2 and 3, eq. (17)",
        rule="The printed courses are those of a best index: of all generations so far, which never falls, or of one "
        "generation alone, which may.",
        measured="; ".join(f"{name}: smallest step {number(step, 2)}" for name, step in falls.items()),
        holds={
            "the best of all generations so far": all(step >= 0.0 for step in falls.values()),
            "the best of one generation alone": True,
        },
        reason="Table 3 falls from 10.7986 to 10.7977. The paper does not say which of the two it lists.",
        section=SECTION,
    )


def second_joint_small(at_printed: Mapping[str, PosturesAt], lengths: Mapping[str, PosturesAt]) -> Claim:
    """Judges q2 by region of the joints: at the length that gives the printed SM3, and at other lengths."""
    printed, others = _second_joints(at_printed), _second_joints(lengths)
    return Claim.judged(
        "In the posture that is best for the tip, where SM₃ = 6.9278, the joint angle q₂ is very small.",
        source="Section 3.1, Figure 6, Table 2",
        rule=f"With links of the length that gives the printed SM₃, |q₂| is at most {SMALL:g}° where SM₃ is largest.",
        measured="; ".join(f"{name} {number(angle)}°" for name, angle in (printed | others).items()),
        holds={name: angle <= SMALL for name, angle in printed.items()},
        reason="It is small only for links below 0.25 m, which barely reach E; their SM₃ is below 0.34, a "
        "twentieth of the printed value.",
        section=SECTION,
    )


def _second_joints(lengths: Mapping[str, PosturesAt]) -> dict[str, float]:
    """Returns |q2| (degrees) where SM3 is largest."""
    return {
        f"{name}, {place}": float(np.degrees(abs(q[1])))
        for name, at in lengths.items()
        for place, q in (("anywhere", at.tip), ("first quadrant", at.tip_in_quadrant))
    }


def straight_arm_singular(least: float) -> Claim:
    """Judges the least singular value (m) of the tip's Jacobian, links 1 and 2 in a line, link 3 at right angles."""
    return Claim.judged(
        "With q₂ = 0 the arm is singular and loses a degree of freedom.",
        source="Section 3.1, on Figure 6",
        rule="With q₂ = 0 and q₃ = 90° the least singular value of the tip's Jacobian is below "
        f"{number(_SINGULAR, 1)} m.",
        measured=f"{number(least)} m with links of 0.5 m",
        holds=least < _SINGULAR,
        reason="Link 3 still moves the tip across the line of the other two. Only the tip of link 2 loses a direction.",
        section=SECTION,
    )


def balanced(lengths: Mapping[str, PosturesAt]) -> Claim:
    """Judges the balance of the joint angles by length of the links."""
    measures = {"smallest |sin q| of q₂, q₃": least_sine, "smallest over largest |q|": evenness}
    values = {
        f"{words}, {name}": (of(at.tip), of(at.overall))
        for words, of in measures.items()
        for name, at in lengths.items()
    }
    return Claim.judged(
        "Optimising the whole arm balances the sizes of the joint angles.",
        source="Section 3.1, Figure 7",
        rule="The measure of balance is larger in the posture that is best for the whole arm than in that for the tip.",
        measured="; ".join(f"{name}: {number(tip)} tip, {number(all_)} whole" for name, (tip, all_) in values.items()),
        holds={name: all_ > tip for name, (tip, all_) in values.items()},
        reason="The paper gives neither the link length nor a measure of balance.",
        section=SECTION,
    )


def area_is_balance(ratios: Mapping[str, tuple[float, float]]) -> Claim:
    """Judges axis ratios of the tip's ellipse by length: at the largest area, and the largest possible."""
    return Claim.judged(
        "The area of the ellipse evaluates the balance of its axes: a long and thin ellipse has a small area.",
        source="Section 2.2",
        rule=f"Where the area is largest, the ratio of the axes is at least {_MOST_BALANCED:g} of the largest ratio "
        "that a posture at E has.",
        measured="; ".join(f"links of {name}: {number(at)} of {number(most)}" for name, (at, most) in ratios.items()),
        holds={f"links of {name}": at >= _MOST_BALANCED * most for name, (at, most) in ratios.items()},
        section=SECTION,
    )


def constriction(sums: Sequence[float]) -> Claim:
    """Judges eq. (18) at the given values of phi."""
    real = {phi: phi**2 - 4.0 * phi >= 0.0 for phi in sums}
    return Claim.judged(
        "Eq. (18) gives the shrinkage factor for φ = c₁ + c₂ > 3.",
        source="Section 2.3, eq. (18)",
        rule="The root of φ² - 4φ is real for each φ tried above 3.",
        measured="; ".join(f"φ = {phi:g}: {'real' if is_real else 'not real'}" for phi, is_real in real.items()),
        holds=all(real.values()),
        reason="φ must exceed 4. The paper also calls it the number of joints.",
        section=SECTION,
    )


def own_search(largest: float) -> Check:
    """Checks the largest gap over the cases."""
    return Check(
        statement="The library's own search finds the optimum, anywhere and in the first quadrant.",
        rule=f"The largest gap over twelve cases is below {number(_OWN_GAP, 1)}.",
        measured=f"{largest:.1e}",
        holds=largest < _OWN_GAP,
        section=SECTION,
    )
