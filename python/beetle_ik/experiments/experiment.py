"""What an experiment is, and what it is given to run."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

from ..report import Report

Progress: TypeAlias = Callable[[str, int, int], None]
"""Called with what is being done, how many of its items are done, and how many there are."""
Item = TypeVar("Item")


def no_progress(_what: str, _done: int, _total: int) -> None:
    """Show nothing."""


@dataclass(frozen=True, kw_only=True)
class Context:
    """How thoroughly to run, from which seed, and where to show progress."""

    short: bool = False
    seed: int = 0
    progress: Progress = no_progress

    def pick(self, *, full: Item, short: Item) -> Item:
        """The setting of a full run or of a short one."""
        return short if self.short else full

    def seeds(self, count: int) -> range:
        """`count` seeds, no two alike."""
        return range(self.seed, self.seed + count)

    def each(self, what: str, items: Sequence[Item]) -> Iterator[Item]:
        """Iterate over `items`, with a progress bar labelled `what`."""
        for done, item in enumerate(items):
            self.progress(what, done, len(items))
            yield item
        self.progress(what, len(items), len(items))


@dataclass(frozen=True, kw_only=True)
class Experiment:
    """A paper that can be run again."""

    name: str
    """As on the command line: "cheng2020"."""
    title: str
    """A headline of our own: what is reproduced."""
    paper: str
    """Authors, title, journal, year."""
    run: Callable[[Context], Report]
    extras: tuple[str, ...] = ()
    """Of beetle-ik, beside `report`: what has to be installed."""
