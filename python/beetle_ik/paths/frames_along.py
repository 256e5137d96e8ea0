"""Frames along a line on a surface: z into the surface, x along the line, turned gradually at sharp edges."""

import math
from typing import NamedTuple

import numpy as np

from .checks import Array
from .seam import Seam, seam_of
from .triangle_mesh import Indices

CREASE = math.pi / 6
"""Angle between faces (rad) from which an edge is sharp, by default."""

_PARALLEL = 1e-6  # sine of the angle below which two directions are parallel


class Style(NamedTuple):
    """Rules by which a line becomes poses: lengths in metres, `crease` in radians."""

    standoff: float
    crease: float
    rounding: float
    lead_in: float
    lead_out: float
    lead: str


def frames_along(points: Array, normals: Array, style: Style, *, closed: bool) -> Seam:
    """Returns the seam along points (m, 3) with outward normals (m, 3); a closed line repeats its first point."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    sharp = _jumps(normals, style.crease)
    normals = _turned_gradually(normals, along, sharp, style.rounding, closed=closed)
    tips = points + style.standoff * normals
    tangents = _tangents(tips, points, closed=closed)
    corners = _jumps(tangents, style.crease)
    tangents = _turned_gradually(tangents, along, corners, style.rounding, closed=closed)
    poses = _poses(tips, tangents, normals)
    if closed:
        poses[-1] = poses[0]
    before, after = (_lead(poses, end, style) for end in (0, -1))
    distance = len(before) * style.lead_in + np.concatenate(
        [[0.0], np.cumsum(np.linalg.norm(np.diff(tips, axis=0), axis=1))]
    )
    contact = np.repeat([False, True, False], [len(before), len(poses), len(after)])
    edges = 0.5 * (distance[sharp] + distance[sharp + 1])
    return seam_of(
        np.concatenate([before, poses, after]), contact, edges, closed=closed and not len(before) + len(after)
    )


def _jumps(directions: Array, crease: float) -> Indices:
    """Returns the indices after which directions turn by more than `crease` (rad) in one step."""
    one, other = directions[:-1], directions[1:]
    turn = np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), np.einsum("ki,ki->k", one, other))
    return np.flatnonzero(turn > crease)


def _turned_gradually(directions: Array, along: Array, jumps: Indices, width: float, *, closed: bool) -> Array:
    """Replaces directions within `width` (m) of a jump by their mean over `width` to both sides."""
    if not len(jumps) or width == 0.0:
        return directions
    if closed:  # a turn before and after, without the repeated point
        length, count = along[-1], len(along) - 1
        once = along[:-1]
        along = np.concatenate([once - length, once, once + length])
        middle = _turned_gradually(
            np.tile(directions[:-1], (3, 1)),
            along,
            np.concatenate([jumps + turn * count for turn in range(3)]),
            min(width, 0.5 * length),
            closed=False,
        )[count : 2 * count]
        return np.concatenate([middle, middle[:1]])
    # The integral of the direction over the length, which is constant about each sample up to halfway to the next.
    bounds = np.concatenate([along[:1], 0.5 * (along[1:] + along[:-1]), along[-1:]])
    integral = np.concatenate([np.zeros((1, 3)), np.cumsum(np.diff(bounds)[:, None] * directions, axis=0)])
    places = bounds[jumps + 1]
    after = np.clip(np.searchsorted(places, along), 0, len(places) - 1)
    apart = np.minimum(np.abs(along - places[after]), np.abs(along - places[np.maximum(after - 1, 0)]))
    near = np.flatnonzero(apart < width)
    # The window is equally wide on both sides, at the ends too, where a narrower one keeps the direction of the end.
    half = np.minimum(width, np.minimum(along[near] - along[0], along[-1] - along[near]))
    ends = [
        np.stack([np.interp(at, bounds, column) for column in integral.T], axis=1)
        for at in (along[near] - half, along[near] + half)
    ]
    mean = ends[1] - ends[0]
    size = np.linalg.norm(mean, axis=1)
    known = size > _PARALLEL * half
    turned = directions.copy()
    turned[near[known]] = mean[known] / size[known, None]
    return turned


def _tangents(tips: Array, points: Array, *, closed: bool) -> Array:
    """Returns the tangents (m, 3) of the line by central differences of the tips; of the points where they coincide."""
    around = [
        np.concatenate([p[-2:-1], p, p[1:2]]) if closed else np.concatenate([p[:1], p, p[-1:]]) for p in (tips, points)
    ]
    across = [p[2:] - p[:-2] for p in around]
    forward = points[np.minimum(np.arange(1, len(points) + 1), len(points) - 1)] - points
    forward[-1] = points[-1] - points[-2]
    steps = np.linalg.norm(forward, axis=1, keepdims=True)
    # A turn back has no direction across: there the line ahead counts.
    tangents = across[0]
    for other in (across[1], forward):
        still = np.linalg.norm(tangents, axis=1, keepdims=True) <= _PARALLEL * steps
        tangents = np.where(still, other, tangents)
    return np.asarray(tangents / np.linalg.norm(tangents, axis=1, keepdims=True), dtype=float)


def _poses(tips: Array, tangents: Array, normals: Array) -> Array:
    """Returns poses (m, 4, 4) with z against the normals, and x along the tangents as far as these allow."""
    x = tangents - np.einsum("ki,ki->k", tangents, normals)[:, None] * normals
    sizes = np.linalg.norm(x, axis=1)
    known = np.flatnonzero(sizes > _PARALLEL)
    if not len(known):
        x, known = np.cross(normals, np.eye(3)[np.abs(normals).argmin(axis=1)]), np.arange(len(x))
    # Where the line runs along the normal, the last x before is kept.
    last = known[np.maximum(np.searchsorted(known, np.arange(len(x)), side="right") - 1, 0)]
    x = x[last] - np.einsum("ki,ki->k", x[last], normals)[:, None] * normals
    lost = np.linalg.norm(x, axis=1) <= _PARALLEL
    x[lost] = np.cross(normals[lost], np.eye(3)[np.abs(normals[lost]).argmin(axis=1)])
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    poses = np.tile(np.eye(4), (len(tips), 1, 1))
    poses[:, :3, :] = np.stack([x, np.cross(-normals, x), -normals, tips], axis=2) + 0.0  # no -0
    return np.asarray(poses)


def _lead(poses: Array, end: int, style: Style) -> Array:
    """Returns the pose (1, 4, 4) from which the tool comes, or to which it leaves; none (0, 4, 4) without a lead."""
    length = style.lead_in if end == 0 else style.lead_out
    if length == 0.0:
        return poses[:0]
    away = poses[end].copy()
    forward = 1.0 if end else -1.0
    away[:3, 3] += length * (-away[:3, 2] if style.lead == "normal" else forward * away[:3, 0])
    return np.asarray(away[None])
