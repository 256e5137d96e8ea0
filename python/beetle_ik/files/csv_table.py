"""Reads and writes tables of numbers as CSV: a header of column names, then one row of numbers per line."""

import csv
import io
import os
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInputError
from ..calls.text import listed
from .whole import path_of, whole_file


def write_table(file: str | os.PathLike[str], columns: Sequence[str], rows: NDArray[np.float64]) -> None:
    """Write `rows` (lines, columns) so that they read back bit for bit."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(rows.tolist())  # Python prints the shortest decimal that reads back exactly
    with whole_file(file) as stream:
        stream.write(text.getvalue().encode())


def read_table(file: str | os.PathLike[str], required: Sequence[str]) -> dict[str, NDArray[np.float64]]:
    """Read the columns of `file` by name, in the file's order.

    Raises:
        InvalidInputError: the file is not CSV in UTF-8, a column of `required` is missing, or an entry is not a finite
            number. Names line and column.
    """
    lines = csv.reader(io.StringIO(_text(file), newline=""), skipinitialspace=True, strict=True)
    try:
        columns = [name.strip() for name in next(lines, [])]
        _check_header(file, columns, required)
        rows = [_numbers(file, lines.line_num, columns, line) for line in lines if line]
    except csv.Error as error:
        raise InvalidInputError(
            f"{os.fspath(file)}, line {lines.line_num}: broken CSV: {error}; check the quotes up to this line"
        ) from error
    if not rows:
        raise InvalidInputError(f"{os.fspath(file)}: no rows below the header")
    return dict(zip(columns, np.array(rows).T, strict=True))


def _text(file: str | os.PathLike[str]) -> str:
    content = path_of(file).read_bytes()
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise InvalidInputError(
            f"{os.fspath(file)}, line {line}: byte 0x{error.object[error.start]:02x} is not UTF-8; "
            "save the file as CSV with the encoding UTF-8"
        ) from error


def _check_header(file: str | os.PathLike[str], columns: list[str], required: Sequence[str]) -> None:
    for name in required:
        if name not in columns:
            found = (listed(columns) or "none") + _header_advice(columns, name)
            raise InvalidInputError(f"{os.fspath(file)}, line 1: column '{name}' is missing; columns found: {found}")
    for i, name in enumerate(columns):
        if name in columns[:i]:
            raise InvalidInputError(f"{os.fspath(file)}, line 1: column '{name}' appears twice")


def _header_advice(columns: list[str], missing: str) -> str:
    """Suggests how to repair a header that lacks the column `missing`."""
    if len(columns) == 1 and any(mark in columns[0] for mark in ";\t"):
        return "; separate them by commas"
    if columns and all(_is_number(name) for name in columns):
        return "; write their names above the numbers"
    otherwise = [name for name in columns if name.lower() == missing.lower()]
    if otherwise:
        return f"; write '{missing}' for '{otherwise[0]}'"
    return ""


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _numbers(file: str | os.PathLike[str], line_number: int, columns: list[str], line: list[str]) -> list[float]:
    where = f"{os.fspath(file)}, line {line_number}"
    if len(line) < len(columns):
        raise InvalidInputError(f"{where}: column '{columns[len(line)]}' is missing")
    if len(line) > len(columns):
        raise InvalidInputError(f"{where}: {len(line)} entries for {len(columns)} columns")
    return [_number(where, name, entry) for name, entry in zip(columns, line, strict=True)]


def _number(where: str, column: str, entry: str) -> float:
    try:
        number = float(entry)
    except ValueError:
        raise InvalidInputError(f"{where}, column '{column}': {entry!r:.60} is not a number") from None
    if not np.isfinite(number):
        raise InvalidInputError(f"{where}, column '{column}': {number} is not finite")
    return number
