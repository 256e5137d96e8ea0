"""Rigid transforms given by users, as arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .._core import InvalidInputError, pose

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def one_target(target: ArrayLike | None) -> NDArray[np.float64]:
    """Returns the pose (4, 4) of the only target; None: the origin."""
    wanted = np.eye(4) if target is None else rigid("target", target)
    if wanted.shape != (4, 4):
        raise InvalidInputError(f"target: expected shape (4, 4), got {wanted.shape}")
    return wanted


def rigid(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """Returns poses (4, 4) or (n, 4, 4) as an array; rounded rotations become rotations.

    Raises:
        InvalidInputError: another shape, no numbers, or no rigid transform; the message names the argument.
    """
    try:
        poses = np.asarray(value, float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"{name} must be an array of numbers, got {value!r:.60}") from None
    if poses.shape[-2:] != (4, 4) or poses.ndim not in (2, 3) or not np.isfinite(poses).all():
        raise InvalidInputError(f"{name}: expected finite poses (4, 4) or (n, 4, 4), got shape {poses.shape}")
    return np.reshape([_transform(name, poses, i) for i in range(poses.size // 16)], poses.shape)


def _transform(name: str, poses: NDArray[np.float64], i: int) -> NDArray[np.float64]:
    """Returns the rigid transform nearest to pose `i`; the error of another matrix names it."""
    try:
        return pose(matrix=poses.reshape(-1, 4, 4)[i])
    except InvalidInputError as error:
        named = name if poses.ndim == 2 else f"{name}: pose {i}"
        raise InvalidInputError(str(error).replace("matrix", named, 1)) from None


def inverted(poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the inverses of rigid transforms (..., 4, 4)."""
    turned = np.swapaxes(poses[..., :3, :3], -1, -2)
    result = np.zeros_like(poses)
    result[..., :3, :3], result[..., 3, 3] = turned, 1.0
    result[..., :3, 3] = -(turned @ poses[..., :3, 3:])[..., 0]
    return result
