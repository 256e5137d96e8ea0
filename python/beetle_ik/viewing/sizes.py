"""Sizes of obstacles, changed by handles on their surfaces."""

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
    """A point of a shape to drag: at a distance (m) along a direction (3,) from a fixed point (3,)."""

    middle: Array
    along: Array
    distance: float

    @property
    def point(self) -> Array:
        """Position of the grip (3,)."""
        return self.middle + self.distance * self.along


def grips(shape: Obstacle) -> list[Grip]:
    """Returns the grips of a shape, at which it is resized; none for shapes made of points.

    Grips are at a corner or on a rim, away from the axes along which the handle in the middle moves the shape.
    """
    match shape:
        case shapes.Sphere():
            return [Grip(shape.center, np.full(3, 1.0 / np.sqrt(3.0)), shape.radius)]
        case shapes.Box():
            return _at_corner(shape.center, shape.rotation, 0.5 * shape.size)
        case shapes.Ellipsoid():
            return _at_corner(shape.center, shape.rotation, shape.semi_axes)
        case shapes.Cylinder():
            return _at_rim(shape.center, shape.axis, shape.radius, 0.5 * shape.length)
        case shapes.Capsule():
            middle, axis = 0.5 * (shape.a + shape.b), shape.b - shape.a
            length = float(np.linalg.norm(axis))
            if length:
                return _at_rim(middle, axis / length, shape.radius, 0.5 * length)
            return [Grip(middle, np.full(3, 1.0 / np.sqrt(3.0)), shape.radius)]
    return []


def _at_corner(center: Array, rotation: Array, half: Array) -> list[Grip]:
    """Returns grips at the corner of a box, along its edges."""
    return [Grip(center + rotation @ (half * (np.arange(3) != k)), rotation[:, k], float(half[k])) for k in range(3)]


def _at_rim(center: Array, axis: Array, radius: float, half: float) -> list[Grip]:
    """Returns grips at the rim of a cylinder: for its radius and for half its length."""
    side = beside(axis)
    return [Grip(center + half * axis, side, radius), Grip(center + radius * side, axis, half)]


def resized(shape: Obstacle, i: int, distance: float) -> Obstacle:
    """Returns the shape with its grip `i` at a distance (m) and the same middle."""
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
            middle, axis = 0.5 * (shape.a + shape.b), shape.b - shape.a
            reach = distance / float(np.linalg.norm(axis)) * axis
            ends = (middle - reach, middle + reach)
            return shapes.Capsule(*ends, shape.radius, touch=touch)
    return shape


def _replaced(values: Array, i: int, value: float) -> Array:
    changed = np.array(values, dtype=float)
    changed[i] = value
    return changed


def beside(axis: Array) -> Array:
    """Returns a unit vector perpendicular to an axis."""
    side = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    return np.asarray(side / np.linalg.norm(side))
