"""The robot's links in the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import Capsule, Ellipsoid, Sphere
from ..figures.style import LINKS, SKY, rgb
from .looks import soup

if TYPE_CHECKING:
    import viser
    from numpy.typing import NDArray

    from .._core import Body, Robot
    from .looks import Look

    Array = NDArray[np.float64]

_TRANSLUCENT = 0.3
_SAME = 7  # decimals at which corners are compared
_SMOOTH = (Capsule, Ellipsoid, Sphere)


class Links:
    """The links of a robot as frames of a scene, which carry their meshes.

    Bodies of links with meshes are drawn only on request: they enclose the meshes.
    """

    def __init__(self, scene: viser.SceneApi, robot: Robot, looks: list[Look]) -> None:
        """Adds the frames with meshes and bodies; `place` moves them."""
        self._scene, self._robot = scene, robot
        self._frames = {
            link: scene.add_frame(f"/robot/{node_name(link)}", show_axes=False) for link in robot.all_link_names
        }
        self._poses = np.full((len(self._frames), 4, 4), np.nan)
        self._looks = looks
        for i, look in enumerate(looks):
            scene.add_glb(f"{self._frames[look.link].name}/look_{i}", look.scene.export(file_type="glb"))
        seen = {look.link for look in looks}
        bodies = [body for body in robot.bodies if getattr(body.shape, "radius", 1.0)]  # a rod has no surface
        self._naked = [body for body in bodies if body.link not in seen]
        for i, body in enumerate(self._naked):
            self._draw(f"body_{i}", body, LINKS[1])  # one colour: neighbours overlap at their joint
        covers = [body for body in bodies if body.link in seen]
        self._covers = [
            self._draw(f"cover_{i}", body, SKY, opacity=_TRANSLUCENT, visible=False) for i, body in enumerate(covers)
        ]
        self._ghosts: list[Any] = []

    def _draw(self, name: str, body: Body, color: str, **how: Any) -> viser.MeshHandle:
        vertices, faces, flat = _mesh(body)
        path = f"{self._frames[body.link].name}/{name}"
        return self._scene.add_mesh_simple(
            path, vertices, faces, color=rgb(color), flat_shading=flat, side="double", **how
        )

    def bounds(self, q: Array) -> tuple[Array, Array]:
        """Returns the least and the greatest coordinates (3,) of links and their meshes at `q` (n,)."""
        poses = dict(zip(self._frames, self._robot.all_link_poses(q), strict=True))
        points = [pose[:3, 3:].T for pose in poses.values()]
        for look in self._looks:
            corners = np.stack(np.meshgrid(*look.scene.bounds.T), axis=-1).reshape(-1, 3)
            points.append(corners @ poses[look.link][:3, :3].T + poses[look.link][:3, 3])
        every = np.concatenate(points)
        return every.min(axis=0), every.max(axis=0)

    @property
    def has_covers(self) -> bool:
        """Whether there are bodies that `show_bodies` shows."""
        return bool(self._covers)

    def show_bodies(self, shown: bool) -> None:
        """Shows or hides the bodies around the meshes."""
        for handle in self._covers:
            handle.visible = shown

    def place(self, q: Array) -> None:
        """Moves the links whose poses change with `q` (n,)."""
        poses = self._robot.all_link_poses(q)
        moved = np.flatnonzero((poses != self._poses).any(axis=(1, 2)))
        frames = list(self._frames.values())
        for i, quaternion in zip(moved, wxyz(poses[moved]), strict=True):
            frames[i].wxyz = quaternion
            frames[i].position = poses[i, :3, 3]
        self._poses = poses

    def show_ghosts(self, configurations: Array) -> None:
        """Draws the robot translucent at configurations (k, n), in place of earlier ghosts; k may be 0."""
        for handle in self._ghosts:
            handle.remove()
        self._ghosts = []
        if not len(configurations):
            return
        poses = np.array([self._robot.all_link_poses(q) for q in configurations])
        looks = [(look.link, look.scene.to_mesh()) for look in self._looks]
        meshes = [(link, mesh.vertices, mesh.faces) for link, mesh in looks]
        meshes += [(body.link, *_mesh(body)[:2]) for body in self._naked]
        for i, (link, vertices, faces) in enumerate(meshes):
            places = poses[:, self._robot.all_link_names.index(link)]
            ghosts = self._scene.add_batched_meshes_simple(
                f"/ghosts/{i}", vertices, faces, batched_wxyzs=wxyz(places), batched_positions=places[:, :3, 3],
                batched_colors=rgb(SKY), opacity=_TRANSLUCENT, lod="off", cast_shadow=False,
            )  # fmt: skip
            self._ghosts.append(ghosts)


def _mesh(body: Body) -> tuple[Array, NDArray[np.int64], bool]:
    """Returns vertices and faces of a body, and whether to shade it flat: light falls smoothly on shared corners."""
    vertices, faces = soup(body.shape.triangles)
    if not isinstance(body.shape, _SMOOTH):
        return vertices, faces, True
    _, first, corners = np.unique(vertices.round(_SAME), axis=0, return_index=True, return_inverse=True)
    return vertices[first], corners.reshape(-1, 3), False


def node_name(name: str) -> str:
    """Returns a name for the scene; a slash would make it a child of another node."""
    return name.replace("/", "|")


def wxyz(poses: Array) -> Array:
    """Converts poses (..., 4, 4) to quaternions (..., 4), as viser takes them."""
    from viser.transforms import SO3

    return np.asarray(SO3.from_matrix(poses[..., :3, :3]).wxyz, dtype=np.float64)
