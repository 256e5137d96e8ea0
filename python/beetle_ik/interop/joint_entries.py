"""Arrays of joint positions in the order of others, with entries of joints that do not move the arm."""

from collections.abc import Collection, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInputError, Robot, UnknownNameError, _JointEntries
from ..calls.text import listed

Array: TypeAlias = NDArray[np.float64]


class JointEntries:
    """Places of an arm's joints in an array; joints that slide are in m.

    Args:
        robot: the arm.
        joints: names of all joints of the file.
        names: names of the first entries, in order.
        argument: name of the argument that has the names, for messages.
        degrees: whether joints that turn are in degrees.

    Raises:
        UnknownNameError: a name that is no joint of the file.
        InvalidInputError: a joint of the arm that is missing, or a name that is there twice.
    """

    def __init__(
        self, robot: Robot, joints: Collection[str], names: Sequence[str], *, argument: str, degrees: bool
    ) -> None:
        """Finds the joints of the arm among the names."""
        self.names = list(names)
        for name in self.names:
            if name not in joints:
                raise UnknownNameError(f"{argument}: no joint '{name}' in the robot; joints: {listed(joints)}")
            if self.names.count(name) > 1:
                raise InvalidInputError(f"{argument}: '{name}' is there twice")
        for joint in robot.joint_names:
            if joint not in self.names:
                raise InvalidInputError(
                    f"{argument}: joint '{joint}' is missing, and moves the frame '{robot.tips[0]}'"
                )
        turns = degrees & np.array([kind != "prismatic" for kind in robot.joint_kinds])
        # From the units of the entries to rad and m.
        self._unit = np.where(turns, np.pi / 180, 1.0)
        self.at = [self.names.index(joint) for joint in robot.joint_names]
        entries = _JointEntries(robot, self.at, len(self.names), self._unit.tolist())
        # The calls of a native class, without a call of Python around each: a solve may take only two microseconds.
        self.read = entries.read
        """`read(name, values)` returns the entries (k,), a copy, checked; `name` is that of the argument."""
        self.q = entries.q
        """`q(name, values)` returns the joint positions of the arm (n,) (rad, m)."""
        self.inside = entries.inside
        """`inside(name, values)` returns them with each at its nearest limit if it is outside."""
        self.placed = entries.placed
        """`placed(q, entries)` returns the entries with the joint positions q (n,) (rad, m) in their places."""

    def limit(self, name: str, values: ArrayLike) -> Array:
        """Returns limits (n,) (rad, m) of a number or one per joint of the arm, in the order of the names."""
        limits = np.array(values, dtype=np.float64)
        if limits.ndim == 0:
            return limits * self._unit
        if limits.shape != (len(self.at),):
            wanted = f"a number or {len(self.at)}, one per joint that moves the frame"
            raise InvalidInputError(f"{name}: expected {wanted}, got shape {limits.shape}")
        return limits[np.argsort(np.argsort(self.at))] * self._unit

    def most(self, degrees: float) -> Array:
        """Returns a bound (n,) (rad) of the joints that turn; joints that slide have none."""
        return np.where(self._unit == 1.0, np.inf, degrees * self._unit)
