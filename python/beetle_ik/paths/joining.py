"""One line of several, with transitions in between."""

import itertools
import os
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._core import InvalidInputError, Obstacle
from ..calls.arguments import require
from ..calls.wording import worded_call
from .checks import Array, number
from .frames_along import CREASE, Style, frames_along
from .nearest import nearest
from .projection import ROUNDED, STEPS, projected
from .seam import Seam, seam_of
from .triangle_mesh import TriangleMesh, mesh_of


@worded_call
def join(
    seams: Iterable[Seam],
    *,
    lift: float = 0.0,
    surface: str | os.PathLike[str] | Obstacle | tuple[ArrayLike, ArrayLike] | Any | None = None,
) -> Seam:
    """Joins seams, such as the passes of `raster`, to one, in their order.

    At the end of a seam the tool leaves the surface by `lift` along its axis, goes straight to above the next one while
    it turns, and comes down. With a `surface` it stays on it instead, on the shortest way that a straight line projects
    to. With neither it goes straight from end to start, which leads into a curved surface. `contact` is False on the
    way.

    Args:
        seams: seams, at least one.
        lift: distance by which the tool leaves the surface in between (m).
        surface: the surface to follow in between, as for `on_surface`; None: none.

    Raises:
        InvalidInputError: no seam, something else among them, both `lift` and `surface`, or a transition over a gap of
            the surface.
        BeetleIkError: trimesh is not installed, and there is a surface.
    """
    require("seams", seams, Iterable)
    parts = list(seams)
    if not parts:
        raise InvalidInputError("seams: at least one is needed, got none")
    for i, part in enumerate(parts):
        require(f"seams[{i}]", part, Seam)
    height = number("lift", lift)
    if surface is not None and height > 0.0:
        raise InvalidInputError("lift and surface: give one of them, a tool that lifts off or one that stays on it")
    mesh = None if surface is None else _facing(surface, parts[0].poses[0])
    ways = []
    for i, (before, after) in enumerate(itertools.pairwise(parts)):
        ends = np.stack([before.poses[-1], after.poses[0]])
        try:
            ways.append(_lifted(ends, height) if mesh is None else _along(mesh, ends))
        except InvalidInputError as error:
            raise InvalidInputError(f"between seams[{i}] and seams[{i + 1}]: {error}; or give lift=") from None
    return _joined(parts, ways)


def _joined(parts: list[Seam], ways: list[Array]) -> Seam:
    """Returns seams with the poses (k, 4, 4) of the way after each but the last."""
    poses, contact, edges, travelled = [parts[0].poses], [parts[0].contact], [parts[0].edges], parts[0].length
    for (before, after), way in zip(itertools.pairwise(parts), ways, strict=True):
        # Poses at the same point are one: a seam that begins where the last one ends.
        first = 1 if not len(way) and np.array_equal(before.poses[-1], after.poses[0]) else 0
        corners = np.concatenate([before.poses[-1:], way, after.poses[:1]])[:, :3, 3]
        travelled += float(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum())
        poses += [way, after.poses[first:]]
        contact += [np.zeros(len(way), dtype=bool), after.contact[first:]]
        edges.append(after.edges + travelled)
        travelled += after.length
    return seam_of(np.concatenate(poses), np.concatenate(contact), np.concatenate(edges), closed=False)


def _lifted(ends: Array, height: float) -> Array:
    """Returns poses (2, 4, 4) above both ends; none (0, 4, 4) without a lift."""
    over = ends.copy()
    over[:, :3, 3] -= height * over[:, :3, 2]
    return over if height > 0.0 else over[:0]


def _facing(surface: Any, tool: Array) -> TriangleMesh:
    """Returns the mesh of a surface, turned to the side from which the tool (4, 4) comes."""
    mesh = mesh_of(surface, flip=False)
    _, (face,) = nearest(mesh, tool[None, :3, 3])
    return mesh if mesh.normals[face] @ tool[:3, 2] <= 0.0 else mesh_of(surface, flip=True)


def _along(mesh: TriangleMesh, ends: Array) -> Array:
    """Returns poses (k, 4, 4) over the mesh between two poses, at their distances from it; x turns evenly."""
    places, step = ends[:, :3, 3], mesh.diagonal / STEPS
    feet, _ = nearest(mesh, places)
    if np.linalg.norm(feet[1] - feet[0]) < step:
        return ends[:0]
    at, faces = projected(mesh, feet, step, within=np.inf)
    style = Style(0.0, CREASE, ROUNDED * step, 0.0, 0.0, "normal")
    way = frames_along(at, mesh.normals_at(at, faces, CREASE), style, closed=False)
    # Angle of each end's x axis from the direction of the way, about the tool's axis.
    x, y = (np.einsum("ki,ki->k", way.poses[[0, -1], :3, axis], ends[:, :3, 0]) for axis in range(2))
    share = (way.distance / way.length)[:, None]
    start, end = np.arctan2(y, x)
    turn = start + share * (np.remainder(end - start + np.pi, 2.0 * np.pi) - np.pi)
    poses = way.poses.copy()
    poses[:, :3, 0] = np.cos(turn) * way.poses[:, :3, 0] + np.sin(turn) * way.poses[:, :3, 1]
    poses[:, :3, 1] = np.cross(poses[:, :3, 2], poses[:, :3, 0])
    standoff = np.linalg.norm(places - feet, axis=1)
    poses[:, :3, 3] -= (standoff[0] + share * (standoff[1] - standoff[0])) * poses[:, :3, 2]
    return poses[1:-1]
