"""Separate tests of equations (1), (2), (4), (6), (7) and (13)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...report import Claim, Part, Section, number
from ..experiment import Context

TITLE = "The equations by themselves"
_TRIALS, _TRIALS_SHORT = 1000, 200
_MET = 1e-9  # m, rad, rad/s, rad/s2
_EQUAL, _UNEQUAL = (1.0, 1.0, 1.0), (1.0, 0.5, 0.5)  # lengths of links (m)
_NODES, _POINTS = 5, 51

Array = NDArray[np.float64]

_TEXT = """
Four statements need no search: each is tested with random numbers. The polynomials of eq. (3) to (6) are correct as
printed. Eq. (2) gives only the cosine of the first joint: its sign has to be added. Eq. (13) rejects a wrist out of
reach, but not one too close to the base for links of unequal length. Eq. (7) keeps the redundant angle in its range at
the five chosen numbers; between them it does so only if straight lines join them. Our planner adds the sign, requires
|k| ≤ 1, and clamps its spline.
"""


def equations(context: Context) -> Part:
    """Tries each equation with random numbers."""
    random = np.random.default_rng(context.seed)
    trials = context.pick(full=_TRIALS, short=_TRIALS_SHORT)
    claims = [
        joins(*_random_motions(random, trials)),
        reaches(_tip(random.uniform(-np.pi, np.pi, (trials, 2)))),
        keeps_out(random.uniform(-np.pi, np.pi, trials), random.uniform(0.1, 1.9, trials)),
        stays_in_range(random.uniform(0.0, 1.0, (trials, _NODES))),
    ]
    return Section(TITLE, [_TEXT]), claims


def _random_motions(random: np.random.Generator, trials: int) -> tuple[Array, Array]:
    """Draws start, via point, end and speed at the via point (trials, 4), and times of both segments (trials, 2)."""
    return random.uniform(-np.pi, np.pi, (trials, 4)), random.uniform(0.1, 3.0, (trials, 2))


def joins(motions: Array, times: Array) -> Claim:
    """Judges whether both polynomials meet their boundary conditions."""
    worst = float(np.abs(boundary_residuals(motions, times)).max())
    return Claim.judged(
        "The polynomials (3) and (5) with the coefficients (4) and (6) lead from rest through the via point to rest.",
        source="Section III-A, eq. (3)-(6)",
        rule=f"Position, velocity and acceleration at both ends of both segments are met to {number(_MET, 1)}.",
        measured=f"{number(worst, 2)} at worst, of {len(motions)} random motions",
        holds=worst <= _MET,
        section=TITLE,
    )


def boundary_residuals(motions: Array, times: Array) -> Array:
    """Returns the residuals of the eleven conditions (trials, 11)."""
    (start, via, end, speed), (t1, t2) = motions.T, times.T
    zero = np.zeros_like(start)
    first = [  # eq. (4)
        start,
        zero,
        zero,
        (4 * via - speed * t1 - 4 * start) / t1**3,
        (speed * t1 - 3 * via + 3 * start) / t1**4,
    ]
    acceleration = _at(first, t1, 2)
    second = [  # eq. (6)
        via,
        speed,
        acceleration / 2,
        (20 * end - 20 * via - 12 * speed * t2 - 3 * acceleration * t2**2) / (2 * t2**3),
        (30 * via - 30 * end + 16 * speed * t2 + 3 * acceleration * t2**2) / (2 * t2**4),
        (12 * end - 12 * via - 6 * speed * t2 - acceleration * t2**2) / (2 * t2**5),
    ]
    return np.column_stack(
        [
            *(_at(first, zero, order) - wanted for order, wanted in enumerate((start, zero, zero))),
            *(_at(first, t1, order) - wanted for order, wanted in enumerate((via, speed))),
            *(_at(second, zero, order) - wanted for order, wanted in enumerate((via, speed, acceleration))),
            *(_at(second, t2, order) - wanted for order, wanted in enumerate((end, zero, zero))),
        ]
    )


def _at(coefficients: list[Array], time: Array, order: int) -> Array:
    """Evaluates the derivative of this order of a polynomial, given its coefficients from the lowest."""
    value = np.zeros_like(time)
    for power in range(len(coefficients) - 1, order - 1, -1):
        value = value * time + coefficients[power] * np.prod(np.arange(power - order + 1, power + 1))
    return value


def reaches(places: Array) -> Claim:
    """Judges whether the angles of eq. (1) and (2) bring a two-link arm to the required position."""
    with np.errstate(invalid="ignore"):  # a position out of reach
        second = np.arccos((np.sum(places**2, axis=1) - 2.0) / 2.0)  # eq. (1), links of 1 m
    unturned = _tip(np.column_stack((np.zeros_like(second), second)))
    cosine = np.sum(places * unturned, axis=1) / np.sum(places**2, axis=1)  # eq. (2)
    first = np.arccos(np.clip(cosine, -1.0, 1.0))
    signed = np.copysign(first, unturned[:, 0] * places[:, 1] - unturned[:, 1] * places[:, 0])
    missed, signed_missed = (
        np.linalg.norm(_tip(np.column_stack((turn, second))) - places, axis=1) for turn in (first, signed)
    )
    return Claim.judged(
        "Equations (1) and (2) give the joint angles of two links.",
        source="Section II, eq. (1)-(2)",
        rule="At these angles the tip is within 1e-6 m of each of the random places in reach.",
        measured=(
            f"{np.sum(signed_missed <= _PLACED)} of {len(places)} places with the sign of the turn added, "
            f"{np.sum(missed <= _PLACED)} with the arccosine alone"
        ),
        holds=bool(np.all(signed_missed <= _PLACED)),
        reading="Eq. (2) gives only the cosine; the first joint turns in the direction from p′ to p.",
        section=TITLE,
    )


_PLACED = 1e-6  # m; an arccosine near 1 has half the digits


def _tip(angles: Array) -> Array:
    """Returns the tip of two links of 1 m (n, 2)."""
    absolute = np.cumsum(angles, axis=1)
    return np.column_stack((np.cos(absolute).sum(axis=1), np.sin(absolute).sum(axis=1)))


def keeps_out(orientations: Array, distances: Array) -> Claim:
    """Judges whether eq. (13) refuses every orientation of the last link that leaves its start out of reach."""
    let_through = {"equal links": _let_through(_EQUAL, orientations, distances)}
    let_through["links of 1, 0.5 and 0.5 m"] = _let_through(_UNEQUAL, orientations, distances)
    return Claim.judged(
        "The restrictions k ≤ 1 keep out redundant parameters for which no joint angles exist.",
        source="Section III-B, eq. (13)",
        rule="No random orientation of the third link with k ≤ 1 leaves its start out of reach of the other two.",
        measured=", ".join(
            f"{count} of {len(orientations)} let through with {arm}" for arm, count in let_through.items()
        ),
        holds={arm: count == 0 for arm, count in let_through.items()},
        reason="With links of unequal length k can be below -1; the paper does not give the lengths.",
        section=TITLE,
    )


def _let_through(lengths: tuple[float, float, float], orientations: Array, distances: Array) -> int:
    first, second, third = lengths
    wrist = np.hypot(distances - third * np.cos(orientations), third * np.sin(orientations))
    k = (wrist**2 - first**2 - second**2) / (2 * first * second)
    return int(np.sum((k <= 1.0) & (np.abs(k) > 1.0)))


def stays_in_range(nodes: Array) -> Claim:
    """Judges whether a redundant angle made from numbers in [0, 1] stays in its range between them."""
    left = {name: int(np.sum(_leaves(nodes, join))) for name, join in _JOINS.items()}
    return Claim.judged(
        "With a normalized sequence “the restored redundant parameter values must be within their range”: (23) holds.",
        source="Section III-B, eq. (7), (23)",
        rule=f"No random sequence of {_NODES} numbers in [0, 1] leaves [0, 1] between them.",
        measured=", ".join(f"{count} of {len(nodes)} leave it, joined by {name}" for name, count in left.items()),
        holds={name: count == 0 for name, count in left.items()},
        reason="The paper says “interpolation”. Ours is the spline, clamped.",
        section=TITLE,
    )


def _leaves(nodes: Array, join: Callable[[Array, Array], Array]) -> NDArray[np.bool_]:
    between = join(np.linspace(0.0, _NODES - 1.0, _POINTS), nodes)
    leaves: NDArray[np.bool_] = np.any((between < -_MET) | (between > 1.0 + _MET), axis=1)
    return leaves


def _lines(at: Array, nodes: Array) -> Array:
    return np.array([np.interp(at, np.arange(_NODES), row) for row in nodes])


def _natural_spline(at: Array, nodes: Array) -> Array:
    """Evaluates a natural cubic spline on unit knots, from the tridiagonal system for its second derivatives."""
    system = np.eye(_NODES)
    for i in range(1, _NODES - 1):
        system[i, i - 1 : i + 2] = 1.0, 4.0, 1.0
    bends = np.zeros_like(nodes)
    bends[:, 1:-1] = 6.0 * np.diff(nodes, 2, axis=1)
    curvature = np.linalg.solve(system, bends.T).T
    i = np.minimum(at.astype(int), _NODES - 2)
    right = at - i
    left = 1.0 - right
    value: Array = (
        left * nodes[:, i]
        + right * nodes[:, i + 1]
        + ((left**3 - left) * curvature[:, i] + (right**3 - right) * curvature[:, i + 1]) / 6.0
    )
    return value


_JOINS: dict[str, Callable[[Array, Array], Array]] = {
    "straight lines": _lines,
    "a natural cubic spline": _natural_spline,
}
