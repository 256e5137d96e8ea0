"""Surroundings of the robot of a planner: named objects, point clouds, and parts that it carries."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..._core import Nearest, Obstacle, PointCloud, Robot, nearest
from .articulation import Articulation
from .fcl import obstacles_of, placed
from .poses import Array

_HALF_DIAGONAL = np.sqrt(3.0) / 2.0  # of a cube


@dataclass(frozen=True)
class WorldCollisionResult:
    """Two bodies that overlap, with the names of mplib."""

    collision_type: str
    object_name1: str
    object_name2: str
    link_name1: str
    link_name2: str


class World:
    """Objects by name, in the frame of the world."""

    def __init__(self, articulation: Articulation, objects: list[Any]) -> None:
        """Adds objects of mplib, or pairs (name, obstacle)."""
        self._articulation = articulation
        self._objects: dict[str, list[Obstacle]] = {}
        for thing in objects:
            self.add_object(*thing) if isinstance(thing, tuple) else self.add_object(thing)

    @property
    def obstacles(self) -> list[Obstacle]:
        """All obstacles."""
        return [obstacle for shapes in self._objects.values() for obstacle in shapes]

    def named(self, message: str) -> str:
        """Returns a message with the names of objects in place of the numbers of `obstacles`."""
        names = [name for name, shapes in self._objects.items() for _ in shapes]
        return re.sub(r"obstacle (\d+)\b", lambda found: f"object '{names[int(found[1])]}'", message)

    def add_object(self, name_or_object: Any, collision_object: Any = None) -> None:
        """Adds or replaces an object: a name and a shape at a pose or an obstacle, or an object with a name.

        Raises:
            InvalidInputError: a shape that is not known.
        """
        if collision_object is None:
            self._objects[name_or_object.name] = obstacles_of(name_or_object)
        else:
            self._objects[name_or_object] = obstacles_of(collision_object)

    def add_point_cloud(self, name: str, vertices: ArrayLike, resolution: float = 0.01) -> None:
        """Adds or replaces a cloud of points (k, 3) (m) whose cubes have edges of `resolution` (m)."""
        self._objects[name] = [PointCloud(vertices, _HALF_DIAGONAL * resolution)]

    def remove_object(self, name: str) -> bool:
        """Removes an object, carried or not; returns whether there was one."""
        carried = self._articulation.attached.pop(name, None)
        return self._objects.pop(name, None) is not None or carried is not None

    def has_object(self, name: str) -> bool:
        """Returns whether an object of this name exists, carried or not."""
        return name in self._objects or self.is_object_attached(name)

    def get_object_names(self) -> list[str]:
        """Returns the names of all objects."""
        return [*self._objects, *self._articulation.attached]

    def is_object_attached(self, name: str) -> bool:
        """Returns whether an object is carried."""
        return name in self._articulation.attached

    def attach(self, name: str, shape: Any, link: str, pose: Array) -> None:
        """Has a link carry a shape, which may touch the links that it touches now."""
        (obstacle,) = obstacles_of(shape)
        carried = placed(obstacle, pose)
        self._objects.pop(name, None)
        touch: list[str] = []
        while True:
            self._articulation.attached[name] = (link, carried, touch)
            robot = self._articulation.arm_at(self._articulation.get_qpos())
            found = nearest(robot, self._q(), [])
            other = None if found is None or found.distance > 0.0 else _other(found, name)
            if other is None or other in touch:
                return
            touch = [*touch, other]

    def detach_object(self, name: str, also_remove: bool = False) -> bool:
        """Lets go of a carried object, which stays where it is unless it is removed; returns whether it was carried."""
        if name not in self._articulation.attached:
            return False
        link, shape, _ = self._articulation.attached.pop(name)
        if not also_remove:
            robot = self._articulation.arm_at(self._articulation.get_qpos())
            self._objects[name] = [placed(shape, robot.fk(self._q(), link=link))]
        return True

    def self_collisions(self, qpos: Array) -> list[WorldCollisionResult]:
        """Returns the pairs of links that overlap."""
        robot, q = self._articulation.arm_at(qpos), qpos[self._articulation.joints.at]
        name, pairs = self._articulation.get_name(), list(robot.collision_pairs)
        found = []
        while pairs:
            apart = nearest(robot.with_collision_pairs(pairs), q, [])
            if apart is None or apart.distance > 0.0:
                break
            one, two = apart.body, _plain(apart.other)
            pairs = [pair for pair in pairs if set(pair) != {one, two}]
            found.append(WorldCollisionResult("self", name, name, one, two))
        return found

    def world_collisions(self, qpos: Array) -> list[WorldCollisionResult]:
        """Returns the links that overlap with objects."""
        robot, q = self._articulation.arm_at(qpos), qpos[self._articulation.joints.at]
        alone, name = robot.with_collision_pairs([]), self._articulation.get_name()
        return [
            WorldCollisionResult("sceneobject", name, thing, link, thing)
            for thing, shapes in self._objects.items()
            for shape in shapes
            for link in _touched(alone, q, shape)
        ]

    def _q(self) -> Array:
        return self._articulation.get_qpos()[self._articulation.joints.at]


def _touched(robot: Robot, q: Array, obstacle: Obstacle) -> Iterator[str]:
    """Yields the links that overlap with an obstacle."""
    links: list[str] = []
    while True:
        found = nearest(robot, q, [_with_touch(obstacle, links)])
        if found is None or found.distance > 0.0 or found.body in links:
            return
        links.append(found.body)
        yield found.body


def _with_touch(obstacle: Obstacle, links: list[str]) -> Obstacle:
    positional, named = obstacle.__getnewargs_ex__()
    return type(obstacle)(*positional, **{**named, "touch": [*obstacle.touch, *links]})


def _other(found: Nearest, name: str) -> str | None:
    """Returns the body that touches the one of this name."""
    pair = [found.body, _plain(found.other)]
    return pair[1 - pair.index(name)] if name in pair else None


def _plain(other: str) -> str:
    """Returns the name in "link 'name'"."""
    return other.partition("'")[2].rpartition("'")[0] or other
