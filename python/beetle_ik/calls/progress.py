"""The progress bar behind `progress=True`, and the argument `progress` of calls in Python."""

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from datetime import timedelta

from .._core import InvalidInputError

_WIDTH = 40  # letters
_COLUMNS = 80  # columns of a terminal of unknown width
_INTERVAL = 0.1  # s between two drawings


class Bar:
    """A bar on standard error if that is a terminal; otherwise nothing is drawn."""

    def __init__(self) -> None:
        """Draws the bar, empty until the first `update`."""
        self._drawn = sys.stderr is not None and sys.stderr.isatty()
        self._begun, self._next = time.monotonic(), 0.0
        self.update(0, 0)

    def update(self, done: int, total: int) -> None:
        """Shows that `done` of `total` steps are done."""
        self.show("", done, total)

    def show(self, what: str, done: int, total: int) -> None:
        """Shows the current activity, and that `done` of its `total` items are done."""
        now = time.monotonic()
        if not self._drawn or (now < self._next and done != total):
            return
        self._next = now + _INTERVAL
        share = done / total if total else 0.0
        bar = "#" * round(_WIDTH * share)
        line = f"{bar:.<{_WIDTH}} {share:4.0%} {done}/{total} {timedelta(seconds=int(now - self._begun))} {what}"
        room = (os.get_terminal_size(sys.stderr.fileno()).columns or _COLUMNS) - 1  # a broken line cannot be drawn over
        print(f"\r{line[:room]:<{room}}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Ends the line of the bar."""
        if self._drawn:
            self._drawn = False
            print(file=sys.stderr)


@contextmanager
def reports(progress: object) -> Iterator[Callable[[int, int], object]]:
    """Yields the function to call with (done, total), for the `progress` argument of a call.

    Raises:
        InvalidInputError: neither True, False, None nor a callable.
    """
    if progress is None or progress is False:
        yield lambda _done, _total: None
    elif progress is True:
        with closing(Bar()) as bar:
            yield bar.update
    elif callable(progress):
        yield progress
    else:
        raise InvalidInputError(f"progress must be True, False or a callable of (done, total), got {progress!r:.60}")
