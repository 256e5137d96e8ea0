"""Converts docstrings, which are written for a terminal, to reStructuredText."""

import re
from typing import Any

_CODE = re.compile(r"(`[^`]*`)")
_SPECIAL = re.compile(r"[\\*|]|(?<=\w)_(?!\w)")
_ENUMERATOR = re.compile(r"(?<=: )(\w)\.$")  # "tolerance: m." is not the first item of a list
_SECTION = re.compile(r"^(Args|Returns|Raises|Yields):$")


def escaped(line: str) -> str:
    """Escapes what reStructuredText would read as markup, except in backquotes."""
    parts = _CODE.split(line)
    parts[::2] = [_SPECIAL.sub(lambda found: "\\" + found[0], part) for part in parts[::2]]
    for i in range(2, len(parts), 2):
        if parts[i][:1].isalnum():
            parts[i] = "\\ " + parts[i]  # the s of several `Sinusoid`s
    return _ENUMERATOR.sub(r"\1\\.", "".join(parts))


def converted(lines: list[str]) -> list[str]:
    """Converts the lines of a docstring; marks indented examples as code."""
    result: list[str] = []
    code = section = False
    for i, line in enumerate(lines):
        if line and not line.startswith(" "):
            code, section = False, bool(_SECTION.match(line))
        elif line and not (code or section or lines[i - 1].strip()):
            code = True
            result += [".. code-block:: python", ""]
        result.append(line if code else escaped(line))
    return result


_kept: dict[str, list[str]] = {}  # docstrings of attributes, by name


def convert(_app: Any, what: str, name: str, _subject: Any, _options: Any, lines: list[str]) -> None:
    """Handles the autodoc event, before napoleon."""
    lines[:] = converted(lines)
    if what in ("attribute", "property"):
        _kept[name] = lines.copy()


def restore(_app: Any, _what: str, name: str, _subject: Any, _options: Any, lines: list[str]) -> None:
    """Undoes what napoleon reads in attributes: words before a colon are no type."""
    lines[:] = _kept.pop(name, lines)


def setup(app: Any) -> dict[str, bool]:
    """Registers the Sphinx extension."""
    app.setup_extension("sphinx.ext.autodoc")
    app.connect("autodoc-process-docstring", convert, priority=100)
    app.connect("autodoc-process-docstring", restore, priority=900)
    return {"parallel_read_safe": True}
