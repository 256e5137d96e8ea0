"""Claims of the paper on tracking, each with the rule that judges it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ...report import Check, Claim, number

SECTION = "Tracking: Figures 8 to 10"
PRINTED_OWN = 0.40e-4  # "m", although all others are in rad
_HAND, _TUNED, _FORWARD = "PID, by hand", "PID, tuned", "PID, tuned, fed forward"
_RIVALS = (_HAND, _TUNED, "artificial bee colony", "GA-RBF")  # rivals of the paper; its PID may be either
_CLEARLY = 0.95
_MATCHES = 1e-6  # m/rad
_WITHIN = 1e-4  # m
_OURS = "Plant and gains are ours: the paper gives neither."


def own_error(errors: Mapping[str, float]) -> Claim:
    """Judges the largest tip errors (m) by variant."""
    return Claim.judged(
        "The pseudo-inverse method tracks with a largest error of 0.40 × 10⁻⁴ m.",
        source="Section 3.2",
        rule=f"The largest error of the tip is at most {number(PRINTED_OWN, 2)} m.",
        measured="; ".join(f"{name}: {number(error)} m" for name, error in errors.items()),
        holds={name: error <= PRINTED_OWN for name, error in errors.items()},
        reading="Integrators, gains and time steps are ours: the paper gives none.",
        reason="Eq. (12) has no feedback. With K = 50 1/s the printed value is bracketed by steps of 1 and 10 ms; that "
        "does not reproduce it.",
        section=SECTION,
    )


def closer(own: Mapping[str, float], rivals: Mapping[str, float], strayed: float) -> Claim:
    """Judges largest errors of joint 1 (rad): by setting of the pseudo-inverse, by rival, and without a posture."""
    least = min(rivals[name] for name in _RIVALS)
    return Claim.judged(
        "The joint follows its reference more closely than under PID, GA-RBF and bee-colony control.",
        source="Section 3.2, Figures 8 and 10",
        rule="Over the two seconds of the path the largest error of joint 1 is below that of each other controller.",
        measured=f"pseudo-inverse {_listed(own)}; {_listed(rivals)} rad",
        holds={
            **{name: error < least for name, error in own.items()},
            f"on the same servos, against the PID fed forward as well: {number(rivals[_FORWARD])} rad": list(
                own.values()
            )[-1]
            < rivals[_FORWARD],
            "with eq. (13) and (14), which hold no posture": strayed < least,
        },
        reading=_OURS,
        reason="Eq. (13) and (14) do not return to the reference: the joints stray by "
        f"{number(strayed)} rad or m while the tip is where it should be.",
        section=SECTION,
    )


def jumps(own: Mapping[str, float], rivals: Mapping[str, float]) -> Claim:
    """Judges peak-to-peak errors of joint 1 (rad)."""
    least = min(rivals[name] for name in _RIVALS)
    return Claim.judged(
        "The error jump range is small.",
        source="Abstract",
        rule="Over the two seconds of the path the range of joint 1's error is below that of each other controller.",
        measured=f"pseudo-inverse {_listed(own)}; {_listed(rivals)} rad",
        holds={
            **{name: value < least for name, value in own.items()},
            "each setting, against the PID fed forward as well": max(own.values()) < rivals[_FORWARD],
        },
        reading=_OURS,
        section=SECTION,
    )


def order(rivals: Mapping[str, float]) -> Claim:
    """Judges the order of the largest errors of joint 1 (rad) by controller."""
    network, bees = rivals["GA-RBF"], rivals["artificial bee colony"]
    return Claim.judged(
        "Of the others GA-RBF is the best, then the bee colony, then PID.",
        source="Section 3.2",
        rule=f"Each largest error is below {100 * _CLEARLY:g} % of the next one's.",
        measured=f"{_listed(rivals)} rad",
        holds={
            name: network < _CLEARLY * bees and bees < _CLEARLY * rivals[name] for name in (_HAND, _TUNED, _FORWARD)
        },
        reading=_OURS,
        reason="The order depends on how each is tuned, which the paper does not say.",
        section=SECTION,
    )


def printed_rivals(rivals: Mapping[str, float], missing: Sequence[str]) -> Claim:
    """Judges the largest errors of joint 1 (rad) by controller."""
    return Claim.judged(
        "Largest errors of 1.72 × 10⁻³, 0.91 × 10⁻³ and 1.38 × 10⁻³ rad by PID, GA-RBF and bee colony.",
        source="Section 3.2, Figure 8",
        rule="The largest errors are the printed ones.",
        measured=f"{_listed(rivals)} rad",
        holds=None,
        missing=missing,
        section=SECTION,
    )


def control_time(missing: Sequence[str]) -> Claim:
    """Leaves the claim undecided: there is nothing to measure."""
    return Claim.judged(
        "The control time is 2.2 s at most, lower than that of the others.",
        source="Section 3.2, Figure 9",
        rule="Not stated.",
        measured="",
        holds=None,
        missing=missing,
        section=SECTION,
    )


def jacobian_entry(printed: Mapping[str, float], differences: float) -> Claim:
    """Judges J(2,1) as printed and with the signs that our copy may have lost, against central differences (m/rad)."""
    return Claim.judged(
        "J(2,1) = L₁ sin q₁ + (L₂ + q₃) sin(q₁ - q₂).",
        source="Eq. (6)",
        rule=f"At q = (0.4, -0.3, 0.1) it is the derivative of eq. (2), to {number(_MATCHES, 1)} m/rad.",
        measured="; ".join(f"{signs}: {number(value)} m/rad" for signs, value in printed.items())
        + f"; by central differences {number(differences)}",
        holds={signs: abs(value - differences) < _MATCHES for signs, value in printed.items()},
        reason="It is L₁ cos q₁ + (L₂ + q₃) cos(q₁ - q₂): no sign makes a sine of that.",
        section=SECTION,
    )


def null_space(printed: float, without: float, reversed_sign: float) -> Claim:
    """Judges the mean of eq. (14) with q0' as our copy prints it, without it, and with the opposite sign."""
    return Claim.judged(
        "The null-space velocity of eq. (13) keeps the joints away from their limits.",
        source="Section 2.1, eq. (13) and (14)",
        rule="Over 8 s the mean cost of eq. (14) is lower with q₀′ than without it.",
        measured=f"{number(printed)} as our copy prints it, {number(reversed_sign)} with a minus sign, "
        f"{number(without)} without q₀′",
        holds={
            "eq. (13) as our copy prints it": printed < without,
            "eq. (13) with a minus sign": reversed_sign < without,
        },
        reason="Our copy has lost the minus signs of eq. (1), (2) and (6); it may have lost this one as well.",
        section=SECTION,
    )


def other_swarms() -> Claim:
    """Leaves the claim undecided: nothing was run."""
    return Claim.judged(
        "With a contraction factor the swarm converges faster than other particle swarms.",
        source="Section 2.3",
        rule="Not stated.",
        measured="",
        holds=None,
        reason="The paper names no other swarm and runs none.",
        section=SECTION,
    )


def limits_kept(violation: float, error: float) -> Check:
    """Checks the largest violation (rad, m) and the largest tip error (m)."""
    return Check(
        statement="The weighted pseudo-inverse keeps the limits of Table 1.",
        rule=f"No limit is violated, and the largest error is below {number(_WITHIN, 1)} m.",
        measured=f"largest violation {violation:g}, largest error {number(error)} m",
        holds=violation == 0.0 and error < _WITHIN,
        section=SECTION,
    )


def _listed(values: Mapping[str, float]) -> str:
    return ", ".join(f"{name} {number(value)}" for name, value in values.items())
