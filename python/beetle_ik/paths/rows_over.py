"""Planes that cut a surface in rows, equally far apart along it."""

import math

import numpy as np

from .._core import InvalidInputError
from .checks import Array
from .section import cut, on_edges
from .triangle_mesh import Indices, TriangleMesh

_SLICES = 256  # at which the surface between planes is measured
_MOST_ROWS = 10_000
_FLATTEST = 1e-3  # slope of a face towards the planes that counts, so that none makes a distance infinite


def offsets_over(mesh: TriangleMesh, faces: Indices, across: Array, spacing: float, inset: float) -> Array:
    """Returns the offsets along `across` of planes whose rows on the faces (t,) are at most `spacing` apart (m).

    The first and the last row are `inset` from the border. Between planes dc apart, the distance along a face is dc
    over its slope; the mean of that along the section counts.
    """
    heights = mesh.vertices @ across
    low, high = float(heights[mesh.faces[faces]].min()), float(heights[mesh.faces[faces]].max())
    if high - low < 1e-9 * mesh.diagonal:
        raise InvalidInputError("the covered part of the surface has no width across direction=")
    # Slices are thinner towards both ends, where a round surface falls away.
    bounds = low + 0.5 * (high - low) * (1.0 - np.cos(np.linspace(0.0, np.pi, _SLICES + 1)))
    slope = np.maximum(np.sqrt(np.maximum(1.0 - (mesh.normals @ across) ** 2, 0.0)), _FLATTEST)
    middles = 0.5 * (bounds[:-1] + bounds[1:])
    stretch = np.array([_mean_stretch(mesh, heights - middle, faces, slope) for middle in middles])
    along = np.concatenate([[0.0], np.cumsum(stretch * np.diff(bounds))])
    length = float(along[-1])
    covered = length - 2.0 * inset
    if covered / spacing > _MOST_ROWS:
        needed = f"{covered / spacing:.3g} rows over {covered:.4g} m"
        raise InvalidInputError(f"spacing: {spacing:g} m would make {needed}; at most {_MOST_ROWS:,} are made")
    count = 1 + max(0, math.ceil(covered / spacing * (1.0 - 1e-9)))
    at = np.linspace(inset, length - inset, count) if covered > 0.0 else np.array([0.5 * length])
    edge = 1e-9 * (high - low)  # a plane in the border cuts nothing
    return np.asarray(np.clip(np.interp(at, along, bounds), low + edge, high - edge))


def _mean_stretch(mesh: TriangleMesh, heights: Array, faces: Indices, slope: Array) -> float:
    """Returns the mean of 1 / slope (t,) over a section, by its length; 0 where nothing is cut."""
    starts, ends, of_line = cut(mesh, heights, faces)
    lengths = np.linalg.norm(on_edges(mesh, heights, ends) - on_edges(mesh, heights, starts), axis=1)
    total = float(lengths.sum())
    return float(lengths @ (1.0 / slope[of_line])) / total if total > 0.0 else 0.0
