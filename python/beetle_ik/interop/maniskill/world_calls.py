"""The calls of mplib's planner that change the world, or ask what touches what."""

from typing import Any

from numpy.typing import ArrayLike

from ..._core import ConvexMesh, InvalidInputError, Obstacle
from ...calls.text import counted
from ...installed.needs import library
from . import fcl
from .articulation import Articulation
from .poses import Array, matrix_of
from .world import World, WorldCollisionResult


class WorldCalls:
    """Point clouds, objects, what links carry, the place of the base, and collisions."""

    robot: Articulation
    planning_world: World
    move_group_link_id: int

    def update_point_cloud(self, points: ArrayLike, resolution: float = 1e-3, name: str = "scene_pcd") -> None:
        """Adds or replaces a point cloud (k, 3) (m) in the frame of the world, of cubes with edges `resolution` (m)."""
        self.planning_world.add_point_cloud(name, points, resolution)

    def remove_point_cloud(self, name: str = "scene_pcd") -> bool:
        """Removes a point cloud; returns whether there was one."""
        return self.planning_world.remove_object(name)

    def remove_object(self, name: str) -> bool:
        """Removes an object; returns whether there was one."""
        return self.planning_world.remove_object(name)

    def update_attached_object(
        self, collision_geometry: Any, pose: Any, name: str = "attached_geom", art_name: Any = None, link_id: int = -1
    ) -> None:
        """Has a link carry a convex shape, at `pose` in the frame of the link; it may touch what it touches now.

        Raises:
            InvalidInputError: a shape that is not known or not convex, or no pose.
        """
        del art_name
        self.planning_world.attach(name, collision_geometry, self.robot.link(link_id), matrix_of("pose", pose))

    def update_attached_box(self, size: ArrayLike, pose: Any, art_name: Any = None, link_id: int = -1) -> None:
        """Has a link carry a box with edges (3,) (m), about `pose` in the frame of the link."""
        self.update_attached_object(fcl.Box(size), pose, self._carried("box", art_name, link_id), None, link_id)

    def update_attached_sphere(self, radius: float, pose: Any, art_name: Any = None, link_id: int = -1) -> None:
        """Has a link carry a ball (m), about `pose` in the frame of the link."""
        self.update_attached_object(fcl.Sphere(radius), pose, self._carried("sphere", art_name, link_id), None, link_id)

    def update_attached_mesh(self, mesh_path: str, pose: Any, art_name: Any = None, link_id: int = -1) -> None:
        """Has a link carry the convex hull of a mesh file, at `pose` in the frame of the link.

        Raises:
            BeetleIkError: trimesh is not installed.
        """
        trimesh = library("trimesh", "trimesh", "a mesh from a file", extra="surfaces")
        hull = ConvexMesh(trimesh.load_mesh(mesh_path).vertices)
        self.update_attached_object(hull, pose, self._carried("mesh", art_name, link_id), None, link_id)

    def detach_object(self, name: str = "attached_geom", also_remove: bool = False) -> bool:
        """Lets go of a carried object, which stays as an obstacle unless it is removed.

        Returns:
            Whether it was carried.
        """
        return self.planning_world.detach_object(name, also_remove)

    def set_base_pose(self, pose: Any) -> None:
        """Places the base of the robot in the world."""
        self.robot.set_base_pose(pose)

    def check_for_self_collision(self, state: ArrayLike | None = None) -> list[WorldCollisionResult]:
        """Returns the pairs of links that overlap, at joint positions or in the present state."""
        return self.planning_world.self_collisions(self._state(state))

    def check_for_env_collision(self, state: ArrayLike | None = None) -> list[WorldCollisionResult]:
        """Returns the links that overlap with objects, at joint positions or in the present state."""
        return self.planning_world.world_collisions(self._state(state))

    def pad_move_group_qpos(self, qpos: ArrayLike, articulation: Any = None) -> Array:
        """Returns all joint positions; of the move group alone, the others stay as they are."""
        del articulation
        return self.robot.full("qpos", qpos)

    def _state(self, state: ArrayLike | None) -> Array:
        return self.robot.get_qpos() if state is None else self.robot.full("state", state)

    def _around(self, used: bool) -> list[Obstacle] | None:
        """Returns the obstacles; None for a robot without bodies, which can touch nothing.

        Raises:
            InvalidInputError: obstacles, and a robot without bodies.
        """
        obstacles = self.planning_world.obstacles if used else []
        if self.robot.has_bodies:
            return obstacles
        if obstacles:
            raise InvalidInputError(
                f"the robot '{self.robot.get_name()}' has no collision shapes, so it cannot keep clear of "
                f'{counted(len(obstacles), "obstacle")}: give a URDF with shapes and collision="hulls"'
            )
        return None

    def _carried(self, kind: str, art_name: Any, link_id: int) -> str:
        number = self.move_group_link_id if link_id == -1 else link_id
        return f"{art_name or self.robot.get_name()}_{number}_{kind}"
