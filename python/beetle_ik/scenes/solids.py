"""Shapes of MoveIt as obstacles, shared by its messages and its text files."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .. import obstacles
from .._core import InvalidInputError, Obstacle

READ = "box, sphere, cylinder, cone"
_SIDES = 64  # of the hull around a cone


def solid(shape: str, sizes: Sequence[float], at: NDArray[np.float64]) -> Obstacle:
    """Returns a primitive at the pose `at` (4, 4): a box (x, y, z), sphere (radius), cylinder or cone (height, radius).

    A cone, its tip on the positive z axis and its origin halfway up, becomes the hull of a pyramid around it, wider by
    0.12 %.

    Raises:
        InvalidInputError: another shape, or another number of sizes.
    """
    match shape, sizes:
        case "box", [_, _, _]:
            return obstacles.Box(at[:3, 3], sizes, at[:3, :3])
        case "sphere", [radius]:
            return obstacles.Sphere(at[:3, 3], radius)
        case "cylinder", [height, radius]:
            return obstacles.Cylinder(at[:3, 3], at[:3, 2], radius, height)
        case "cone", [height, radius]:
            angle = 2.0 * np.pi * np.arange(_SIDES) / _SIDES
            rim = radius / np.cos(np.pi / _SIDES) * np.array([np.cos(angle), np.sin(angle)]).T
            corners = np.vstack([np.c_[rim, np.full(_SIDES, -0.5 * height)], [0.0, 0.0, 0.5 * height]])
            return obstacles.ConvexMesh(moved(corners, at))
        case (("box" | "sphere" | "cylinder" | "cone"), _):
            raise InvalidInputError(f"a {shape} with {len(sizes)} dimensions")
        case ("plane", _):
            raise two_sided()
    raise InvalidInputError(f"a primitive of type {shape!r:.60}; those that can be read: {READ}")


def moved(points: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns points (k, 3) moved by a pose (4, 4). Numbers that overflow are for the obstacle to refuse."""
    with np.errstate(over="ignore", invalid="ignore"):
        return points @ at[:3, :3].T + at[:3, 3]


def two_sided() -> InvalidInputError:
    """Returns the error for a plane."""
    return InvalidInputError("a plane has two sides: use a bik.obstacles.HalfSpace or a thin Box")
