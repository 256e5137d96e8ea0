"""The thread of a viewer."""

import threading
import time
from collections.abc import Callable, Collection

Request = Callable[[], None]

_PATIENCE = 0.1  # s


class Worker:
    """A thread that carries out requests, at most once a tick, and keeps ticking during a motion.

    Args:
        work: carries out the requests since the last tick, and returns whether anything still moves.
        dt: time between two ticks (s).
    """

    def __init__(self, work: Callable[[Collection[Request]], bool], dt: float) -> None:
        """Waits for `start`."""
        self._work = work
        self._dt = dt
        self._requests: dict[int, tuple[object, Request]] = {}
        self._closed = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._run, name="beetle-ik viewer", daemon=True)

    def start(self) -> None:
        """Starts the thread."""
        self._thread.start()

    def ask(self, source: object, request: Request) -> None:
        """Queues `request` for the thread, in place of a waiting one of the same source. Never blocks."""
        with self._changed:
            self._requests.pop(id(source), None)  # keeps the order of the newest requests
            self._requests[id(source)] = (source, request)
            self._changed.notify()

    def close(self) -> None:
        """Ends the thread, and waits a moment for it, unless it is the caller. Waiting requests are dropped.

        A search under way in the thread goes on, and its result is dropped.
        """
        with self._changed:
            self._closed = True
            self._changed.notify()
        if threading.current_thread() is not self._thread:
            self._thread.join(_PATIENCE)

    def _run(self) -> None:
        due, moving = time.monotonic(), False
        while True:
            with self._changed:
                if not moving:
                    self._changed.wait_for(lambda: self._closed or self._requests)
                self._changed.wait_for(lambda: self._closed, timeout=max(0.0, due - time.monotonic()))
                if self._closed:
                    return
                requests, self._requests = self._requests, {}
            due = max(due, time.monotonic() - self._dt) + self._dt
            moving = self._work([request for _, request in requests.values()])
