"""Winding of triangles: turned alike across their edges, and outward where the mesh is closed."""

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInputError

Faces = NDArray[np.int64]


def outward(vertices: NDArray[np.float64], faces: Faces) -> tuple[Faces, bool]:
    """Returns the faces turned alike, and whether the whole mesh is closed.

    Faces that share an edge of two faces belong to one part. A closed part is turned outward. An open part keeps the
    winding of most of its faces, since it has no inside.
    """
    pairs, against, bordered = _across_edges(faces, len(vertices))
    turned, part = _walk(len(faces), pairs, against)
    if (turned[pairs[:, 0]] ^ turned[pairs[:, 1]] != against).any():
        raise InvalidInputError("surface has one side only, like a Moebius strip: cut it, so that it has an outside")
    faces = np.where(turned[:, None], faces[:, ::-1], faces)
    a, b, c = (vertices - vertices.mean(axis=0))[faces].transpose(1, 0, 2)
    volume = np.bincount(part, np.einsum("ki,ki->k", a, np.cross(b, c)))
    is_open = np.bincount(part, bordered) > 0
    mostly_turned = np.bincount(part, np.where(turned, 1.0, -1.0)) > 0
    inside_out = np.where(is_open, mostly_turned, volume < 0)
    return np.where(inside_out[part][:, None], faces[:, ::-1], faces), not is_open.any()


def _across_edges(faces: Faces, vertices: int) -> tuple[Faces, NDArray[np.bool_], NDArray[np.bool_]]:
    """Returns pairs of faces (p, 2) on one edge, whether they wind differently, and which faces have a border."""
    starts, ends = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    keys = np.minimum(starts, ends) * vertices + np.maximum(starts, ends)
    order = np.argsort(keys, kind="stable")
    _, first, counts = np.unique(keys[order], return_index=True, return_counts=True)
    one, other = order[first[counts == 2]], order[first[counts == 2] + 1]
    bordered = np.zeros(len(faces), dtype=bool)
    bordered[order[np.repeat(counts != 2, counts)] // 3] = True
    return np.stack([one, other], axis=1) // 3, starts[one] == starts[other], bordered


def _walk(count: int, pairs: Faces, against: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], Faces]:
    """Returns which faces to turn so that each part winds alike, and the part of each face: a search in breadth."""
    here, there = np.concatenate([pairs, pairs[:, ::-1]]).T
    order = np.argsort(here, kind="stable")
    there, differs = there[order], np.concatenate([against, against])[order]
    bounds = np.searchsorted(here[order], np.arange(count + 1))
    turned, part, parts = np.zeros(count, dtype=bool), np.full(count, -1), 0
    for seed in range(count):
        if part[seed] >= 0:
            continue
        part[seed], wave, parts = parts, np.array([seed]), parts + 1
        while len(wave):
            counts = bounds[wave + 1] - bounds[wave]
            ends = np.cumsum(counts)
            edges = np.arange(ends[-1]) - np.repeat(ends - counts - bounds[wave], counts)
            wanted = np.repeat(turned[wave], counts) ^ differs[edges]
            new, first = np.unique(there[edges], return_index=True)
            unseen = part[new] < 0
            turned[new[unseen]] = wanted[first[unseen]]
            part[new[unseen]] = part[seed]
            wave = new[unseen]
    return turned, part
