"""Planned motions as the results of mplib: clear of obstacles, or along a screw."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..._core import (
    BeetleIkError,
    InvalidInputError,
    Limits,
    Obstacle,
    Robot,
    clearance,
    nearest,
    plan_point_to_point,
    time_optimal,
)
from .poses import Array
from .results import Result, sampled, standing
from .screw import followed, screw

_FINER = 10  # factor by which poses of a screw come closer
_SAME = 1e-9  # rad, m: largest difference of joints, or of entries of poses, that count as the same
_STILL = 1e-12  # rad, m: largest motion of a joint that counts as none


def planned(
    robot: Robot,
    q: Array,
    end: dict[str, Array],
    limits: Limits,
    obstacles: list[Obstacle] | None,
    keep: Any,
    time_step: float,
    named: Callable[[str], str],
) -> Result:
    """Plans a motion that is clear of everything.

    Args:
        robot: the robot.
        q: configuration at the start (n,).
        end: {"end": a pose (4, 4)} or {"end_q": configurations (k, n)}, one of which is to be reached.
        limits: limits of the motion.
        obstacles: what is around; None for a robot without bodies, which can touch nothing.
        keep: what holds at every instant, as of `plan_point_to_point`.
        time_step: time between two rows of the result (s).
        named: puts the names of objects into a message.
    """
    goals = end.get("end_q")
    if goals is not None and (nearby := np.abs(goals - q).max(axis=1) < _SAME).any():
        return standing(goals[np.argmax(nearby)])
    try:
        plan = plan_point_to_point(
            robot,
            start_q=q,
            end=end.get("end"),
            end_q=goals,
            limits=limits,
            obstacles=obstacles,
            margin=0.0,
            free_start=obstacles is not None,
            keep=keep,
        )
    except InvalidInputError as error:
        if goals is None and np.allclose(robot.fk(q), end["end"], rtol=0.0, atol=_SAME):
            return standing(q)
        return {"status": f"RRTConnect Failed. {named(str(error))}"}
    if not plan.success:
        return {"status": f"RRTConnect Failed. {named(plan.message)}"}
    return {**sampled(plan.trajectory, time_step), "plan": plan}


def along_screw(
    robot: Robot,
    q: Array,
    goal: Array,
    limits: Limits,
    obstacles: list[Obstacle] | None,
    time_step: float,
    named: Callable[[str], str],
) -> Result:
    """Returns the motion from q (n,) along the screw to a pose (4, 4); other arguments as of `planned`."""
    rows = followed(robot, q, screw(robot.fk(q), goal))
    if isinstance(rows, str):  # near a singular configuration the joints need more poses
        rows = followed(robot, q, screw(robot.fk(q), goal, finer=_FINER))
    if isinstance(rows, str):
        return {"status": f"screw plan failed: {rows}"}
    if obstacles is not None:
        clear = clearance(robot, rows, obstacles)
        if np.any(clear < 0.0):
            found = nearest(robot, rows[np.argmax(clear < 0.0)], obstacles)
            assert found is not None
            told = named(f"link '{found.body}' meets {found.other}")
            return {"status": f"screw plan failed: {told}"}
    if np.abs(rows - rows[0]).max() < _STILL:
        return standing(rows[0])
    try:
        return sampled(time_optimal(rows, limits), time_step)
    except BeetleIkError as error:
        return {"status": f"screw plan failed: {error}"}
