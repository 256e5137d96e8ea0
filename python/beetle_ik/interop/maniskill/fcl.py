"""Collision shapes under the names that mplib has for those of FCL, as obstacles of this library.

Shapes of mplib itself are taken too; what they do not let one read is refused.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ... import obstacles
from ..._core import InvalidInputError, Obstacle
from .poses import Array, Pose, matrix_of

_ORIGIN = np.zeros(3)


def Box(*side: Any) -> Obstacle:  # noqa: N802 -- the name of mplib
    """Returns a box about the origin with edges (3,) or x, y, z (m)."""
    return obstacles.Box(_ORIGIN, side[0] if len(side) == 1 else side)


def Sphere(radius: float) -> Obstacle:  # noqa: N802
    """Returns a ball about the origin (m)."""
    return obstacles.Sphere(_ORIGIN, radius)


def Cylinder(radius: float, lz: float) -> Obstacle:  # noqa: N802
    """Returns a cylinder about the origin, along z (m)."""
    return obstacles.Cylinder(_ORIGIN, (0, 0, 1), radius, lz)


def Capsule(radius: float, lz: float) -> Obstacle:  # noqa: N802
    """Returns a capsule about the origin whose axis of length lz is along z (m)."""
    return obstacles.Capsule((0, 0, -lz / 2), (0, 0, lz / 2), radius)


def Ellipsoid(a: float, b: float, c: float) -> Obstacle:  # noqa: N802
    """Returns an ellipsoid about the origin with these semi-axes (m)."""
    return obstacles.Ellipsoid(_ORIGIN, (a, b, c))


@dataclass
class CollisionObject:
    """A shape at a pose."""

    geometry: Any
    pose: Any = field(default_factory=Pose)

    def get_collision_geometry(self) -> Any:
        """Returns the shape."""
        return self.geometry


@dataclass
class FCLObject:
    """Shapes at poses in the frame of a named object."""

    name: str
    pose: Any = field(default_factory=Pose)
    shapes: Sequence[Any] = ()
    shape_poses: Sequence[Any] = ()


def obstacles_of(thing: Any) -> list[Obstacle]:
    """Returns the obstacles of an object of mplib, of a `CollisionObject`, or of a shape.

    Raises:
        InvalidInputError: a shape that is not known, or that mplib does not let one read.
    """
    if hasattr(thing, "shape_poses"):
        base = matrix_of("pose", thing.pose)
        pairs = zip(thing.shapes, thing.shape_poses, strict=True)
        shapes = [(_geometry(shape), base @ matrix_of("pose", pose)) for shape, pose in pairs]
        return [placed(obstacle_of(shape), pose) for shape, pose in shapes]
    if hasattr(thing, "get_collision_geometry"):
        return [placed(obstacle_of(_geometry(thing)), matrix_of("pose", thing.pose))]
    return [obstacle_of(thing)]


def obstacle_of(geometry: Any) -> Obstacle:
    """Returns the obstacle of a shape of this library or of mplib, about its own origin."""
    if isinstance(geometry, Obstacle):
        return geometry
    kind = type(geometry).__name__
    if kind not in _READ:
        raise InvalidInputError(
            f"a {kind} is no shape that can be read: give one of beetle_ik.obstacles, such as Mesh(vertices, faces)"
        )
    return _READ[kind](geometry)


def placed(obstacle: Obstacle, pose: Array) -> Obstacle:
    """Returns an obstacle moved by a pose (4, 4)."""
    turn, shift = pose[:3, :3], pose[:3, 3]

    def moved(points: ArrayLike) -> Array:
        return np.asarray(points) @ turn.T + shift

    touch = list(obstacle.touch)
    if isinstance(obstacle, obstacles.Sphere):
        return obstacles.Sphere(moved(obstacle.center), obstacle.radius, touch=touch)
    if isinstance(obstacle, obstacles.Box):
        return obstacles.Box(moved(obstacle.center), obstacle.size, turn @ obstacle.rotation, touch=touch)
    if isinstance(obstacle, obstacles.Capsule):
        return obstacles.Capsule(moved(obstacle.a), moved(obstacle.b), obstacle.radius, touch=touch)
    if isinstance(obstacle, obstacles.Cylinder):
        axis = turn @ obstacle.axis
        return obstacles.Cylinder(moved(obstacle.center), axis, obstacle.radius, obstacle.length, touch=touch)
    if isinstance(obstacle, obstacles.Ellipsoid):
        return obstacles.Ellipsoid(moved(obstacle.center), obstacle.semi_axes, turn @ obstacle.rotation, touch=touch)
    if isinstance(obstacle, obstacles.ConvexMesh):
        return obstacles.ConvexMesh(moved(obstacle.points), touch=touch)
    if isinstance(obstacle, obstacles.Mesh):
        return obstacles.Mesh(moved(obstacle.vertices), obstacle.faces, touch=touch)
    if isinstance(obstacle, obstacles.PointCloud):
        return obstacles.PointCloud(moved(obstacle.points), obstacle.radius, touch=touch)
    if np.array_equal(pose, np.eye(4)):
        return obstacle
    raise InvalidInputError(f"a {type(obstacle).__name__} cannot be moved to a pose: give it in the frame of the world")


def _geometry(shape: Any) -> Any:
    return shape.get_collision_geometry() if hasattr(shape, "get_collision_geometry") else shape


_READ: dict[str, Callable[[Any], Obstacle]] = {
    "Box": lambda shape: Box(shape.side),
    "Sphere": lambda shape: Sphere(shape.radius),
    "Cylinder": lambda shape: Cylinder(shape.radius, shape.lz),
    "Capsule": lambda shape: Capsule(shape.radius, shape.lz),
    "Ellipsoid": lambda shape: Ellipsoid(*shape.radii),
    "Convex": lambda shape: obstacles.ConvexMesh(np.asarray(shape.get_vertices())),
}
