"""Numbers with names: dicts, ROS messages, and rows or tables of pandas and numpy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Labelled = tuple[list[str], NDArray[np.float64]]

_POSITIONS = "q:"  # as tables of trajectories name them, beside "qd:" and "qdd:"


def labelled(value: Any) -> Labelled | None:
    """Returns the names and numbers (k,) or (m, k) of a value whose numbers have names; None for anything else."""
    found = _parts(value)
    if found is None:
        return None
    names, numbers = found
    names = [str(name) for name in names]
    columns = [i for i, name in enumerate(names) if name.startswith(_POSITIONS)]
    if columns:
        names, numbers = [names[i].removeprefix(_POSITIONS) for i in columns], numbers[..., columns]
    return names, np.ascontiguousarray(numbers, dtype=np.float64)


def _parts(value: Any) -> tuple[list[Any], NDArray[Any]] | None:
    if isinstance(value, Mapping):
        return list(value), np.stack([np.asarray(each, dtype=np.float64) for each in value.values()], axis=-1)
    fields = getattr(getattr(value, "dtype", None), "names", None)
    if isinstance(fields, tuple):
        return list(fields), np.stack([np.asarray(value[name], dtype=np.float64) for name in fields], axis=-1)
    if hasattr(value, "name") and hasattr(value, "position"):  # sensor_msgs/JointState
        return list(value.name), np.asarray(value.position, dtype=np.float64)
    labels = getattr(value, "columns", None)
    if labels is None and getattr(value, "ndim", None) == 1:
        labels = getattr(value, "index", None)
    if not isinstance(labels, Iterable) or not any(isinstance(label, str) for label in labels):
        return None
    return list(labels), np.asarray(value, dtype=np.float64)
