"""Scenes: obstacles that are made once, saved, loaded and passed to every call."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, overload

from .._core import InvalidInputError, Obstacle, PreparedObstacles
from ..calls.wording import worded_call

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_WRITTEN_OUT = 8  # a longer scene is represented by its length


class Scene(Sequence[Obstacle]):
    """Obstacles in the frame of the robot's base, in order. Every `obstacles=` takes a scene or a list.

    A scene does not change; `scene + [obstacle]` and `scene[1:]` are new scenes. Scenes compare and hash by content.
    A scene prepares its obstacles for collision tests once; a list is prepared at each call.

    Args:
        obstacles: obstacles of `bik.obstacles`.

    Raises:
        InvalidInputError: an item is no obstacle; the message gives its position.

    For example:

        >>> scene = bik.Scene([bik.obstacles.Sphere((0.5, 0.0, 0.3), 0.1)])
        >>> len(scene + [bik.obstacles.Box((0.5, 0.3, 0.1), (0.2, 0.2, 0.2))])
        2
    """

    @worded_call
    def __init__(self, obstacles: Iterable[Obstacle] = ()) -> None:
        """Checks the obstacles, and prepares them for calls."""
        if isinstance(obstacles, Obstacle):
            raise InvalidInputError(f"obstacles must be a list, got a single one: [{obstacles!r:.60}]")
        try:
            given = tuple(obstacles)
        except TypeError:
            raise InvalidInputError(f"obstacles must be a list of bik.obstacles, got {obstacles!r:.60}") from None
        for i, obstacle in enumerate(given):
            if not isinstance(obstacle, Obstacle):
                made = "must be made by bik.obstacles, such as Sphere or Box"
                raise InvalidInputError(f"obstacle {i} {made}, got {obstacle!r:.60}")
        self._obstacles = given
        self._prepared = PreparedObstacles(given)  # read by calls of the core

    def __reduce__(self) -> tuple[type[Scene], tuple[tuple[Obstacle, ...]]]:
        """Pickles the obstacles alone."""
        return type(self), (self._obstacles,)

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> Scene:
        """Reads a scene from a JSON file.

        The file has the form written by `save`, or is just a list of shapes, each with its "type" (the name of the
        class in lower case, with underscores) and the arguments of the class (m, rad).

        Raises:
            InvalidInputError: the file is not a scene, or is of a later version; the message names the file and the
                obstacle.
        """
        from .json_file import read_obstacles

        return cls(read_obstacles(file))

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the scene to a JSON file, from which `load` returns an equal one."""
        from .json_file import write_obstacles

        write_obstacles(file, self._obstacles)

    @classmethod
    def from_moveit(cls, file: str | os.PathLike[str], *, frame: ArrayLike | None = None) -> Scene:
        """Reads the collision objects of a MoveIt planning scene in YAML (`moveit_msgs/PlanningScene`).

        The scene has the boxes, spheres, cylinders and meshes in the order of the file. Cones, planes, octomaps and
        objects attached to the robot are refused, not left out. Needs PyYAML.

        Args:
            file: the YAML file, as `ros2 topic echo` or MotionBenchMaker write it.
            frame: pose (4, 4) of the frame of the objects in the frame of the robot's base; None: the two frames agree.

        Raises:
            InvalidInputError: the file is not a planning scene, has objects in several frames, or an object that cannot
                be read; the message names the file and the object.
        """
        from .moveit import read_planning_scene

        return cls(read_planning_scene(file, frame))

    @classmethod
    def from_trimesh(cls, geometry: Any) -> Scene:
        """Returns the obstacles of a `trimesh.Trimesh` or `trimesh.Scene`, in metres.

        Primitives (boxes, spheres, cylinders, capsules) become the exact shape, convex meshes a `ConvexMesh`,
        all others a `Mesh`.

        Raises:
            InvalidInputError: another type, a unit other than metres, or a geometry without faces.
        """
        from .trimesh import obstacles_of

        return cls(obstacles_of(geometry))

    @overload
    def __getitem__(self, index: int) -> Obstacle: ...

    @overload
    def __getitem__(self, index: slice) -> Scene: ...

    def __getitem__(self, index: int | slice) -> Obstacle | Scene:
        """Returns an obstacle, or a scene of several."""
        return Scene(self._obstacles[index]) if isinstance(index, slice) else self._obstacles[index]

    def __len__(self) -> int:
        """Returns the number of obstacles."""
        return len(self._obstacles)

    def __iter__(self) -> Iterator[Obstacle]:
        """Iterates over the obstacles."""
        return iter(self._obstacles)

    def __add__(self, others: Iterable[Obstacle]) -> Scene:
        """Returns a scene with `others` after its own obstacles."""
        return Scene((*self._obstacles, *Scene(others)))

    def __eq__(self, other: object) -> bool:
        """Whether the other is a scene of equal obstacles in the same order."""
        return self._obstacles == other._obstacles if isinstance(other, Scene) else NotImplemented

    def __hash__(self) -> int:
        """Hashes the obstacles."""
        return hash(self._obstacles)

    def _repr_html_(self) -> str:
        """Shows the obstacles in a notebook."""
        from ..figures.notebook import scene

        return scene(self._obstacles)

    def __repr__(self) -> str:
        """Writes the obstacles out if they are few, and otherwise their number."""
        if len(self) > _WRITTEN_OUT:
            return f"<Scene: {len(self)} obstacles>"
        return f"Scene([{', '.join(map(repr, self._obstacles))}])"


Scene.__module__ = "beetle_ik"
