"""Arms, limits and paths of the experiment. The paper states none of the limits: they are ours."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

Criterion: TypeAlias = Literal["time", "joint_travel"]

UNITS: dict[Criterion, str] = {"time": "s", "joint_travel": "rad"}
WORDS: dict[Criterion, str] = {"time": "least time", "joint_travel": "least rotation"}

START, END = (1.0, 0.0, 0.0), (0.5, 1.5, 0.0)  # section IV-A.1
REACH = 2.0  # m; the paper does not state it
LINKS = (2, 3, 4, 5)
POPULATION, GENERATIONS = 50, 200
ONE_EACH = POPULATION * (GENERATIONS + 1)  # evaluations of a swarm with one evaluation for each member
EVALUATIONS = POPULATION * (3 * GENERATIONS + 1)  # each beetle evaluates two antennae and its new position


def limits(acceleration: float) -> bik.Limits:
    """Returns limits of half a turn a second, without position limits."""
    return bik.Limits(lower=-np.inf, upper=np.inf, velocity=np.pi, acceleration=acceleration)


FROM_END_TO_END = limits(2 * np.pi)
ALONG_PATH = limits(4 * np.pi)
THREE_LINKS = bik.Robot.planar([1.0, 1.0, 1.0])  # arm of the motions along a path


def arm(links: int) -> bik.Robot:
    """Returns an arm of equal links."""
    return bik.Robot.planar([REACH / links] * links)


def each(plan: Callable[[int], bik.Plan], seeds: Sequence[int]) -> list[bik.Plan]:
    """Plans for all seeds on all cores: planning releases the interpreter."""
    with ThreadPoolExecutor() as pool:
        return list(pool.map(plan, seeds))


def pentagram() -> bik.Path:
    """Returns a star about (1, 1) with its points 0.5 m away."""
    return bik.paths.pentagram((1.0, 1.0, 0.0), 1.0, radius=0.5)


def trefoil() -> NDArray[np.float64]:
    """Returns a smooth closed curve of three lobes about (1, 1): 51 points."""
    angle = np.linspace(0.0, 2 * np.pi, 51)
    radius = (1.0 + 0.35 * np.cos(3 * angle)) * 0.6 / 1.35
    return np.column_stack((1.0 + radius * np.cos(angle), 1.0 + radius * np.sin(angle), 0.0 * angle))
