"""Displacement of obstacles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .. import obstacles as shapes

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .._core import Obstacle


def displaced(shape: Obstacle, by: NDArray[np.float64]) -> Obstacle | None:
    """Returns the shape moved rigidly by a pose (4, 4); None for a `Grid` or an `Ellipse`, which cannot be turned."""
    turn, touch = by[:3, :3], list(shape.touch)

    def at(points: NDArray[np.float64]) -> NDArray[np.float64]:
        return points @ turn.T + by[:3, 3]

    match shape:
        case shapes.Sphere():
            return shapes.Sphere(at(shape.center), shape.radius, touch=touch)
        case shapes.Box():
            return shapes.Box(at(shape.center), shape.size, turn @ shape.rotation, touch=touch)
        case shapes.Capsule():
            return shapes.Capsule(at(shape.a), at(shape.b), shape.radius, touch=touch)
        case shapes.Cylinder():
            return shapes.Cylinder(at(shape.center), turn @ shape.axis, shape.radius, shape.length, touch=touch)
        case shapes.Ellipsoid():
            return shapes.Ellipsoid(at(shape.center), shape.semi_axes, turn @ shape.rotation, touch=touch)
        case shapes.HalfSpace():
            normal = turn @ shape.normal
            return shapes.HalfSpace(normal, shape.offset + float(normal @ by[:3, 3]), touch=touch)
        case shapes.ConvexMesh():
            return shapes.ConvexMesh(at(shape.points), touch=touch)
        case shapes.Mesh():
            return shapes.Mesh(at(shape.vertices), shape.faces, touch=touch)
        case shapes.PointCloud():
            return shapes.PointCloud(at(shape.points), shape.radius, touch=touch)
    return None
