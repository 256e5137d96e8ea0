"""What an attack is: a promise, a generator of short programs, and a judge of what they leave behind."""

from __future__ import annotations

import zlib
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

import beetle_ik as bik

HEADER = "import numpy as np\nfrom numpy import inf, nan\n\nimport beetle_ik as bik\n\n"

# Plain data: dicts with fixed keys, lists that may be shortened, tuples of fixed length, numbers, text, bytes.
Case = dict[str, Any]


class BrokenError(Exception):
    """A promise is broken. The first argument says how in few words and is the same for all cases of one defect."""

    def __init__(self, what: str, detail: object = "") -> None:
        super().__init__(what, detail)
        self.what, self.detail = what, detail


class Attack(ABC):
    """One promise, attacked.

    `draw` makes a case as plain data, `program` writes it as Python, and `judge` looks at the variables that it leaves.
    What runs is the text of the program itself, so a failing case is repeated by pasting it.
    """

    name: ClassVar[str]
    promise: ClassVar[str]
    page: ClassVar[str]  # where the promise is made
    deadline: ClassVar[float] = 300.0  # s, many times what a case takes on a machine that is busy: a longer one hangs
    refusals: ClassVar[tuple[type[Exception], ...]] = (bik.BeetleIkError,)  # what the program may raise

    @abstractmethod
    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Draws a case; a hard one is singular, at the edge of reach, near limits or deformed."""

    @abstractmethod
    def program(self, case: Case) -> str:
        """Returns the case as a few lines of Python, below `HEADER`."""

    def judge(self, case: Case, left: dict[str, Any]) -> int:  # noqa: ARG002
        """Checks the variables of the program; returns how many inputs were tried.

        Raises:
            BrokenError: the promise is broken.
        """
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:  # noqa: B027
        """Checks an exception of `refusals`.

        Raises:
            BrokenError: a right input was refused, or the message does not say enough.
        """


@dataclass(frozen=True)
class Verdict:
    """How a case ended. `failure` is None, or says what is broken in words that all cases of one defect share."""

    inputs: int
    refused: bool = False
    failure: str | None = None
    detail: str = ""


def is_hard(index: int) -> bool:
    """Half of the cases are hard ones: two easy and two hard ones by turns, so that two processes share both."""
    return index % 4 >= 2


def drawn(attack: Attack, seed: int, index: int) -> Case:
    """The case of an attack, a seed and an index."""
    return attack.draw(np.random.default_rng([zlib.crc32(attack.name.encode()), seed, index]), is_hard(index))


def tried(attack: Attack, case: Case) -> Verdict:
    """Runs the program of a case and judges it."""
    left: dict[str, Any] = {}
    try:
        exec(compile(HEADER + attack.program(case), f"<{attack.name}>", "exec"), left)
    except attack.refusals as error:
        return _judged(attack.judge_refusal, case, error, refused=True)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a panic is no Exception
        return Verdict(1, failure=f"raises {type(error).__name__}", detail=str(error))
    return _judged(attack.judge, case, left, refused=False)


def _judged(judge: Callable[[Case, Any], int | None], case: Case, outcome: Any, *, refused: bool) -> Verdict:
    try:
        return Verdict(judge(case, outcome) or 1, refused)
    except BrokenError as broken:
        return Verdict(1, refused, broken.what, str(broken.detail))
    except Exception as error:
        return Verdict(1, refused, f"the judge raises {type(error).__name__}", str(error))
