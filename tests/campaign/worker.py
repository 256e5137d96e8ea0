"""One process of a campaign: tries cases, and says before each one which it is, so that a crash has a name."""

from __future__ import annotations

import json
import os
import resource
import time
import traceback
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from typing import TextIO

from .attack import HEADER, Attack, Case, Verdict, drawn, tried
from .shrinking import shrunk

MEMORY = 8 * 2**30  # bytes of addresses: a case that wants more raises MemoryError, or crashes and is a failure


@dataclass
class Share:
    """The cases of a worker: every `stride`-th index from `first` on, of each attack up to `cases`."""

    first: int
    stride: int
    cases: int | None  # of each attack; None: without end
    skipped: dict[str, int]  # the first index of an attack that has had cases before


def run(attacks: list[Attack], seed: int, share: Share) -> None:
    """Tries cases and writes two lines of JSON a case: which one begins, and how it ended."""
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what programs print goes to the log
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    for attack, index in _turns(attacks, share):
        _say(out, begin=[attack.name, index])
        start = time.monotonic()
        try:
            case = drawn(attack, seed, index)
        except Exception as error:
            verdict = Verdict(0, failure=f"the generator raises {type(error).__name__}", detail=str(error))
            _say(out, end=[attack.name, index], verdict=asdict(verdict), seconds=0.0, program="")
            continue
        verdict = tried(attack, case)
        seconds = time.monotonic() - start
        told = {}
        if verdict.failure:
            smallest = shrunk(case, lambda smaller, a=attack, v=verdict: _same(a, smaller, v.failure))
            verdict = replace(verdict, detail=tried(attack, smallest).detail)
            told = {"program": HEADER + attack.program(smallest)}
        _say(out, end=[attack.name, index], verdict=asdict(verdict), seconds=seconds, **told)


def _same(attack: Attack, case: Case, failure: str | None) -> bool:
    """Whether a smaller case fails in the same way."""
    try:
        return tried(attack, case).failure == failure
    except Exception:  # a program that cannot be written of it
        return False


def _turns(attacks: list[Attack], share: Share) -> Iterator[tuple[Attack, int]]:
    """Yields the next index of the attack that has had the least time."""
    spent = {attack.name: 0.0 for attack in attacks}
    following = {attack.name: share.skipped.get(attack.name, share.first) for attack in attacks}
    waiting = list(attacks)
    while waiting:
        attack = min(waiting, key=lambda each: spent[each.name])
        index = following[attack.name]
        if share.cases is not None and index >= share.cases:
            waiting.remove(attack)
            continue
        following[attack.name] += share.stride
        start = time.monotonic()
        yield attack, index
        spent[attack.name] += time.monotonic() - start


def _say(out: TextIO, **line: object) -> None:
    out.write(json.dumps(line) + "\n")
    out.flush()


def repeated(attack: Attack, seed: int, index: int) -> str:
    """Tries one case again, and returns its program and how it ended."""
    case = drawn(attack, seed, index)
    try:
        verdict = tried(attack, case)
    except Exception:
        traceback.print_exc()
        raise
    return f"{HEADER}{attack.program(case)}\n\n# {verdict}"
