"""Obstacles of a MoveIt planning scene in YAML, or in the text of RViz."""

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import obstacles
from .._core import BeetleIkError, InvalidInputError, Obstacle, pose
from ..files.whole import content_of
from .attached import Attached, carried
from .bounded_yaml import load_yaml
from .frames import frame_of, placed_frames, rigid
from .octomap import octomap_message
from .rviz import is_rviz_text, rviz_obstacles
from .solids import moved, solid, two_sided

_PRIMITIVES = {1: "box", 2: "sphere", 3: "cylinder", 4: "cone", 5: "prism"}  # types of shape_msgs/SolidPrimitive
_LISTS = (("primitives", "primitive_poses"), ("meshes", "mesh_poses"), ("planes", "plane_poses"))


def read_moveit(file: str | os.PathLike[str], frame: ArrayLike | None) -> tuple[list[Obstacle], list[Attached]]:
    """Reads the obstacles, and what the robot carries; `frame` is the pose (4, 4) of their frame in that of the base.

    Raises:
        InvalidInputError: not a planning scene, or an object that cannot become an obstacle; the message names it.
    """
    content, where = content_of(file), os.fspath(file)
    place = np.eye(4) if frame is None else rigid(frame)
    try:
        text = content.decode("utf-8").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise InvalidInputError(f"{where}: not UTF-8: expected YAML, or a .scene text of RViz") from error
    if where.endswith(".scene") or is_rviz_text(text):
        return rviz_obstacles(where, text, place), []
    return _planning_scene(where, text, place)


def _planning_scene(where: str, text: str, place: NDArray[np.float64]) -> tuple[list[Obstacle], list[Attached]]:
    """Reads a planning scene in YAML."""
    # "ros2 topic echo" ends each message with a line "---".
    scene = load_yaml(where, text.rstrip().removesuffix("---"))
    world = scene.get("world") if isinstance(scene, dict) else None
    if not isinstance(world, dict):
        raise InvalidInputError(
            f'{where}: expected a MoveIt planning scene: a mapping with "world", or the .scene text of RViz'
        )
    objects = world.get("collision_objects") or []
    if not isinstance(objects, list):
        raise InvalidInputError(f'{where}: "collision_objects" must be a list')
    octomap = _get(world, "octomap", {})
    maps = [octomap] if _get(_get(octomap, "octomap", {}), "data", None) else []
    frames = placed_frames(where, scene, [*(found for found in objects if isinstance(found, dict)), *maps], place)
    shapes = [shape for i, found in enumerate(objects) for shape in _object(where, i, found, frames)]
    for found in maps:
        at = frames[frame_of(found)]
        origin = _pose(f"{where}: octomap", found["origin"]) if found.get("origin") else np.eye(4)
        shapes += octomap_message(f"{where}: octomap", found["octomap"], at @ origin)
    return shapes, _attached(where, scene)


def _attached(where: str, scene: dict[str, Any]) -> list[Attached]:
    """Reads what the robot carries, each shape in the frame of its link."""
    entries = _get(_get(scene, "robot_state", {}), "attached_collision_objects", [])
    if not isinstance(entries, list):
        raise InvalidInputError(f'{where}: "attached_collision_objects" must be a list')
    found: list[Attached] = []
    for i, entry in enumerate(entries):
        held = _get(entry, "object", None)
        link, touch = _get(entry, "link_name", None), _get(entry, "touch_links", [])
        if not (isinstance(held, dict) and isinstance(link, str) and isinstance(touch, list)):
            raise InvalidInputError(
                f'{where}: attached object {i}: expected a mapping with "link_name" and "object", got {entry!r:.60}'
            )
        name = str(held.get("id", f"attached_{i}"))
        if frame_of(held) not in ("", link):
            raise InvalidInputError(
                f"{where}: object '{name}' on link '{link}' is given in the frame '{frame_of(held)}': "
                "give it in the frame of the link"
            )
        shapes = _object(where, i, held, {frame_of(held): np.eye(4)})
        try:
            found += carried(link, name, shapes, tuple(map(str, touch)))
        except BeetleIkError as error:
            told = str(error)
            raise InvalidInputError(told if told.startswith(where) else f"{where}: object '{name}': {told}") from error
    return found


def _object(where: str, number: int, found: Any, frames: Mapping[str, NDArray[np.float64]]) -> Iterator[Obstacle]:
    """Reads the shapes of an object; `frames` has the pose of each frame."""
    if not isinstance(found, dict):
        raise InvalidInputError(f"{where}: object {number} must be a mapping, got {found!r:.60}")
    name = f"{where}: object '{found.get('id', number)}'"
    if found.get("operation", 0) not in (0, "add", "ADD", b"\x00"):
        raise InvalidInputError(
            f"{name}: operation {found['operation']!r:.60}: only objects that are added can be read"
        )
    at = frames[frame_of(found)]
    at = at @ _pose(name, found["pose"]) if found.get("pose") else at
    count = 0
    for shapes, poses in _LISTS:
        items, places = found.get(shapes) or [], found.get(poses) or []
        if not (isinstance(items, list) and isinstance(places, list) and len(items) == len(places)):
            raise InvalidInputError(f'{name}: "{shapes}" and "{poses}" must be lists of one length')
        for item, place in zip(items, places, strict=True):
            count += 1
            try:
                shape = _shape(shapes, item, at @ _pose(name, place))
            except (BeetleIkError, AttributeError, LookupError, OverflowError, TypeError, ValueError) as error:
                told = error if isinstance(error, BeetleIkError) else f"unreadable {shapes}: {error!r:.60}"
                prefix = "" if str(told).startswith(where) else f"{name}: "
                raise InvalidInputError(f"{prefix}{told}") from error
            yield shape
    if count == 0:
        raise InvalidInputError(f"{name} has no primitives and no meshes")


def _shape(kind: str, item: Any, at: NDArray[np.float64]) -> Obstacle:
    if kind == "meshes":
        if not item.get("vertices"):
            raise InvalidInputError("a mesh without vertices; files of meshes are not read: load them by trimesh")
        vertices = np.array([_numbers(vertex, "xyz") for vertex in item["vertices"]])
        faces = [_get(face, "vertex_indices", face) for face in item["triangles"]]
        return obstacles.Mesh(moved(vertices, at), faces)
    if kind == "planes":
        raise two_sided()
    given = item["type"]
    shape = _PRIMITIVES.get(given, str(given)) if isinstance(given, int) else str(given).lower()
    return solid(shape, [float(size) for size in item["dimensions"]], at)


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


def _numbers(given: Any, names: str) -> list[float]:
    values: Sequence[Any] = [given[name] for name in names] if isinstance(given, dict) else given
    numbers = [float(value) for value in values]
    if len(numbers) != len(names):
        raise ValueError(names)
    return numbers


def _get(mapping: Any, key: str, default: Any) -> Any:
    """Returns an entry of a mapping; `default` if it is missing or empty, or the value is no mapping."""
    return (mapping.get(key) or default) if isinstance(mapping, dict) else default
