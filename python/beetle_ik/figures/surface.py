"""Draws shaded triangles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Triangles = NDArray[np.float64]

_MOST = 30_000  # triangles of a figure: matplotlib takes a second for them
_LIGHT = np.array([-0.35, -0.55, 0.76])  # light from the upper left, in front of the default view
_DARKEST = 0.35  # brightness of a face turned away from the light
_EMPTY = 1e-15  # m^2: smaller faces are left out


class Surface(NamedTuple):
    """Triangles (t, 3, 3) (m) of one colour."""

    triangles: Triangles
    color: str
    alpha: float = 1.0


def draw_surfaces(axes: Any, surfaces: Sequence[Surface]) -> None:
    """Draws surfaces in 3-D axes. matplotlib sorts faces by depth within a collection only: all of them are in one."""
    from matplotlib.colors import to_rgba
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # type: ignore[import-untyped, unused-ignore]

    total = sum(len(surface.triangles) for surface in surfaces)
    drawn, colors = [], []
    for surface in surfaces:
        share = max(200, _MOST * len(surface.triangles) // max(total, 1))
        faces, shades = _shaded(simplified(surface.triangles, share))
        color = np.tile(to_rgba(surface.color, surface.alpha), (len(faces), 1))
        color[:, :3] *= shades[:, None]
        drawn.append(faces)
        colors.append(color)
    if sum(len(faces) for faces in drawn):
        # Edges in the colours of the faces close the gaps between them.
        faces, face_colors = np.concatenate(drawn), np.concatenate(colors)
        opaque = bool((face_colors[:, 3] == 1.0).all())
        edges: Any = {"edgecolors": face_colors, "linewidths": 0.3} if opaque else {"linewidths": 0}
        axes.add_collection3d(Poly3DCollection(faces, facecolors=face_colors, **edges))


def _shaded(triangles: Triangles) -> tuple[Triangles, NDArray[np.float64]]:
    """Returns the triangles that have an area, and the brightness of each."""
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    area = np.linalg.norm(across, axis=1)
    seen = area > _EMPTY
    toward = (across[seen] / area[seen, None]) @ (_LIGHT / np.linalg.norm(_LIGHT))
    return triangles[seen], _DARKEST + (1 - _DARKEST) * (0.5 + 0.5 * toward)


def simplified(triangles: Triangles, most: int) -> Triangles:
    """Returns about `most` triangles or fewer: corners in one cell of a grid merge, and faces that collapse vanish."""
    if len(triangles) <= most:
        return triangles
    low, size = triangles.min(axis=(0, 1)), float(np.ptp(triangles, axis=(0, 1)).max())
    cells = 256
    while cells > 4:
        kept = _clustered(triangles, low, size / cells)
        if len(kept) <= most:
            return kept
        cells = int(cells / 1.4)
    return kept


def _clustered(triangles: Triangles, low: NDArray[np.float64], cell: float) -> Triangles:
    corners = triangles.reshape(-1, 3)
    places = np.floor((corners - low) / max(cell, 1e-12)).astype(np.int64)
    _, index, counts = np.unique(places, axis=0, return_inverse=True, return_counts=True)
    index = index.ravel()
    means = np.stack([np.bincount(index, corners[:, k]) for k in range(3)], axis=1) / counts[:, None]
    faces = index.reshape(-1, 3)
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    faces = faces[whole]
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return np.asarray(means[faces[np.sort(first)]])
