"""The skeleton of a robot without meshes: its rigid parts, the axes between them, the points that links run through.

It is computed from the poses of the links alone, so it is the same for Denavit-Hartenberg tables and files.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .._core import Robot

    Array = NDArray[np.float64]

_TURN = 0.3  # rad, m: test displacement of a joint, which shows the links that it moves
_MOVED = 1e-9
_PARALLEL = 0.05  # rad: the common normal of axes at a smaller angle may be anywhere


@dataclass
class Axis:
    """The axis of a joint: a line through `point` along `along`, at the configuration of the skeleton.

    Attributes:
        travel: range of a prismatic joint to either side (m); None: the joint is revolute.
        enter: point where the links before the joint meet the axis.
        leave: point where the links after the joint leave the axis.
        row: point where the links meet the first of a row of parallel axes; None: this axis is the first.
    """

    along: Array
    point: Array
    travel: tuple[float, float] | None
    enter: Array = field(default_factory=lambda: np.zeros(3))
    leave: Array = field(default_factory=lambda: np.zeros(3))
    row: Array | None = None

    def foot(self, point: Array) -> Array:
        """Returns the point of the axis nearest to `point`."""
        return self.point + self.along * float((point - self.point) @ self.along)


@dataclass
class Part:
    """Links that move as one. What a mimic joint moves is a part of its own.

    Attributes:
        links: their names.
        axis: the axis about which the part moves; None for a fixed part, or a part that several joints move at once.
        after: the parts that move relative to this part.
        ends: pairs of poses (4, 4) for each tip link on the part: of the link, and of its tip, which a tool moves.
        distance: length of the skeleton from the base to the part (m).
    """

    links: list[str]
    axis: Axis | None
    after: list[Part] = field(default_factory=list)
    ends: list[tuple[Array, Array]] = field(default_factory=list)
    distance: float = 0.0

    @property
    def about(self) -> Axis:
        """The axis of a part that moves on another."""
        assert self.axis is not None, "it moves on another"
        return self.axis

    @property
    def stub(self) -> float:
        """Length that the links run along the axis (m)."""
        return 0.0 if self.axis is None else float(np.linalg.norm(self.axis.leave - self.axis.enter))

    @property
    def way_to_tip(self) -> float:
        """Distance (m) from the point where the links leave the axis to the tip on the part."""
        if self.axis is None or not self.ends:
            return 0.0
        return float(np.linalg.norm(self.ends[0][0][:3, 3] - self.axis.leave))


def skeleton(robot: Robot, q: Array) -> tuple[list[Part], Array]:
    """Returns the parts at the root of the robot at `q` (n,), and the poses of all links (links, 4, 4)."""
    moved = _Displacements(robot, q)
    parts: list[Part] = []
    part_of: dict[str, Part] = {}
    for link in robot.all_link_names:
        part = next((each for each in parts if not moved.between(each.links[0], link)), None)
        if part is None:
            parts.append(part := Part([], None))
        part.links.append(link)
        part_of[link] = part
    placed: list[Part] = []
    for way in robot._links_to_tips():
        for previous, link in pairwise(way):
            before, part = part_of[previous], part_of[link]
            joints = moved.between(before.links[0], part.links[0])
            if part is before or part in placed or len(joints) != 1:  # several joints: as of a mobile base
                continue
            part.axis = moved.axis(before.links[0], part.links[0], joints[0])
            before.after.append(part)
            placed.append(part)
    for tip, pose in zip(robot.tips, robot.fk(q).reshape(-1, 4, 4), strict=True):
        part_of[tip].ends.append((moved.pose(tip), pose))
    roots = [part for part in parts if part not in placed]
    for root in roots:
        _run(root, moved.pose(root.links[0])[:3, 3])
    return [root for root in roots if root.after], moved.poses


class _Displacements:
    """Poses of all links, at one configuration and after a step of each joint."""

    def __init__(self, robot: Robot, q: Array) -> None:
        self._robot, self._q = robot, q
        self._steps = np.where(q + _TURN <= robot.upper, _TURN, -_TURN)
        self._index = {link: i for i, link in enumerate(robot.all_link_names)}
        self.poses: Array = robot.all_link_poses(q)
        shifted = [robot.all_link_poses(q + row) for row in np.diag(self._steps)]
        self._shifted = np.array(shifted).reshape(-1, *self.poses.shape)

    def pose(self, link: str) -> Array:
        """Returns the pose (4, 4) of a link before any step."""
        return np.asarray(self.poses[self._index[link]])

    def between(self, link: str, other: str) -> list[int]:
        """Returns the joints that move a link relative to another one, by themselves or by mimic joints."""
        i, j = self._index[link], self._index[other]
        apart = np.linalg.inv(self._shifted[:, i]) @ self._shifted[:, j] - np.linalg.inv(self.poses[i]) @ self.poses[j]
        return [int(joint) for joint in np.flatnonzero(np.abs(apart).max(axis=(1, 2), initial=0.0) > _MOVED)]

    def axis(self, link: str, other: str, joint: int) -> Axis:
        """Returns the axis about which a joint, or a mimic joint that follows it, moves `other` relative to `link`."""
        i, j = self._index[link], self._index[other]
        before, step = self.poses[j], self._steps[joint]
        after = self.poses[i] @ np.linalg.inv(self._shifted[joint, i]) @ self._shifted[joint, j]
        motion = after @ np.linalg.inv(before)
        turn, shift = motion[:3, :3], motion[:3, 3]
        along = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        if np.linalg.norm(along) < _MOVED:
            way = float(np.linalg.norm(shift))
            ends = (self._robot.lower[joint], self._robot.upper[joint])
            low, high = (float(end - self._q[joint]) * way / abs(step) for end in ends)
            return Axis(shift / way * np.sign(step), before[:3, 3], (low, high))
        point: Array = np.linalg.lstsq(np.eye(3) - turn, shift, rcond=1e-9)[0].astype(np.float64)
        return Axis(along / np.linalg.norm(along) * np.sign(step), point, None)


def _run(part: Part, start: Array) -> None:
    """Lays the skeleton through a part that begins at the point `start`, and through the parts after it."""
    for each in part.after:
        leave = start if part.axis is None else _leaving(part.axis, each)
        each.about.enter = _near(leave, part.axis, each.about)
        each.distance = part.distance + sum(
            float(np.linalg.norm(step)) for step in (leave - start, each.about.enter - leave)
        )
        if part.axis is not None:
            part.axis.leave = leave
        _run(each, each.about.enter)
    if part.axis is not None and not part.after:
        part.axis.leave = _end(part)


def _leaving(axis: Axis, after: Part) -> Array:
    """Returns the point where the links leave an axis towards the axis of the next part, `after`.

    Between parallel axes any point would do. If a row of parallel axes ends in another plane than it began, for example
    on arms with three parallel axes and a wrist beside them, the links alternate between the two planes.
    """
    if not _parallel(axis, after.about):
        return _nearest(axis, after.about)
    after.about.row = start = axis.enter if axis.row is None else axis.row
    there = axis.foot(start)
    if np.linalg.norm(there - axis.enter) > _MOVED:
        return there
    last = after
    while last.after and _parallel(axis, last.after[0].about):
        last = last.after[0]
    return axis.enter if last is after else axis.foot(_end(last))


def _end(part: Part) -> Array:
    """Returns the point where the links leave the axis of a part, if it does not depend on the parts before."""
    if part.after:
        return _nearest(part.about, part.after[0].about)
    return part.about.foot(part.ends[0][0][:3, 3]) if part.ends else part.about.enter


def _near(leave: Array, before: Axis | None, axis: Axis) -> Array:
    """Returns the point where links that come from `leave` meet an axis."""
    if before is None or _parallel(before, axis):
        return axis.foot(leave)
    return _nearest(axis, before)


def _nearest(axis: Axis, other: Axis) -> Array:
    """Returns the point of an axis nearest to another axis that is not parallel."""
    across = np.cross(axis.along, other.along)
    t = np.cross(other.point - axis.point, other.along) @ across / (across @ across)
    return axis.point + float(t) * axis.along


def _parallel(axis: Axis, other: Axis) -> bool:
    return float(np.linalg.norm(np.cross(axis.along, other.along))) < _PARALLEL
