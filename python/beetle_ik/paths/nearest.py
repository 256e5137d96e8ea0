"""Nearest points of a triangle mesh."""

import numpy as np

from ..installed.needs import library
from .checks import Array
from .triangle_mesh import Indices, TriangleMesh

_BLOCK = 64  # points that share one look at all triangles
_SLACK = 1e-9  # of the diagonal, for rounding


def nearest(mesh: TriangleMesh, points: Array) -> tuple[Array, Indices]:
    """Returns the nearest points (k, 3) of the mesh, and the faces (k,) they are on.

    Triangles are bounded by balls. Those whose ball is nearer to a block of points than the farthest end of another
    are candidates; of these each point takes its own, and trimesh finds the nearest point of each.
    """
    centers = mesh.triangles.mean(axis=1)
    radii = np.linalg.norm(mesh.triangles - centers[:, None], axis=2).max(axis=1)
    found = [_of_block(mesh, block, centers, radii) for block in np.array_split(points, -(-len(points) // _BLOCK))]
    return np.concatenate([at for at, _ in found]), np.concatenate([face for _, face in found])


def _of_block(mesh: TriangleMesh, points: Array, centers: Array, radii: Array) -> tuple[Array, Indices]:
    slack = _SLACK * mesh.diagonal
    middle = points.mean(axis=0)
    reach = np.linalg.norm(points - middle, axis=1).max()
    distances = np.linalg.norm(centers - middle, axis=1)
    near = np.flatnonzero(distances - radii <= (distances + radii).min() + 2.0 * reach + slack)
    apart = np.linalg.norm(points[:, None] - centers[near], axis=2)
    candidates = apart - radii[near] <= (apart + radii[near]).min(axis=1, keepdims=True) + slack
    row, column = np.nonzero(candidates)
    faces = near[column]
    closest_point = library("trimesh.triangles", "trimesh", "a line on a surface", extra="surfaces").closest_point
    at = np.asarray(closest_point(mesh.triangles[faces], points[row]), dtype=float)
    order = np.lexsort((np.linalg.norm(at - points[row], axis=1), row))
    best = order[np.searchsorted(row[order], np.arange(len(points)))]
    return at[best], faces[best]
