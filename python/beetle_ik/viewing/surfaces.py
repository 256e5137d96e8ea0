"""The robot's links in the scene."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .._core import Capsule, Ellipsoid, Sphere
from .._style import LINKS, SKY, rgb
from .._surface import simplified

if TYPE_CHECKING:
    import viser
    from numpy.typing import NDArray

    from .._core import Mesh, Robot

    Meshes = list[tuple[str, Mesh]]
    Array = NDArray[np.float64]

_MOST = 100_000  # triangles of a link
_TRANSLUCENT = 0.25
_SAME = 7  # decimals of corners that are the same
_SMOOTH = (Capsule, Ellipsoid, Sphere)


class Surface(NamedTuple):
    """Triangles (t, 3, 3) (m) in the frame of a link, and their colour."""

    link: str
    triangles: Array
    color: tuple[int, int, int]
    is_body: bool
    """Whether it encloses a mesh of the same link."""
    smooth: bool = False

    def mesh(self) -> dict[str, Any]:
        """Returns what viser takes: vertices, faces, and how light falls on them. Shared corners are smooth."""
        vertices, faces = soup(self.triangles)
        if self.smooth:
            _, first, corners = np.unique(vertices.round(_SAME), axis=0, return_index=True, return_inverse=True)
            vertices, faces = vertices[first], corners.reshape(-1, 3)
        return {"vertices": vertices, "faces": faces, "flat_shading": not self.smooth}


def surfaces(robot: Robot, meshes: Meshes) -> list[Surface]:
    """Returns the meshes of a robot, and the bodies of its links."""
    colors = dict(zip(robot.all_link_names, cycle(map(rgb, LINKS)), strict=False))
    made = [Surface(link, simplified(mesh.triangles, _MOST), colors[link], is_body=False) for link, mesh in meshes]
    covered = {surface.link for surface in made}
    for body in robot.bodies:
        if getattr(body.shape, "radius", 1.0):  # a rod without thickness has no surface
            color = rgb(SKY if body.link in covered else LINKS[1])  # one colour: neighbours overlap at their joint
            smooth = isinstance(body.shape, _SMOOTH)
            made.append(Surface(body.link, body.shape.triangles, color, body.link in covered, smooth))
    return made


class Links:
    """The links of a robot as frames of a scene, which carry their surfaces.

    Bodies of links that have meshes are drawn only where they are asked for: they enclose the meshes.
    """

    def __init__(self, scene: viser.SceneApi, robot: Robot, meshes: Meshes) -> None:
        """Adds the frames and the surfaces; `place` moves them."""
        self._scene, self._robot = scene, robot
        self._surfaces = surfaces(robot, meshes)
        self._frames = [
            # A slash in a name would make it a child of another link.
            scene.add_frame(f"/robot/{link.replace('/', '|')}", show_axes=False)
            for link in robot.all_link_names
        ]
        self._poses = np.full((len(self._frames), 4, 4), np.nan)
        self._bodies = [handle for surface, handle in self._draw() if surface.is_body]
        self._ghosts: list[Any] = []

    def _draw(self) -> Iterator[tuple[Surface, viser.MeshHandle]]:
        frames = dict(zip(self._robot.all_link_names, self._frames, strict=True))
        for i, surface in enumerate(self._surfaces):
            yield surface, self._scene.add_mesh_simple(
                f"{frames[surface.link].name}/{i}", **surface.mesh(), color=surface.color, side="double",
                opacity=_TRANSLUCENT if surface.is_body else None, visible=not surface.is_body,
            )  # fmt: skip

    def show_bodies(self, shown: bool) -> None:
        """Shows or hides the bodies around the meshes."""
        for handle in self._bodies:
            handle.visible = shown

    def place(self, q: Array) -> None:
        """Moves the links that `q` (n,) moves."""
        poses = self._robot.all_link_poses(q)
        moved = np.flatnonzero((poses != self._poses).any(axis=(1, 2)))
        quaternions = wxyz(poses[moved])
        for i, quaternion in zip(moved, quaternions, strict=True):
            self._frames[i].wxyz = quaternion
            self._frames[i].position = poses[i, :3, 3]
        self._poses = poses

    def show_ghosts(self, configurations: Array) -> None:
        """Draws the robot translucent at configurations (k, n), in place of earlier ghosts; k may be 0."""
        for handle in self._ghosts:
            handle.remove()
        self._ghosts = []
        if not len(configurations):
            return
        poses = np.array([self._robot.all_link_poses(q) for q in configurations])
        for i, surface in enumerate(self._surfaces):
            if surface.is_body:
                continue
            places = poses[:, self._robot.all_link_names.index(surface.link)]
            ghosts = self._scene.add_batched_meshes_simple(
                f"/ghosts/{i}", **surface.mesh(), batched_wxyzs=wxyz(places), batched_positions=places[:, :3, 3],
                batched_colors=rgb(SKY), opacity=_TRANSLUCENT, lod="off", cast_shadow=False,
            )  # fmt: skip
            self._ghosts.append(ghosts)


def soup(triangles: Array) -> tuple[Array, NDArray[np.int64]]:
    """Returns vertices (3 t, 3) and faces (t, 3) of triangles (t, 3, 3)."""
    return triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)


def wxyz(poses: Array) -> Array:
    """Returns the quaternions (..., 4) of poses (..., 4, 4), as viser takes them."""
    from viser.transforms import SO3

    return np.asarray(SO3.from_matrix(poses[..., :3, :3]).wxyz, dtype=np.float64)
