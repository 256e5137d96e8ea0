"""Follows poses and twists with one command per tick: a `TwistTracker` behind the messages of ROS 2."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..._core import BeetleIkError, InvalidInputError, Limits, Robot, Step
from ..teleop import TwistTracker
from .reading import Array, pose_of, twist_of

SILENCE = 0.2
"""Time without a target after which the arm stops (s)."""

Say = Callable[[str, str], None]
"""Logs a level ("info", "warning", "error") and a text."""


class Servo:
    """Commands within limits, from poses and twists. Times are in nanoseconds, on the clock of the stamps.

    Args:
        robot: the arm.
        limits: its limits.
        dt: time of a tick (s).
        say: logs a line.
    """

    def __init__(self, robot: Robot, limits: Limits, dt: float, say: Say) -> None:
        """Begins at rest; `start` says where."""
        self.robot, self.limits, self.dt, self.say = robot, limits, dt, say
        self.jog: TwistTracker | None = None
        self.target: tuple[Array, int] | None = None
        self.twist: Array | None = None
        self.led = False  # by twists
        self.quiet = 0.0  # s since the last message
        self.resting = 0  # ticks
        self.held = ""

    def start(self, q: Array) -> None:
        """Starts at rest at q (n,). States are not fed back later: the drives follow the commands."""
        self.jog = TwistTracker(self.robot, q, dt=self.dt, limits=self.limits, timeout=SILENCE, recover=True)
        self.target, self.twist, self.led, self.quiet, self.resting = None, None, False, 0.0, 0
        self.say("info", f"starts at {q.round(3).tolist()}")

    def pose(self, message: Any) -> None:
        """Keeps the newest pose for the next tick; its stamp in nanoseconds, zero meaning now."""
        stamp = message.header.stamp
        self.target = pose_of(self.robot, message), stamp.sec * 1_000_000_000 + stamp.nanosec
        self.twist, self.led, self.quiet = None, False, 0.0

    def move(self, message: Any) -> None:
        """Keeps the newest twist, which moves the tip until `SILENCE` has passed without another."""
        twist, along_tip = twist_of(self.robot, message)
        if self.jog is None:
            return
        if along_tip:
            axes = self.robot.fk(self.jog.tracker.q)[:3, :3]
            twist = np.concatenate((axes @ twist[:3], axes @ twist[3:]))
        if not self.led:
            self.jog.stop()  # the twist begins where the arm is
        self.target, self.twist, self.led, self.quiet = None, twist, True, 0.0

    @property
    def rests(self) -> bool:
        """Whether the arm rests and nothing has come for `SILENCE`."""
        return self.jog is None or (self.resting > 2 and self.quiet > SILENCE)

    def stop(self) -> float | None:
        """Brakes within all limits, and returns the time it takes (s); None before the start."""
        self.target = self.twist = None
        self.led = False
        return None if self.jog is None else self.jog.stop()

    def stopping(self) -> list[Step]:
        """Returns the commands of the fastest stop within the limits, up to rest; the servo has then ended."""
        jog, self.jog = self.jog, None
        if jog is None:
            return []
        ticks = int(jog.stop() / self.dt) + 3  # the last ones at rest
        return [jog.tracker.step(None) for _ in range(ticks)]

    def tick(self, now: int) -> Step | None:
        """Returns the command of this tick; None before the start."""
        if self.jog is None:
            return None
        try:
            step = self._follow(self.jog, now)
        except InvalidInputError as problem:  # no pose: the tracker is as before
            self.say("error", str(problem))
            step = self.jog.tracker.step(None)
        self.resting = 0 if np.any(step.qd) else self.resting + 1
        reason = "" if step.success else step.status.name
        if reason and reason != self.held:
            self.say("warning", step.message)
        self.held = reason
        return step

    def _follow(self, jog: TwistTracker, now: int) -> Step:
        self.quiet += self.dt
        if self.led:
            twist, self.twist = self.twist, None
            return jog.step(twist)
        tracker = jog.tracker
        if self.target is None:
            if SILENCE < self.quiet <= SILENCE + self.dt:
                jog.stop()
            return tracker.step(None)
        (target, seen), self.target = self.target, None
        if seen == 0:
            return tracker.step(target)
        return tracker.step(target, stamp=tracker.time + tracker.dt - (now - seen) * 1e-9)


def answered(say: Say, what: str, handle: Callable[[Any], object], message: Any) -> None:
    """Handles a message; one that cannot be used is answered by a line of the log, never by an exception."""
    try:
        handle(message)
    except (BeetleIkError, AttributeError, TypeError, ValueError, OverflowError) as problem:
        say("error", f"{what}: {problem}")
