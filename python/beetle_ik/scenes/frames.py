"""Frames of planning scenes."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import BeetleIkError, InvalidInputError, pose


def frame_of(found: Any) -> str:
    """Returns the name of the frame in which an object is given; empty if it is not named."""
    header = found.get("header") if isinstance(found, dict) else None
    name = header.get("frame_id") if isinstance(header, dict) else None
    return str(name or "").removeprefix("/")


def placed_frames(
    where: str, scene: dict[str, Any], objects: Iterable[Any], place: NDArray[np.float64]
) -> dict[str, NDArray[np.float64]]:
    """Returns the pose of each frame of the objects in the frame of the robot's base.

    Frames that `fixed_frame_transforms` list are placed by them; `place` is the pose of the frame that these lead to,
    or else of the only frame.

    Raises:
        InvalidInputError: several frames without a transform, or a transform that cannot be read; the message names
            them.
    """
    known = {name: place @ transform for name, transform in _transforms(where, scene)}
    used = {frame_of(found) for found in objects}
    if len(used) > 1 and not used <= known.keys():
        named = ", ".join(f"'{name}'" for name in sorted(used))
        raise InvalidInputError(
            f"{where}: the objects are in several frames ({named}); only one can be read, and those that "
            "fixed_frame_transforms lists"
        )
    return {name: known.get(name, place) for name in used}


def _transforms(where: str, scene: dict[str, Any]) -> list[tuple[str, NDArray[np.float64]]]:
    """Reads the transforms of a scene: from the frame "child_frame_id" to the one of the header, which all share."""
    given = scene.get("fixed_frame_transforms") or []
    if not isinstance(given, list):
        raise InvalidInputError(f'{where}: "fixed_frame_transforms" must be a list')
    found: list[tuple[str, NDArray[np.float64]]] = []
    parents = {frame_of(entry) for entry in given}
    if len(parents) > 1:
        named = ", ".join(f"'{name}'" for name in sorted(parents))
        raise InvalidInputError(f"{where}: the fixed_frame_transforms lead to several frames ({named})")
    for entry in given:
        try:
            name, transform = str(entry["child_frame_id"]), entry["transform"]
            position = [float(transform["translation"][axis]) for axis in "xyz"]
            at = pose(position, xyzw=[float(transform["rotation"][axis]) for axis in "xyzw"])
        except (BeetleIkError, LookupError, OverflowError, TypeError, ValueError) as error:
            raise InvalidInputError(f"{where}: a transform that cannot be read: {entry!r:.60}") from error
        found.append((name.removeprefix("/"), at))
    return [(name, np.eye(4)) for name in parents] + found


def rigid(frame: ArrayLike) -> NDArray[np.float64]:
    """Returns the argument `frame` as a pose (4, 4).

    Raises:
        InvalidInputError: not a pose.
    """
    try:
        matrix = np.asarray(frame, dtype=float)
        if matrix.shape != (4, 4) or (matrix[3] != (0, 0, 0, 1)).any():
            raise ValueError
        return pose(matrix[:3, 3], matrix=matrix[:3, :3])
    except (TypeError, ValueError) as error:
        raise InvalidInputError(f"frame must be a pose (4, 4), got {frame!r:.60}") from error
