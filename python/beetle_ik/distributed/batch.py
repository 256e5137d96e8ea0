"""`solve_batch` in chunks."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from numbers import Integral
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from .. import _core
from .._core import BatchSolution, InvalidInputError, Limits, Robot, Status, Stop
from ..calls.arguments import read_once, require
from ..calls.text import counted
from ..calls.wording import worded_call
from ..chunked.chunks import Job, require_client, run
from ..chunked.fingerprint import description
from ..chunked.store import Column, Layout, store_path
from ..scenes import Scene, obstacles_for

if TYPE_CHECKING:
    from distributed import Client
    from numpy.typing import ArrayLike, NDArray

    from .._core import Obstacle, _Goals, _Progress, _Solver, _Tasks, _TipKey, _Tolerance

_ERRORS = ("position_error", "rotation_error")
_COLUMNS = (
    "q",
    "success",
    "status",
    "position_error",
    "rotation_error",
    "clearance",
    "iterations",
    "restarts",
    "evaluations",
)


@dataclass(frozen=True, repr=False)
class BatchArrays:
    """Results of a batch in the order of the targets: numpy arrays in memory, or zarr arrays with a store.

    `q[a:b]` reads rows of a zarr array, and `q[:]` reads all. Names and bits are those of `bik.BatchSolution`.
    """

    q: Any
    """The best configurations found (m, n) (rad, m), inside the limits; NaN in rows whose `status` is INVALID."""
    success: Any
    """Whether each target was reached within the tolerances (m,)."""
    status: Any
    """Reason why each search ended (m,), values of `Status`."""
    position_error: Any
    """Distances of the tip from the targets (m,) (m); the largest of several tips."""
    rotation_error: Any
    """Geodesic angles to the targets' orientations (m,) (rad), the largest of several tips."""
    errors: Mapping[_TipKey, tuple[Any, Any]]
    """Errors of each tip, by the keys of the targets: {tip: (position (m,) (m), rotation (m,) (rad))}."""
    clearance: Any
    """Smallest distances to obstacles or between links (m,) (m), as in `Solution.clearance`."""
    iterations: Any
    """Iterations over all starts (m,)."""
    restarts: Any
    """Restarts after the first start (m,)."""
    evaluations: Any
    """Evaluations of the forward kinematics (m,)."""
    message: str
    """Number of solved targets, and advice on the others."""
    elapsed: float
    """Time of this call (s)."""
    limits: Limits
    """The limits in force."""
    store: Path | None
    """The folder of the store."""

    def __len__(self) -> int:
        """Returns the number of targets."""
        count: int = self.q.shape[0]
        return count

    def __repr__(self) -> str:
        """Shows the number of solved targets, and the folder of the store."""
        return f"<BatchArrays{'' if self.store is None else f' in {str(self.store)!r}'}: {self.message}>"


@worded_call
def solve_batch(
    client: Client | None,
    robot: Robot,
    targets: ArrayLike | Mapping[str, ArrayLike] | Mapping[_TipKey, ArrayLike],
    *,
    store: str | os.PathLike[str] | None = None,
    rows_per_chunk: int = 32768,
    any_instruction_set: bool = False,
    start_q: ArrayLike | None = None,
    threads: int | None = None,
    on_invalid: Literal["raise", "skip"] = "raise",
    progress: _Progress = None,
    task: _Tasks = None,
    solver: _Solver | None = None,
    position_tolerance: _Tolerance = 1e-6,
    rotation_tolerance: _Tolerance = 1e-6,
    goals: _Goals = None,
    prefer: Literal["any", "nearest", "best"] = "any",
    joint_weights: ArrayLike | None = None,
    limits: Limits | None = None,
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    stop: Stop | None = None,
    seed: int = 0,
) -> BatchArrays:
    """Solves many targets in chunks, on the workers of a dask client or here.

    The results are those of `bik.solve_batch`, to the bit, for any chunks and any number of workers of one instruction
    set. With a store, each chunk is written as soon as it is computed. If a worker, the scheduler or this process is
    killed, the same call goes on: whole chunks are kept, half-written ones are computed again.

    Args:
        client: a `distributed.Client`; None: the chunks are computed here, one after the other.
        robot: the arm.
        targets: poses (m, 4, 4) or positions (m, 3) (m), or a dict of them, as for `bik.solve_batch`. The rows of a
            chunk are sent to its worker; rows of a zarr array are read by the worker.
        store: folder of a zarr group for the results, on a file system that all workers share; None: the results stay
            in memory.
        rows_per_chunk: targets of a chunk, which is one task and one chunk of each array of the store.
        any_instruction_set: whether workers may differ in their instruction set, and so in the last bits of results.
        start_q: as for `bik.solve_batch`.
        threads: number of threads if `client` is None; None: one per core. Workers compute a chunk in each thread.
        on_invalid: as for `bik.solve_batch`; "raise" raises when the chunk of the row is computed.
        progress: True shows a progress bar; a callable is called with (done, total) after each chunk.
        task: this and all others as for `bik.solve_batch`.
        solver: the solver of a search.
        position_tolerance: largest position error (m).
        rotation_tolerance: largest rotation error (rad).
        goals: secondary objectives along the self-motion.
        prefer: choice among several solutions.
        joint_weights: cost of moving each joint (n,).
        limits: position limits; None: the robot's.
        obstacles: obstacles in the frame of the base.
        margin: smallest distance (m).
        self_collision: whether links must keep clear of each other.
        stop: budgets of each target. After `max_time` bits differ from run to run.
        seed: seed of the random draws.

    Raises:
        BeetleIkError: a library of the extra is missing; a worker has another version of beetle-ik or another
            instruction set; the connection to the scheduler is lost.
        InvalidInputError: as for `bik.solve_batch`; a store that cannot be written, or is of another robot, other
            targets, options, version or instruction set.
        LimitError: a start outside the limits (names the row).
        OSError: a chunk cannot be written, for example because the disk is full; the store keeps the others.
    """
    began = time.monotonic()
    require_client(client, threads)
    folder = None if store is None else store_path(store)
    chunk_rows = _rows_per_chunk(rows_per_chunk)
    require("any_instruction_set", any_instruction_set, bool)
    options: dict[str, Any] = {
        "on_invalid": on_invalid,
        "task": task,
        "solver": solver,
        "position_tolerance": position_tolerance,
        "rotation_tolerance": rotation_tolerance,
        "goals": read_once(goals),
        "prefer": prefer,
        "joint_weights": joint_weights if joint_weights is None else _array("joint_weights", joint_weights),
        "limits": limits,
        "obstacles": obstacles_for(robot, obstacles) if isinstance(obstacles, Scene) else read_once(obstacles),
        "margin": margin,
        "self_collision": self_collision,
        "stop": stop,
        "seed": seed,
    }
    keys = tuple(targets) if isinstance(targets, Mapping) else None
    inputs = [_array("targets", part) for part in (targets.values() if isinstance(targets, Mapping) else [targets])]
    all_starts = None if start_q is None else _array("start_q", start_q)
    each_starts = all_starts is not None and all_starts.ndim == 2
    if each_starts:
        inputs.append(all_starts)
    else:
        options["start_q"] = all_starts
    rows = _row_count(inputs, each_starts)
    solve = partial(_solve_rows, robot, keys, options)
    # Checks all other arguments in the core, by a batch without targets.
    none = _solved(robot, keys, options, 0, [array[:0] for array in inputs], threads)
    columns = {name: Column(array.dtype, array.shape[1:]) for name, array in _columns(none).items()}
    asked = {"robot": robot, "tips": keys, **options, "rows": rows, "rows_per_chunk": chunk_rows}
    identity = {name: description(value) for name, value in asked.items()}
    job = Job("solve_batch", identity, Layout(columns, (rows,), (min(chunk_rows, max(rows, 1)),)), inputs, solve)
    found = run(job, client, folder, threads=threads, progress=progress, any_instruction_set=any_instruction_set)
    return BatchArrays(
        **{name: found[name] for name in _COLUMNS},
        errors=_errors(list(none.errors), found),
        message=_message(found["status"], job.layout),
        elapsed=time.monotonic() - began,
        limits=none.limits,
        store=folder,
    )


def _solved(
    robot: Robot,
    keys: Sequence[Any] | None,
    options: Mapping[str, Any],
    first_row: int,
    inputs: Sequence[Any],
    threads: int | None,
) -> BatchSolution:
    """Solves targets: the first inputs are the targets of each key, and a further input is their starts."""
    count = 1 if keys is None else len(keys)
    targets = inputs[0] if keys is None else dict(zip(keys, inputs, strict=False))
    starts = {"start_q": inputs[count]} if len(inputs) > count else {}
    return _core.solve_batch(robot, targets, first_row=first_row, threads=threads, **options, **starts)


def _solve_rows(
    robot: Robot,
    keys: Sequence[Any] | None,
    options: Mapping[str, Any],
    _chunk: int,
    rows: tuple[slice],
    inputs: Sequence[Any],
    threads: int | None,
) -> Mapping[str, NDArray[Any]]:
    return _columns(_solved(robot, keys, options, rows[0].start, inputs, threads))


def _columns(batch: BatchSolution) -> dict[str, NDArray[Any]]:
    columns = {name: getattr(batch, name) for name in _COLUMNS}
    if len(batch.errors) > 1:
        for i, errors in enumerate(batch.errors.values()):
            columns |= {f"{name}.{i}": error for name, error in zip(_ERRORS, errors, strict=True)}
    return columns


def _errors(keys: Sequence[Any], found: Mapping[str, Any]) -> dict[Any, tuple[Any, Any]]:
    if len(keys) == 1:
        return {keys[0]: (found[_ERRORS[0]], found[_ERRORS[1]])}
    return {key: (found[f"{_ERRORS[0]}.{i}"], found[f"{_ERRORS[1]}.{i}"]) for i, key in enumerate(keys)}


def _message(status: Any, layout: Layout) -> str:
    counts = np.zeros(len(Status), int)
    for chunk in range(layout.chunks):
        counts += np.bincount(status[layout.region(chunk)], minlength=len(Status))
    return _core._batch_message(counts.tolist())


def _array(name: str, value: Any) -> Any:
    """Returns a zarr array unchanged, and another value as a numpy array."""
    if type(value).__module__.partition(".")[0] == "zarr" and hasattr(value, "shape"):
        return value
    try:
        array = np.asarray(value)
    except ValueError:
        array = np.asarray(None)
    if array.dtype.kind not in "fiu" or array.ndim == 0:
        raise InvalidInputError(f"{name} must be an array of numbers, got {value!r:.60}")
    return array


def _row_count(inputs: Sequence[Any], starts: bool) -> int:
    """Returns the number of targets, which must agree for all tips and for the starts, the last input."""
    rows: int = inputs[0].shape[0] if inputs else 0
    for i, array in enumerate(inputs):
        what = "start_q" if starts and i == len(inputs) - 1 else "targets"
        if what == "targets" and array.shape[1:] not in ((3,), (4, 4)):
            shape = f"({array.shape[0]},)" if array.ndim == 1 else f"({', '.join(map(str, array.shape))})"
            raise InvalidInputError(f"targets: expected poses (m, 4, 4) or positions (m, 3), got shape {shape}")
        if array.shape[0] != rows:
            why = ", one per target" if what == "start_q" else " as for the first tip"
            raise InvalidInputError(f"{what}: expected {counted(rows, 'row')}{why}, got {array.shape[0]}")
    return rows


def _rows_per_chunk(value: object) -> int:
    if not isinstance(value, Integral) or isinstance(value, bool) or not 1 <= int(value) < 2**31:
        raise InvalidInputError(f"rows_per_chunk must be a whole number from 1 to 2^31 - 1, got {value!r:.60}")
    return int(value)
