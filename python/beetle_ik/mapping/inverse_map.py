"""Placements of the base from which a target is reached."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np

from .._core import InvalidInputError, pose
from ..calls.arguments import require_count
from .map_figure import MappedVoxels, drawn_on_floor
from .rigid_poses import inverted, one_target, rigid

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

_MOST_YAWS = 3600
_PLACES = 81  # places of a figure along x and y


@runtime_checkable
class _Map(MappedVoxels, Protocol):
    """Interface of `ReachabilityMap` that the inverse map uses."""

    def query(self, T: ArrayLike) -> Any: ...  # noqa: N803


class InverseReachabilityMap:
    """A reachability map seen from the target, made by `ReachabilityMap.inverse`. Bases and targets are in one frame.

    A base B reaches the target T where the map reaches B^-1 T, so both maps agree by construction.

    Attributes:
        map: the reachability map.
    """

    def __init__(self, map: _Map) -> None:  # noqa: A002
        """Stores the map."""
        if not isinstance(map, _Map):
            raise InvalidInputError(f"map must be a ReachabilityMap, got {map!r:.60}")
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
        """Returns the fraction of yaws at which an upright base reaches a target, for each place (x, y).

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
        """Draws the fraction of yaws at which an upright base at this height (m) reaches a target (4, 4), by place."""
        radius = 0.5 * self.map.voxel * max(self.map.index.shape[:2])
        at = one_target(target)[:2, 3]
        x, y = (centre + np.linspace(-radius, radius, _PLACES) for centre in at)
        share = self.on_floor(x, y, target=target, height=height)
        title = f"{self.map.robot.name}: where an upright base at z = {height:g} m reaches the target"
        return drawn_on_floor(title, at, x, y, share)

    def _repr_html_(self) -> str:
        """Shows the map in a notebook."""
        from ..figures.notebook import reachability_map

        return f"<b>InverseReachabilityMap</b>: where may the base stand?<div>{reachability_map(self.map)}</div>"

    def __repr__(self) -> str:
        """Names the map."""
        return f"<InverseReachabilityMap of {self.map!r}>"


def _numbers(name: str, value: ArrayLike, *, dimensions: int = 1) -> NDArray[np.float64]:
    """Returns finite numbers with at most `dimensions` dimensions."""
    try:
        numbers = np.asarray(value, float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"{name} must be numbers, got {value!r:.60}") from None
    if numbers.ndim > dimensions or not np.isfinite(numbers).all():
        raise InvalidInputError(f"{name} must be finite, in {dimensions} dimensions at most, got {value!r:.60}")
    return numbers


InverseReachabilityMap.__module__ = "beetle_ik"
