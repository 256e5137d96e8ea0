"""Surfaces as triangle meshes: reads what users have, welds vertices, and gives normals."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import obstacles
from .._core import InvalidInputError, Obstacle
from ..calls.warned import warn
from ..installed.needs import library
from .checks import Array, rows
from .winding import outward

Indices = NDArray[np.int64]

_WELDED = 1e-9  # vertices nearer than this fraction of the diagonal are one
_LARGE = 20.0  # m, diagonal from which millimetres are suspected


class TriangleMesh:
    """Vertices (v, 3) and faces (t, 3) that wind alike, outward where the mesh is closed."""

    def __init__(self, vertices: Array, faces: Indices, *, flip: bool) -> None:
        """Welds equal vertices, drops faces without area, and turns the faces alike, or with `flip` the other way."""
        self.diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
        self.vertices, faces = _welded(vertices, faces, self.diagonal * _WELDED)
        faces = _with_area(self.vertices, faces)
        if not len(faces):
            raise InvalidInputError("surface has no triangle of any area")
        faces, self.closed = outward(self.vertices, faces)
        self.faces = faces[:, ::-1] if flip else faces
        self.triangles = self.vertices[self.faces]
        double_area = np.cross(self.triangles[:, 1] - self.triangles[:, 0], self.triangles[:, 2] - self.triangles[:, 0])
        lengths = np.linalg.norm(double_area, axis=1, keepdims=True)
        self.areas = 0.5 * lengths[:, 0]
        self.normals = double_area / lengths
        # Corners of faces in the order of their vertices, for the faces around a vertex.
        self._around = np.argsort(self.faces, axis=None, kind="stable")
        self._valence = np.bincount(self.faces.ravel(), minlength=len(self.vertices))
        self._first = np.concatenate([[0], np.cumsum(self._valence)[:-1]])

    def normals_at(self, points: Array, faces: Indices, crease: float) -> Array:
        """Returns the outward normals (k, 3) at points (k, 3) on faces (k,), interpolated between those of the corners.

        The normal of a corner is the mean over the faces around its vertex, weighted by their angles, without those
        that turn from the face by more than `crease` (rad): beyond a sharp edge is another surface.
        """
        used, of_point = np.unique(faces, return_inverse=True)
        corners = self._corner_normals(used, crease)[of_point]
        mixed = np.einsum("ki,kij->kj", self._barycentric(points, faces), corners)
        return np.asarray(mixed / np.linalg.norm(mixed, axis=1, keepdims=True), dtype=float)

    def _corner_normals(self, faces: Indices, crease: float) -> Array:
        """Returns the normals (k, 3, 3) at the three corners of faces (k,)."""
        vertices = self.faces[faces].ravel()
        counts = self._valence[vertices]
        ends = np.cumsum(counts)
        position = np.arange(ends[-1]) - np.repeat(ends - counts, counts) + np.repeat(self._first[vertices], counts)
        neighbours, corner = np.divmod(self._around[position], 3)
        own = np.repeat(self.normals[np.repeat(faces, 3)], counts, axis=0)
        weights = self._angles(neighbours, corner)
        weights *= np.einsum("ki,ki->k", self.normals[neighbours], own) >= np.cos(crease) - 1e-12
        sums = np.add.reduceat(weights[:, None] * self.normals[neighbours], ends - counts, axis=0)
        return np.asarray(sums / np.linalg.norm(sums, axis=1, keepdims=True), dtype=float).reshape(-1, 3, 3)

    def _angles(self, faces: Indices, corner: Indices) -> Array:
        """Returns the angles (k,) (rad) of faces at their corners."""
        here = self.triangles[faces, corner]
        one, other = (self.triangles[faces, (corner + turn) % 3] - here for turn in (1, 2))
        across = np.linalg.norm(np.cross(one, other), axis=1)
        return np.asarray(np.arctan2(across, np.einsum("ki,ki->k", one, other)), dtype=float)

    def _barycentric(self, points: Array, faces: Indices) -> Array:
        a, b, c = self.triangles[faces].transpose(1, 0, 2)
        normals, areas = self.normals[faces], 2.0 * self.areas[faces]
        shares = [
            np.einsum("ki,ki->k", np.cross(to - points, onward - points), normals) / areas
            for to, onward in ((b, c), (c, a), (a, b))
        ]
        clipped = np.clip(np.stack(shares, axis=1), 0.0, 1.0)
        return np.asarray(clipped / clipped.sum(axis=1, keepdims=True), dtype=float)


def mesh_of(surface: Any, *, flip: object) -> TriangleMesh:
    """Returns the mesh of what `on_surface` and `raster` take as a surface."""
    if not isinstance(flip, bool):
        raise InvalidInputError(f"flip must be True or False, got {flip!r:.60}")
    vertices, faces = _arrays(surface)
    vertices = rows("surface: vertices", vertices, 3, 3)
    faces = _indices(faces, len(vertices))
    diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    if diagonal > _LARGE:
        warn(f"surface is {diagonal:.4g} m from corner to corner: if its file is in millimetres, scale it by 0.001")
    return TriangleMesh(vertices, faces, flip=flip)


def _arrays(surface: Any) -> tuple[Any, Any]:
    """Returns vertices and faces as given."""
    if isinstance(surface, str | os.PathLike):
        return _read(surface)
    if isinstance(surface, obstacles.Box | obstacles.ConvexMesh):
        corners = np.asarray(surface.triangles).reshape(-1, 3)
        return corners, np.arange(len(corners)).reshape(-1, 3)
    if isinstance(surface, Obstacle) and not isinstance(surface, obstacles.Mesh):
        raise InvalidInputError(
            f"surface: the triangles of a {type(surface).__name__} are only for drawing; make a finer mesh, "
            "for example with trimesh.creation, or give a Box, a ConvexMesh or a Mesh"
        )
    if hasattr(surface, "vertices") and hasattr(surface, "faces"):
        return surface.vertices, surface.faces
    if isinstance(surface, tuple | list) and len(surface) == 2:
        return surface[0], surface[1]
    raise InvalidInputError(
        f"surface must be a file, a mesh of trimesh, a bik.obstacles.Mesh or (vertices, faces), got {surface!r:.60}"
    )


def _read(file: str | os.PathLike[str]) -> tuple[Any, Any]:
    name = os.fspath(file)
    trimesh = library("trimesh", "trimesh", "a surface from a file", extra="surfaces")
    if not os.path.isfile(name):  # noqa: PTH113 - Path raises for names that are too long
        raise InvalidInputError(f"surface: no file '{name:.200}'")
    try:
        mesh = trimesh.load_mesh(name)
        return mesh.vertices, mesh.faces
    except Exception as error:  # trimesh raises errors of any kind on files it cannot read
        raise InvalidInputError(f"surface: trimesh cannot read '{name}': {error}") from error


def _indices(faces: Any, vertices: int) -> Indices:
    try:
        taken = np.array(faces)
    except ValueError:
        raise InvalidInputError("surface: faces must be an array (t, 3) of whole numbers") from None
    if taken.ndim != 2 or taken.shape[1] != 3:
        raise InvalidInputError(f"surface: faces: expected shape (t, 3), got {taken.shape}")
    if not np.issubdtype(taken.dtype, np.integer):
        raise InvalidInputError(f"surface: faces must be whole numbers, indices of vertices, got {taken.dtype}")
    wrong = np.flatnonzero(((taken < 0) | (taken >= vertices)).any(axis=1))
    if len(wrong):
        row = int(wrong[0])
        raise InvalidInputError(f"surface: faces[{row}] is {taken[row].tolist()}, but there are {vertices} vertices")
    return taken.astype(np.int64)


def _welded(vertices: Array, faces: Indices, size: float) -> tuple[Array, Indices]:
    """Makes vertices in the same cell of a fine grid one: files of triangles repeat them."""
    cells = np.round((vertices - vertices.min(axis=0)) / (size or 1.0)).astype(np.int64)
    _, first, inverse = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    return vertices[first], inverse.reshape(-1)[faces]


def _with_area(vertices: Array, faces: Indices) -> Indices:
    """Leaves out triangles that are lines or points."""
    a, b, c = vertices[faces].transpose(1, 0, 2)
    longest = np.max([np.linalg.norm(q - p, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return np.asarray(faces[area > 1e-12 * longest**2])
