"""Numbers as people type them: round limits that tie, values at a limit, and one bit beside it."""

from __future__ import annotations

import numpy as np

Limits = tuple[float, float, float]  # velocity, acceleration, jerk
FARTHEST = 1e3  # rad or m


def number(random: np.random.Generator, lowest: int = -3, highest: int = 3) -> float:
    """One, two or five times a power of ten."""
    return float(random.choice([1.0, 2.0, 5.0]) * 10.0 ** int(random.integers(lowest, highest + 1)))


def limits(random: np.random.Generator, lowest: int = -3, highest: int = 3) -> Limits:
    """Round limits of a joint; of half of them velocity and acceleration limit are reached at once, or nearly."""
    velocity, acceleration, jerk = (number(random, lowest, highest) for _ in range(3))
    if random.random() < 0.5:
        jerk = acceleration**2 / velocity * float(random.choice([1.0, 1.0, 0.25, 0.5, 2.0, 4.0]))
    return velocity, acceleration, jerk


def beside(random: np.random.Generator, value: float) -> float:
    """The value; sometimes the next number, or one that is farther off."""
    match random.integers(6):
        case 0:
            return float(np.nextafter(value, random.choice([-np.inf, np.inf])))
        case 1:
            return float(value * (1.0 + random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(-16, -2)))
    return value


def within(random: np.random.Generator, limit: float) -> float:
    """Zero, the limit, a round part of it, or any number between."""
    share = float(random.choice([0.0, 0.0, 1.0, 1.0, 0.5, 0.2, random.uniform(), 10.0 ** random.uniform(-16, 0)]))
    return beside(random, share * limit) * float(random.choice([-1.0, 1.0]))


def rates(random: np.random.Generator, of_joint: Limits, *, ends: bool = False) -> tuple[float, float]:
    """Velocity and acceleration that keep the limits after a start, or before an end; at a limit in many ways."""
    velocity, acceleration, jerk = of_joint
    for _ in range(20):
        a = within(random, acceleration)
        change = a * abs(a) / (2 * jerk) * (-1 if ends else 1)  # from here to where the acceleration is zero
        v = within(random, velocity)
        if random.random() < 0.3:
            v = beside(random, float(random.choice([-1.0, 0.0, 0.5, 1.0])) * velocity - change)
        if stays(of_joint, (v, a), ends=ends):
            return v, a
    return 0.0, 0.0


def stays(of_joint: Limits, at: tuple[float, float], *, ends: bool = False) -> bool:
    """Whether a joint with this velocity and acceleration can stay inside its limits, or was inside them before."""
    (velocity, acceleration, jerk), (v, a) = of_joint, at
    change = a * abs(a) / (2 * jerk) * (-1 if ends else 1)
    return abs(v) <= velocity and abs(a) <= acceleration and abs(v + change) <= velocity


def displacement(random: np.random.Generator, of_joint: Limits) -> float:
    """None, a round one, a tiny one, or that of a motion from rest to rest that just reaches its limits."""
    velocity, acceleration, jerk = of_joint
    ties = (2 * acceleration**3 / jerk**2, velocity * (velocity / acceleration + acceleration / jerk))
    match random.integers(4):
        case 0:
            size = 0.0
        case 1:
            size = number(random, -3, 0)
        case 2:
            size = 10.0 ** random.uniform(-16, 0)
        case _:
            size = beside(random, min(float(random.choice(ties)), FARTHEST))
    return size * float(random.choice([-1.0, 1.0]))
