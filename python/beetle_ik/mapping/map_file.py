"""Maps as npz files, and as the stores that they are computed into."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import BeetleIkError, InvalidInputError, MapGrid, Robot
from ..calls.arguments import require
from ..chunked.fingerprint import sealed
from ..chunked.finished import read_finished
from ..files.npz import read_arrays, with_ending
from ..files.whole import path_of, whole_file

if TYPE_CHECKING:
    from numpy.typing import NDArray

FORMAT = 2
"""Version of the file; a file of another version is refused."""

QUALITY = ("manipulability", "clearance")
"""Optional results besides the bits."""

_SEAL = "seal"
_SEALED = ("robot", "grid", "bits", *QUALITY)


def write(file: str | os.PathLike[str], robot: Robot, grid: MapGrid, results: Mapping[str, Any]) -> None:
    """Writes a map; `results` are its arrays. The file appears complete or not at all."""
    kept = {**attached(robot, grid), **results}
    arrays: dict[str, Any] = {"reachability_map": np.array(FORMAT), **kept, _SEAL: _seal(kept)}
    with whole_file(with_ending(file)) as stream:
        np.savez_compressed(stream, **arrays)


def read(file: str | os.PathLike[str], robot: Robot | None) -> dict[str, Any]:
    """Returns robot, grid and results of a map, checked; `robot` is the required robot, if given."""
    if robot is not None:
        require("robot", robot, Robot)
    place = path_of(file)
    if place.is_dir():
        arrays: dict[str, Any] = dict(read_finished(place, "reachability"))
    else:
        arrays = read_arrays(file)
        if "reachability_map" not in arrays:
            raise InvalidInputError(f"{place}: not a reachability map")
        version = arrays["reachability_map"]
        if version.shape or version.dtype.kind not in "iu" or version != FORMAT:
            reads = f"this library reads format {FORMAT}: compute it again"
            raise InvalidInputError(f"{place}: a map of format {version!s:.60}; {reads}")
    try:
        stored, grid = _restored(Robot, arrays["robot"]), _restored(MapGrid, arrays["grid"])
        results = {"bits": arrays["bits"], **{name: arrays.get(name) for name in QUALITY}}
        require_results(grid, results)
        if not place.is_dir():  # stores are sealed by chunks
            _require_sealed(arrays)
    except (KeyError, BeetleIkError) as error:
        raise InvalidInputError(f"{place}: damaged reachability map: {error!s:.200}") from error
    require_same_robot(f"{place}: the map", stored, robot)
    return {"robot": stored, "grid": grid, **results}


def _require_sealed(arrays: Mapping[str, Any]) -> None:
    """Raises `InvalidInputError` unless all arrays belong to one map: an array may come from another file."""
    seal = arrays[_SEAL]
    if seal.dtype != np.uint8 or not np.array_equal(seal, _seal(arrays)):
        raise InvalidInputError("its arrays do not belong together")


def _seal(arrays: Mapping[str, Any]) -> NDArray[np.uint8]:
    return sealed(b"reachability_map", FORMAT, {name: arrays[name] for name in _SEALED if name in arrays})


def require_results(grid: MapGrid, results: Mapping[str, Any]) -> None:
    """Raises `InvalidInputError` unless the arrays have the shapes and types of a map of this grid."""
    wanted = {"bits": ((*grid.shape, grid.bytes), np.uint8), **dict.fromkeys(QUALITY, ((*grid.shape,), np.float32))}
    for name, array in results.items():
        shape, kind = wanted[name]
        if array is not None and (array.shape != shape or array.dtype != kind):
            wrong = f"got {array.shape} of {array.dtype}"
            raise InvalidInputError(f"{name}: expected shape {shape} of {np.dtype(kind)}, {wrong}")


def require_same_robot(what: str, mapped: Robot, robot: Robot | None) -> None:
    """Raises `InvalidInputError` unless the robots are equal."""
    if robot is None or mapped == robot:
        return
    other = f"of robot '{mapped.name}', not of '{robot.name}'"
    if mapped.name == robot.name:
        other = f"of another robot '{robot.name}': joints, limits, base, tool or bodies differ"
    raise InvalidInputError(f"{what} is {other}")


def attached(robot: Robot, grid: MapGrid) -> dict[str, NDArray[np.uint8]]:
    """Returns the contents of a file besides the results: robot and grid."""
    return {"robot": _stored(robot), "grid": _stored(grid)}


def _stored(value: Robot | MapGrid) -> NDArray[np.uint8]:
    reduced: Any = value.__reduce__()
    _, (stored,) = reduced
    return np.frombuffer(stored, np.uint8)


def _restored(kind: Any, stored: NDArray[np.uint8]) -> Any:
    return kind._restore(stored.tobytes())
