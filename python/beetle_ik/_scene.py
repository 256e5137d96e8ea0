"""Reads obstacles from JSON.

A scene is a list of shapes, or an object with the list as "obstacles":

    {"obstacles": [
        {"type": "sphere", "center": [0.5, 0.0, 0.4], "radius": 0.1},
        {"type": "box", "center": [0.5, 0.0, 0.1], "size": [0.4, 0.6, 0.2]}
    ]}

The other keys of a shape are the arguments of its class in `beetle_ik.obstacles`, in metres and radians.
"""

import inspect
import json
import os
from typing import Any

from . import obstacles
from ._core import BeetleIkError, InvalidInputError, Obstacle
from ._files import path_of

_SHAPES: dict[str, type[Obstacle]] = {
    "sphere": obstacles.Sphere,
    "box": obstacles.Box,
    "capsule": obstacles.Capsule,
    "cylinder": obstacles.Cylinder,
    "half_space": obstacles.HalfSpace,
    "ellipsoid": obstacles.Ellipsoid,
    "ellipse": obstacles.Ellipse,
    "convex_mesh": obstacles.ConvexMesh,
    "mesh": obstacles.Mesh,
    "point_cloud": obstacles.PointCloud,
    "grid": obstacles.Grid,
}


def read_obstacles(file: str | os.PathLike[str]) -> list[Obstacle]:
    """Reads the obstacles of a scene.

    Raises:
        InvalidInputError: the file is not a scene. Names the file and the obstacle.
    """
    where = os.fspath(file)
    try:
        scene = json.loads(path_of(file).read_text(encoding="utf-8"))
    except UnicodeDecodeError as error:
        raise InvalidInputError(f"{where}: not UTF-8: save the file as JSON with the encoding UTF-8") from error
    except (json.JSONDecodeError, RecursionError) as error:
        raise InvalidInputError(f"{where}: not JSON: {error}") from error
    shapes = scene.get("obstacles") if isinstance(scene, dict) else scene
    if not isinstance(shapes, list):
        raise InvalidInputError(f'{where}: expected a list of shapes, or an object with such a list as "obstacles"')
    return [_shape(f"{where}: obstacle {i}", shape) for i, shape in enumerate(shapes)]


def _shape(where: str, shape: Any) -> Obstacle:
    types = ", ".join(_SHAPES)
    if not isinstance(shape, dict) or "type" not in shape:
        raise InvalidInputError(f'{where}: expected an object with a "type", one of {types}')
    kind = _SHAPES.get(shape["type"]) if isinstance(shape["type"], str) else None
    if kind is None:
        raise InvalidInputError(f"{where}: unknown type {shape['type']!r:.60}; types: {types}")
    arguments = {name: value for name, value in shape.items() if name != "type"}
    try:
        inspect.signature(kind).bind(**arguments)
        return kind(**arguments)
    except (TypeError, BeetleIkError) as error:
        raise InvalidInputError(f"{where} ({shape['type']}): {error}") from error
