"""Best placement of the base for several targets."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .._core import InvalidInputError, Obstacle, Robot, pose, solve_batch
from ..calls.arguments import require
from ..calls.text import counted
from ..calls.wording import worded_call
from ..scenes import Scene
from .compute import reachability
from .map_file import require_same_robot
from .reachability_map import ReachabilityMap
from .rigid_poses import inverted, rigid

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_YAWS = 24
_WIDEST = 8  # largest distance around a place that counts for its margin, in voxels
_VERIFIED = 32  # places verified by `solve`
_MOST_PLACES = 10_000_000


@dataclass(frozen=True, eq=False)
class BasePlacement:
    """The best placement of a robot's base for several targets, found by `best_base`."""

    pose: NDArray[np.float64]
    """Pose of the base (4, 4)."""
    reached: NDArray[np.bool_]
    """Whether each target is reached from there (k,) bool, by `solve`."""
    margin: float
    """Displacement of the base in x, y and z (m) within the region at which the map still reaches the same targets: in
    steps of its voxels, at most 8."""

    @property
    def success(self) -> bool:
        """Whether all targets are reached."""
        return bool(self.reached.all())

    @property
    def message(self) -> str:
        """Number of reached targets."""
        x, y, z = self.pose[:3, 3]
        count = f"{int(self.reached.sum())} of {counted(len(self.reached), 'target')}"
        found = f"{count} reached from ({x:.3g}, {y:.3g}, {z:.3g})"
        return found if self.success else f"{found}; widen the region, or move the others"

    def _repr_html_(self) -> str:
        """Shows the place in a notebook."""
        from html import escape

        from ..figures.notebook import shown, table

        yaw = float(np.arctan2(self.pose[1, 0], self.pose[0, 0]))
        rows = [
            ["base [m]", shown(self.pose[:3, 3])],
            ["yaw [rad]", shown(yaw)],
            ["may be off by [m]", shown(self.margin)],
        ]
        return f"<b>BasePlacement</b>: {escape(self.message)}{table(rows)}"

    def __repr__(self) -> str:
        """Shows the number of reached targets."""
        return f"<BasePlacement: {self.message}>"


@worded_call
def best_base(
    robot: Robot,
    targets: ArrayLike,
    *,
    region: ArrayLike,
    obstacles: Iterable[Obstacle] | None = None,
    map: ReachabilityMap | None = None,  # noqa: A002
) -> BasePlacement:
    """Finds the placement of an upright base that reaches most of several targets, with the widest margin.

    A map ranks the places of a grid as fine as its voxels, at 24 yaws each; the best 32 are verified by `solve`.

    Args:
        robot: the arm.
        targets: poses (k, 4, 4) of its tip.
        region: two opposite corners (2, 3) (m) of the box in which the base may stand, in the frame of the targets.
        obstacles: obstacles that solutions keep clear of, in the frame of the targets.
        map: a map of the robot; None: a map with voxels of 5 cm is computed.

    Returns:
        A `BasePlacement`.

    Raises:
        InvalidInputError: wrong shape, NaN, or no rigid transform; a map of another robot.
    """
    require("robot", robot, Robot)
    wanted = rigid("targets", targets)
    if wanted.ndim == 2 or len(wanted) == 0:
        raise InvalidInputError(f"targets: expected poses (k, 4, 4), one at least, got shape {wanted.shape}")
    scene = None if obstacles is None else Scene(obstacles)
    if map is None:
        map = reachability(robot)  # noqa: A001
    require("map", map, ReachabilityMap)
    require_same_robot("map", map.robot, robot)
    axes = _axes(region, map.voxel)
    ranked = _ranked(map, wanted, axes)
    mount = robot.link_poses(np.zeros(robot.dof))[0]
    best: BasePlacement | None = None
    for predicted, margin, base in ranked:
        if best is not None and best.reached.sum() >= predicted:
            break
        placed = robot.with_base(base @ mount)
        found = solve_batch(placed, wanted, obstacles=scene).success
        if best is None or found.sum() > best.reached.sum():
            best = BasePlacement(base, found, margin)
    assert best is not None, "there is one place at least"
    return best


def _axes(region: ArrayLike, voxel: float) -> list[NDArray[np.float64]]:
    """Returns the coordinates of the places along x, y and z (m)."""
    try:
        corners = np.asarray(region, float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"region must be two corners (2, 3), got {region!r:.60}") from None
    if corners.shape != (2, 3):
        raise InvalidInputError(f"region: expected two corners (2, 3), got shape {corners.shape}")
    if not np.isfinite(corners).all():
        raise InvalidInputError(f"region must be finite, got {corners.tolist()}")
    lower, upper = corners.min(axis=0), corners.max(axis=0)
    counts = np.floor((upper - lower) / voxel + 1.0 + 1e-9)
    if counts.prod() * _YAWS > _MOST_PLACES:
        raise InvalidInputError(
            f"region: {counts.prod() * _YAWS:.3g} places to try, at most {_MOST_PLACES:.0e}: take a smaller region, or "
            "a map with larger voxels"
        )
    middle = 0.5 * (lower + upper)
    return [m + voxel * (np.arange(int(n)) - 0.5 * (int(n) - 1)) for m, n in zip(middle, counts, strict=True)]


def _ranked(
    map: ReachabilityMap,  # noqa: A002
    targets: NDArray[np.float64],
    axes: list[NDArray[np.float64]],
) -> list[tuple[int, float, NDArray[np.float64]]]:
    """Returns the best places: number of targets that the map reaches from there, margin (m), and base (4, 4)."""
    shape = tuple(map_axis.size for map_axis in axes)
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    found: list[tuple[int, float, NDArray[np.float64]]] = []
    for yaw in np.arange(_YAWS) * (2 * np.pi / _YAWS):
        turned = pose([0.0, 0.0, 0.0], rpy=[0.0, 0.0, yaw])
        back = np.tile(inverted(turned), (len(places), 1, 1))
        back[:, :3, 3] = -places @ turned[:3, :3]
        reached = np.stack([map.query(back @ target) for target in targets])
        count = reached.sum(axis=0)
        margins = _margins(reached.reshape(len(targets), *shape)).ravel() * map.voxel
        for place in np.lexsort((-margins, -count))[:_VERIFIED]:
            base = turned.copy()
            base[:3, 3] = places[place]
            found.append((int(count[place]), float(margins[place]), base))
    found.sort(key=lambda entry: (-entry[0], -entry[1]))
    return found[:_VERIFIED]


def _margins(reached: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Returns the steps around each place (k, x, y, z) within which its targets stay reached, at most 8."""
    margins = np.zeros(reached.shape[1:], np.int64)
    eroded = kept = reached
    alive = np.ones(reached.shape[1:], bool)
    for _ in range(_WIDEST):
        for axis in range(1, 4):
            if reached.shape[axis] == 1:
                continue
            edge = [(0, 0)] * 4
            edge[axis] = (1, 1)
            padded = np.pad(eroded, edge, mode="edge")
            size = reached.shape[axis]
            before, after = (np.take(padded, np.arange(start, start + size), axis=axis) for start in (0, 2))
            eroded = eroded & before & after
        alive &= (eroded == kept).all(axis=0) & reached.any(axis=0)
        margins += alive
    return margins


BasePlacement.__module__ = "beetle_ik"
