"""Calls of the published planner, which all searches of this experiment use."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

Solver: TypeAlias = bik.papers.BeetleSwarm | bik.papers.PSO | bik.papers.Genetic | bik.DifferentialEvolution
Objective: TypeAlias = Literal["time", "joint_travel", "tip_travel"]

PAPERS_ELBOWS = (1, 1)  # the arccosine of eq. (1) is never negative


def plan_between(
    robot: bik.Robot,
    start: Sequence[float],
    end: Sequence[float],
    objective: Objective,
    *,
    limits: bik.Limits,
    solver: Solver,
    stop: bik.Stop,
    seed: int = 0,
    elbows: tuple[int, int] = PAPERS_ELBOWS,
    obstacles: Sequence[bik.obstacles.Ellipse] = (),
) -> bik.Plan:
    """Plans a motion through a via point (section III-A, first problem), its parameters found by `solver`."""
    return bik.plan_point_to_point(
        robot,
        start,
        end,
        method=bik.papers.TPBSO(elbows=elbows, solver=solver),
        objective=objective,
        limits=limits,
        obstacles=obstacles,
        stop=stop,
        seed=seed,
    )


def plan_along(
    robot: bik.Robot,
    path: bik.Path | NDArray[np.float64],
    objective: Literal["time", "joint_travel"],
    *,
    limits: bik.Limits,
    accuracy: float,
    solver: Solver,
    stop: bik.Stop,
    seed: int = 0,
) -> bik.Plan:
    """Plans a motion along a path (section III-A, second problem), its parameters found by `solver`."""
    return bik.plan_along_path(
        robot,
        path,
        method=bik.papers.TPBSO(solver=solver),
        objective=objective,
        limits=limits,
        accuracy=accuracy,
        stop=stop,
        seed=seed,
    )
