"""Lines projected onto a surface."""

import math
import os
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from .._core import InvalidInputError, Obstacle
from ..calls.wording import worded_call
from .checks import Array, choice, number, require_count, rows
from .frames_along import CREASE, Style, frames_along
from .nearest import nearest
from .seam import Seam
from .triangle_mesh import Indices, TriangleMesh, mesh_of

STEPS = 200  # poses over the diagonal of the surface, by default
ROUNDED = 5  # steps before and after an edge, by default
_HALVINGS = 8  # of a line whose projection jumps
_GAP = 4.0  # steps that a projection may jump
_WITHIN = 0.1  # of the diagonal of the surface, by default


@worded_call
def on_surface(
    surface: str | os.PathLike[str] | Obstacle | tuple[ArrayLike, ArrayLike] | Any,
    points: ArrayLike,
    *,
    standoff: float = 0.0,
    step: float | None = None,
    closed: bool = False,
    lead_in: float = 0.0,
    lead_out: float = 0.0,
    lead: Literal["normal", "tangent"] = "normal",
    crease: float = CREASE,
    rounding: float | None = None,
    flip: bool = False,
    within: float | None = None,
) -> Seam:
    """Projects a line onto a surface, and returns poses of the tool along it.

    The line through `points` is divided every `step`, and each point moved to the nearest one of the surface. There
    the tool's z axis points into the surface, and its x axis along the line. Normals are interpolated between the
    corners of the triangles, so that they turn smoothly over a curved surface. Across a sharp edge they are not: there
    the tool turns gradually, from `rounding` before the edge to `rounding` after it, while its tip stays on the
    surface. It does the same at sharp corners of the line.

    Args:
        surface: a file that trimesh reads, in metres; a mesh of trimesh; a `Mesh`, `ConvexMesh` or `Box` of
            `bik.obstacles`; or (vertices (v, 3) (m), faces (t, 3)); in the frame of the robot's base. Faces that wind
            against their neighbours are turned; closed parts are turned outward.
        points: points (k, 3) (m) near the surface, joined by straight lines.
        standoff: distance of the tip from the surface, along the tool's axis (m).
        step: largest distance between poses, measured along the given line (m); None: a 200th of the surface's
            diagonal.
        closed: whether the line returns to its first point; its last pose then equals the first.
        lead_in: length of the straight approach before the line (m).
        lead_out: length of the straight departure after the line (m).
        lead: direction of both, along the surface's "normal" or the line's "tangent".
        crease: angle between neighbouring faces (rad) from which their edge is sharp.
        rounding: length along the line before and after a sharp edge or corner in which the tool turns (m); 0: at once,
            None: five steps.
        flip: whether the tool comes from the other side of the surface.
        within: largest distance of `points` from the surface (m); None: a tenth of the surface's diagonal.

    Returns:
        A `Seam`.

    Raises:
        InvalidInputError: a surface that is none or has one side only, a file that cannot be read, NaN, points that are
            all the same or too far from the surface, or a line whose projection jumps.
        BeetleIkError: trimesh is not installed.

    For example:

        >>> table = bik.obstacles.Box((0.5, 0.0, 0.1), (0.4, 0.4, 0.2))
        >>> seam = bik.paths.on_surface(table, [(0.4, 0.0, 0.2), (0.6, 0.0, 0.2)], standoff=0.01)
        >>> seam
        Seam(68 poses, 0.2 m)
        >>> seam.poses[0, [0, 2], 3].round(6).tolist(), seam.poses[0, :3, 2].round(6).tolist()
        ([0.4, 0.21], [0.0, 0.0, -1.0])
    """
    mesh = mesh_of(surface, flip=flip)
    line = rows("points", points, 3, 2)
    if not isinstance(closed, bool):
        raise InvalidInputError(f"closed must be True or False, got {closed!r:.60}")
    spacing = mesh.diagonal / STEPS if step is None else number("step", step, above=True)
    style = Style(
        standoff=number("standoff", standoff),
        crease=number("crease", crease, most=math.pi),
        rounding=ROUNDED * spacing if rounding is None else number("rounding", rounding),
        lead_in=number("lead_in", lead_in),
        lead_out=number("lead_out", lead_out),
        lead=choice("lead", lead, "normal", "tangent"),
    )
    reach = _WITHIN * mesh.diagonal if within is None else number("within", within)
    at, faces = projected(mesh, np.concatenate([line, line[:1]]) if closed else line, spacing, reach)
    return frames_along(at, mesh.normals_at(at, faces, style.crease), style, closed=closed)


def projected(mesh: TriangleMesh, line: Array, step: float, within: float) -> tuple[Array, Indices]:
    """Returns points (m, 3) on the mesh along a line, no two the same, and their faces (m,)."""
    lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
    require_count("step", step, float(lengths.sum()) / step)
    counts = np.maximum(1, np.ceil(lengths / step * (1.0 - 1e-12)).astype(int))
    # Where along the line, in units of its pieces.
    where = np.append(
        np.repeat(np.arange(len(counts)), counts) + np.concatenate([np.arange(n) / n for n in counts]), len(counts)
    )
    at, faces = nearest(mesh, _along(line, where))
    _require_near(line, at[np.append(0, np.cumsum(counts))], within)
    for _ in range(_HALVINGS):
        wide = np.flatnonzero(np.linalg.norm(np.diff(at, axis=0), axis=1) > _GAP / 2.0 * step)
        if not len(wide):
            break
        between = 0.5 * (where[wide] + where[wide + 1])
        new_at, new_faces = nearest(mesh, _along(line, between))
        where = np.insert(where, wide + 1, between)
        at, faces = np.insert(at, wide + 1, new_at, axis=0), np.insert(faces, wide + 1, new_faces)
    gaps = np.linalg.norm(np.diff(at, axis=0), axis=1)
    if gaps.max() > _GAP * step:
        i = int(gaps.argmax())
        raise InvalidInputError(
            f"the projection of the line jumps by {gaps[i]:.4g} m behind points[{int(where[i])}]: give more points, "
            "nearer to the surface"
        )
    kept = np.append(True, gaps > 1e-9 * mesh.diagonal)
    if kept.sum() < 2:
        raise InvalidInputError("points are all projected to one point of the surface: a line needs two")
    return at[kept], faces[kept]


def _require_near(points: Array, at: Array, within: float) -> None:
    distances = np.linalg.norm(at - points, axis=1)
    worst = int(distances.argmax())
    if distances[worst] > within:
        raise InvalidInputError(
            f"points[{worst}] is {distances[worst]:.4g} m from the surface, farther than within={within:.4g}: give a "
            "larger within=, or move it nearer"
        )


def _along(line: Array, where: Array) -> Array:
    piece = np.minimum(where.astype(int), len(line) - 2)
    share = (where - piece)[:, None]
    return np.asarray((1.0 - share) * line[piece] + share * line[piece + 1], dtype=float)
