"""One line of several, with transitions in between."""

import itertools
from collections.abc import Iterable

import numpy as np

from .._core import InvalidInputError
from ..calls.arguments import require
from ..calls.wording import worded_call
from .checks import number
from .seam import Seam, seam_of


@worded_call
def join(seams: Iterable[Seam], *, lift: float = 0.0) -> Seam:
    """Joins seams, such as the passes of `raster`, to one, in their order.

    At the end of a seam the tool leaves the surface by `lift` along its axis, goes straight to above the next one while
    it turns, and comes down. Its `contact` is False on the way. With a `lift` of 0 it goes straight from end to start,
    which leads along the border of a flat surface, and into a curved one: there choose a lift.

    Args:
        seams: seams, at least one.
        lift: distance by which the tool leaves the surface in between (m).

    Raises:
        InvalidInputError: no seam, or something else among them.
    """
    require("seams", seams, Iterable)
    parts = list(seams)
    if not parts:
        raise InvalidInputError("seams: at least one is needed, got none")
    for i, part in enumerate(parts):
        require(f"seams[{i}]", part, Seam)
    height = number("lift", lift)
    poses, contact, edges, travelled = [parts[0].poses], [parts[0].contact], [parts[0].edges], parts[0].length
    for before, after in itertools.pairwise(parts):
        over = np.stack([before.poses[-1], after.poses[0]])
        over[:, :3, 3] -= height * over[:, :3, 2]
        # Poses at the same point are one: seams that begin where the last one ends, and transitions without a lift.
        way = over if height > 0.0 else over[:0]
        start = 1 if height == 0.0 and np.array_equal(before.poses[-1], after.poses[0]) else 0
        corners = np.concatenate([before.poses[-1:], way, after.poses[:1]])[:, :3, 3]
        travelled += float(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum())
        poses += [way, after.poses[start:]]
        contact += [np.zeros(len(way), dtype=bool), after.contact[start:]]
        edges.append(after.edges + travelled)
        travelled += after.length
    return seam_of(np.concatenate(poses), np.concatenate(contact), np.concatenate(edges), closed=False)
