"""Points of circular arcs: G2 and G3."""

import math

import numpy as np

from ..checks import Array, require_count
from .lines import refused

PLANES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}
"""The axes of each plane, counterclockwise seen from the third: XY, ZX, YZ."""

_UNEQUAL = 1e-3  # relative difference of the two radii from which centre and end contradict each other
_ROUNDED = 2e-5  # m, a difference that the digits of a program explain
_WIDEST = math.radians(10.0)  # between points


def center_of_radius(line: int, start: Array, end: Array, radius: float, *, clockwise: bool) -> Array:
    """Returns the centre (2,) of an arc given by its radius: of at most a half circle, or more if it is negative."""
    chord = end - start
    length = float(np.hypot(*chord))
    if length == 0.0:
        raise refused(line, "an arc by R needs an end other than its start: a full circle takes I, J or K")
    square = radius * radius - 0.25 * length * length
    if square < -2.0 * abs(radius) * _ROUNDED:
        raise refused(
            line, f"R of {abs(radius):.6g} m does not reach: half the distance to the end is {length / 2:.6g} m"
        )
    left = np.array([-chord[1], chord[0]]) / length
    sign = (-1.0 if clockwise else 1.0) * (1.0 if radius > 0.0 else -1.0)
    return np.asarray(0.5 * (start + end) + sign * math.sqrt(max(square, 0.0)) * left, dtype=float)


def arc_shares(
    line: int, start: Array, end: Array, center: Array, *, clockwise: bool, tolerance: float
) -> tuple[Array, Array]:
    """Returns points (k, 2) of an arc without its start, and how far along it they are (k,), from 0 to 1.

    The chords are within `tolerance` (m) of the arc.
    The radius changes evenly from that of the start to that of the end, which differ by the digits of the program.
    """
    first, last = start - center, end - center
    radii = float(np.hypot(*first)), float(np.hypot(*last))
    if radii[0] == 0.0:
        raise refused(line, "the centre of the arc is its start: the radius is 0")
    if abs(radii[1] - radii[0]) > max(_ROUNDED, _UNEQUAL * radii[0]):
        raise refused(line, f"the end is {radii[1]:.6g} m from the centre of the arc, and the start {radii[0]:.6g} m")
    angles = math.atan2(first[1], first[0]), math.atan2(last[1], last[0])
    sign = -1.0 if clockwise else 1.0
    turn = sign * (sign * (angles[1] - angles[0]) % math.tau or math.tau)  # an end at the start is a full circle
    # The rise of an arc of angle a over its chord is 2 r sin(a / 4)^2.
    widest = min(_WIDEST, 4.0 * math.asin(math.sqrt(min(1.0, max(1e-300, tolerance / (2.0 * max(radii)))))))
    require_count("tolerance", tolerance, abs(turn) / widest)
    count = max(2, math.ceil(abs(turn) / widest))
    share = np.arange(1, count + 1) / count
    angle, radius = angles[0] + share * turn, radii[0] + share * (radii[1] - radii[0])
    points = center + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points[-1] = end
    return points, share
