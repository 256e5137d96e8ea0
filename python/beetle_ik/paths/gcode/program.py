"""A program of moves, read from G-code."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..._core import Path, from_samples
from ..checks import Array, number
from ..seam import Seam, seam_of


@dataclass(frozen=True)
class GcodeMove:
    """A move of a program.

    Attributes:
        kind: "rapid", "line" or "arc".
        first: index of the pose where it begins.
        last: index of the pose where it ends.
        feed: speed of the tip (m/s); NaN for a rapid move.
        line: line of the program, from 1.
    """

    kind: str
    first: int
    last: int
    feed: float
    line: int


@dataclass(frozen=True, eq=False, repr=False)
class GcodeProgram:
    """Poses of the tip through a program, and how each step from pose to pose is made.

    Attributes:
        poses: poses (m, 4, 4) (m) in the frame of the robot's base; the first one is where the path begins.
        moves: the moves, a list of `GcodeMove`. Of an arc, `poses[(first + last) // 2]` is a pose on the way.
        rapid: whether each step is rapid, (m - 1,).
        feeds: speed of the tip in each step (m - 1,) (m/s); NaN where it is rapid.
        extrusion: length that a printer extrudes in each step (m - 1,) (m), from the E words.
        ignored: lines without effect on the path, a list of (line, text): coolant, temperatures, waits, homing,
            commands of firmware, and moves from or to a position that is not known.
    """

    poses: Array
    moves: list[GcodeMove]
    rapid: NDArray[np.bool_]
    feeds: Array
    extrusion: Array
    ignored: list[tuple[int, str]]

    @property
    def length(self) -> float:
        """Length of all steps that are not rapid (m)."""
        return float(self._lengths()[~self.rapid].sum())

    def seams(self) -> list[Seam]:
        """Returns the stretches between rapid moves, each as a `Seam`; of a program with E words those that extrude.

        The tool's orientation is that of the program; its x axis does not turn along the line.
        """
        working = ~self.rapid & (self.extrusion > 0.0) if (self.extrusion > 0.0).any() else ~self.rapid
        bounds = np.flatnonzero(np.diff(np.concatenate([[False], working, [False]]).astype(int)))
        stretches = [self.poses[first : last + 1] for first, last in bounds.reshape(-1, 2)]
        return [
            seam_of(
                poses.copy(), np.ones(len(poses), dtype=bool), np.empty(0), closed=np.array_equal(poses[0], poses[-1])
            )
            for poses in stretches
        ]

    def path(self, rapid_speed: float, *, turn_speed: float = 1.0) -> Path:
        """Returns the reference path at the speeds of the program, for `track`.

        Args:
            rapid_speed: speed of rapid moves (m/s).
            turn_speed: speed of steps in which the tool only turns (rad/s).

        Raises:
            InvalidInputError: a speed that is not positive.
        """
        speeds = np.where(self.rapid, number("rapid_speed", rapid_speed, above=True), self.feeds)
        pace = number("turn_speed", turn_speed, above=True)
        turns = self.poses[:-1, :3, :3].transpose(0, 2, 1) @ self.poses[1:, :3, :3]
        angles = np.arccos(np.clip((np.trace(turns, axis1=1, axis2=2) - 1.0) / 2.0, -1.0, 1.0))
        lengths = self._lengths()
        steps = np.where(lengths > 0.0, lengths / speeds, angles / pace)
        return from_samples(np.concatenate([[0.0], np.cumsum(steps)]), self.poses)

    def _lengths(self) -> Array:
        return np.asarray(np.linalg.norm(np.diff(self.poses[:, :3, 3], axis=0), axis=1), dtype=float)

    def __len__(self) -> int:
        """Returns the number of poses."""
        return len(self.poses)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """Returns the poses, so that calls take a program in their place."""
        return np.array(self.poses, dtype=dtype, copy=copy)

    def __repr__(self) -> str:
        """Returns a description in a line."""
        return f"GcodeProgram({len(self.moves)} moves, {len(self)} poses, {self.length:.4g} m)"
