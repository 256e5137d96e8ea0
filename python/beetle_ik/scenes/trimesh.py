"""Obstacles from the library trimesh, which is not imported: its objects are recognised by their attributes."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import obstacles
from .._core import BeetleIkError, InvalidInputError, Obstacle

_METRES = (None, "m", "meter", "meters", "metre", "metres")
_RIGID = 1e-9  # largest error of an entry of R R' - 1


def obstacles_of(geometry: Any) -> list[Obstacle]:
    """Returns the obstacles of a mesh or a scene of trimesh.

    Raises:
        InvalidInputError: another type, a unit other than metres, or a geometry without faces; the message names it.
    """
    return [_obstacle(name, part, transform) for name, part, transform in _parts(geometry)]


def _parts(geometry: Any) -> Iterator[tuple[str, Any, NDArray[np.float64]]]:
    """Yields the name, the geometry and the pose (4, 4) of each part."""
    if hasattr(geometry, "graph") and hasattr(geometry, "geometry"):
        _require_metres("the scene", geometry)
        for node in geometry.graph.nodes_geometry:
            transform, name = geometry.graph[node]
            yield f"geometry '{node}'", geometry.geometry[name], np.asarray(transform, dtype=float)
    elif hasattr(geometry, "vertices"):
        yield "the mesh", geometry, np.eye(4)
    else:
        raise InvalidInputError(f"geometry must be a trimesh.Trimesh or a trimesh.Scene, got {geometry!r:.60}")


def _obstacle(name: str, part: Any, transform: NDArray[np.float64]) -> Obstacle:
    _require_metres(name, part)
    if not hasattr(part, "faces"):
        raise InvalidInputError(f"{name} has no faces; points become a bik.obstacles.PointCloud(points, radius)")
    try:
        return _primitive(part, transform) or _mesh(part, transform)
    except BeetleIkError as error:
        raise InvalidInputError(f"{name}: {error}") from error


def _primitive(part: Any, transform: NDArray[np.float64]) -> Obstacle | None:
    """Returns the exact shape of a primitive, whose triangles would lie inside it; None for other parts."""
    primitive = getattr(part, "primitive", None)
    turn = transform[:3, :3]
    if primitive is None or np.abs(turn @ turn.T - np.eye(3)).max() > _RIGID or np.linalg.det(turn) < 0:
        return None
    at = transform @ np.asarray(getattr(primitive, "transform", np.eye(4)), dtype=float)
    match type(part).__name__:
        case "Box":
            return obstacles.Box(at[:3, 3], primitive.extents, at[:3, :3])
        case "Sphere":
            center = transform[:3, :3] @ np.asarray(primitive.center) + transform[:3, 3]
            return obstacles.Sphere(center, float(primitive.radius))
        case "Cylinder":
            return obstacles.Cylinder(at[:3, 3], at[:3, 2], float(primitive.radius), float(primitive.height))
        case "Capsule":
            # The start of the axis differs between versions of trimesh.
            place = np.asarray(primitive.transform, dtype=float)
            along = (np.asarray(part.vertices) - place[:3, 3]) @ place[:3, 2]
            middle, half = 0.5 * (along.min() + along.max()), 0.5 * float(primitive.height)
            low, high = (at[:3, 3] + (middle + side * half) * at[:3, 2] for side in (-1, 1))
            return obstacles.Capsule(low, high, float(primitive.radius))
    return None


def _mesh(part: Any, transform: NDArray[np.float64]) -> Obstacle:
    vertices = np.asarray(part.vertices, dtype=float) @ transform[:3, :3].T + transform[:3, 3]
    faces = np.asarray(part.faces)
    if part.is_watertight and part.is_convex:
        return obstacles.ConvexMesh(vertices)
    mirrored = np.linalg.det(transform[:3, :3]) < 0
    return obstacles.Mesh(vertices, faces[:, ::-1] if mirrored else faces)


def _require_metres(name: str, part: Any) -> None:
    units = getattr(part, "units", None)
    if units not in _METRES:
        raise InvalidInputError(f"{name} is in {units}: use convert_units('meters') of trimesh first")
