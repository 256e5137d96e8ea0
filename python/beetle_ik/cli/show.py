"""Prints results: tables for people, JSON for machines."""

import json
import math
from collections.abc import Iterable
from typing import Any

import numpy as np
import typer

_NOISE_DECIMALS = 12


def print_json(value: Any) -> None:
    """Prints `value` as JSON."""
    typer.echo(to_json(value))


def to_json(value: Any) -> str:
    """Returns `value` as JSON; NaN and infinite numbers become null."""
    return json.dumps(_plain(value), indent=2, ensure_ascii=False)


def print_pairs(title: str, pairs: Iterable[tuple[str, str]]) -> None:
    """Prints a table of names and values."""
    print_table(title, (), pairs)


def print_table(title: str, columns: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> None:
    """Prints a table; without `columns` it has no header."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(*columns, box=SIMPLE_HEAD, show_header=bool(columns))
    for row in rows:
        table.add_row(*(Text(entry) for entry in row))
    typer.echo(title)
    Console().print(table)


def listed(values: Iterable[float]) -> str:
    """Formats numbers as a short list."""
    return ", ".join(_decimal(value, digits=6) for value in values)


def as_argument(values: Iterable[float]) -> str:
    """Formats numbers for options like --q and --start-q, with ten digits."""
    return ",".join(_decimal(value, digits=10) for value in values)


def _decimal(value: float, digits: int) -> str:
    """Formats `value` with this many significant digits; rounding noise around zero becomes 0."""
    return f"{round(value, _NOISE_DECIMALS) + 0.0:.{digits}g}"  # -0.0 + 0.0 is 0.0


def _plain(value: Any) -> Any:
    match value:
        case dict():
            return {key: _plain(entry) for key, entry in value.items()}
        case list() | tuple():
            return [_plain(entry) for entry in value]
        case np.ndarray() | np.generic():
            return _plain(value.tolist())
        case float() if not math.isfinite(value):
            return None
    return value
