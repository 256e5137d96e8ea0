"""Nearest points of a triangle mesh."""

import math

import numpy as np

from ..installed.needs import library
from .checks import Array
from .triangle_mesh import Indices, TriangleMesh

_BLOCK = 8  # points that share their candidates
_SLACK = 1e-9  # of the diagonal, for rounding


def nearest(mesh: TriangleMesh, points: Array) -> tuple[Array, Indices]:
    """Returns the nearest points (k, 3) of the mesh, and the faces (k,) they are on.

    Points that follow each other are near each other: the candidates of a block of them are found among those of the
    block twice as long. trimesh finds the nearest point of each candidate.
    """
    closest_point = library("trimesh", "trimesh", "a line on a surface", extra="surfaces").triangles.closest_point
    centers = mesh.triangles.mean(axis=1)
    balls = np.column_stack([centers, np.linalg.norm(mesh.triangles - centers[:, None], axis=2).max(axis=1)])
    pairs = _candidates(balls, points, np.arange(len(points)), np.arange(len(balls)), _SLACK * mesh.diagonal)
    row, faces = (np.concatenate(part) for part in zip(*pairs, strict=True))
    size = 2.0 ** round(math.log2(mesh.diagonal))  # trimesh has absolute tolerances; a power of two rounds nothing
    at = size * np.asarray(closest_point(mesh.triangles[faces] / size, points[row] / size), dtype=float)
    order = np.lexsort((np.linalg.norm(at - points[row], axis=1), row))
    best = order[np.searchsorted(row[order], np.arange(len(points)))]
    return at[best], faces[best]


def _candidates(
    balls: Array, points: Array, block: Indices, faces: Indices, slack: float
) -> list[tuple[Indices, Indices]]:
    """Returns pairs of points of the block and faces, among them the nearest face of each point.

    Triangles are inside of balls (t, 4): centre and radius. One whose ball begins farther away than another ends is
    not the nearest, and for a block not if it is farther by the diameter of the block.
    """
    middle = points[block].mean(axis=0)
    reach = np.sqrt(((points[block] - middle) ** 2).sum(axis=1).max())
    apart, radii = np.sqrt(((balls[faces, :3] - middle) ** 2).sum(axis=1)), balls[faces, 3]
    faces = faces[apart - radii <= (apart + radii).min() + 2.0 * reach + slack]
    if len(block) > _BLOCK:
        halves = np.array_split(block, 2)
        return [pair for half in halves for pair in _candidates(balls, points, half, faces, slack)]
    apart, radii = np.linalg.norm(points[block][:, None] - balls[faces, :3], axis=2), balls[faces, 3]
    row, column = np.nonzero(apart - radii <= (apart + radii).min(axis=1, keepdims=True) + slack)
    return [(block[row], faces[column])]
