"""Sections of a triangle mesh by planes, chained along shared edges."""

from typing import NamedTuple

import numpy as np

from .checks import Array
from .triangle_mesh import Indices, TriangleMesh


class Curve(NamedTuple):
    """A section without gaps: points (k, 3), the face (k - 1,) of each of its lines, and whether it closes."""

    points: Array
    faces: Indices
    closed: bool


class Cut(NamedTuple):
    """Lines in which a plane cuts faces: the edges (k, 2) on which each begins and ends, and its face (k,)."""

    starts: Indices
    ends: Indices
    faces: Indices


def cut(mesh: TriangleMesh, heights: Array, faces: Indices) -> Cut:
    """Returns the lines in which a plane cuts some faces (t,), for the heights (v,) of all vertices above it.

    A vertex in the plane counts as above it, so that a face crosses the plane in two edges or not at all, and no case
    is special. All faces wind alike: lines of neighbours meet end to start, on an edge known by its vertices.
    """
    above = (heights >= 0.0)[mesh.faces[faces]]
    count = above[:, 0].astype(np.int8) + above[:, 1] + above[:, 2]
    crossing = np.flatnonzero((count == 1) | (count == 2))
    above = above[crossing]
    # The corner that is alone on its side, and the other two in the order of winding.
    alone_above = count[crossing] == 1
    alone = np.where(alone_above, above.argmax(axis=1), above.argmin(axis=1))
    turn = (alone[:, None] + np.arange(3)) % 3
    corners = np.take_along_axis(mesh.faces[faces[crossing]], turn, axis=1)
    one, other = np.sort(corners[:, [0, 1]], axis=1), np.sort(corners[:, [0, 2]], axis=1)
    starts = np.where(alone_above[:, None], one, other)
    ends = np.where(alone_above[:, None], other, one)
    return Cut(starts, ends, faces[crossing])


def on_edges(mesh: TriangleMesh, heights: Array, edges: Indices) -> Array:
    """Returns the points (k, 3) at height 0 on edges (k, 2)."""
    low, high = heights[edges].T
    share = (low / (low - high))[:, None]
    return np.asarray((1.0 - share) * mesh.vertices[edges[:, 0]] + share * mesh.vertices[edges[:, 1]], dtype=float)


def sections(mesh: TriangleMesh, normal: Array, offset: float, faces: Indices) -> list[Curve]:
    """Returns the section of some faces (t,) by the plane of points x with normal . x = offset."""
    heights = mesh.vertices @ normal - offset
    starts, ends, of_line = cut(mesh, heights, faces)
    if not len(of_line):
        return []
    edges, inverse = np.unique(np.concatenate([starts, ends]), axis=0, return_inverse=True)
    points = on_edges(mesh, heights, edges)
    start, end = inverse.reshape(2, -1)
    curves = []
    for lines in _chains(start, end, len(edges)):
        at = np.append(start[lines], end[lines[-1]])
        curves.append(_without_points(points[at], of_line[lines], closed=bool(at[0] == at[-1])))
    return [curve for curve in curves if len(curve.faces)]


def _chains(start: Indices, end: Indices, count: int) -> list[list[int]]:
    """Returns lines in the order in which they follow each other: open chains first, then closed ones."""
    line_at = np.full(count, -1)
    line_at[start] = np.arange(len(start))
    has_before = np.zeros(count, dtype=bool)
    has_before[end] = True
    used = np.zeros(len(start), dtype=bool)
    chains = []
    for first in np.concatenate([np.flatnonzero(~has_before[start]), np.arange(len(start))]):
        chain, line = list[int](), int(first)
        while line >= 0 and not used[line]:
            used[line] = True
            chain.append(line)
            line = int(line_at[end[line]])
        if chain:
            chains.append(chain)
    return chains


def _without_points(points: Array, faces: Indices, *, closed: bool) -> Curve:
    """Leaves out lines without length, which a plane through a vertex makes."""
    long = np.linalg.norm(np.diff(points, axis=0), axis=1) > 0.0
    return Curve(points[np.append(True, long)], faces[long], closed)
