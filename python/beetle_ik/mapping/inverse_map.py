"""Where the base may stand so that a target is reached."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .._arguments import require, require_count
from .._core import InvalidInputError, pose
from .reachability_map import ReachabilityMap

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

_MOST_YAWS = 3600


class InverseReachabilityMap:
    """The same map seen from the target, made by `ReachabilityMap.inverse`. Bases and targets are poses in one frame.

    A base B reaches the target T where the map reaches B^-1 T, so both maps agree by construction.

    Attributes:
        map: the map.
    """

    def __init__(self, map: ReachabilityMap) -> None:  # noqa: A002
        """Keeps the map."""
        require("map", map, ReachabilityMap)
        self.map = map

    def query(self, base: ArrayLike, target: ArrayLike | None = None) -> Any:
        """Returns whether the arm reaches a target from these bases.

        Args:
            base: pose (4, 4) or poses (n, 4, 4) of the robot's base.
            target: pose (4, 4) of the tip; None: the origin.

        Returns:
            A bool, or (n,) bool.
        """
        return self.map.query(inverted(rigid("base", base)) @ one_target(target))

    def on_floor(
        self, x: ArrayLike, y: ArrayLike, *, target: ArrayLike | None = None, height: float = 0.0, yaws: int = 24
    ) -> NDArray[np.float32]:
        """Returns the share of yaws at which an upright base reaches a target, for each place (x, y).

        Args:
            x: coordinates of the places (i,) (m).
            y: coordinates of the places (j,) (m).
            target: pose (4, 4) of the tip; None: the origin.
            height: height of the base (m).
            yaws: number of yaws, spread evenly over a turn.

        Returns:
            (i, j) float32.
        """
        require_count("yaws", yaws)
        if not 1 <= yaws <= _MOST_YAWS:
            raise InvalidInputError(f"yaws must be from 1 to {_MOST_YAWS}, got {yaws}")
        xs, ys = (np.atleast_1d(_numbers(name, line)) for name, line in (("x", x), ("y", y)))
        height = float(_numbers("height", height, dimensions=0))
        reached = np.zeros((len(xs), len(ys)), int)
        for yaw in np.arange(yaws) * (2 * np.pi / yaws):
            bases = np.tile(pose([0.0, 0.0, height], rpy=[0.0, 0.0, yaw]), (len(xs), len(ys), 1, 1))
            bases[..., 0, 3], bases[..., 1, 3] = xs[:, None], ys
            reached += self.query(bases.reshape(-1, 4, 4), target).reshape(reached.shape)
        return (reached / yaws).astype(np.float32)

    def plot(self, target: ArrayLike | None = None, *, height: float = 0.0) -> Figure:
        """Draws where an upright base at this height (m) reaches a target (4, 4), by the share of its yaws."""
        from . import map_figure

        return map_figure.drawn_on_floor(self, target, height)

    def __repr__(self) -> str:
        """Names the map."""
        return f"<InverseReachabilityMap of {self.map!r}>"


def _numbers(name: str, value: ArrayLike, *, dimensions: int = 1) -> NDArray[np.float64]:
    """Returns finite numbers of at most so many dimensions."""
    try:
        numbers = np.asarray(value, float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"{name} must be numbers, got {value!r:.60}") from None
    if numbers.ndim > dimensions or not np.isfinite(numbers).all():
        raise InvalidInputError(f"{name} must be finite, in {dimensions} dimensions at most, got {value!r:.60}")
    return numbers


def one_target(target: ArrayLike | None) -> NDArray[np.float64]:
    """Returns the pose (4, 4) of the only target; None: the origin."""
    wanted = np.eye(4) if target is None else rigid("target", target)
    if wanted.shape != (4, 4):
        raise InvalidInputError(f"target: expected shape (4, 4), got {wanted.shape}")
    return wanted


def rigid(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """Returns poses (4, 4) or (n, 4, 4) as an array.

    Raises:
        InvalidInputError: another shape, or no numbers. Names the argument.
    """
    try:
        poses = np.asarray(value, float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"{name} must be an array of numbers, got {value!r:.60}") from None
    if poses.shape[-2:] != (4, 4) or poses.ndim not in (2, 3) or not np.isfinite(poses).all():
        raise InvalidInputError(f"{name}: expected finite poses (4, 4) or (n, 4, 4), got shape {poses.shape}")
    return poses


def inverted(poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the inverses of rigid transforms (..., 4, 4)."""
    turned = np.swapaxes(poses[..., :3, :3], -1, -2)
    result = np.zeros_like(poses)
    result[..., :3, :3], result[..., 3, 3] = turned, 1.0
    result[..., :3, 3] = -(turned @ poses[..., :3, 3:])[..., 0]
    return result


InverseReachabilityMap.__module__ = "beetle_ik"
