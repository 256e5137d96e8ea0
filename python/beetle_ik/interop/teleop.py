"""Velocities of an operator's hand, joystick or space mouse as commands of an arm."""

from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInputError, Robot, Step, Tracker, pose

Array: TypeAlias = NDArray[np.float64]
_LEAD = (0.01, 0.05)  # m, rad: how far the reference may be ahead of an arm that is led slowly
_LEAD_TIME = 0.15  # s: how far ahead it may be besides, at the speed of the twist


class TwistTracker:
    """Moves the tip of an arm with a velocity that is given in each tick, inside all limits.

    Twists are integrated to a reference pose, which a `Tracker` follows. The reference stays near the arm: where a
    limit, a singular configuration or an obstacle holds the arm, the reference waits, and a twist back acts at once.
    A twist of zero is the fastest stop.

    Args:
        robot: the arm, with one tip.
        start_q: configuration at t = 0 (n,).
        dt: time step (s).
        frame: frame of the twists: "base", or "tip" for the axes of the tip. Both turn about the tip.
        timeout: time without a twist after which the arm stops (s); until then it keeps the last one.
        options: further arguments of `Tracker`: limits, obstacles, margin, task, goals, keep and others. `recover`
            is off unless given: an arm that is led should not leave a dead end by itself.

    Raises:
        InvalidInputError: as of `Tracker`; another frame, or a timeout that is not positive.

    For example:

        >>> import beetle_ik as bik
        >>> robot = bik.Robot.named("ur5e")
        >>> limits = bik.Limits(velocity=1.0, acceleration=5.0)
        >>> jog = TwistTracker(robot, [0.0, -1.5, 1.5, -1.5, -1.5, 0.0], dt=0.01, limits=limits)
        >>> for _ in range(100):
        ...     step = jog.step([0.0, 0.1, 0.0, 0.0, 0.0, 0.0])  # m/s along y
        >>> step.inside_limits
        True
    """

    def __init__(
        self,
        robot: Robot,
        start_q: ArrayLike,
        *,
        dt: float,
        frame: Literal["base", "tip"] = "base",
        timeout: float = 0.2,
        **options: Any,
    ) -> None:
        """Starts at rest."""
        if frame not in ("base", "tip"):
            raise InvalidInputError(f"frame must be 'base' or 'tip', got {frame!r:.60}")
        if not (isinstance(timeout, int | float) and timeout > 0.0):
            raise InvalidInputError(f"timeout must be positive (s), got {timeout!r:.60}")
        self.tracker = Tracker(robot, start_q, dt=dt, **{"recover": False, **options})
        if len(robot.tips) > 1:
            raise InvalidInputError(f"a TwistTracker moves one tip, and the robot has {len(robot.tips)}")
        self._frame, self._timeout = frame, timeout
        self.reference: Array
        """The pose (4, 4) that the arm follows."""
        self._rest()

    def step(self, twist: ArrayLike | None) -> Step:
        """Moves the arm by one tick.

        Args:
            twist: velocity and angular velocity of the tip (6,) (m/s, rad/s); None: no new one in this tick.

        Raises:
            InvalidInputError: wrong shape, or NaN; nothing has then changed.
        """
        if twist is not None:
            self._twist, self._silent = _checked(twist), 0.0
        else:
            self._silent += self.tracker.dt
            if self._silent > self._timeout:
                self._twist = np.zeros(6)
        if not self._twist.any():
            return self._stopped()
        self._stopping = False
        self.reference = self._moved()
        return self.tracker.step(self.reference)

    def stop(self) -> float:
        """Begins the fastest stop, and returns its duration (s); each following `step(None)` is a tick of it."""
        self._rest()
        return self.tracker.stop()

    def reset(self, q: ArrayLike) -> None:
        """Begins again at q (n,), at rest."""
        self.tracker.reset(q)
        self._rest()

    def _rest(self) -> None:
        self.reference = self.tracker.robot.fk(self.tracker.q)
        self._twist, self._silent, self._stopping = np.zeros(6), 0.0, True

    def _stopped(self) -> Step:
        """Takes a tick of the fastest stop: a reference that stands still would first be overshot."""
        if not self._stopping:
            self.stop()
        step = self.tracker.step(None)
        self.reference = self.tracker.robot.fk(step.q)
        return step

    def _moved(self) -> Array:
        """Returns the reference a tick later; a part of it that is too far ahead of the arm waits."""
        here, before = self.tracker.robot.fk(self.tracker.q), self.reference
        axes = np.eye(3) if self._frame == "base" else before[:3, :3]
        along, about = axes @ self._twist[:3], axes @ self._twist[3:]
        after = before.copy()
        after[:3, 3] += along * self.tracker.dt
        after[:3, :3] = pose([0.0, 0.0, 0.0], rotvec=about * self.tracker.dt)[:3, :3] @ before[:3, :3]
        for part, speed, lead, apart in (
            (np.s_[:3, 3], along, _LEAD[0], _far),
            (np.s_[:3, :3], about, _LEAD[1], _turned),
        ):
            allowed = lead + _LEAD_TIME * float(np.linalg.norm(speed))
            if allowed < apart(after, here) > apart(before, here):
                after[part] = before[part]
        return pose(matrix=after)


def _far(one: Array, other: Array) -> float:
    return float(np.linalg.norm(one[:3, 3] - other[:3, 3]))


def _turned(one: Array, other: Array) -> float:
    """Returns the angle between two poses (rad)."""
    chord = float(np.linalg.norm(one[:3, :3] - other[:3, :3])) / np.sqrt(8.0)
    return 2.0 * float(np.arcsin(min(chord, 1.0)))


def _checked(twist: ArrayLike) -> Array:
    try:
        values = np.array(twist, dtype=float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"twist must be an array of numbers, got {twist!r:.60}") from None
    if values.shape != (6,):
        raise InvalidInputError(f"twist: expected 6 numbers (m/s, rad/s), got shape {values.shape}")
    if not np.isfinite(values).all():
        raise InvalidInputError(f"twist must be finite, got {values}")
    return values
