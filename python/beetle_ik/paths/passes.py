"""Parallel passes over a surface."""

import math
import os
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._core import InvalidInputError, Obstacle
from ..calls.wording import worded_call
from .checks import Array, number, require_count
from .checks import direction as unit
from .frames_along import CREASE, Style, frames_along
from .projection import ROUNDED, STEPS
from .rows_over import offsets_over
from .seam import Seam
from .section import Curve, sections
from .triangle_mesh import Indices, TriangleMesh, mesh_of

_FACING = 1e-6  # cosine by which a face must look towards the tool, so that walls do not count
_TOUCHING = 1e-8  # of the diagonal: pieces that end and begin so near are one
_KEPT = 0.1  # of a pass that is shorter than its insets


@worded_call
def raster(
    surface: str | os.PathLike[str] | Obstacle | tuple[ArrayLike, ArrayLike] | Any,
    *,
    spacing: float,
    direction: ArrayLike,
    standoff: float = 0.0,
    side: ArrayLike | None = None,
    steepest: float = math.pi / 2,
    inset: float | None = None,
    step: float | None = None,
    crease: float = CREASE,
    rounding: float | None = None,
    flip: bool = False,
) -> list[Seam]:
    """Covers a surface with parallel passes, for polishing, spraying or scanning.

    Parallel planes cut the surface; each piece of a section is a pass, so that a hole divides one into two. Passes are
    in the order of travel: every second row runs backwards. The distance between rows along the surface is at most
    `spacing`, in the mean over a row, and the same everywhere: planes are closer together where the surface is steep.
    `bik.paths.join` makes one line of the passes.

    Args:
        surface: as for `on_surface`.
        spacing: distance between rows along the surface (m).
        direction: direction (3,) of the first row; the part along `side` is left out.
        standoff: distance of the tip from the surface, along the tool's axis (m).
        side: direction (3,) from the part to the tool, away from the surface. Faces that look that way are covered.
            None: the mean normal of an open surface, and from above, (0, 0, 1), for a closed one.
        steepest: largest angle between a covered face's normal and `side` (rad). The default covers all that looks
            towards the tool, up to vertical walls; np.pi covers everything.
        inset: distance of the passes from the border of the covered surface and from its holes (m); None: half the
            spacing. A pass that is too short for it keeps its middle tenth.
        step: largest distance between poses (m); None: a 200th of the surface's diagonal.
        crease: angle between neighbouring faces (rad) from which their edge is sharp.
        rounding: length along a pass before and after a sharp edge in which the tool turns (m); None: five steps.
        flip: whether the tool comes from the other side of an open surface.

    Returns:
        A list of `Seam`, one for each pass.

    Raises:
        InvalidInputError: a surface that is none or has one side only, a file that cannot be read, NaN, a direction
            along `side`, no face that looks towards it, or no `side` for a surface that looks to all sides.
        BeetleIkError: trimesh is not installed, and the surface is a file.

    For example:

        >>> table = bik.obstacles.Box((0.5, 0.0, 0.1), (0.4, 0.4, 0.2))
        >>> passes = bik.paths.raster(table, spacing=0.1, direction=(1, 0, 0), side=(0, 0, 1))
        >>> [round(float(row.poses[0, 1, 3]), 3) for row in passes]
        [-0.15, -0.05, 0.05, 0.15]
        >>> bik.paths.join(passes, lift=0.02)
        Seam(410 poses, 1.62 m)
    """
    mesh = mesh_of(surface, flip=flip)
    pitch = number("spacing", spacing, above=True)
    every = mesh.diagonal / STEPS if step is None else number("step", step, above=True)
    style = Style(
        standoff=number("standoff", standoff),
        crease=number("crease", crease, most=math.pi),
        rounding=ROUNDED * every if rounding is None else number("rounding", rounding),
        lead_in=0.0,
        lead_out=0.0,
        lead="normal",
    )
    border = pitch / 2.0 if inset is None else number("inset", inset)
    up = _side(mesh, side)
    forward, across = _axes(direction, up)
    faces = _covered(mesh, up, number("steepest", steepest, most=math.pi))
    passes = []
    for row, offset in enumerate(offsets_over(mesh, faces, across, pitch, border)):
        pieces = [_oriented(curve, forward) for curve in sections(mesh, across, offset, faces)]
        pieces.sort(key=lambda curve: float(curve.points[0] @ forward))
        pieces = _connected(pieces, _TOUCHING * mesh.diagonal)
        for curve in pieces if row % 2 == 0 else [_reversed(curve) for curve in reversed(pieces)]:
            at, on = _sampled(curve, every, 0.0 if curve.closed else border)
            passes.append(frames_along(at, mesh.normals_at(at, on, style.crease), style, closed=curve.closed))
    if not passes:
        raise InvalidInputError("no plane cuts the covered part of the surface: choose another direction=")
    return passes


def _side(mesh: TriangleMesh, side: ArrayLike | None) -> Array:
    if side is not None:
        return unit("side", side)
    if mesh.closed:
        return np.array([0.0, 0.0, 1.0])
    mean = mesh.areas @ mesh.normals
    if np.linalg.norm(mean) < 1e-6 * mesh.areas.sum():
        raise InvalidInputError("side= is needed: the normals of the surface point to all sides")
    return unit("side", mean)


def _axes(direction: ArrayLike, up: Array) -> tuple[Array, Array]:
    """Returns the direction of the rows, perpendicular to `up`, and the direction from row to row."""
    asked = unit("direction", direction)
    forward = asked - (asked @ up) * up
    if np.linalg.norm(forward) < 1e-6:
        raise InvalidInputError(
            f"direction is along side= {up.round(6).tolist()}, from which the tool comes: rows run across it"
        )
    forward = unit("direction", forward)
    return forward, np.cross(up, forward)


def _covered(mesh: TriangleMesh, up: Array, steepest: float) -> Indices:
    least = math.cos(steepest)
    faces = np.flatnonzero(mesh.normals @ up > (_FACING if abs(least) < _FACING else least - 1e-9))
    if not len(faces):
        raise InvalidInputError(
            f"no face of the surface looks towards side= {up.round(6).tolist()}: choose another, or flip=True for an "
            "open surface that winds the other way"
        )
    return faces


def _oriented(curve: Curve, forward: Array) -> Curve:
    """Returns a section that runs forward; a closed one begins at its rearmost point."""
    if not curve.closed:
        return _reversed(curve) if (curve.points[-1] - curve.points[0]) @ forward < 0.0 else curve
    first = int((curve.points[:-1] @ forward).argmin())
    points = np.roll(curve.points[:-1], -first, axis=0)
    return Curve(np.concatenate([points, points[:1]]), np.roll(curve.faces, -first), True)


def _connected(pieces: list[Curve], gap: float) -> list[Curve]:
    """Joins pieces that meet end to start: where triangles meet at a part of an edge, their section is in two."""
    whole: list[Curve] = []
    for curve in pieces:
        last = whole[-1] if whole else curve
        if whole and not last.closed and np.linalg.norm(last.points[-1] - curve.points[0]) <= gap:
            whole[-1] = Curve(
                np.concatenate([last.points[:-1], curve.points]), np.append(last.faces, curve.faces), False
            )
        else:
            whole.append(curve)
    return whole


def _reversed(curve: Curve) -> Curve:
    return Curve(curve.points[::-1], curve.faces[::-1], curve.closed)


def _sampled(curve: Curve, step: float, inset: float) -> tuple[Array, Indices]:
    """Returns points (m, 3) of a section at equal distances along it, away from its ends, and their faces (m,)."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve.points, axis=0), axis=1))])
    left_out = min(inset, 0.5 * (1.0 - _KEPT) * along[-1])
    length = float(along[-1]) - 2.0 * left_out
    require_count("step", step, length / step)
    at = np.linspace(left_out, along[-1] - left_out, max(2, math.ceil(length / step * (1.0 - 1e-12)) + 1))
    line = np.clip(np.searchsorted(along, at, side="right") - 1, 0, len(curve.faces) - 1)
    points = np.stack([np.interp(at, along, column) for column in curve.points.T], axis=1)
    return points, curve.faces[line]
