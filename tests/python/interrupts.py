"""Ctrl-C without a clock: signals that come while the process computes, and a thread that runs meanwhile."""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import count
from types import FrameType

EVERY = 0.01  # s of computing, on all threads together
MOST = 100  # signals between two looks for them: 0.2 s are promised, and some machines are five times as slow
TURNS, LOOKS = 10, 1000
CALLBACKS = {"_remove", "remove", "cb"}  # of weak references, which swallow exceptions: a look in one is none


@contextmanager
def signals(look: Callable[[], None], pipe: int) -> Iterator[None]:
    """Sends a signal whenever the process has computed for 10 ms, and a byte into the pipe with each.

    Python calls `look` when the main thread looks for signals; bytes come at once. No signals come while the process
    waits for its turn on a busy machine.
    """

    def handle(_: int, frame: FrameType | None) -> None:
        names = set()
        while frame is not None:
            names.add(frame.f_code.co_name)
            frame = frame.f_back
        if not names & CALLBACKS:
            look()

    handler, earlier = signal.signal(signal.SIGPROF, handle), signal.set_wakeup_fd(pipe)
    signal.setitimer(signal.ITIMER_PROF, EVERY, EVERY)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, handler)
        signal.set_wakeup_fd(earlier)


@contextmanager
def pipe() -> Iterator[tuple[int, int]]:
    """Opens a pipe for reading and writing, of which no write waits."""
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    try:
        yield reading, writing
    finally:
        os.close(writing)
        os.close(reading)


@contextmanager
def interrupted(*, most: float = MOST) -> Iterator[None]:
    """Raises KeyboardInterrupt when the block looks for signals the third time; at most `most` may come between.

    A call that does not look meets the handler once, after it has returned, and nothing is raised.
    """
    came: list[int] = []
    numbers = count(1)

    def look() -> None:
        number = next(numbers)  # a further signal may call the handler while it runs
        with suppress(BlockingIOError):
            came.append(len(os.read(reading, 100_000)))
        if number == 3:
            raise KeyboardInterrupt

    with pipe() as (reading, writing):
        os.set_blocking(reading, False)
        try:
            with signals(look, writing):
                yield
        finally:
            assert max(came, default=0) <= most, f"signals between two looks: {came}"


@contextmanager
def interrupted_by_another_thread() -> Iterator[None]:
    """Raises KeyboardInterrupt in the block when another thread has had Python's lock ten times.

    No thread is made to give the lock up: the other one gets it where the block releases it.
    """
    turns = looks = 0
    raised = count()

    def run() -> None:
        nonlocal turns
        while os.read(reading, 1) != b"\0":
            turns += 1

    def look() -> None:
        nonlocal looks
        looks += 1
        if turns >= TURNS and next(raised) == 0:
            raise KeyboardInterrupt
        assert looks < LOOKS, "no other thread runs"

    other, interval = threading.Thread(target=run), sys.getswitchinterval()
    with pipe() as (reading, writing):
        other.start()
        sys.setswitchinterval(1e3)  # s
        try:
            with signals(look, writing):
                yield
        finally:
            sys.setswitchinterval(interval)
            os.write(writing, b"\0")
            other.join()
