"""`reachability` in chunks."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ..calls.wording import worded_call
from ..mapping.compute import computed

if TYPE_CHECKING:
    from distributed import Client
    from numpy.typing import ArrayLike

    from .._core import Obstacle, Robot, Task, _Progress
    from ..mapping import ReachabilityMap


@worded_call
def reachability(
    client: Client | None,
    robot: Robot,
    *,
    store: str | os.PathLike[str] | None = None,
    any_instruction_set: bool = False,
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
    progress: _Progress = None,
) -> ReachabilityMap:
    """Computes a reachability map on the workers of a dask client: `bik.reachability` in chunks of voxels.

    The map is bit-identical to that of `bik.reachability`, for any number of workers of one instruction set. With a
    store, each chunk is written as soon as it is computed, and the same call goes on after a worker, the scheduler or
    this process was killed.

    Args:
        client: a `distributed.Client`; None: the chunks are computed here, as by `bik.reachability`.
        robot: an arm with one tip.
        store: folder of a zarr group to compute into, on a file system that all workers share.
        any_instruction_set: whether workers may differ in their instruction set, and so in poses within rounding.
        voxel: this and all others as for `bik.reachability`; edge of the voxels (m).
        directions: number of directions of the tip's z axis.
        rolls: number of rolls about each direction.
        region: two opposite corners of a box (2, 3) (m); None: all that the tip can reach.
        task: the part of a pose that counts.
        obstacles: obstacles in the frame of the base.
        margin: smallest distance (m).
        self_collision: whether links must keep clear of each other.
        evaluations: largest number of evaluations for a pose.
        quality: whether to measure manipulability and clearance.
        threads: number of threads if `client` is None; None: one per core. Workers compute a chunk in each thread.
        progress: True shows a progress bar; a callable is called with (done, total), in voxels, after each chunk.

    Raises:
        BeetleIkError: a library of the extra is missing; a worker has another version of beetle-ik or another
            instruction set; the connection to the scheduler is lost.
        InvalidInputError: as for `bik.reachability`.
        OSError: a chunk cannot be written; the store keeps the others.
    """
    poses = {"voxel": voxel, "directions": directions, "rolls": rolls, "region": region}
    kept_clear = {"obstacles": obstacles, "margin": margin, "self_collision": self_collision}
    asked = {"task": task, **kept_clear, "evaluations": evaluations, "quality": quality}
    return computed(
        client,
        robot,
        poses,
        asked,
        threads=threads,
        progress=progress,
        store=store,
        any_instruction_set=any_instruction_set,
    )
