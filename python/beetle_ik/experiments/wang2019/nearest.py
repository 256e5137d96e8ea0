"""Straight motion between the nearest configurations of two positions, and the bound on any motion."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

from .settings import END, FROM_END_TO_END, REACH, START, arm

_VELOCITY, _ACCELERATION = np.pi, 2 * np.pi  # limits in FROM_END_TO_END
_SEARCH_SEEDS = range(3)  # seeds of the searches for the nearest pair at given elbows
_SEARCH = bik.Stop(max_evaluations=20_000)
_OUT_OF_REACH = 10.0  # rad; more than any displacement


@cache
def nearest(links: int) -> bik.Plan:
    """Plans the paper's motion with the library's planner, which chooses the elbows at both ends."""
    return bik.plan_point_to_point(arm(links), START, END, limits=FROM_END_TO_END)


@cache
def nearest_bent_as_in_the_paper(links: int) -> bik.Plan:
    """Plans between the nearest configurations with positive elbows, which the paper's arccosine gives."""
    start, end = _nearest_pair(links)
    return bik.plan_point_to_point(arm(links), start_q=start, end_q=end, limits=FROM_END_TO_END)


def bang_bang(plan: bik.Plan) -> float:
    """Returns the least time (s) of any motion within the limits that joins the ends of `plan`."""
    q = plan.trajectory.q
    return max(_least_time(abs(way)) for way in q[-1] - q[0])


def _least_time(way: float) -> float:
    """Returns the time from rest to rest: full acceleration, full speed if it is reached, then full braking."""
    if way <= _VELOCITY**2 / _ACCELERATION:
        return 2.0 * math.sqrt(way / _ACCELERATION)
    return way / _VELOCITY + _VELOCITY / _ACCELERATION


def _nearest_pair(links: int) -> NDArray[np.float64]:
    """Returns start and end (2, links) with the least largest joint displacement, both elbows positive."""
    free = links - 2
    if free == 0:
        return np.array([_configurations(np.empty((1, 0)), place)[0] for place in (START, END)])

    def displacement(orientations: NDArray[np.float64]) -> NDArray[np.float64]:
        start, end = (
            _configurations(half, place)
            for half, place in zip(np.split(orientations, 2, axis=1), (START, END), strict=True)
        )
        largest: NDArray[np.float64] = np.nan_to_num(np.abs(end - start).max(axis=1), nan=_OUT_OF_REACH)
        return largest

    bounds = np.full(2 * free, np.pi)
    solver = bik.DifferentialEvolution(population=40, stall_generations=None)
    found = [
        bik.minimize(displacement, -bounds, bounds, solver=solver, stop=_SEARCH, seed=seed, vectorized=True)
        for seed in _SEARCH_SEEDS
    ]
    best = min(found, key=lambda minimum: minimum.value).x
    return np.array(
        [_configurations(half[None], place)[0] for half, place in zip(np.split(best, 2), (START, END), strict=True)]
    )


def _configurations(orientations: NDArray[np.float64], place: tuple[float, float, float]) -> NDArray[np.float64]:
    """Returns joint angles (m, links) with the last links at `orientations` (m, links - 2); NaN out of reach."""
    length = REACH / (2 + orientations.shape[1])
    x = place[0] - length * np.cos(orientations).sum(axis=1)
    y = place[1] - length * np.sin(orientations).sum(axis=1)
    cosine = (x * x + y * y) / (2.0 * length * length) - 1.0
    with np.errstate(invalid="ignore"):
        bend = np.arccos(cosine)
    first = np.arctan2(y, x) - bend / 2.0  # equal links
    absolute = np.column_stack((first, first + bend, orientations))
    q = np.diff(absolute, axis=1, prepend=0.0)
    return np.pi - (np.pi - q) % (2 * np.pi)
