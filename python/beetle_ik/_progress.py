"""The progress bar behind `progress=True`, and the argument `progress` of calls in Python."""

from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager

from ._core import InvalidInputError


class Bar:
    """A bar on standard error if that is a terminal; otherwise nothing is drawn."""

    def __init__(self) -> None:
        """Draws the bar, empty until the first `update`."""
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TaskProgressColumn,
            TextColumn,
            TimeElapsedColumn,
        )

        console = Console(stderr=True)
        columns = (
            BarColumn(),
            TaskProgressColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("{task.description}"),
        )
        self._progress = Progress(*columns, console=console, disable=not console.is_terminal)
        self._task = self._progress.add_task("", total=None)
        self._progress.start()

    def update(self, done: int, total: int) -> None:
        """Shows that `done` of `total` steps are done."""
        self._progress.update(self._task, completed=done, total=total)

    def show(self, what: str, done: int, total: int) -> None:
        """Shows the current activity, and that `done` of its `total` items are done."""
        self._progress.update(self._task, description=what, completed=done, total=total)

    def close(self) -> None:
        """Stops the bar and releases the terminal."""
        self._progress.stop()


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
