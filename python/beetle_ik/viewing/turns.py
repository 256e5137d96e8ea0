"""Turns of a viewer: its thread carries out requests and moves the arm, and Python changes the state between them."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING

from .._core import BeetleIkError
from .arm import DT
from .worker import Request, Worker

if TYPE_CHECKING:
    from .arm import Arm
    from .parts import Parts

_log = logging.getLogger(__name__)

_LONGEST_TICK = 0.1  # s: longest time by which a motion advances, after a rest or on a busy machine


class Turns:
    """Changes of the state of a viewer, one at a time.

    Attributes:
        lock: held by whoever changes or reads the whole state.
        closed: whether the viewer has ended.
        moves: whether the arm is moving to its target, or a motion is played back.
        callbacks: functions called after a turn that changed the target.
    """

    def __init__(self, name: str, arm: Arm) -> None:
        """Takes requests, which wait for `start`. `name` is that of the robot, for messages."""
        self.lock = threading.RLock()
        self.closed, self._first_close = threading.Event(), threading.Lock()
        self.moves = False
        self.callbacks: list[Callable[[], object]] = []
        self._name, self._arm, self._told = name, arm, arm.targets
        self._last_tick = time.monotonic()
        self._worker = Worker(self._turn, DT)
        self.ask = self._worker.ask

    def start(self, parts: Parts) -> None:
        """Starts the thread, which moves and shows the parts of the page."""
        self._parts = parts
        self._worker.start()

    def end(self) -> bool:
        """Ends the thread; returns False if it has been ended before."""
        if not self._first_close.acquire(blocking=False):  # never released
            return False
        self.closed.set()
        self._worker.close()
        return True

    @contextmanager
    def between(self) -> Iterator[None]:
        """Locks the state for the block, which changes it from Python, and shows the result.

        Raises:
            BeetleIkError: the viewer is closed.
        """
        if self.closed.is_set():
            raise BeetleIkError(f"the viewer of '{self._name}' is closed: bik.view opens another one")
        with self.lock:
            yield
            self.moves = True  # corrected at the next tick
            self._parts.refresh()
        self.ask("changed", lambda: None)

    def pass_time(self, seconds: float) -> None:
        """Moves the arm on by a time (s), in a recording."""
        self.moves = self._parts.pass_time(seconds)

    def _turn(self, requests: Collection[Request]) -> bool:
        """Carries out requests, moves the arm on by a tick, and shows the result; returns whether it still moves."""
        with self.lock:
            now = time.monotonic()
            elapsed, self._last_tick = min(now - self._last_tick, _LONGEST_TICK), now
            if requests:
                self._parts.report.problem = ""
            for request in requests:
                self._guarded(request)
            if self.closed.is_set():  # meanwhile
                return False
            self.moves = bool(self._guarded(lambda: self._parts.advance(elapsed)))
            self._guarded(partial(self._parts.refresh, moving=self.moves))
            targets = self._arm.targets
        if targets is not self._told:
            self._told = targets
            for callback in self.callbacks:
                self._guarded(callback)
        return self.moves

    def _guarded(self, action: Callable[[], object]) -> object:
        """Carries out an action; its exceptions are shown on the page, and do not end the thread."""
        try:
            return action()
        except BeetleIkError as error:
            problem = str(error)
        except Exception as error:  # raised by a callback
            if self.closed.is_set():
                return None  # no page is left to show the error
            _log.exception("an error in the viewer of '%s'", self._name)
            problem = f"{type(error).__name__}: {error}"
        self._parts.report.problem = problem
        return None
