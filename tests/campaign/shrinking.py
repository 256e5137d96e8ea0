"""Makes a failing case smaller: fewer joints, obstacles and steps, rounder numbers, shorter files."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from typing import Any

from .attack import Case


def shrunk(case: Case, fails: Callable[[Case], bool], *, tries: int = 400, seconds: float = 30.0) -> Case:
    """Returns the smallest case found that still fails; `fails` says whether one does so in the same way."""
    end = time.monotonic() + seconds
    improved = True
    while improved:
        improved = False
        for candidate in simpler(case):
            tries -= 1
            if tries < 0 or time.monotonic() > end:
                return case
            if fails(candidate):
                case, improved = candidate, True
                break
    return case


def simpler(value: Any) -> Iterator[Any]:
    """Yields simpler values, the simplest first. Text stays: it is a name or an expression."""
    if isinstance(value, dict):
        yield from ({**value, key: part} for key in value for part in simpler(value[key]))
    elif isinstance(value, tuple):
        yield from ((*value[:i], part, *value[i + 1 :]) for i, old in enumerate(value) for part in simpler(old))
    elif isinstance(value, list | bytes):
        yield from _shorter(value)
        if isinstance(value, list):
            yield from ([*value[:i], part, *value[i + 1 :]] for i, old in enumerate(value) for part in simpler(old))
    elif isinstance(value, bool) or value is None:
        return
    elif isinstance(value, int):
        yield from (number for number in (0, 1, value // 2) if abs(number) < abs(value))
    elif isinstance(value, float):
        yield from _rounder(value)


def _shorter(sequence: Any) -> Iterator[Any]:
    """Leaves out halves, quarters and so on, down to one item."""
    size = (len(sequence) + 1) // 2
    while size:
        for start in range(0, len(sequence), size):
            yield sequence[:start] + sequence[start + size :]
        size //= 2


def _rounder(number: float) -> Iterator[float]:
    def complexity(number: float) -> tuple[bool, bool, int]:
        return number != 0.0, number != 1.0, len(repr(number))

    if math.isfinite(number):
        for candidate in (0.0, 1.0, float(round(number)), round(number, 2), float(f"{number:.3g}")):
            if complexity(candidate) < complexity(number):
                yield candidate
