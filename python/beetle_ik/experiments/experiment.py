"""Experiments, and the context in which they run."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

from ..report import Report

Progress: TypeAlias = Callable[[str, int, int], None]
"""Called with the current activity, the number of items done, and their total."""
Item = TypeVar("Item")


def no_progress(_what: str, _done: int, _total: int) -> None:
    """Shows nothing."""


@dataclass(frozen=True, kw_only=True)
class Context:
    """Thoroughness, first seed and progress of a run."""

    short: bool = False
    seed: int = 0
    progress: Progress = no_progress

    def pick(self, *, full: Item, short: Item) -> Item:
        """Returns the setting of a full run or of a short one."""
        return short if self.short else full

    def seeds(self, count: int) -> range:
        """Returns `count` different seeds."""
        return range(self.seed, self.seed + count)

    def each(self, what: str, items: Sequence[Item]) -> Iterator[Item]:
        """Iterates over `items`, with a progress bar labelled `what`."""
        for done, item in enumerate(items):
            self.progress(what, done, len(items))
            yield item
        self.progress(what, len(items), len(items))


@dataclass(frozen=True, kw_only=True)
class Experiment:
    """A reproducible paper."""

    name: str
    """Name on the command line, for example "cheng2020"."""
    title: str
    """Our headline for the reproduced results."""
    paper: str
    """Authors, title, journal, year."""
    run: Callable[[Context], Report]
    extras: tuple[str, ...] = ()
    """Extras of beetle-ik that have to be installed, besides `report`."""
