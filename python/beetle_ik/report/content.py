"""Contents of a report: sections of text, tables and figures; claims of the paper and checks of the library.

Each part is checked when it is made, so that a mistake shows where it was written and not in the finished page.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

from .claim import Check, Claim, Printed

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

    from ..figures.frames import Frames

_FILE_STEM = re.compile(r"[a-z0-9_]+")


@dataclass(frozen=True)
class Spread:
    """A mean and a standard deviation over repeated runs."""

    mean: float
    std: float

    @classmethod
    def of(cls, values: Sequence[float]) -> Spread:
        """Returns mean and (sample) standard deviation of `values`; the deviation of a single value is NaN."""
        mean = sum(values) / len(values)
        squares = sum((value - mean) ** 2 for value in values)
        return cls(mean, (squares / (len(values) - 1)) ** 0.5 if len(values) > 1 else float("nan"))


Value: TypeAlias = str | int | float | Spread | None
"""Content of a cell: text, or numbers, which are rounded on the page and kept whole in the CSV; None: not
applicable."""
Cell: TypeAlias = Value | tuple[Value | Printed, Value]
"""Content of a cell, or (printed, measured) in a compared column."""


@dataclass(frozen=True, kw_only=True)
class Column:
    """A column of a table. Each cell of a `compared` column is the pair (printed, measured)."""

    name: str
    unit: str = ""
    compared: bool = False
    digits: int = 4

    @property
    def header(self) -> str:
        """Name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True, kw_only=True)
class Table:
    """A table of the report, and a CSV file of the same name."""

    name: str
    """Stem of the file, for example "table_2"."""
    title: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[Cell]]
    caption: str = ""
    folded: bool = False
    """Whether the table is hidden until the reader opens it, for the numbers behind a figure."""
    carried_over: str = ""
    """Command that computes the table, if this run did not."""

    def __post_init__(self) -> None:
        """Refuses rows that do not fit the columns."""
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
    """A figure of the report, and a PNG file of the same name; a GIF file for an animation."""

    name: str
    """Stem of the file, for example "figure_2"."""
    title: str
    drawing: Drawing
    """Figure made by `report.drawing`."""
    caption: str = ""
    """Explanation of the figure."""
    frames: Frames | None = None
    """Animation of the drawing, if any."""

    def __post_init__(self) -> None:
        """Refuses a name that cannot be a file's."""
        _check_file_stem(self.name)


@dataclass(frozen=True, kw_only=True)
class CarriedOver:
    """Text with numbers that this run did not compute. The page marks it and names the command."""

    text: str
    """Text of a section."""
    command: str
    """Command that computes the numbers."""


Block: TypeAlias = str | CarriedOver | Table | Figure


@dataclass(frozen=True)
class Section:
    """A title and its content.

    Text is paragraphs separated by empty lines; a paragraph whose lines begin with "- " is a list. `code`, *emphasis*,
    **strong** and [words](address) are understood, everything else is shown as written.
    """

    title: str
    blocks: Sequence[Block]


Part: TypeAlias = tuple[Section, Sequence[Claim | Check]]
"""A section with the claims and checks that it decides."""


@dataclass(frozen=True, kw_only=True)
class Report:
    """Findings of an experiment."""

    summary: str
    """Findings in a few sentences, for readers who read nothing else."""
    sections: Sequence[Section]
    claims: Sequence[Claim] = field(default=())
    checks: Sequence[Check] = field(default=())
    """Statements of the run on the library itself."""

    def __post_init__(self) -> None:
        """Refuses unknown section titles and names used twice."""
        titles = {section.title for section in self.sections}
        decided: list[Claim | Check] = [*self.claims, *self.checks]
        for judged in decided:
            if judged.section is not None and judged.section not in titles:
                raise ValueError(f"'{judged.statement}': there is no section '{judged.section}'")
        names = [*(table.name for table in self.tables), *(figure.name for figure in self.figures)]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"two tables or figures are named '{name}'")

    @classmethod
    def of(cls, summary: str, parts: Sequence[Part]) -> Report:
        """Makes a report of several parts, in this order."""
        return cls(
            summary=summary,
            sections=[section for section, _ in parts],
            claims=[judged for _, all_judged in parts for judged in all_judged if isinstance(judged, Claim)],
            checks=[judged for _, all_judged in parts for judged in all_judged if isinstance(judged, Check)],
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
    def failed(self) -> list[Check]:
        """Checks that do not hold: a regression or a changed result."""
        return [check for check in self.checks if not check.holds]

    @property
    def carried_over(self) -> list[str]:
        """Commands that compute parts left out by this run; empty if it computed everything."""
        tables = [table.carried_over for table in self.tables if table.carried_over]
        texts = [block.command for block in self.blocks if isinstance(block, CarriedOver)]
        return list(dict.fromkeys(tables + texts))


def _check_file_stem(name: str) -> None:
    if not _FILE_STEM.fullmatch(name):
        raise ValueError(f"'{name}' is no name for a file: use lower-case letters, digits and '_'")
