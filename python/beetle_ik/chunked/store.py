"""The results of a job on disk: a zarr group with one array per column, written chunk by chunk.

The array `chunks` holds two hashes for each chunk: of its inputs, and of its results, its number and the job. They are
written last, so a chunk whose results do not match them is unfinished, or belongs elsewhere or to another store.
Nothing in the store depends on time or on who computed it: two stores of one job are equal byte for byte.
"""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Mapping
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .._core import BeetleIkError, InvalidInputError
from ..calls.text import listed
from ..installed.needs import library
from .fingerprint import digest, sealed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Arrays = Mapping[str, NDArray[np.generic]]

FORMAT = 2
ATTRIBUTE = "beetle_ik"
CONTENT = "content"
HASHES = (2, 32)  # two hashes of 32 bytes for each chunk
FINISHED = "chunks"
_ENCODING = {"name": "default", "separator": "."}  # files, not a folder for each chunk


class Column(NamedTuple):
    """One array of a store: the type and shape of each of its items."""

    dtype: np.dtype[Any]
    shape: tuple[int, ...] = ()


class Layout(NamedTuple):
    """Layout of a store: items in a grid of one or several axes, cut into chunks."""

    columns: Mapping[str, Column]
    shape: tuple[int, ...]
    chunk_shape: tuple[int, ...]

    @property
    def counts(self) -> tuple[int, ...]:
        """Number of chunks along each axis; the last ones may be smaller."""
        return tuple(-(-items // chunk) for items, chunk in zip(self.shape, self.chunk_shape, strict=True))

    @property
    def chunks(self) -> int:
        """Number of all chunks, which are numbered along the last axis first."""
        return prod(self.counts)

    def region(self, chunk: int) -> tuple[slice, ...]:
        """Returns the range of items of a chunk along each axis."""
        place = np.unravel_index(chunk, self.counts)
        axes = zip(place, self.chunk_shape, self.shape, strict=True)
        return tuple(slice(int(i) * length, min((int(i) + 1) * length, end)) for i, length, end in axes)


def store_path(store: object) -> Path:
    """Returns the folder that the argument `store` names, as an absolute path.

    Raises:
        InvalidInputError: the argument is not the path of a folder, for example an address like s3://.
    """
    if not isinstance(store, str | os.PathLike) or not str(store) or "\0" in str(store):
        raise InvalidInputError(f"store must be the path of a folder, got {store!r:.60}")
    if "://" in str(store):
        raise InvalidInputError(f"store must be a folder on a file system, got {store!r:.60}: mount it")
    return Path(store).absolute()


class Store:
    """The arrays of a job in a zarr group. Every process opens its own."""

    def __init__(self, folder: Path, layout: Layout) -> None:
        """Opens a store that `prepare` made."""
        if not (folder / "zarr.json").exists():
            what = "no store here: the folder must be on a file system that all workers share, under the same path"
            raise FileNotFoundError(errno.ENOENT, what, str(folder))
        self.group = zarr_library().open_group(store=folder, mode="r+", zarr_format=3)
        self._folder = folder
        self._layout = layout
        self._job = job(self.group.attrs.asdict())
        self._opened: dict[str, Any] = {}

    @classmethod
    def prepare(cls, folder: Path, layout: Layout, identity: Mapping[str, Any], attached: Arrays) -> Store:
        """Makes the store of a job, or opens the one that is there, finished or not.

        Raises:
            BeetleIkError: zarr is not installed.
            InvalidInputError: the folder cannot be written, holds something else, or the store of another job.
        """
        zarr = zarr_library()
        wanted = {"format": FORMAT, **identity}
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if (folder / "zarr.json").exists():
                _require_same_job(folder, wanted)
            else:
                _require_empty(folder)
                # Writes the attributes first, in one file, so that an empty store of this job can be continued.
                attributes = {ATTRIBUTE: wanted, CONTENT: content(layout, attached)}
                zarr.create_group(store=folder, attributes=attributes, zarr_format=3)
            store = cls(folder, layout)
            if store.group.attrs.asdict().get(CONTENT) != content(layout, attached):
                raise ValueError("what it says of its arrays is of another store")
            store._create_arrays(attached)
        except OSError as error:
            raise InvalidInputError(f"store: folder '{folder}' cannot be written: {error.strerror}") from error
        except BeetleIkError:
            raise
        except Exception as error:  # zarr raises many kinds
            raise InvalidInputError(f"store: '{folder}' is damaged: {error!s:.200}: give another folder") from error
        return store

    def holds(self, chunk: int, inputs: NDArray[np.uint8]) -> bool:
        """Whether a chunk is there and whole, and was computed from inputs with the hash `inputs`.

        Raises:
            InvalidInputError: the chunk was computed from other inputs.
        """
        hashes = self._read(FINISHED, (slice(chunk, chunk + 1),))
        if hashes is None or not hashes.any():
            return False
        region = self._layout.region(chunk)
        columns = {name: self._read(name, region) for name in self._layout.columns}
        found = {name: column for name, column in columns.items() if column is not None}
        if len(found) < len(columns) or not np.array_equal(sealed(self._job, chunk, found), hashes[0, 1]):
            return False
        if not np.array_equal(hashes[0, 0], inputs):
            where = f"rows {region[0].start} to {region[0].stop - 1} of the store '{self._folder}'"
            raise InvalidInputError(f"store: {where} were computed from other targets or starts: give another folder")
        return True

    def write(self, chunk: int, arrays: Arrays, inputs: NDArray[np.uint8]) -> None:
        """Writes a whole chunk. Each file replaces the old one when it is complete.

        Raises:
            OSError: the chunk, which the message names, cannot be written; the other chunks are unchanged.
        """
        region = self._layout.region(chunk)
        columns = {name: np.ascontiguousarray(arrays[name]) for name in self._layout.columns}
        hashes = np.stack([inputs, sealed(self._job, chunk, columns)])
        failure = None
        try:
            for name, column in columns.items():
                self._array(name)[region] = column
            self._array(FINISHED)[chunk : chunk + 1] = hashes[None]
        except OSError as error:
            failure = error
        if failure is not None:  # raised here, without zarr's own as its context: not all of them can be sent by dask
            kept = "the finished chunks are kept, and the same call goes on from them"
            what = f"{failure.strerror}: chunk {chunk} of {self._layout.chunks} cannot be written; {kept}"
            raise OSError(failure.errno, what, str(self._folder))

    def finish(self) -> None:
        """Removes the unfinished files that killed processes left behind."""
        for file in self._folder.rglob("*.partial"):
            file.unlink(missing_ok=True)

    def _create_arrays(self, attached: Arrays) -> None:
        layout = self._layout
        for name, array in attached.items():
            self._create(name, array.shape, array.shape, array.dtype, 0)
            found = self._read(name, (slice(None),))
            if found is None or not np.array_equal(found, array):
                self._array(name)[:] = array
        for name, (dtype, shape) in layout.columns.items():
            whole, chunk = (*layout.shape, *shape), (*layout.chunk_shape, *shape)
            self._create(name, whole, chunk, dtype, _absent(dtype))
        self._create(FINISHED, (layout.chunks, *HASHES), (1, *HASHES), np.dtype(np.uint8), 0)

    def _create(
        self, name: str, shape: tuple[int, ...], chunks: tuple[int, ...], dtype: np.dtype[Any], fill: object
    ) -> None:
        if name in self.group:
            there = self.group[name]
            if (there.shape, there.dtype) != (shape, dtype):
                raise ValueError(f"array '{name}' is of another size or type")
            return
        checksum = library("zarr.codecs", "zarr", "store=", extra="distributed").Crc32cCodec()
        self.group.create_array(
            name,
            shape=shape,
            chunks=tuple(max(length, 1) for length in chunks),
            dtype=dtype,
            fill_value=fill,
            compressors=[checksum],
            chunk_key_encoding=_ENCODING,
        )

    def _array(self, name: str) -> Any:
        """Opens a column, once. Chunks of NaN are written too, which zarr otherwise leaves out."""
        if name not in self._opened:
            self._opened[name] = self.group[name].with_config({"write_empty_chunks": True})
        return self._opened[name]

    def _read(self, name: str, region: tuple[slice, ...]) -> NDArray[np.generic] | None:
        """Reads a chunk of a column; None if its file is damaged."""
        try:
            values: NDArray[np.generic] = self._array(name)[region]
        except ValueError:
            return None
        return values


def content(layout: Layout, attached: Arrays) -> dict[str, Any]:
    """Returns the description that a store keeps of its arrays."""
    return {
        "columns": sorted(layout.columns),
        "shape": list(layout.shape),
        "chunk_shape": list(layout.chunk_shape),
        "attached": {name: digest([array]).tobytes().hex() for name, array in sorted(attached.items())},
    }


def job(attributes: Mapping[str, Any]) -> bytes:
    """Returns the identity and layout of the results of a store, as bytes."""
    return json.dumps([attributes.get(ATTRIBUTE), attributes.get(CONTENT)], sort_keys=True).encode()


def zarr_library() -> Any:
    """Returns zarr, imported at its first use."""
    return library("zarr", "zarr", "store=", extra="distributed")


def _absent(dtype: np.dtype[Any]) -> object:
    """Returns the fill value of rows that were not computed."""
    if dtype.kind == "f":
        return np.nan
    return False if dtype.kind == "b" else np.iinfo(dtype).max


def _require_empty(folder: Path) -> None:
    """Refuses a folder with other files; unfinished files of a killed process are allowed."""
    others = sorted(entry.name for entry in folder.iterdir() if entry.suffix != ".partial")
    if others:
        raise InvalidInputError(f"store: folder '{folder}' holds other files: {listed(others)}: give another folder")


def description(folder: Path) -> dict[str, Any] | None:
    """Returns the description that a store keeps of its job; None if the folder is no store of this library."""
    try:
        there = zarr_library().open_group(store=folder, mode="r", zarr_format=3).attrs.asdict().get(ATTRIBUTE)
    except (ValueError, KeyError, TypeError, FileNotFoundError):
        return None
    return there if isinstance(there, dict) else None


def _require_same_job(folder: Path, wanted: Mapping[str, Any]) -> None:
    there = description(folder)
    if there is None:
        raise InvalidInputError(f"store: folder '{folder}' is not a store of beetle-ik: give another folder")
    names = [*there, *(name for name in wanted if name not in there)]
    differences = [
        f"{name} is {there.get(name)!r} there and {wanted.get(name)!r} here"
        for name in names
        if name not in there or name not in wanted or there[name] != wanted[name]
    ]
    if differences:
        raise InvalidInputError(f"store: '{folder}' holds another job: {'; '.join(differences)}: give another folder")
