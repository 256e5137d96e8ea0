"""Computes a map, a group of chunks after another."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np

from .._arguments import require
from .._core import BeetleIkError, InvalidInputError, MapGrid, Robot, map_chunks
from .._progress import Bar
from .reachability_map import ReachabilityMap

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from .._core import Obstacle, Task

_GROUPS = 20  # calls of the core: each holds its own results beside the map

Progress = bool | Callable[[int, int], object] | None


def reachability(
    robot: Robot,
    *,
    voxel: float = 0.05,
    directions: int = 50,
    rolls: int = 6,
    region: ArrayLike | None = None,
    task: Task | None = None,
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    evaluations: int = 200,
    quality: bool = False,
    threads: int | None = None,
    progress: Progress = None,
    store: str | os.PathLike[str] | None = None,
) -> ReachabilityMap:
    """Computes which poses an arm reaches: cubic voxels, with the same orientations at the centre of each.

    Arms whose first axis is vertical have maps that cost about an eighth: the orientations turn with the azimuth of the
    voxel about that axis, so that the voxels at one distance from it and one height differ by the limits of the first
    joint alone. Obstacles and checks of the robot against itself end that.

    An orientation is reached where a solution is found within the tolerances of `solve`. Of arms with a closed form and at
    most six joints, all others cannot be reached, but for those within rounding of a limit or of the edge of the reach.
    Elsewhere `evaluations` bounds the search, and a few orientations that can be reached are missed.

    Args:
        robot: an arm with one tip.
        voxel: edge of the voxels (m).
        directions: number of directions of the tip's z axis, a spherical Fibonacci set. A tip that keeps a direction, as
            of planar arms and SCARAs, has no other.
        rolls: number of rolls about each direction.
        region: two opposite corners of a box (2, 3) (m) in the frame of the robot's base, extended to whole voxels, whose
            faces are at multiples of `voxel` from the first axis; None: all that the tip can reach.
        task: the part of a pose that matters; `tasks.Pointing()` has no rolls, `tasks.Position()` one orientation.
        obstacles, margin, self_collision: what solutions keep clear of, as for `solve`.
        evaluations: most evaluations of a pose: values of the parameter of a redundant arm with a closed form, and
            evaluations of the forward kinematics for arms without one.
        quality: whether to measure manipulability and clearance of the best configuration found in each voxel.
        threads: number of threads; None: one per core. The map has the same bits for any number.
        progress: True shows a progress bar; a callable is called with (done, total), in voxels.
        store: a zarr store to compute into.

    Returns:
        A `ReachabilityMap`.

    Raises:
        InvalidInputError: a robot with several tips, or whose tip moves in too few directions for the task; a voxel,
            region or count that makes no map.
    """
    require("robot", robot, Robot)
    require("quality", quality, bool)
    asked: dict[str, Any] = {
        "task": task,
        "obstacles": None if obstacles is None else list(obstacles),
        "margin": margin,
        "self_collision": self_collision,
    }
    grid = MapGrid(robot, voxel=voxel, directions=directions, rolls=rolls, region=region, **asked)
    if store is not None:
        raise BeetleIkError("store= needs zarr: pip install 'beetle-ik[distributed]'")
    reached = np.empty((*grid.shape, grid.bytes), np.uint8)
    measured = [np.empty(grid.shape, np.float32) for _ in range(2)] if quality else []
    options = asked | {"evaluations": evaluations, "quality": quality, "threads": threads}
    numbers = np.arange(prod(grid.chunks))
    with _shown(progress) as update:
        done = 0
        for group in np.array_split(numbers, min(_GROUPS, len(numbers))):
            report = None if update is None else _onward(update, done, prod(grid.shape))
            chunks = map_chunks(robot, grid, group.tolist(), **options, progress=report)
            for number, arrays in zip(group.tolist(), chunks, strict=True):
                place = tuple(slice(*ends) for ends in grid.chunk(number))
                for whole, part in zip((reached, *measured), arrays, strict=False):
                    whole[place] = part
                done += arrays[0].shape[0] * arrays[0].shape[1] * arrays[0].shape[2]
    return ReachabilityMap(robot, grid, reached, *measured)


@contextmanager
def _shown(progress: Progress) -> Iterator[Callable[[int, int], object] | None]:
    """Yields the function to call with (done, total), or None."""
    if progress is None or progress is False:
        yield None
    elif progress is True:
        bar = Bar()
        try:
            yield bar.update
        finally:
            bar.close()
    elif callable(progress):
        yield progress
    else:
        raise InvalidInputError(f"progress must be True, False or a callable of (done, total), got {progress!r:.60}")


def _onward(update: Callable[[int, int], object], before: int, total: int) -> Callable[[int, int], object]:
    """Returns a function that reports the progress of a part that begins when `before` of `total` are done."""
    return lambda done, _: update(before + done, total)
