"""Poses along a line: the result of `on_surface`, `raster` and `join`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInputError, Path, from_samples
from .checks import Array, number


@dataclass(frozen=True, eq=False, repr=False)
class Seam:
    """Poses of the tip along a line, with the distance travelled. `plan_along_path` takes it as it is.

    The z axis of each pose points into the surface, the x axis along the line.

    Attributes:
        poses: poses (m, 4, 4) (m).
        distance: distance that the tip has travelled at each pose (m,) (m), from 0.
        contact: whether each pose is on the line itself (m,), not on a lead-in, a lead-out or a transition.
        edges: distances (m) at which the line crosses a sharp edge of the surface.
        closed: whether the line ends in its first pose.

    For example:

        >>> table = bik.obstacles.Box((0.5, 0.0, 0.1), (0.4, 0.4, 0.2))
        >>> seam = bik.paths.on_surface(table, [(0.4, 0.0, 0.2), (0.6, 0.0, 0.2)], lead_in=0.05)
        >>> round(seam.length, 3), seam.contact[:2].tolist()
        (0.25, [False, True])
        >>> round(seam.path(speed=0.1).duration, 6)
        2.5
    """

    poses: Array
    distance: Array
    contact: NDArray[np.bool_]
    edges: Array
    closed: bool

    @property
    def length(self) -> float:
        """Length of the line that the tip travels (m), with its leads and transitions."""
        return float(self.distance[-1])

    def path(self, speed: float) -> Path:
        """Returns the reference path at a constant speed of the tip (m/s), for `track`.

        Raises:
            InvalidInputError: a speed that is not positive, or two poses in a row at the same point.
        """
        pace = number("speed", speed, above=True)
        still = np.flatnonzero(np.diff(self.distance) <= 0.0)
        if len(still):
            i = int(still[0])
            raise InvalidInputError(f"poses {i} and {i + 1} are at the same point, where the tool only turns")
        return from_samples(self.distance / pace, self.poses)

    def __len__(self) -> int:
        """Returns the number of poses."""
        return len(self.poses)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """Returns the poses, so that calls take a seam in their place."""
        return np.array(self.poses, dtype=dtype, copy=copy)

    def __eq__(self, other: object) -> bool:
        """Whether the other is a seam of the same numbers."""
        if not isinstance(other, Seam):
            return NotImplemented
        return self.closed == other.closed and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in ("poses", "contact", "edges")
        )

    def __hash__(self) -> int:
        """Returns a hash of the poses."""
        return hash((self.poses.tobytes(), self.closed))

    def __repr__(self) -> str:
        """Returns a description in a line."""
        return f"Seam({len(self)} poses, {self.length:.4g} m{', closed' if self.closed else ''})"


def seam_of(poses: Array, contact: NDArray[np.bool_], edges: Array, *, closed: bool) -> Seam:
    """Returns a seam that cannot be changed, with its distances."""
    steps = np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1)
    seam = Seam(poses, np.concatenate([[0.0], np.cumsum(steps)]), contact, edges, closed)
    for array in (seam.poses, seam.distance, seam.contact, seam.edges):
        array.flags.writeable = False
    return seam
