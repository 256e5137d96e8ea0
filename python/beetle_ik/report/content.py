"""What a report is made of: sections of text, tables and figures, and claims with their verdicts.

Everything is checked when it is made, so that a mistake shows where it was written and not in the finished page.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum, StrEnum
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

    from .._frames import Frames

_FILE_STEM = re.compile(r"[a-z0-9_]+")


class Verdict(StrEnum):
    """What became of a claim."""

    REPRODUCED = "reproduced"
    WITH_READING = "reproduced with a stated reading"
    NOT_REPRODUCIBLE = "not reproducible"  # a finding, with its reason
    MISSED = "missed"  # this run is outside what it must show: something has changed or broken


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One statement of a paper beside what came out.

    Made by `Claim.checked` where a run decides, by `Claim.not_reproducible` where no run could.
    """

    statement: str
    """What the paper says, in our words or, in quotes, in its own."""
    source: str
    """Where it says so: "Section IV-A, Figure 2"."""
    measured: str
    """What came out, with units, and the bound it was held against."""
    verdict: Verdict
    reason: str = ""
    """The reading, or why it cannot be reproduced. Required unless plainly reproduced or missed."""
    section: str | None = None
    """Title of the section that shows it."""

    def __post_init__(self) -> None:
        """Refuse a verdict without the reason that it needs."""
        if self.verdict in (Verdict.WITH_READING, Verdict.NOT_REPRODUCIBLE) and not self.reason:
            raise ValueError(f"claim '{self.statement}': '{self.verdict}' needs a reason")

    @classmethod
    def checked(
        cls, statement: str, *, source: str, measured: str, holds: bool, reading: str = "", section: str | None = None
    ) -> Claim:
        """A claim that the run decides: reproduced if it `holds`, with a `reading` where one had to be chosen."""
        kept = Verdict.WITH_READING if reading else Verdict.REPRODUCED
        return cls(
            statement=statement,
            source=source,
            measured=measured,
            verdict=kept if holds else Verdict.MISSED,
            reason=reading,
            section=section,
        )

    @classmethod
    def not_reproducible(
        cls, statement: str, *, source: str, reason: str, measured: str = "", section: str | None = None
    ) -> Claim:
        """A claim that cannot be reproduced, and why: data the paper does not give, a target out of reach."""
        return cls(
            statement=statement,
            source=source,
            measured=measured,
            verdict=Verdict.NOT_REPRODUCIBLE,
            reason=reason,
            section=section,
        )


@dataclass(frozen=True)
class Spread:
    """A mean and a standard deviation over repeated runs."""

    mean: float
    std: float

    @classmethod
    def of(cls, values: Sequence[float]) -> Spread:
        """Mean and (sample) standard deviation of `values`; the deviation of a single one is NaN."""
        mean = sum(values) / len(values)
        squares = sum((value - mean) ** 2 for value in values)
        return cls(mean, (squares / (len(values) - 1)) ** 0.5 if len(values) > 1 else float("nan"))


class Printed(Enum):
    """Why there is no printed value to set beside the measured one."""

    NOT_IN_COPY = "not in our copy"  # the paper prints it; the text that we have lost it
    NOT_STATED = "not stated"  # the paper does not give it


Value: TypeAlias = str | int | float | Spread | None
"""None: does not apply. Text, and numbers, which are rounded for reading and kept whole in the CSV."""
Cell: TypeAlias = Value | tuple[Value | Printed, Value]
"""In a compared column: (printed, measured)."""


@dataclass(frozen=True, kw_only=True)
class Column:
    """A column of a table. In one that is `compared` each cell is the pair (printed, measured)."""

    name: str
    unit: str = ""
    compared: bool = False
    digits: int = 3

    @property
    def header(self) -> str:
        """Name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True, kw_only=True)
class Table:
    """A table of the report, and a CSV file of the same name."""

    name: str
    """Stem of its file: "table_2"."""
    title: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[Cell]]
    caption: str = ""
    folded: bool = False
    """Shown when the reader asks for it: for the numbers behind a figure."""

    def __post_init__(self) -> None:
        """Refuse rows that do not fit the columns."""
        _check_file_stem(self.name)
        for i, row in enumerate(self.rows):
            if len(row) != len(self.columns):
                raise ValueError(f"table '{self.name}', row {i}: {len(row)} cells for {len(self.columns)} columns")
            for column, cell in zip(self.columns, row, strict=True):
                if isinstance(cell, tuple) != column.compared:
                    expected = "a pair (printed, measured)" if column.compared else "a single value"
                    raise ValueError(f"table '{self.name}', row {i}, column '{column.name}': expected {expected}")


@dataclass(frozen=True, kw_only=True)
class Figure:
    """A figure of the report, and a PNG file of the same name; a GIF file where it moves."""

    name: str
    """Stem of its file: "figure_2"."""
    title: str
    drawing: Drawing
    """Made by `report.drawing`."""
    caption: str = ""
    """What to look at, and what it means."""
    frames: Frames | None = None
    """What moves in the drawing."""

    def __post_init__(self) -> None:
        """Refuse a name that is no file's."""
        _check_file_stem(self.name)


Block: TypeAlias = str | Table | Figure


@dataclass(frozen=True)
class Section:
    """A title and what follows it.

    Text is paragraphs separated by empty lines; a paragraph whose lines begin with "- " is a list. `code`,
    *emphasis*, **strong** and [words](address) are understood, everything else stands as written.
    """

    title: str
    blocks: Sequence[Block]


Part: TypeAlias = tuple[Section, list[Claim]]
"""A section with the claims that it decides."""


@dataclass(frozen=True, kw_only=True)
class Report:
    """What an experiment found."""

    summary: str
    """The finding in a few sentences: what a reader should know who reads nothing else."""
    sections: Sequence[Section]
    claims: Sequence[Claim] = field(default=())

    def __post_init__(self) -> None:
        """Refuse links to nowhere and names used twice."""
        titles = {section.title for section in self.sections}
        for claim in self.claims:
            if claim.section is not None and claim.section not in titles:
                raise ValueError(f"claim '{claim.statement}': there is no section '{claim.section}'")
        names = [block.name for block in self.blocks if not isinstance(block, str)]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"two tables or figures are named '{name}'")

    @classmethod
    def of(cls, summary: str, parts: Sequence[Part]) -> Report:
        """A report of several parts, in this order."""
        return cls(
            summary=summary,
            sections=[section for section, _ in parts],
            claims=[claim for _, claims in parts for claim in claims],
        )

    @property
    def blocks(self) -> list[Block]:
        """Texts, tables and figures of all sections."""
        return [block for section in self.sections for block in section.blocks]

    @property
    def tables(self) -> list[Table]:
        """All tables, in order."""
        return [block for block in self.blocks if isinstance(block, Table)]

    @property
    def figures(self) -> list[Figure]:
        """All figures, in order."""
        return [block for block in self.blocks if isinstance(block, Figure)]

    @property
    def missed(self) -> list[Claim]:
        """Claims that this run should have shown and did not."""
        return [claim for claim in self.claims if claim.verdict is Verdict.MISSED]


def _check_file_stem(name: str) -> None:
    if not _FILE_STEM.fullmatch(name):
        raise ValueError(f"'{name}' is no name for a file: use lower-case letters, digits and '_'")
