"""Random arms, limits and targets for `hostile_streams.py`."""

# All functions of TARGETS have the same signature.
# ruff: noqa: ARG001

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import beetle_ik as bik

LENGTHS = (10, 400)  # ticks of a stream
TICKS = (1e-3, 2e-3, 5e-3, 2e-2)  # s
DROPOUTS, NOT_A_NUMBER = 0.3, 0.01  # shares of the ticks of a stream that has them


@dataclass(frozen=True)
class Stream:
    """Tracker and its targets, one per tick; None where no target arrives."""

    name: str
    robot: bik.Robot
    start: np.ndarray
    dt: float
    limits: dict[str, Any]  # arguments of `Limits`
    targets: list[np.ndarray | None]
    moving: tuple[np.ndarray, np.ndarray] | None = None  # velocity and acceleration at the start, if the arm can stop


def draw(name: str, random: np.random.Generator) -> Stream:
    """Draws arm, tick, limits, length and targets of a stream."""
    robot = bik.Robot.named(str(random.choice(bik.Robot.names())))
    lower, upper = np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)
    start = lower + (upper - lower) * random.uniform(0.05, 0.95, robot.dof)
    limits = _limits(robot, start, random)
    targets = list(TARGETS[name](robot, start, int(random.integers(*LENGTHS)), random))
    dt = float(random.choice(TICKS))
    moving = _moving(limits, robot.dof, random) if random.random() < 0.5 else None
    return Stream(name, robot, start, dt, limits, targets, moving)


def _limits(robot: bik.Robot, start: np.ndarray, random: np.random.Generator) -> dict[str, Any]:
    """Draws limits: slow to unrealistically fast; some vary with time, some position limits touch the start."""
    limits: dict[str, Any] = {"velocity": _spread(random, 0.1, 4.0, robot.dof)}
    limits["acceleration"] = _spread(random, 0.5, 50.0, robot.dof)
    if random.random() < 0.7:
        limits["jerk"] = _spread(random, 5.0, 5000.0, robot.dof)
    if random.random() < 0.3:
        mean = float(_spread(random, 0.2, 3.0, 1)[0])
        limits["velocity"] = bik.Sinusoid(
            mean=mean,
            amplitude=mean * random.uniform(0.1, 0.9),
            angular_frequency=random.uniform(0.5, 20.0),
            phase=random.uniform(0.0, 6.0),
        )
    if random.random() < 0.3:
        limits["lower"] = np.maximum(robot.lower, start - random.choice([0.0, 0.05, 0.5], robot.dof))
    return limits


def _moving(limits: dict[str, Any], dof: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray] | None:
    """Draws velocity and acceleration of a start, slow enough for most arms to stop in time."""
    velocity = limits["velocity"]
    if isinstance(velocity, bik.Sinusoid):
        return None
    return 0.5 * velocity * random.uniform(-1, 1, dof), 0.2 * limits["acceleration"] * random.uniform(-1, 1, dof)


def _spread(random: np.random.Generator, low: float, high: float, size: int) -> np.ndarray:
    """Draws log-uniform values; half of the time equal for all joints."""
    values = np.exp(random.uniform(np.log(low), np.log(high), size))
    return values if random.random() < 0.5 else np.full(size, values[0])


Targets = Callable[[bik.Robot, np.ndarray, int, np.random.Generator], np.ndarray | list[np.ndarray | None]]


def _held(poses: np.ndarray, ticks: int, random: np.random.Generator) -> np.ndarray:
    """Holds each of the poses for some fifty ticks."""
    changes = random.random(ticks) < 0.02
    return poses[np.cumsum(changes) % len(poses)]


def _jumps(robot: bik.Robot, start: np.ndarray, ticks: int, random: np.random.Generator) -> np.ndarray:
    return _held(robot.fk(robot.random_configurations(30, seed=int(random.integers(2**31)))), ticks, random)


def _every_tick(robot: bik.Robot, start: np.ndarray, ticks: int, random: np.random.Generator) -> np.ndarray:
    return robot.fk(robot.random_configurations(ticks, seed=int(random.integers(2**31))))


def _noise(robot: bik.Robot, start: np.ndarray, ticks: int, random: np.random.Generator) -> np.ndarray:
    targets = _jumps(robot, start, ticks, random).copy()
    targets[:, :3, 3] += 10.0 ** random.uniform(-7, -1) * random.standard_normal((ticks, 3))
    return targets


def _smooth(robot: bik.Robot, start: np.ndarray, ticks: int, random: np.random.Generator) -> np.ndarray:
    waves = random.uniform(0.0, 0.05, (robot.dof, 1)) * np.arange(ticks)
    return robot.fk(
        np.clip(start + (random.uniform(0.0, 1.0, (robot.dof, 1)) * np.sin(waves)).T, robot.lower, robot.upper)
    )


def _dropouts(robot: bik.Robot, start: np.ndarray, ticks: int, random: np.random.Generator) -> list[np.ndarray | None]:
    gone = random.random(ticks) < DROPOUTS
    several = _noise if random.random() < 0.5 else _smooth
    targets = several(robot, start, ticks, random)
    return [None if missing and i else target for i, (missing, target) in enumerate(zip(gone, targets, strict=True))]


def _far(robot: bik.Robot, start: np.ndarray, ticks: int, random: np.random.Generator) -> np.ndarray:
    targets = _jumps(robot, start, ticks, random).copy()
    targets[:, :3, 3] += random.uniform(-10.0, 10.0, 3)
    return targets


def _edge(robot: bik.Robot, start: np.ndarray, ticks: int, random: np.random.Generator) -> np.ndarray:
    """Positions at 0.9 to 1.1 of the reach, in random directions."""
    points = robot.fk(robot.random_configurations(200, seed=int(random.integers(2**31))))[:, :3, 3]
    reach = np.linalg.norm(points, axis=1).max()
    farther = points / np.linalg.norm(points, axis=1, keepdims=True) * reach * random.uniform(0.9, 1.1, (200, 1))
    return _held(farther, ticks, random)


def _singular(robot: bik.Robot, start: np.ndarray, ticks: int, random: np.random.Generator) -> np.ndarray:
    """Poses of configurations with joints at zero or at a limit."""
    places = np.stack([np.clip(np.zeros(robot.dof), robot.lower, robot.upper), robot.lower, robot.upper, start])
    chosen = random.integers(0, 4, (30, robot.dof))
    return _held(robot.fk(np.clip(np.take_along_axis(places.T, chosen.T, axis=1).T, -6.0, 6.0)), ticks, random)


def _turning_back(robot: bik.Robot, start: np.ndarray, ticks: int, random: np.random.Generator) -> np.ndarray:
    """Two poses by turns, for 1 to 40 ticks each."""
    two = robot.fk(robot.random_configurations(2, seed=int(random.integers(2**31))))
    return two[np.arange(ticks) // int(random.integers(1, 40)) % 2]


def _not_a_number(robot: bik.Robot, start: np.ndarray, ticks: int, random: np.random.Generator) -> np.ndarray:
    targets = _jumps(robot, start, ticks, random).copy()
    targets[random.random(ticks) < NOT_A_NUMBER, 0, 3] = np.nan
    return targets


TARGETS: dict[str, Targets] = {
    "jumps": _jumps,
    "every tick": _every_tick,
    "noise": _noise,
    "smooth": _smooth,
    "dropouts": _dropouts,
    "far away": _far,
    "edge of reach": _edge,
    "singular": _singular,
    "turning back": _turning_back,
    "NaN": _not_a_number,
}
