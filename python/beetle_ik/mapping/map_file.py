"""Maps as npz files, and as the stores they are computed into."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from .._arguments import require
from .._core import BeetleIkError, InvalidInputError, MapGrid, Robot
from .._files import path_of, whole_file
from ..chunked.store import read_finished
from ..export import read_arrays
from .reachability_map import QUALITY, ReachabilityMap

if TYPE_CHECKING:
    from numpy.typing import NDArray

FORMAT = 1
"""Version of the file; a file of another version is refused."""


def write(map: ReachabilityMap, file: str | os.PathLike[str]) -> None:  # noqa: A002
    """Writes a map; the file appears complete or not at all."""
    arrays: dict[str, Any] = {
        "reachability_map": np.array(FORMAT),
        **attached(map.robot, map.grid),
        "bits": map.bits,
    }
    arrays |= {name: getattr(map, name) for name in QUALITY if getattr(map, name) is not None}
    with whole_file(file) as stream:
        np.savez_compressed(stream, **arrays)


def read(file: str | os.PathLike[str], robot: Robot | None) -> ReachabilityMap:
    """Reads a map, of `robot` if that is given."""
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
        found = ReachabilityMap(stored, grid, arrays["bits"], *(arrays.get(name) for name in QUALITY))
    except (KeyError, BeetleIkError) as error:
        raise InvalidInputError(f"{place}: damaged reachability map: {error!s:.200}") from error
    require_same_robot(f"{place}: the map", stored, robot)
    return found


def require_same_robot(what: str, mapped: Robot, robot: Robot | None) -> None:
    """Raises `InvalidInputError` unless the robots are equal."""
    if robot is None or mapped == robot:
        return
    other = f"of robot '{mapped.name}', not of '{robot.name}'"
    if mapped.name == robot.name:
        other = f"of another robot '{robot.name}': joints, limits, base, tool or bodies differ"
    raise InvalidInputError(f"{what} is {other}")


def attached(robot: Robot, grid: MapGrid) -> dict[str, NDArray[np.uint8]]:
    """Returns what a file says of a map besides its results."""
    return {"robot": _stored(robot), "grid": _stored(grid)}


def _stored(value: Robot | MapGrid) -> NDArray[np.uint8]:
    reduced: Any = value.__reduce__()
    _, (stored,) = reduced
    return np.frombuffer(stored, np.uint8)


def _restored(kind: Any, stored: NDArray[np.uint8]) -> Any:
    return kind._restore(stored.tobytes())
