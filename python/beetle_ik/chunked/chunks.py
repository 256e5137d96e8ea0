"""Work cut into chunks: computed here or by the workers of a dask client, kept in memory or in a store.

A chunk is a pure function of the job, its number and its inputs. So it may be computed anywhere, and again after a
worker was lost; chunks that a store holds are not computed again.
"""

from __future__ import annotations

import errno
import pickle
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import islice
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from .._core import BeetleIkError, InvalidInputError, __version__, _instructions
from ..calls.progress import reports
from ..calls.text import counted
from ..installed.needs import library
from .fingerprint import digest
from .store import Layout, Store

if TYPE_CHECKING:
    from distributed import Client
    from numpy.typing import NDArray

    Array: TypeAlias = NDArray[np.generic]
    Chunks: TypeAlias = Generator[tuple[int, Mapping[str, Array]]]
    Region: TypeAlias = tuple[slice, ...]
    Compute: TypeAlias = Callable[[int, Region, Sequence[Array], int | None], Mapping[str, Array]]

_AT_LEAST, _AT_MOST = 2, 3  # chunks sent for each thread of a worker: one in work, others that wait
ANY = "any"
"""Instruction set of a store that workers of different instruction sets may fill."""


@dataclass(frozen=True)
class Job:
    """Items to compute, in chunks."""

    call: str
    """The public call, by its name."""
    options: Mapping[str, Any]
    """Arguments that determine the results besides the inputs, as JSON."""
    layout: Layout
    inputs: Sequence[Any]
    """Arrays cut like the results. Workers read their part of a zarr array; parts of other arrays are sent to them."""
    compute: Compute
    """Returns the columns of a chunk, from its number, its region, its parts of the inputs and the number of threads.
    It is pickled.
    """
    attached: Mapping[str, Array] = field(default_factory=dict)
    """Further arrays of a store, so that it can be read without the call."""


class Build(NamedTuple):
    """Version and instruction set on which the bits of results depend."""

    version: str
    instructions: str


class _Part(NamedTuple):
    """A part of a zarr array, read where it is needed."""

    array: Any
    region: Region

    def read(self) -> Array:
        """Reads the part. The array is opened anew: a missing array would be read as zeros.

        Raises:
            FileNotFoundError: this machine does not see the array.
        """
        zarr, array = library("zarr", "zarr", "reading targets"), None
        with suppress(FileNotFoundError):
            array = zarr.open_array(store=self.array.store, path=self.array.path, mode="r")
        if array is None:
            what = "no array of zarr here: it must be on a file system that all workers share, under the same path"
            raise FileNotFoundError(errno.ENOENT, what, str(self.array.store_path))
        return np.asarray(array[self.region])


def run(
    job: Job,
    client: Client | None,
    store: Path | None,
    *,
    threads: int | None,
    progress: object,
    any_instruction_set: bool,
) -> Mapping[str, Any]:
    """Computes all chunks; returns the columns: arrays of numpy, or of zarr with a store.

    Raises:
        BeetleIkError: a worker has another version of the library or another instruction set, or the connection to the
            scheduler is lost.
        InvalidInputError: the store belongs to another job; or an error of `job.compute`.
        OSError: the store cannot be written.
    """
    build = Build(__version__, ANY if any_instruction_set else _instructions)
    layout = job.layout
    identity = {"call": job.call, **build._asdict(), **job.options}
    kept = None if store is None else Store.prepare(store, layout, identity, job.attached)
    columns = {} if kept else {name: np.empty((*layout.shape, *c.shape), c.dtype) for name, c in layout.columns.items()}
    results = _here(job, kept, threads) if client is None else _on_workers(job, client, store, build)
    done, total = 0, prod(layout.shape)
    with reports(progress) as report, closing(results):
        for chunk, arrays in results:
            region = layout.region(chunk)
            for name, array in arrays.items():
                columns[name][region] = array
            done += prod(part.stop - part.start for part in region)
            report(done, total)
    if kept is None:
        return columns
    kept.finish()
    return {name: kept.group[name] for name in layout.columns}


def _here(job: Job, store: Store | None, threads: int | None) -> Chunks:
    for chunk in range(job.layout.chunks):
        inputs = [np.asarray(array[job.layout.region(chunk)]) for array in job.inputs]
        yield chunk, _computed(job.compute, job.layout, chunk, inputs, store, threads)


def _on_workers(job: Job, client: Client, store: Path | None, build: Build) -> Chunks:
    """Yields chunks as they finish. Few are sent at a time, so that memory does not grow with their number."""
    as_completed = library("distributed", "dask", "client=", extra="distributed").as_completed
    # Sends the work as a task, which the scheduler can repeat for a new worker.
    work = client.submit(_same, pickle.dumps((job.compute, job.layout, store)), pure=False)
    left = iter(range(job.layout.chunks))
    chunk_of: dict[Any, int] = {}
    ended = as_completed()

    def send(count: int) -> None:
        for chunk in islice(left, max(count, 0)):
            inputs = [_to_send(array, job.layout.region(chunk)) for array in job.inputs]
            future = client.submit(_on_a_worker, work, build, chunk, inputs, pure=False)
            chunk_of[future] = chunk
            ended.add(future)

    try:
        threads = _threads_of(client)
        send(_AT_MOST * threads)
        for future in ended:
            arrays = future.result()
            yield chunk_of.pop(future), arrays
            if len(chunk_of) <= _AT_LEAST * threads:
                threads = _threads_of(client)  # workers come and go
                send(_AT_MOST * threads - len(chunk_of))
    except _connection_errors() as error:
        done = job.layout.chunks - len(chunk_of) - sum(1 for _ in left)
        what = f"the connection to the scheduler is lost after {done} of {counted(job.layout.chunks, 'chunk')}"
        advice = "without store= they are lost" if store is None else "the same call with a new client goes on"
        raise BeetleIkError(f"{what}: {advice}") from error
    finally:
        if chunk_of and client.status == "running":
            client.cancel(list(chunk_of))


def _threads_of(client: Client) -> int:
    """Returns the number of threads of all workers; at least one, for workers that are still to come."""
    if client.scheduler is None:
        from distributed.comm.core import CommClosedError

        raise CommClosedError("no scheduler")
    threads: int = sum(client.nthreads().values())
    return max(threads, 1)


def _to_send(array: Any, region: Region) -> Any:
    return np.ascontiguousarray(array[region]) if isinstance(array, np.ndarray) else _Part(array, region)


def _same(value: bytes) -> bytes:
    return value


def _on_a_worker(work: bytes, build: Build, chunk: int, inputs: Sequence[Any]) -> Mapping[str, Array]:
    """Computes a chunk in one thread: the other threads of the worker have chunks of their own."""
    _require_same_build(build)
    arrays = [part.read() if isinstance(part, _Part) else part for part in inputs]
    compute, layout, store = _opened(work)
    return _computed(compute, layout, chunk, arrays, store, 1)


def _computed(
    compute: Compute, layout: Layout, chunk: int, inputs: Sequence[Array], store: Store | None, threads: int | None
) -> Mapping[str, Array]:
    """Returns the columns of a chunk; with a store, writes those that it lacks, and returns none."""
    region = layout.region(chunk)
    if store is None:
        return compute(chunk, region, inputs, threads)
    made_from = digest(inputs)
    if not store.holds(chunk, made_from):
        store.write(chunk, compute(chunk, region, inputs, threads), made_from)
    return {}


@lru_cache(maxsize=2)
def _opened(work: bytes) -> tuple[Compute, Layout, Store | None]:
    """Unpickles the data shared by all chunks of a job; cached from one chunk to the next."""
    compute, layout, store = pickle.loads(work)
    return compute, layout, None if store is None else Store(store, layout)


def _require_same_build(wanted: Build) -> None:
    from distributed import get_worker

    worker = get_worker().address
    if wanted.version != __version__:
        difference = f"has beetle-ik {__version__}, the client {wanted.version}"
        raise BeetleIkError(f"worker {worker} {difference}: install one version everywhere")
    if wanted.instructions not in (ANY, _instructions):
        difference = f"computes with {_instructions} instructions, the client with {wanted.instructions}"
        advice = "the last bits of results would differ; any_instruction_set=True allows it"
        raise BeetleIkError(f"worker {worker} {difference}: {advice}")


def _connection_errors() -> tuple[type[BaseException], ...]:
    from distributed import CancelledError
    from distributed.comm.core import CommClosedError

    return (CancelledError, CommClosedError)


def require_client(client: object, threads: int | None) -> None:
    """Raises unless `client` is None or a client of dask that waits for its results.

    Raises:
        BeetleIkError: dask is not installed.
        InvalidInputError: another value, or `threads` together with a client.
    """
    if client is None:
        return
    kind = library("distributed", "dask", "client=", extra="distributed").Client
    if not isinstance(client, kind) or client.asynchronous:
        wanted = "a distributed.Client, not an asynchronous one, or None"
        raise InvalidInputError(f"client must be {wanted}, got {client!r:.60}")
    if threads is not None:
        raise InvalidInputError(f"threads must be None with a client, whose workers have theirs, got {threads!r:.60}")
