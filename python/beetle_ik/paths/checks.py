"""Checks of the arguments of paths: numbers, points and directions, with errors that name the argument."""

import math
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInputError

Array = NDArray[np.float64]

FARTHEST = 1e6  # m, coordinates that are taken
MOST_POSES = 1_000_000
"""Poses of a path, at most: more is a slip in a step or a tolerance."""


def number(name: str, value: object, *, least: float = 0.0, most: float = math.inf, above: bool = False) -> float:
    """Returns a finite number that is at least `least`, or above it, and at most `most`."""
    if isinstance(value, bool | np.bool) or not isinstance(value, Real):
        raise InvalidInputError(f"{name} must be a number, got {value!r:.60}")
    taken = float(value)
    if not math.isfinite(taken) or taken < least or (above and taken <= least) or taken > most:
        raise InvalidInputError(f"{name} must be {_range(least, most, above=above)}, got {taken:g}")
    return taken


def _range(least: float, most: float, *, above: bool) -> str:
    if most < math.inf:
        return f"between {least:g} and {most:g}"
    return "positive and finite" if above else "zero or more, and finite"


def rows(name: str, value: ArrayLike, width: int, fewest: int) -> Array:
    """Returns rows (k, width) of finite numbers, at least `fewest`."""
    try:
        taken: Any = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"{name} must be an array of numbers (k, {width}), got {value!r:.60}") from None
    if taken.ndim != 2 or taken.shape[1] != width:
        raise InvalidInputError(f"{name}: expected shape (k, {width}), got {taken.shape}")
    if len(taken) < fewest:
        raise InvalidInputError(f"{name}: at least {fewest} are needed, got {len(taken)}")
    usable = (np.abs(taken) <= FARTHEST).all(axis=1)
    if not usable.all():
        row = int(np.flatnonzero(~usable)[0])
        kind = f"within {FARTHEST:g} m" if np.isfinite(taken[row]).all() else "finite"
        raise InvalidInputError(f"{name}[{row}] must be {kind}, got {taken[row].tolist()}")
    return np.asarray(taken, dtype=float)


def point(name: str, value: ArrayLike) -> Array:
    """Returns three finite numbers (3,)."""
    try:
        taken = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"{name} must be three numbers, got {value!r:.60}") from None
    if taken.shape != (3,):
        raise InvalidInputError(f"{name}: expected shape (3,), got {taken.shape}")
    if not np.isfinite(taken).all():
        raise InvalidInputError(f"{name} must be finite, got {taken.tolist()}")
    return taken


def direction(name: str, value: ArrayLike) -> Array:
    """Returns a direction (3,) of unit length."""
    taken = point(name, value)
    largest = float(np.abs(taken).max())
    if largest == 0.0:
        raise InvalidInputError(f"{name} must not be zero, got {taken.tolist()}")
    taken = taken / largest  # whose squares neither vanish nor overflow
    return np.asarray(taken / np.linalg.norm(taken), dtype=float)


def choice(name: str, value: object, *choices: str) -> str:
    """Returns one of the choices."""
    if not isinstance(value, str) or value not in choices:
        raise InvalidInputError(f"{name} must be {' or '.join(map(repr, choices))}, got {value!r:.60}")
    return value


def require_count(name: str, size: float, poses: float) -> None:
    """Raises `InvalidInputError` if a path would have too many poses."""
    if poses > MOST_POSES:
        raise InvalidInputError(f"{name}: {size:g} m would make {poses:.3g} poses; at most {MOST_POSES:,} are made")
