"""Computation of a map, chunk by chunk."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import MapGrid, Robot, map_chunks
from ..calls.arguments import require
from ..calls.wording import worded_call
from ..chunked.chunks import Job, require_client, run
from ..chunked.fingerprint import description
from ..chunked.store import Column, Layout, store_path
from ..scenes import obstacles_for
from .map_file import QUALITY, attached
from .reachability_map import ReachabilityMap

if TYPE_CHECKING:
    from distributed import Client
    from numpy.typing import ArrayLike, NDArray

    from .._core import Obstacle, Task, _Progress


@worded_call
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
    progress: _Progress = None,
    store: str | os.PathLike[str] | None = None,
) -> ReachabilityMap:
    """Computes a reachability map: cubic voxels, with the same orientations at the centre of each.

    The map of an arm whose first axis is vertical takes an eighth of the time: its orientations turn with the azimuth
    of the voxel about that axis, so that voxels at the same distance and height differ only by the limits of the first
    joint. Obstacles and self-collision checks remove this saving.

    An orientation is reached if a solution is found within the tolerances of `solve`. For an arm with a closed form and
    at most six joints, all other orientations are out of reach, except within rounding of a limit or of the edge of the
    reach. For other arms, `evaluations` bounds the search, and a few reachable orientations are missed.

    Args:
        robot: an arm with one tip.
        voxel: edge of the voxels (m).
        directions: number of directions of the tip's z axis, a spherical Fibonacci set. A tip with one constant
            direction, as of planar arms and SCARAs, has no other.
        rolls: number of rolls about each direction.
        region: two opposite corners of a box (2, 3) (m) in the frame of the robot's base, extended to whole voxels,
            whose faces are at multiples of `voxel` from the first axis; None: all that the tip can reach.
        task: the part of a pose that counts; `tasks.Pointing()` has no rolls, `tasks.Position()` one orientation.
        obstacles: obstacles that solutions keep clear of, in the frame of the robot's base, as for `solve`.
        margin: distance to keep (m), as for `solve`.
        self_collision: whether links must not touch each other, as for `solve`.
        evaluations: largest number of evaluations for a pose: parameter values of a redundant arm with a closed form,
            or evaluations of the forward kinematics for an arm without one.
        quality: whether to measure manipulability and clearance of the best configuration found in each voxel.
        threads: number of threads; None: one per core. The map has the same bits for any number.
        progress: True shows a progress bar; a callable is called with (done, total), in voxels, after each chunk.
        store: folder of a zarr group to compute into. The same call continues after an interruption;
            `ReachabilityMap.load` reads the finished store.

    Returns:
        A `ReachabilityMap`.

    Raises:
        InvalidInputError: a robot with several tips, or whose tip moves in too few directions for the task; a voxel,
            region or count that makes no map; a store that cannot be written, or belongs to another map.
        OSError: a chunk cannot be written to the store, which keeps the others.
    """
    poses = {"voxel": voxel, "directions": directions, "rolls": rolls, "region": region}
    kept_clear = {"obstacles": obstacles, "margin": margin, "self_collision": self_collision}
    asked = {"task": task, **kept_clear, "evaluations": evaluations, "quality": quality}
    return computed(None, robot, poses, asked, threads=threads, progress=progress, store=store)


def computed(
    client: Client | None,
    robot: Robot,
    poses: Mapping[str, Any],
    asked: Mapping[str, Any],
    *,
    threads: int | None,
    progress: object,
    store: str | os.PathLike[str] | None,
    any_instruction_set: bool = False,
) -> ReachabilityMap:
    """Computes a map here or on the workers of a client; `poses` and `asked` are arguments of `reachability`."""
    require_client(client, threads)
    require("robot", robot, Robot)
    require("quality", asked["quality"], bool)
    require("any_instruction_set", any_instruction_set, bool)
    folder = None if store is None else store_path(store)
    obstacles = asked["obstacles"]
    options = {**asked, "obstacles": None if obstacles is None else obstacles_for(robot, obstacles)}
    of_grid = {name: options[name] for name in ("task", "obstacles", "margin", "self_collision")}
    grid = MapGrid(robot, **poses, **of_grid)
    map_chunks(robot, grid, [], **options, threads=threads)  # the core checks all other arguments
    columns = {"bits": Column(np.dtype(np.uint8), (grid.bytes,))}
    if options["quality"]:
        columns |= {name: Column(np.dtype(np.float32)) for name in QUALITY}
    region = None if poses["region"] is None else np.asarray(poses["region"], np.float64)
    identity = {
        name: description(value) for name, value in {"robot": robot, **poses, "region": region, **options}.items()
    }
    layout = Layout(columns, tuple(grid.shape), tuple(grid.chunk_shape))
    chunk = partial(_chunk, robot, grid, options)
    job = Job("reachability", identity, layout, [], chunk, attached(robot, grid))
    found = run(job, client, folder, threads=threads, progress=progress, any_instruction_set=any_instruction_set)
    return ReachabilityMap(robot, grid, **{name: column[:] for name, column in found.items()})


def _chunk(
    robot: Robot,
    grid: MapGrid,
    options: Mapping[str, Any],
    chunk: int,
    _region: tuple[slice, ...],
    _inputs: object,
    threads: int | None,
) -> dict[str, NDArray[Any]]:
    (arrays,) = map_chunks(robot, grid, [chunk], **options, threads=threads)
    names = ("bits", *QUALITY)
    return {name: array for name, array in zip(names, arrays, strict=True) if array is not None}
