"""Counts with nouns and lists of names, for messages; numbers that read back."""

from collections.abc import Collection, Iterable
from typing import SupportsFloat

_LIST_LENGTH = 400  # characters


def counted(number: int, thing: str) -> str:
    """Returns "1 step" or "2 steps"."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"


def listed(names: Collection[str]) -> str:
    """Joins names with commas, up to a readable length, and gives the number of the rest."""
    shown = ", ".join(names)
    if len(shown) <= _LIST_LENGTH:
        return shown
    kept: list[str] = []
    for name in names:
        if len(", ".join([*kept, name])) > _LIST_LENGTH:
            break
        kept.append(name)
    return f"{', '.join(kept)} and {len(names) - len(kept)} more" if kept else f"{len(names)} names"


def exact(numbers: Iterable[SupportsFloat]) -> str:
    """Returns numbers separated by spaces, each of which reads back to the bit."""
    return " ".join(repr(float(number)) for number in numbers)
