"""The reachability map of an arm."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from .._core import MapGrid, Robot
from ..calls.arguments import require
from .inverse_map import InverseReachabilityMap
from .map_figure import drawn
from .map_file import QUALITY, read, require_results, write

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

_A_BATCH = 3  # dimensions of a batch of poses


class ReachabilityMap:
    """Poses that an arm reaches, computed by `reachability`: voxels, and orientations at the centre of each.

    Attributes:
        robot: the arm.
        origin: the lower corner of the voxels (3,) (m), in the frame of the robot's base.
        voxel: edge of a voxel (m).
        orientations: number of orientations of each voxel.
        axis: None, or the point (2,) (m) of a vertical axis, about which the orientations turn with the azimuth of the
            voxel.
        index: fraction of the orientations that are reached (x, y, z) float32.
        bits: a bit for each orientation (x, y, z, bytes) uint8, the lowest first.
        manipulability: largest manipulability found in each voxel (x, y, z) float32, NaN where there is none; None
            without `quality`.
        clearance: largest clearance found in each voxel (x, y, z) float32 (m), NaN without obstacles and
            self-collision; None without `quality`.
    """

    def __init__(
        self,
        robot: Robot,
        grid: MapGrid,
        bits: NDArray[np.uint8],
        manipulability: NDArray[np.float32] | None = None,
        clearance: NDArray[np.float32] | None = None,
    ) -> None:
        """Stores the results of all chunks of a grid; to make a map, call `reachability` or `load`."""
        require("robot", robot, Robot)
        require("grid", grid, MapGrid)
        require_results(grid, {"bits": bits, "manipulability": manipulability, "clearance": clearance})
        self.robot, self.grid, self.bits = robot, grid, bits
        self.manipulability, self.clearance = manipulability, clearance
        self.origin, self.voxel, self.axis, self.orientations = grid.origin, grid.voxel, grid.axis, grid.orientations
        self.index = np.empty(grid.shape, np.float32)
        for layer, part in zip(self.index, bits, strict=True):  # by layers: counts take eight times the bits
            layer[:] = np.bitwise_count(part).sum(axis=-1, dtype=np.float32) / grid.orientations
        for array in (bits, self.index):
            array.setflags(write=False)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of voxels along x, y and z."""
        x, y, z = self.grid.shape
        return x, y, z

    def query(self, T: ArrayLike) -> Any:  # noqa: N803
        """Returns whether poses are reached, by the voxel and the nearest orientation of each.

        Args:
            T: pose (4, 4), or poses (n, 4, 4).

        Returns:
            A bool, or (n,) bool; False outside the voxels.
        """
        found = self.grid.locate(T)
        inside = found[:, 0] >= 0
        x, y, z, number = found[inside].T
        reached = np.zeros(len(found), bool)
        reached[inside] = self.bits[x, y, z, number >> 3] >> (number & 7).astype(np.uint8) & 1
        return bool(reached[0]) if np.ndim(T) != _A_BATCH and len(reached) == 1 else reached

    def poses(self, voxel: tuple[int, int, int]) -> NDArray[np.float64]:
        """Returns the poses (orientations, 4, 4) of the voxel (x, y, z), numbered from 0."""
        return self.grid.poses(voxel)

    def reached(self, voxel: tuple[int, int, int]) -> NDArray[np.bool_]:
        """Returns whether each of the `poses` of the voxel (x, y, z) is reached (orientations,) bool."""
        self.grid.poses(voxel)  # refuses voxels outside
        return np.unpackbits(self.bits[tuple(voxel)], count=self.orientations, bitorder="little").astype(bool)

    def inverse(self) -> InverseReachabilityMap:
        """Returns the inverse map: the placements of the base from which a target is reached."""
        return InverseReachabilityMap(self)

    def plot(self, kind: Literal["slices", "cloud"] = "slices") -> Figure:
        """Draws the fraction of orientations reached: in three planes through the best voxel, or as an open cloud."""
        return drawn(self, kind)

    def to_npz(self, file: str | os.PathLike[str]) -> None:
        """Writes the map, with its robot, to a compressed npz file, from which `load` returns an equal one.

        A name without ending gets .npz.
        """
        results = {name: getattr(self, name) for name in ("bits", *QUALITY) if getattr(self, name) is not None}
        write(file, self.robot, self.grid, results)

    @staticmethod
    def load(file: str | os.PathLike[str], *, robot: Robot | None = None) -> ReachabilityMap:
        """Reads a map that `to_npz` wrote.

        Args:
            file: the file.
            robot: the required robot of the map; None: any.

        Raises:
            InvalidInputError: the file, which the message names, is no map, is damaged, or is of another version or
                robot.
        """
        return ReachabilityMap(**read(file, robot))

    def __eq__(self, other: object) -> bool:
        """Compares robot, voxels, orientations and results."""
        if not isinstance(other, ReachabilityMap):
            return NotImplemented
        if self.robot != other.robot or self.grid != other.grid:
            return False
        pairs = (("bits", False), ("manipulability", True), ("clearance", True))
        return all(_same(getattr(self, name), getattr(other, name), nan) for name, nan in pairs)

    __hash__ = None  # type: ignore[assignment]

    def _repr_html_(self) -> str:
        """Shows the map in a notebook."""
        from ..figures.notebook import reachability_map

        return reachability_map(self)

    def __repr__(self) -> str:
        """Shows the size of the map and the fraction that is reached."""
        held = int(np.count_nonzero(self.index))
        share = f"{100 * float(self.index.mean()):.3g} %"
        size = "x".join(map(str, self.shape))
        return (
            f"<ReachabilityMap of '{self.robot.name}': {size} voxels of {self.voxel:g} m, {held} of them reached; "
            f"{share} of {self.orientations * self.index.size} poses>"
        )


def _same(a: Any, b: Any, nan: bool) -> bool:
    if a is None or b is None:
        return a is b
    return np.array_equal(a, b, equal_nan=nan)


ReachabilityMap.__module__ = "beetle_ik"
