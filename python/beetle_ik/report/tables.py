"""Tables on the page and in files: cells of the page, lines of the CSV file."""

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from .claim import Printed
from .content import Column, Spread, Table, Value
from .numbers import number, spread

_Entry: TypeAlias = Value | Printed
_PARTS = ("printed", "measured")


@dataclass(frozen=True)
class ShownCell:
    """A cell of the page: its text and its kind (classes of the style sheet)."""

    text: str
    kind: str


def shown_rows(table: Table) -> list[list[ShownCell]]:
    """Returns the body of the table for the page: one cell a column, two for a compared column."""
    shown = [
        [ShownCell(_text(entry, part, column), _kind(entry, part)) for entry in entries]
        for column, part, entries in _flat_columns(table)
    ]
    return [list(row) for row in zip(*shown, strict=True)]


def to_csv(table: Table) -> str:
    """Returns the table with all digits: compared columns as two, a spread as mean and standard deviation."""
    columns = [
        csv_column for column, part, entries in _flat_columns(table) for csv_column in _csv(column, part, entries)
    ]
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(zip(*columns, strict=True))
    return text.getvalue()


def _flat_columns(table: Table) -> Iterator[tuple[Column, str, list[_Entry]]]:
    """Yields each column with its entries; a compared column as two, named "printed" and "measured"."""
    for i, column in enumerate(table.columns):
        cells = [row[i] for row in table.rows]
        if column.compared:
            for k, part in enumerate(_PARTS):
                yield column, part, [cell[k] for cell in cells if isinstance(cell, tuple)]
        else:
            yield column, "", [cell for cell in cells if not isinstance(cell, tuple)]


def _csv(column: Column, part: str, entries: list[_Entry]) -> Iterator[list[object]]:
    """Yields header and entries as written: one column, or two if any entry is a spread."""
    header = f"{column.header} {part}".rstrip()
    if any(isinstance(entry, Spread) for entry in entries):
        yield [f"{header} mean", *(_plain(entry.mean if isinstance(entry, Spread) else entry) for entry in entries)]
        yield [f"{header} std", *(entry.std if isinstance(entry, Spread) else "" for entry in entries)]
    else:
        yield [header, *map(_plain, entries)]


def _plain(entry: _Entry) -> object:
    return entry.value if isinstance(entry, Printed) else entry  # the csv module writes None as an empty entry


def _kind(entry: _Entry, part: str) -> str:
    if isinstance(entry, Printed):
        return "absent"
    return f"{'text' if isinstance(entry, str) else 'number'} {part}".rstrip()


def _text(entry: _Entry, part: str, column: Column) -> str:
    digits = _printed_digits(entry) if part == "printed" else column.digits
    match entry:
        case None:
            return "–"
        case str():
            return entry
        case Printed():
            return entry.value
        case Spread(mean, std):
            return spread(mean, std, digits)
    return number(entry, digits)


def _printed_digits(entry: _Entry) -> int:
    """Counts the digits of a number as given: a printed value is shown as the paper prints it."""
    value = entry.mean if isinstance(entry, Spread) else entry
    return len(str(value).partition("e")[0].replace(".", "").lstrip("-0")) or 1
