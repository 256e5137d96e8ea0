"""Finished stores, read without the job that filled them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import InvalidInputError
from .fingerprint import sealed
from .store import CONTENT, FINISHED, FORMAT, HASHES, Column, Layout, content, description, job, zarr_library

if TYPE_CHECKING:
    from numpy.typing import NDArray


def read_finished(folder: Path, call: str) -> dict[str, NDArray[np.generic]]:
    """Reads all arrays of a finished store of `call`.

    Raises:
        BeetleIkError: zarr is not installed.
        InvalidInputError: the folder is no such store, is unfinished or damaged, or holds parts of another store; the
            message names it.
    """
    there = description(folder)
    if there is None or there.get("call") != call:
        raise InvalidInputError(f"{folder}: not a store of {call}")
    if there.get("format") != FORMAT:
        reads = f"this library reads {FORMAT}: compute it again"
        raise InvalidInputError(f"{folder}: a store of format {there.get('format')!r:.60}; {reads}")
    group = zarr_library().open_group(store=folder, mode="r", zarr_format=3)
    repair = "the call that made it repairs it"
    try:
        attributes = group.attrs.asdict()
        names = (*attributes[CONTENT]["attached"], *attributes[CONTENT]["columns"])
        opened: dict[str, Any] = {name: group[name] for name in (*names, FINISHED)}
        arrays: dict[str, NDArray[Any]] = {name: np.asarray(array[:]) for name, array in opened.items()}
        hashes = arrays.pop(FINISHED)
        finished = np.asarray(hashes.any(axis=(1, 2)))
        if finished.all():
            _require_own(attributes, arrays, hashes)
    except Exception as error:  # zarr raises many kinds
        raise InvalidInputError(f"{folder}: damaged store: {error!s:.200}; {repair}") from error
    if not finished.all():
        done = f"{np.count_nonzero(finished)} of {len(finished)} chunks are done"
        raise InvalidInputError(f"{folder}: {done}: the call that began the store goes on")
    return arrays


def _require_own(attributes: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], hashes: NDArray[Any]) -> None:
    """Raises `ValueError` unless all arrays are those that the store was made with, chunk by chunk."""
    said = attributes[CONTENT]
    columns = {name: Column(arrays[name].dtype) for name in said["columns"]}
    layout = Layout(columns, tuple(said["shape"]), tuple(said["chunk_shape"]))
    if content(layout, {name: array for name, array in arrays.items() if name not in columns}) != said:
        raise ValueError("what it says of the job is of another store")
    sizes = {arrays[name].shape[: len(layout.shape)] for name in columns}
    if sizes != {layout.shape} or hashes.shape != (layout.chunks, *HASHES):
        raise ValueError("arrays of another size")
    of_job = job(attributes)
    for chunk in range(layout.chunks):
        region = layout.region(chunk)
        if not np.array_equal(
            sealed(of_job, chunk, {name: arrays[name][region] for name in columns}), hashes[chunk, 1]
        ):
            raise ValueError(f"chunk {chunk} of {layout.chunks} is damaged, or of another store")
