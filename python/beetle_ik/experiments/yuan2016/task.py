"""The paper's robot and targets, and the runs of its solvers."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import beetle_ik as bik

from .published import BUDGET, MOTIONS, ROTATION, START, TARGETS, Array

ROBOT = bik.Robot.named("kr210_yuan2016")
TOLERANCE = 1e-4  # m and rad


def home() -> Array:
    """Returns the pose of motion 0, to whose orientation the last motion returns: eq. (22) does not hold there."""
    return ROBOT.fk(np.radians(START))


def target(motion: int, position: Sequence[float] | Array | None = None) -> Array:
    """Returns the target pose (4, 4) of a motion, by its number from 0."""
    pose = np.eye(4)
    pose[:3, :3] = home()[:3, :3] if motion == len(MOTIONS) - 1 else ROTATION
    pose[:3, 3] = TARGETS[motion] if position is None else position
    return pose


def error(q: Array, goal: Array) -> float:
    """Returns E of eq. (11)."""
    return float(0.5 * np.sum((goal - ROBOT.fk(q)) ** 2))


def curvatures(q: Array) -> Array:
    """Returns the curvatures of E at a solution, largest first: eigenvalues of J'J, J the derivative of the matrix.

    A rotation w moves three axes, whose squared displacements sum to 2 w'w.
    """
    jacobian = ROBOT.jacobian(q) * np.repeat([1.0, np.sqrt(2.0)], 3)[:, None]
    curvature: Array = np.linalg.svd(jacobian, compute_uv=False) ** 2
    return curvature


def reach(goal: Array, start: Array, solver: bik.papers.APPS, *, budget: int = BUDGET) -> bik.Solution:
    """Sends APPS from `start` (rad) to `goal`; meeting its threshold is enough to count as solved."""
    return bik.solve(
        ROBOT,
        goal,
        start_q=start,
        solver=solver,
        position_tolerance=TOLERANCE,
        rotation_tolerance=TOLERANCE,
        stop=bik.Stop(max_iterations=budget, max_evaluations=2 * budget),
    )


@dataclass(frozen=True, kw_only=True)
class Motion:
    """One motion as found by APPS."""

    name: str
    goal: Array
    """Target pose (4, 4)."""
    start: Array
    """Start configuration (rad)."""
    solution: bik.Solution

    @property
    def rounded(self) -> Array:
        """Angles R_2: the solution to 0.01 degrees, as sent to the robot."""
        rounded: Array = np.degrees(self.solution.q).round(2)
        return rounded


def run_all(solver: bik.papers.APPS) -> list[Motion]:
    """Runs all motions, each from the rounded end of the one before."""
    start = START
    motions = []
    for i, name in enumerate(MOTIONS):
        goal, begin = target(i), np.radians(start)
        motion = Motion(name=name, goal=goal, start=begin, solution=reach(goal, begin, solver))
        motions.append(motion)
        start = motion.rounded
    return motions
