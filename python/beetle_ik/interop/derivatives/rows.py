"""Leading axes as rows of one call of the core."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Rows: TypeAlias = NDArray[np.float64]


def in_rows(compute: Callable[..., Rows], *arrays: ArrayLike, ndims: tuple[int, ...], shape: tuple[int, ...]) -> Rows:
    """Calls `compute` once for all rows, and gives its result the leading axes of `arrays`, broadcast.

    Args:
        compute: takes arrays (m, ...), and returns (m, *shape).
        arrays: values with any leading axes.
        ndims: number of axes that belong to each array itself, not to the rows.
        shape: shape of one result.

    A row with NaN or infinite values gives NaN, as functions of JAX and PyTorch do; the core does not see it.
    """
    values = [np.asarray(array, dtype=np.float64) for array in arrays]
    own = [value.shape[value.ndim - ndim :] for value, ndim in zip(values, ndims, strict=True)]
    leading = np.broadcast_shapes(
        *(value.shape[: value.ndim - ndim] for value, ndim in zip(values, ndims, strict=True))
    )
    count = int(np.prod(leading))
    flat = [
        np.broadcast_to(value, leading + each).reshape(count, *each) for value, each in zip(values, own, strict=True)
    ]
    if all(np.isfinite(value).all() for value in values):
        return compute(*flat).reshape(leading + shape)
    finite = np.logical_and.reduce([np.isfinite(value.reshape(count, -1)).all(axis=1) for value in flat])
    result = np.full((count, *shape), np.nan)
    if finite.any():
        result[finite] = compute(*(value[finite] for value in flat))
    return result.reshape(leading + shape)
