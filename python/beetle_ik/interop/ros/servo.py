"""Follows poses and twists with one command per tick: a `Tracker` behind the messages of ROS 2."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..._core import BeetleIkError, InvalidInputError, Limits, Robot, Step, Tracker, pose
from .reading import Array, pose_of, twist_of

SILENCE = 0.2
"""Time without a target after which the arm stops (s)."""

LEAD = (0.05, 0.2)
"""How far a target moved by twists may be ahead of the tip (m, rad): an arm at a limit is not pulled on later."""

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
        self.tracker: Tracker | None = None
        self.target: tuple[Array, int] | None = None
        self.twist: tuple[Array, bool] | None = None
        self.quiet = 0.0  # s
        self.resting = 0  # ticks
        self.led: Array | None = None
        self.held = ""

    def start(self, q: Array) -> None:
        """Starts at rest at q (n,). States are not fed back later: the drives follow the commands."""
        self.tracker = Tracker(self.robot, q, dt=self.dt, limits=self.limits, timeout=SILENCE)
        self.target = self.twist = self.led = None
        self.say("info", f"starts at {q.round(3).tolist()}")

    def pose(self, message: Any) -> None:
        """Keeps the newest pose for the next tick; its stamp in nanoseconds, zero meaning now."""
        stamp = message.header.stamp
        self.target = pose_of(self.robot, message), stamp.sec * 1_000_000_000 + stamp.nanosec
        self.twist = self.led = None

    def move(self, message: Any) -> None:
        """Keeps the newest twist, which moves the target until `SILENCE` has passed without another."""
        self.twist, self.quiet = twist_of(self.robot, message), 0.0
        self.target = None

    @property
    def rests(self) -> bool:
        """Whether the arm rests, and no target is left to follow."""
        return self.tracker is None or (self.resting > 2 and self.target is None and self.twist is None)

    def stop(self) -> float | None:
        """Brakes within all limits, and returns the time it takes (s); None before the start."""
        self.target = self.twist = self.led = None
        return None if self.tracker is None else self.tracker.stop()

    def stopping(self) -> list[Step]:
        """Returns the commands of the fastest stop within the limits, up to rest; the servo has then ended."""
        tracker, self.tracker = self.tracker, None
        steps: list[Step] = []
        if tracker is not None:
            ticks = int(tracker.stop() / self.dt) + 3  # and the last ones at rest
            steps = [tracker.step(None) for _ in range(ticks)]
        return steps

    def tick(self, now: int) -> Step | None:
        """Returns the command of this tick; None before the start."""
        if self.tracker is None:
            return None
        try:
            step = self._follow(self.tracker, now)
        except InvalidInputError as problem:  # no pose: the tracker is as before
            self.say("error", str(problem))
            self.target = None
            step = self.tracker.step(None)
        self.resting = 0 if np.any(step.qd) else self.resting + 1
        reason = "" if step.success else step.status.name
        if reason and reason != self.held:
            self.say("warning", step.message)
        self.held = reason
        return step

    def _follow(self, tracker: Tracker, now: int) -> Step:
        if self.twist is not None:
            self.quiet += self.dt
            if self.quiet > SILENCE:
                self.stop()
                return tracker.step(None)
            return tracker.step(self._led(tracker, *self.twist))
        if self.target is None:
            return tracker.step(None)
        (target, seen), self.target = self.target, None
        if seen == 0:
            return tracker.step(target)
        return tracker.step(target, stamp=tracker.time + tracker.dt - (now - seen) * 1e-9)

    def _led(self, tracker: Tracker, twist: Array, along_tip: bool) -> Array:
        """Returns the target that the twist moves, never far ahead of the tip."""
        tip = self.robot.fk(tracker.q)
        led = tip if self.led is None else self.led
        turn = led[:3, :3] @ tip[:3, :3].T
        angle = np.arccos(np.clip(0.5 * (np.trace(turn) - 1.0), -1.0, 1.0))
        if np.linalg.norm(led[:3, 3] - tip[:3, 3]) > LEAD[0] or angle > LEAD[1]:
            led = tip
        linear, angular = (tip[:3, :3] @ part if along_tip else part for part in (twist[:3], twist[3:]))
        moved = led.copy()
        moved[:3, 3] += self.dt * linear
        moved[:3, :3] = pose(np.zeros(3), rotvec=self.dt * angular)[:3, :3] @ led[:3, :3]
        self.led = moved
        return moved


def answered(say: Say, what: str, handle: Callable[[Any], object], message: Any) -> None:
    """Handles a message; one that cannot be used is answered by a line of the log, never by an exception."""
    try:
        handle(message)
    except (BeetleIkError, AttributeError, TypeError, ValueError, OverflowError) as problem:
        say("error", f"{what}: {problem}")
