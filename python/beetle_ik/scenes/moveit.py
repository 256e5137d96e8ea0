"""Obstacles of a MoveIt planning scene in YAML."""

import os
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import obstacles
from .._core import BeetleIkError, InvalidInputError, Obstacle, pose
from ..files.whole import path_of
from ..installed.needs import library

_PRIMITIVES = {1: "box", 2: "sphere", 3: "cylinder", 4: "cone", 5: "prism"}  # types of shape_msgs/SolidPrimitive
_LISTS = (("primitives", "primitive_poses"), ("meshes", "mesh_poses"), ("planes", "plane_poses"))


def read_planning_scene(file: str | os.PathLike[str], frame: ArrayLike | None) -> list[Obstacle]:
    """Reads the collision objects; `frame` is the pose (4, 4) of their frame in the frame of the robot's base.

    Raises:
        InvalidInputError: not a planning scene, or an object that cannot become an obstacle; the message names it.
    """
    yaml = library("yaml", "pyyaml", "reading a MoveIt planning scene")
    path, where = path_of(file), os.fspath(file)
    place = np.eye(4) if frame is None else _rigid(frame)
    try:
        scene = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError, yaml.YAMLError) as error:  # also for dates and integers that Python cannot hold
        raise InvalidInputError(f"{where}: not YAML: {error}") from error
    world = scene.get("world") if isinstance(scene, dict) else None
    if not isinstance(world, dict):
        raise InvalidInputError(f'{where}: expected a MoveIt planning scene: a mapping with "world"')
    _require_no_more(where, scene, world)
    objects = world.get("collision_objects") or []
    if not isinstance(objects, list):
        raise InvalidInputError(f'{where}: "collision_objects" must be a list')
    frames = {str(_get(_get(found, "header", {}), "frame_id", "")) for found in objects if isinstance(found, dict)}
    if len(frames) > 1:
        named = ", ".join(f"'{name}'" for name in sorted(frames))
        raise InvalidInputError(f"{where}: the objects are in several frames ({named}); only one can be read")
    return [shape for i, found in enumerate(objects) for shape in _object(where, i, found, place)]


def _require_no_more(where: str, scene: dict[str, Any], world: dict[str, Any]) -> None:
    """Refuses other contents than collision objects: the arm would run into anything left out."""
    octomap = _get(_get(world, "octomap", {}), "octomap", {})
    if _get(octomap, "data", None):
        raise InvalidInputError(f"{where}: the octomap cannot be read: make a bik.obstacles.Grid or PointCloud of it")
    attached = _get(_get(scene, "robot_state", {}), "attached_collision_objects", [])
    if attached:
        raise InvalidInputError(
            f"{where}: the robot carries what is in attached_collision_objects: take that out of the file, "
            "and use robot.with_attached(link, shape)"
        )


def _object(where: str, number: int, found: Any, frame: NDArray[np.float64]) -> Iterator[Obstacle]:
    if not isinstance(found, dict):
        raise InvalidInputError(f"{where}: object {number} must be a mapping, got {found!r:.60}")
    name = f"{where}: object '{found.get('id', number)}'"
    if found.get("operation", 0) not in (0, "add", "ADD", b"\x00"):
        raise InvalidInputError(
            f"{name}: operation {found['operation']!r:.60}: only objects that are added can be read"
        )
    at = frame @ _pose(name, found["pose"]) if found.get("pose") else frame
    count = 0
    for shapes, poses in _LISTS:
        items, places = found.get(shapes) or [], found.get(poses) or []
        if not (isinstance(items, list) and isinstance(places, list) and len(items) == len(places)):
            raise InvalidInputError(f'{name}: "{shapes}" and "{poses}" must be lists of one length')
        for item, place in zip(items, places, strict=True):
            count += 1
            try:
                yield _shape(name, shapes, item, at @ _pose(name, place))
            except (BeetleIkError, AttributeError, LookupError, OverflowError, TypeError, ValueError) as error:
                told = error if isinstance(error, BeetleIkError) else f"unreadable {shapes}: {error!r:.60}"
                prefix = "" if str(told).startswith(where) else f"{name}: "
                raise InvalidInputError(f"{prefix}{told}") from error
    if count == 0:
        raise InvalidInputError(f"{name} has no primitives and no meshes")


def _shape(name: str, kind: str, item: Any, at: NDArray[np.float64]) -> Obstacle:
    if kind == "meshes":
        if not item.get("vertices"):
            raise InvalidInputError(
                f"{name}: a mesh without vertices; files of meshes are not read: load them by trimesh"
            )
        vertices = np.array([_numbers(vertex, "xyz") for vertex in item["vertices"]])
        faces = [_get(face, "vertex_indices", face) for face in item["triangles"]]
        return obstacles.Mesh(vertices @ at[:3, :3].T + at[:3, 3], faces)
    if kind == "planes":
        raise InvalidInputError(f"{name}: a plane has two sides: use a bik.obstacles.HalfSpace or a thin Box")
    given = item["type"]
    shape = _PRIMITIVES.get(given, given) if isinstance(given, int) else str(given).lower()
    sizes = [float(size) for size in item["dimensions"]]
    match shape, sizes:
        case "box", [_, _, _]:
            return obstacles.Box(at[:3, 3], sizes, at[:3, :3])
        case "sphere", [radius]:
            return obstacles.Sphere(at[:3, 3], radius)
        case "cylinder", [height, radius]:
            return obstacles.Cylinder(at[:3, 3], at[:3, 2], radius, height)
        case (("box" | "sphere" | "cylinder"), _):
            raise InvalidInputError(f"{name}: a {shape} with {len(sizes)} dimensions")
    raise InvalidInputError(f"{name}: a primitive of type {shape!r:.60}; those that can be read: box, sphere, cylinder")


def _pose(name: str, given: Any) -> NDArray[np.float64]:
    """Reads a pose: position and orientation, each a mapping or a list."""
    try:
        position = _numbers(given["position"], "xyz")
        orientation = _numbers(given["orientation"], "xyzw")
    except (LookupError, OverflowError, TypeError, ValueError) as error:
        raise InvalidInputError(f"{name}: a pose needs a position (x, y, z) and an orientation (x, y, z, w)") from error
    try:
        return pose(position, xyzw=orientation)
    except BeetleIkError as error:
        raise InvalidInputError(f"{name}: {error}") from error


def _rigid(frame: ArrayLike) -> NDArray[np.float64]:
    try:
        matrix = np.asarray(frame, dtype=float)
        if matrix.shape != (4, 4) or (matrix[3] != (0, 0, 0, 1)).any():
            raise ValueError
        return pose(matrix[:3, 3], matrix=matrix[:3, :3])
    except (TypeError, ValueError) as error:
        raise InvalidInputError(f"frame must be a pose (4, 4), got {frame!r:.60}") from error


def _numbers(given: Any, names: str) -> list[float]:
    values: Sequence[Any] = [given[name] for name in names] if isinstance(given, dict) else given
    numbers = [float(value) for value in values]
    if len(numbers) != len(names):
        raise ValueError(names)
    return numbers


def _get(mapping: Any, key: str, default: Any) -> Any:
    """Returns an entry of a mapping; `default` if it is missing or empty, or the value is no mapping."""
    return (mapping.get(key) or default) if isinstance(mapping, dict) else default
