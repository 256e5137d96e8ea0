"""The robot's links in the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import Capsule, Ellipsoid, Sphere
from .._style import LINKS, SKY, rgb
from .looks import soup

if TYPE_CHECKING:
    import viser
    from numpy.typing import NDArray

    from .._core import Body, Robot
    from .looks import Look

    Array = NDArray[np.float64]

_TRANSLUCENT = 0.25
_SAME = 7  # decimals of corners that are the same
_SMOOTH = (Capsule, Ellipsoid, Sphere)


class Links:
    """The links of a robot as frames of a scene, which carry what is seen of them.

    Bodies of links that have a look are drawn only where they are asked for: they enclose what is seen.
    """

    def __init__(self, scene: viser.SceneApi, robot: Robot, looks: list[Look]) -> None:
        """Adds the frames and what they carry; `place` moves them."""
        self._scene, self._robot = scene, robot
        bare = not looks and not robot.bodies
        self._frames = {
            link: scene.add_frame(f"/robot/{node_name(link)}", show_axes=bare, axes_length=0.05, axes_radius=0.003)
            for link in robot.all_link_names
        }
        self._poses = np.full((len(self._frames), 4, 4), np.nan)
        self._meshes: list[tuple[str, Array, NDArray[np.int64]]] = []
        """Of each link: vertices and faces for its ghosts."""
        for i, look in enumerate(looks):
            mesh = look.scene.to_mesh()
            scene.add_glb(f"{self._frames[look.link].name}/look_{i}", look.scene.export(file_type="glb"))
            self._meshes.append((look.link, mesh.vertices, mesh.faces))
        seen = {look.link for look in looks}
        self._covers = [self._draw(i, body, seen) for i, body in enumerate(robot.bodies) if _is_thick(body)]
        self._ghosts: list[Any] = []

    def _draw(self, i: int, body: Body, seen: set[str]) -> viser.MeshHandle | None:
        """Draws a body, and returns it if it covers what is seen of its link."""
        covers = body.link in seen and body.source != "attached"
        vertices, faces = soup(body.shape.triangles)
        smooth = isinstance(body.shape, _SMOOTH)
        if smooth:  # light falls smoothly where corners are shared
            _, first, corners = np.unique(vertices.round(_SAME), axis=0, return_index=True, return_inverse=True)
            vertices, faces = vertices[first], corners.reshape(-1, 3)
        if not covers:
            self._meshes.append((body.link, vertices, faces))
        handle = self._scene.add_mesh_simple(
            f"{self._frames[body.link].name}/body_{i}", vertices, faces, flat_shading=not smooth, side="double",
            color=rgb(SKY if covers else LINKS[1]),  # one colour: neighbours overlap at their joint
            opacity=_TRANSLUCENT if covers else None, visible=not covers,
        )  # fmt: skip
        return handle if covers else None

    @property
    def has_covers(self) -> bool:
        """Whether there are bodies that `show_bodies` shows."""
        return any(self._covers)

    def show_bodies(self, shown: bool) -> None:
        """Shows or hides the bodies around what is seen."""
        for handle in filter(None, self._covers):
            handle.visible = shown

    def place(self, q: Array) -> None:
        """Moves the links that `q` (n,) moves."""
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
        for i, (link, vertices, faces) in enumerate(self._meshes):
            places = poses[:, self._robot.all_link_names.index(link)]
            ghosts = self._scene.add_batched_meshes_simple(
                f"/ghosts/{i}", vertices, faces, batched_wxyzs=wxyz(places), batched_positions=places[:, :3, 3],
                batched_colors=rgb(SKY), opacity=_TRANSLUCENT, lod="off", cast_shadow=False,
            )  # fmt: skip
            self._ghosts.append(ghosts)


def _is_thick(body: Body) -> bool:
    """Whether it has a surface; a rod of radius zero has none."""
    return bool(getattr(body.shape, "radius", 1.0))


def node_name(name: str) -> str:
    """Returns a name for the scene; a slash would make it a child of another node."""
    return name.replace("/", "|")


def wxyz(poses: Array) -> Array:
    """Returns the quaternions (..., 4) of poses (..., 4, 4), as viser takes them."""
    from viser.transforms import SO3

    return np.asarray(SO3.from_matrix(poses[..., :3, :3]).wxyz, dtype=np.float64)
