"""Scenes as JSON.

    {"version": 1, "obstacles": [
        {"type": "sphere", "center": [0.5, 0.0, 0.4], "radius": 0.1},
        {"type": "box", "center": [0.5, 0.0, 0.1], "size": [0.4, 0.6, 0.2]}
    ]}

A bare list is a scene too. What the robot carries is in "attached", each with "link", "shape", "touch" and "name". The
other keys of a shape are the arguments of its class in `beetle_ik.obstacles`, in metres and radians.
"""

import inspect
import json
import os
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from .. import obstacles
from .._core import BeetleIkError, InvalidInputError, Obstacle
from ..calls.names import meant
from ..files.whole import content_of, whole_file
from .attached import Attached, checked

VERSION = 1

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
_TYPES = {shape: name for name, shape in _SHAPES.items()}


def write_scene(file: str | os.PathLike[str], shapes: Iterable[Obstacle], attached: Sequence[Attached]) -> None:
    """Writes the file of a scene."""
    text = scene_text(shapes, attached)
    with whole_file(file) as stream:
        stream.write(text.encode())


def scene_text(shapes: Iterable[Obstacle], attached: Sequence[Attached] = ()) -> str:
    """Returns a scene as JSON, an obstacle a line. Numbers are exact."""
    lines = ",\n".join(f"    {json.dumps(_described(shape))}" for shape in shapes)
    carried = [json.dumps(entry._asdict() | {"shape": _described(entry.shape)}) for entry in attached]
    more = ', "attached": [\n    {}\n]'.format(",\n    ".join(carried)) if carried else ""
    return f'{{"version": {VERSION}, "obstacles": [\n{lines}\n]{more}}}\n'


def _described(shape: Obstacle) -> dict[str, Any]:
    kind = type(shape)
    names = [name for name in inspect.signature(kind).parameters if name != "touch" or shape.touch]
    return {"type": _TYPES[kind]} | {name: np.asarray(getattr(shape, name)).tolist() for name in names}


def read_scene(file: str | os.PathLike[str]) -> tuple[list[Obstacle], list[Attached]]:
    """Reads the obstacles and the attached objects of a scene.

    Raises:
        InvalidInputError: the file is not a scene; the message names the file and the obstacle.
    """
    return _scene_in(content_of(file), os.fspath(file))


def obstacles_in(content: bytes, where: str) -> list[Obstacle]:
    """Reads the obstacles of a scene from the content of a file; `where` names the file in errors.

    Raises:
        InvalidInputError: the content is not a scene, or has attached objects; the message names the file and the
            obstacle.
    """
    shapes, attached = _scene_in(content, where)
    if attached:
        raise InvalidInputError(f"{where}: the robot carries '{attached[0].name}' in this scene: use Scene.attach_to")
    return shapes


def _scene_in(content: bytes, where: str) -> tuple[list[Obstacle], list[Attached]]:
    try:
        scene = json.loads(content.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise InvalidInputError(f"{where}: not UTF-8: save the file as JSON with the encoding UTF-8") from error
    except json.JSONDecodeError as error:
        raise InvalidInputError(f"{where}: not JSON: {_not_json(error)}") from error
    except (ValueError, RecursionError) as error:  # also raised for integers of thousands of digits
        raise InvalidInputError(f"{where}: not JSON: {error}") from error
    shapes = scene
    if isinstance(scene, dict):
        _require_version(where, scene)
        shapes = scene.get("obstacles")
    if not isinstance(shapes, list):
        raise InvalidInputError(f'{where}: expected a list of shapes, or an object with such a list as "obstacles"')
    known = ["version", "obstacles", "attached"]
    if isinstance(scene, dict) and (unknown := scene.keys() - set(known)):
        key = min(unknown)
        keys = ", ".join(f'"{name}"' for name in known)
        raise InvalidInputError(f"{where}: unknown key {key!r:.60}{meant(key, known)}; keys: {keys}")
    attached = scene.get("attached", []) if isinstance(scene, dict) else []
    if not isinstance(attached, list):
        raise InvalidInputError(f'{where}: "attached" must be a list, got {attached!r:.60}')
    obstacles_read = [_shape(f"{where}: obstacle {i}", shape) for i, shape in enumerate(shapes)]
    return obstacles_read, [_attached(f"{where}: attached {i}", entry) for i, entry in enumerate(attached)]


def _attached(where: str, entry: Any) -> Attached:
    keys = Attached._fields
    if not isinstance(entry, dict) or entry.keys() != set(keys):
        raise InvalidInputError(f"{where}: expected an object with the keys {', '.join(keys)}, got {entry!r:.60}")
    try:
        return checked([Attached(**entry | {"shape": _shape(where, entry["shape"])})])[0]
    except BeetleIkError as error:
        raise InvalidInputError(str(error).replace("attached 0", where, 1)) from error


def _not_json(error: json.JSONDecodeError) -> str:
    """Returns the message for invalid JSON; it names a trailing comma, which other formats allow."""
    before = error.doc[: error.pos].rstrip()
    if before.endswith(",") and error.doc[error.pos :].lstrip()[:1] in ("]", "}"):
        comma = len(before) - 1
        return f"a comma after the last entry, line {error.doc.count(chr(10), 0, comma) + 1}: remove it"
    return str(error)


def _require_version(where: str, scene: dict[str, Any]) -> None:
    version = scene.get("version", VERSION)
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise InvalidInputError(f'{where}: "version" must be {VERSION}, got {version!r:.60}')
    if version > VERSION:
        raise InvalidInputError(
            f"{where}: a scene of version {version}; this beetle-ik reads version {VERSION}: use a later beetle-ik"
        )


def _shape(where: str, shape: Any) -> Obstacle:
    types = ", ".join(_SHAPES)
    if not isinstance(shape, dict) or "type" not in shape:
        raise InvalidInputError(f'{where}: expected an object with a "type", one of {types}')
    kind = _SHAPES.get(shape["type"]) if isinstance(shape["type"], str) else None
    if kind is None:
        near = meant(str(shape["type"]), _SHAPES)
        raise InvalidInputError(f"{where}: unknown type {shape['type']!r:.60}{near}; types: {types}")
    arguments = {name: value for name, value in shape.items() if name != "type"}
    where = f"{where} ({shape['type']})"
    _require_keys(where, arguments, inspect.signature(kind))
    try:
        return kind(**arguments)
    except BeetleIkError as error:
        raise InvalidInputError(f"{where}: {error}") from error


def _require_keys(where: str, arguments: dict[str, Any], signature: inspect.Signature) -> None:
    """Checks that all keys are arguments of the shape, and that none is missing."""
    known = list(signature.parameters)
    keys = f"keys: {', '.join(known)}"
    if unknown := arguments.keys() - set(known):
        key = min(unknown)
        raise InvalidInputError(f"{where}: unknown key {key!r:.60}{meant(key, known)}; {keys}")
    for name, parameter in signature.parameters.items():
        if parameter.default is inspect.Parameter.empty and name not in arguments:
            raise InvalidInputError(f"{where}: the key '{name}' is missing; {keys}")
