"""Scenes: obstacles that are made once, saved, loaded and passed to every call."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, overload

from .._core import InvalidInputError, Obstacle, PreparedObstacles, Robot
from ..calls.arguments import require
from ..calls.wording import worded_call
from .attached import Attached, attached_to, checked, require_carried

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_WRITTEN_OUT = 8  # a longer scene is represented by its length


class Scene(Sequence[Obstacle]):
    """Obstacles in the frame of the robot's base, in order. Every `obstacles=` takes a scene or a list.

    A scene does not change; `scene + [obstacle]` and `scene[1:]` are new scenes. Scenes compare and hash by content.
    A scene prepares its obstacles for collision tests once; a list is prepared at each call.

    Args:
        obstacles: obstacles of `bik.obstacles`, or a scene, whose attached objects are then kept.
        attached: objects that the robot carries in the scene, each (link, shape, touch, name), the arguments of
            `robot.with_attached`. Calls refuse a robot that does not carry them: `attach_to` makes one that does.

    Raises:
        InvalidInputError: an item is no obstacle; the message gives its position. Or an attached object of another
            form.

    For example:

        >>> scene = bik.Scene([bik.obstacles.Sphere((0.5, 0.0, 0.3), 0.1)])
        >>> len(scene + [bik.obstacles.Box((0.5, 0.3, 0.1), (0.2, 0.2, 0.2))])
        2
    """

    @worded_call
    def __init__(self, obstacles: Iterable[Obstacle] = (), *, attached: Iterable[Attached] = ()) -> None:
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
        self._attached = checked(attached, obstacles.attached if isinstance(obstacles, Scene) else ())
        # Read by calls of the core.
        self._prepared = PreparedObstacles(given, [[entry.link, entry.name] for entry in self._attached])

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickles the obstacles and the attached objects alone."""
        return _scene, (self._obstacles, [tuple(entry) for entry in self._attached])

    @property
    def attached(self) -> tuple[Attached, ...]:
        """Shapes that the robot carries, each (link, shape, touch, name) as `robot.with_attached` takes it."""
        return self._attached

    @worded_call
    def attach_to(self, robot: Robot) -> Robot:
        """Returns a copy of the robot that carries the attached objects.

        Raises:
            InvalidInputError: an object that the robot cannot carry, such as one on a link that it does not have; the
                message names it.
        """
        require("robot", robot, Robot)
        return attached_to(robot, self._attached)

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> Scene:
        """Reads a scene from a JSON file.

        The file has the form written by `save`, or is just a list of shapes, each with its "type" (the name of the
        class in lower case, with underscores) and the arguments of the class (m, rad).

        Raises:
            InvalidInputError: the file cannot be read, is not a scene, or is of a later version; the message names the
                file and the obstacle.
        """
        from .json_file import read_scene

        shapes, attached = read_scene(file)
        return cls(shapes, attached=attached)

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the scene to a JSON file, from which `load` returns an equal one."""
        from .json_file import write_scene

        write_scene(file, self._obstacles, self._attached)

    @classmethod
    def from_moveit(cls, file: str | os.PathLike[str], *, frame: ArrayLike | None = None) -> Scene:
        """Reads a MoveIt planning scene: YAML (`moveit_msgs/PlanningScene`), or the text that RViz saves (".scene").

        The scene has the boxes, spheres, cylinders, cones (as hulls around them) and meshes in the order of the file,
        and the occupied voxels of an octomap as a `Grid`. What the robot carries becomes `attached`, its meshes convex
        hulls: `scene.attach_to(robot)` is the robot that carries it, and calls refuse others. Planes and prisms are
        refused, not left out; the colours and subframes of objects are ignored. YAML needs PyYAML.

        Args:
            file: the file: YAML as `ros2 topic echo --full-length` or MotionBenchMaker write it, or text of RViz in the
                format of any version.
            frame: pose (4, 4) of the frame of the objects in the frame of the robot's base; None: the two frames agree.
                If the file gives transforms between frames (`fixed_frame_transforms`), they are applied, and `frame` is
                the pose of the frame that they lead to.

        Raises:
            InvalidInputError: the file cannot be read or is not a planning scene, has objects in frames without a
                transform, or an object that cannot be read; the message names the file, and the object or the line.
        """
        from .moveit import read_moveit

        shapes, attached = read_moveit(file, frame)
        return cls(shapes, attached=attached)

    @classmethod
    def from_octomap(
        cls,
        file: str | os.PathLike[str],
        *,
        frame: ArrayLike | None = None,
        region: tuple[ArrayLike, ArrayLike] | None = None,
    ) -> Scene:
        """Reads the occupied voxels of an octomap, a ".bt" or ".ot" file of OctoMap, as one `Grid`.

        A leaf of any size becomes voxels of the resolution of the map. In an ".ot" file (`OcTree`, `ColorOcTree`),
        occupied means a probability of at least 0.5. Free and unknown voxels are both left out: the arm may move where
        nothing was seen. A map without occupied voxels is a scene without obstacles.

        Args:
            file: the file of the map.
            frame: pose (4, 4) of the frame of the map in the frame of the robot's base; None: the two frames agree.
                Turns by multiples of 90 degrees about its axes are possible, since the voxels of a `Grid` lie along the
                axes of the base. For others, `robot.with_base` puts the robot into the frame of the map.
            region: two opposite corners (3,) (m) of a box in the frame of the map; voxels that do not meet it are left
                out. None: the whole map.

        Raises:
            InvalidInputError: no file, not such a file, an incomplete one, a map of another kind, a turned frame, or a
                map too large for a grid without `region`; the message names the file.
        """
        from .octomap import read_octomap

        return cls(read_octomap(file, frame, region))

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
        """Returns an obstacle, or a scene of several with all attached objects."""
        if isinstance(index, slice):
            return Scene(self._obstacles[index], attached=self._attached)
        return self._obstacles[index]

    def __len__(self) -> int:
        """Returns the number of obstacles."""
        return len(self._obstacles)

    def __iter__(self) -> Iterator[Obstacle]:
        """Iterates over the obstacles."""
        return iter(self._obstacles)

    def __add__(self, others: Iterable[Obstacle]) -> Scene:
        """Returns a scene with `others` after its own obstacles."""
        added = Scene(others)
        return Scene((*self._obstacles, *added), attached=(*self._attached, *added.attached))

    def __eq__(self, other: object) -> bool:
        """Whether the other is a scene of equal obstacles and attached objects in the same order."""
        if not isinstance(other, Scene):
            return NotImplemented
        return (self._obstacles, self._attached) == (other._obstacles, other._attached)

    def __hash__(self) -> int:
        """Hashes the obstacles and the attached objects."""
        return hash((self._obstacles, self._attached))

    def _repr_html_(self) -> str:
        """Shows the obstacles in a notebook."""
        from ..figures.notebook import scene

        return scene(self._obstacles)

    def __repr__(self) -> str:
        """Writes the obstacles out if they are few, and otherwise their number."""
        if len(self) > _WRITTEN_OUT:
            attached = f", {len(self._attached)} attached" if self._attached else ""
            return f"<Scene: {len(self)} obstacles{attached}>"
        attached = f", attached={[tuple(entry) for entry in self._attached]}" if self._attached else ""
        return f"Scene([{', '.join(map(repr, self._obstacles))}]{attached})"


def obstacles_for(robot: Robot, obstacles: Iterable[Obstacle]) -> list[Obstacle]:
    """Returns the obstacles as a list, for a robot that carries what is attached in the scene.

    Raises:
        InvalidInputError: an item is no obstacle, or the robot does not carry an attached object.
    """
    scene = Scene(obstacles)
    require_carried(robot, scene.attached)
    return list(scene)


def _scene(obstacles: tuple[Obstacle, ...], attached: Iterable[Attached]) -> Scene:
    """Makes a scene, to be pickled by name."""
    return Scene(obstacles, attached=attached)


Scene.__module__ = "beetle_ik"
