"""Lines of a program as words: a letter and a number each."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from ..._core import InvalidInputError

_COMMENT = re.compile(r"\([^()]*\)|;.*")
_WORD = re.compile(r"\s*([A-Za-z])\s*([+-]?(?:\d+\.?\d*|\.\d+))")
_EXPONENT = re.compile(r"[A-Za-z]\s*[-+.\d]*[.\d]e[-+\d]+")
_CHECKSUM = re.compile(r"\*\s*\d+\s*$")
_NUMBER_OF_LINE = re.compile(r"^\s*[Nn]\s*\d+")
_MACRO = re.compile(r"^(?:GOTO|IF|WHILE|DO|END|THEN)(?:\s|\d|\[|$)", re.IGNORECASE)
_NAMED = re.compile(r"^[A-Za-z_]{4,}")  # commands of firmware, such as START_PRINT
_OTHER = re.compile(r"^[Mm]\s*(\d+(?:\.\d+)?)")


class Line(NamedTuple):
    """Words of a line, or its text where it is no line of words but a command that moves nothing."""

    number: int
    words: list[tuple[str, float]]
    text: str


def refused(line: int, reason: str) -> InvalidInputError:
    """Returns the error of a line."""
    return InvalidInputError(f"line {line}: {reason}")


def lines(text: str) -> Iterator[Line]:
    """Yields the lines of a program that say anything.

    Raises:
        InvalidInputError: something that is no word; the message names the line.
    """
    for number, whole in enumerate(text.splitlines(), start=1):
        said = _CHECKSUM.sub("", _COMMENT.sub(" ", whole)).strip()
        said = _NUMBER_OF_LINE.sub("", said).strip()
        if not said or said.startswith("%"):
            continue
        yield Line(number, _words(number, said), said)


def _words(number: int, said: str) -> list[tuple[str, float]]:
    """Returns the words of a line; none for a command that moves nothing."""
    if said.startswith("/"):
        raise refused(number, f"{said:.40}: a line that a switch leaves out (/) is not read: delete it, or its /")
    if _MACRO.match(said) or (re.search(r"[#\[\]=]", said) and not _NAMED.match(said)):
        raise refused(
            number, f"{said:.40}: parameters, expressions and jumps are not read: let the program be written out"
        )
    if _NAMED.match(said):
        return []
    other = _OTHER.match(said)
    if other and not re.search(r"[GgXxYyZz]\s*[-+.\d]", said):  # an M word, whose parameters may be any text
        return [("M", float(other[1]))]
    if exponent := _EXPONENT.search(said):
        raise refused(number, f"{exponent[0]:.20}: numbers have no exponents in G-code")
    words = [(letter.upper(), float(value)) for letter, value in _WORD.findall(said)]
    if rest := _WORD.sub("", said).strip():
        raise refused(number, f"'{rest:.20}' is no word: a letter and a number, such as X10.5")
    return words
