"""Motions of a human hand or body for a robot of other measures: several points at once, by weights and levels."""

from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import tasks
from .._core import InvalidInputError, Robot, Step, Tracker, UnknownNameError, pose
from ..calls.text import listed

Array: TypeAlias = NDArray[np.float64]
_FLAT = 1e-6  # ratio of singular values below which points are on a line


class Retargeter:
    """Leads several tips of a robot by points of a human, in each tick inside all limits.

    `fit` finds how the human's points become the robot's, from one posture or several that both take: one scale, one
    rotation and one translation for all, and an offset for each point, so that the mean of these postures is met
    exactly.

    Args:
        robot: the robot, loaded with a list of tips.
        start_q: configuration at t = 0 (n,).
        points: tip of the robot for each point of the human, such as {"index": "index_tip"}.
        dt: time step (s).
        weights: cost of the squared distance of each point; those that are not named have 1. They count among points
            of one level that cannot all be met.
        levels: level of each point; those that are not named have 0. Points of a lower level are met first.
        options: further arguments of `Tracker`: limits, goals, obstacles, keep, target_filter and others.

    Raises:
        UnknownNameError: no tip of that name, or a weight or level of a point that is not led.
        InvalidInputError: as of `Tracker`; no point, two points for one tip, or a weight that is not positive.
    """

    def __init__(
        self,
        robot: Robot,
        start_q: ArrayLike,
        points: Mapping[str, str],
        *,
        dt: float,
        weights: Mapping[str, float] | None = None,
        levels: Mapping[str, int] | None = None,
        **options: Any,
    ) -> None:
        """Starts at rest; until `fit` is called, points are taken as they are."""
        self.points = dict(points)
        _check_points(robot, self.points, {"weights": weights or {}, "levels": levels or {}})
        task = {}
        for name, tip in self.points.items():
            weight = float((weights or {}).get(name, 1.0))
            if not 0.0 < weight < np.inf:
                raise InvalidInputError(f"weights: the weight of '{name}' must be positive, got {weight:g}")
            # Weights of a task multiply the errors, not their squares.
            task[tip] = tasks.Position(weights=np.full(3, np.sqrt(weight)), level=int((levels or {}).get(name, 0)))
        self.tracker = Tracker(robot, start_q, dt=dt, task=task, **options)
        self.scale = 1.0
        """Ratio of the robot's measures to the human's."""
        self.transform = np.eye(4)
        """Rotation and translation (4, 4) from the human's frame to that of the robot's base, after the scale."""
        self.offsets = {name: np.zeros(3) for name in self.points}
        """Offset of each point in the frame of the base (3,) (m)."""

    def fit(
        self,
        human: Mapping[str, ArrayLike],
        q: ArrayLike,
        *,
        scale: float | None = None,
        rotation: ArrayLike | None = None,
        offsets: bool = True,
    ) -> float:
        """Fits scale, rotation, translation and offsets, by least squares (Umeyama 1991).

        Args:
            human: position (3,) (m) of each point in one posture, or positions (m, 3) in several, in a frame that
                moves with the palm or the pelvis.
            q: configuration of the robot (n,) in that posture, or (m, n).
            scale: ratio of measures; None: fitted.
            rotation: rotation (3, 3) from the human's frame to the robot's base; None: fitted, from three points or
                more that are not on a line.
            offsets: whether each point gets an offset.

        Returns:
            Root mean square of the distances that remain (m).

        Raises:
            InvalidInputError: a point that is missing, wrong shape, NaN, a scale that is not positive, or too few
                points for a rotation or a scale.
        """
        theirs, ours = self._postures(human, q)
        if scale is not None and not 0.0 < scale < np.inf:
            raise InvalidInputError(f"scale must be positive, got {scale!r:.60}")
        here, there = theirs.reshape(-1, 3), ours.reshape(-1, 3)
        mine, yours = there - there.mean(axis=0), here - here.mean(axis=0)
        turn = _rotation(yours, mine) if rotation is None else pose([0, 0, 0], matrix=rotation)[:3, :3]
        turned = yours @ turn.T
        size = float(np.sum(turned**2))
        if scale is None and size == 0.0:
            raise InvalidInputError("human: all points are one, from which no scale can be found: give scale=")
        self.scale = float(np.sum(turned * mine) / size) if scale is None else float(scale)
        if self.scale <= 0.0:
            raise InvalidInputError("human: the points do not resemble those of the robot: give scale= and rotation=")
        self.transform = np.eye(4)
        self.transform[:3, :3] = turn
        self.transform[:3, 3] = there.mean(axis=0) - self.scale * turn @ here.mean(axis=0)
        left = ours - (self.scale * theirs @ turn.T + self.transform[:3, 3])
        means = left.mean(axis=0) if offsets else np.zeros((len(self.points), 3))
        self.offsets = dict(zip(self.points, means, strict=True))
        return float(np.sqrt(np.mean(np.sum((left - means) ** 2, axis=2))))

    def targets(self, human: Mapping[str, ArrayLike], *, frame: ArrayLike | None = None) -> dict[str, Array]:
        """Returns the target (3,) (m) of each tip; a point that is missing, or NaN, gives none.

        Args:
            human: position (3,) (m) of each point.
            frame: pose (4, 4) of the palm or the pelvis, in the frame of the points; None: they are given in its frame.

        Raises:
            UnknownNameError: a point that is not led.
            InvalidInputError: wrong shape, or a frame that is no pose.
        """
        inward = np.eye(4) if frame is None else np.linalg.inv(pose(matrix=frame))
        found = {}
        for name, place in human.items():
            if name not in self.points:
                raise UnknownNameError(f"no point '{name}' is led; points: {listed(self.points)}")
            point = _point(name, place)
            if np.isfinite(point).all():
                local = inward[:3, :3] @ point + inward[:3, 3]
                moved = self.scale * self.transform[:3, :3] @ local + self.transform[:3, 3]
                found[self.points[name]] = moved + self.offsets[name]
        return found

    def step(
        self, human: Mapping[str, ArrayLike] | None, *, frame: ArrayLike | None = None, stamp: float | None = None
    ) -> Step:
        """Moves the robot by one tick towards the points.

        Args:
            human: as of `targets`; None, or no point at all: nothing new in this tick.
            frame: as of `targets`.
            stamp: time at which the points were measured (s), as of `Tracker.step`.

        Raises:
            UnknownNameError: as of `targets`.
            InvalidInputError: as of `targets`.
        """
        targets = {} if human is None else self.targets(human, frame=frame)
        return self.tracker.step(targets or None, stamp=stamp)

    def _postures(self, human: Mapping[str, ArrayLike], q: ArrayLike) -> tuple[Array, Array]:
        """Returns positions of the points of human and robot, both (m, k, 3) (m)."""
        robot = self.tracker.robot
        missing = [name for name in self.points if name not in human]
        if missing:
            raise InvalidInputError(f"human: points are missing: {listed(missing)}")
        theirs = np.stack([np.atleast_2d(np.asarray(human[name], dtype=float)) for name in self.points], axis=1)
        at = [robot.tips.index(tip) for tip in self.points.values()]
        ours = robot.fk(np.atleast_2d(np.asarray(q, dtype=float)))[:, :, :3, 3][:, at]
        if theirs.shape != ours.shape:
            raise InvalidInputError(
                f"human: expected (3,) or ({len(ours)}, 3) for each point, as many as configurations, "
                f"got shape {theirs.shape[:1] + theirs.shape[2:]}"
            )
        if not np.isfinite(theirs).all():
            raise InvalidInputError("human: positions must be finite")
        return theirs, ours


def _check_points(robot: Robot, points: Mapping[str, str], named: Mapping[str, Mapping[str, Any]]) -> None:
    if not points:
        raise InvalidInputError("points: at least one is needed, got none")
    for tip in points.values():
        if tip not in robot.tips:
            raise UnknownNameError(f"points: no tip '{tip}'; tips: {listed(robot.tips)}")
        if list(points.values()).count(tip) > 1:
            raise InvalidInputError(f"points: two points lead the tip '{tip}'")
    for argument, values in named.items():
        for name in values:
            if name not in points:
                raise UnknownNameError(f"{argument}: no point '{name}' is led; points: {listed(points)}")


def _point(name: str, place: ArrayLike) -> Array:
    point = np.asarray(place, dtype=float)
    if point.shape != (3,):
        raise InvalidInputError(f"human: expected (3,) for point '{name}', got shape {point.shape}")
    return point


def _rotation(start: Array, end: Array) -> Array:
    """Returns the rotation (3, 3) that turns centred points (k, 3) onto others best (Kabsch 1976)."""
    left, sizes, right = np.linalg.svd(end.T @ start)
    if sizes[1] <= _FLAT * sizes[0] or sizes[0] == 0.0:
        raise InvalidInputError("human: the points are on a line, from which no rotation can be found: give rotation=")
    mirrored = np.linalg.det(left) * np.linalg.det(right) < 0.0
    return np.asarray(left @ np.diag([1.0, 1.0, -1.0 if mirrored else 1.0]) @ right)
