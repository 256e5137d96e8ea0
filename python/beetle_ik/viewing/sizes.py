"""The sizes of obstacles, changed by handles on their surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import obstacles as shapes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .._core import Obstacle

    Array = NDArray[np.float64]

_SMALLEST = 0.002  # m: half a size, or a radius


class Grip(NamedTuple):
    """A point of a surface to drag, seen from the middle of the shape: a direction (3,) and a distance (m)."""

    middle: Array
    along: Array
    distance: float

    @property
    def point(self) -> Array:
        """Where it is (3,)."""
        return self.middle + self.distance * self.along


def grips(shape: Obstacle) -> list[Grip]:
    """Returns where the size of a shape can be dragged; none for shapes that are made of points."""
    match shape:
        case shapes.Sphere():
            return [Grip(shape.center, np.eye(3)[0], shape.radius)]
        case shapes.Box():
            return [Grip(shape.center, shape.rotation[:, k], 0.5 * float(shape.size[k])) for k in range(3)]
        case shapes.Ellipsoid():
            return [Grip(shape.center, shape.rotation[:, k], float(shape.semi_axes[k])) for k in range(3)]
        case shapes.Cylinder():
            side = Grip(shape.center, beside(shape.axis), shape.radius)
            return [side, Grip(shape.center, shape.axis, 0.5 * shape.length)]
        case shapes.Capsule():
            middle, axis = 0.5 * (shape.a + shape.b), shape.b - shape.a
            length = float(np.linalg.norm(axis))
            if not length:
                return [Grip(middle, np.eye(3)[0], shape.radius)]
            return [Grip(middle, beside(axis), shape.radius), Grip(middle, axis / length, 0.5 * length)]
    return []


def resized(shape: Obstacle, i: int, distance: float) -> Obstacle:
    """Returns the shape with its grip `i` at a distance (m) from its middle, which stays."""
    distance, touch = max(distance, _SMALLEST), list(shape.touch)
    match shape:
        case shapes.Sphere():
            return shapes.Sphere(shape.center, distance, touch=touch)
        case shapes.Box():
            return shapes.Box(shape.center, _replaced(shape.size, i, 2 * distance), shape.rotation, touch=touch)
        case shapes.Ellipsoid():
            return shapes.Ellipsoid(shape.center, _replaced(shape.semi_axes, i, distance), shape.rotation, touch=touch)
        case shapes.Cylinder():
            radius, length = (distance, shape.length) if i == 0 else (shape.radius, 2 * distance)
            return shapes.Cylinder(shape.center, shape.axis, radius, length, touch=touch)
        case shapes.Capsule():
            if i == 0:
                return shapes.Capsule(shape.a, shape.b, distance, touch=touch)
            grip = grips(shape)[1]
            ends = (grip.middle - distance * grip.along, grip.middle + distance * grip.along)
            return shapes.Capsule(*ends, shape.radius, touch=touch)
    return shape


def _replaced(values: Array, i: int, value: float) -> Array:
    changed = np.array(values, dtype=float)
    changed[i] = value
    return changed


def beside(axis: Array) -> Array:
    """Returns a direction across an axis."""
    side = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    return np.asarray(side / np.linalg.norm(side))
