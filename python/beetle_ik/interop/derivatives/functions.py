"""The functions of the core that JAX and PyTorch call, with their shapes."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from ..._core import Robot
from ...scenes import Scene
from . import checks, nearest
from .curvature import curvature
from .following import following, solutions
from .rows import Rows, in_rows


@dataclass(frozen=True)
class RowFunction:
    """A function of the core, which takes all rows in one call; leading axes of its arrays are rows."""

    compute: Callable[..., Rows]
    """Takes arrays (m, ...), and returns (m, *shape)."""
    ndims: tuple[int, ...]
    """Number of axes that belong to each array itself, not to the rows."""
    shape: tuple[int, ...]
    """Shape of one result."""

    def __call__(self, *arrays: ArrayLike) -> Rows:
        """Returns the results, with the leading axes of the arrays; a row with NaN gives NaN."""
        return in_rows(self.compute, *arrays, ndims=self.ndims, shape=self.shape)


def poses(robot: Robot, link: str | None) -> RowFunction:
    """Returns `Robot.fk`; an unknown link is an error here, not in a call."""
    robot.fk(np.zeros(robot.dof), link=link)
    return RowFunction(partial(robot.fk, link=link), (1,), (*checks.axis_of_tips(robot, link), 4, 4))


def jacobians(robot: Robot, link: str | None) -> RowFunction:
    """Returns `Robot.jacobian`; an unknown link is an error here."""
    robot.jacobian(np.zeros(robot.dof), link=link)
    return RowFunction(partial(robot.jacobian, link=link), (1,), (*checks.axis_of_tips(robot, link), 6, robot.dof))


def curvatures(robot: Robot, link: str | None) -> RowFunction:
    """Returns the derivative of the Jacobian by the joints."""
    return RowFunction(partial(curvature, robot, link), (1,), (6, robot.dof, robot.dof))


def solved(robot: Robot, ndims: tuple[int, ...]) -> RowFunction:
    """Returns `solve_batch`, of targets and, if there are two entries in `ndims`, starts; see `solutions`."""
    return RowFunction(partial(solutions, robot), ndims, (robot.dof + 1,))


def ways(robot: Robot, rows: int, damping: float) -> RowFunction:
    """Returns how solutions follow targets and starts; see `following`."""
    size = rows * len(robot.tips) + robot.dof
    return RowFunction(partial(following, robot, rows, damping), (1, 0), (robot.dof, size))


def clearances(robot: Robot, scene: Scene) -> RowFunction:
    """Returns the smallest distances; a robot without bodies is an error here."""
    nearest.distances(robot, scene, np.zeros((1, robot.dof)))
    return RowFunction(partial(nearest.distances, robot, scene), (1,), ())


def clearance_gradients(robot: Robot, scene: Scene) -> RowFunction:
    """Returns the gradients of the smallest distances."""
    return RowFunction(partial(nearest.gradients, robot, scene), (1,), (robot.dof,))
