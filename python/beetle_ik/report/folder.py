"""The folder of a report: it holds the whole old report or the whole new one, nothing in between."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .._core import InvalidInputError
from ..files.whole import whole_folder

MANIFEST = "report.json"


@contextmanager
def report_folder(folder: Path, *, option: str = "out") -> Iterator[Path]:
    """Yields an empty folder to write into; it replaces the report in `folder` when the block succeeds.

    Raises:
        InvalidInputError: on entering, `folder` cannot be written or holds files that no earlier report wrote.
    """
    earlier = _files_of_report(folder, option)
    with whole_folder(folder, option=option) as staging:
        yield staging
        for file in earlier:
            file.unlink(missing_ok=True)
        for place in sorted({parent for file in earlier for parent in file.parents}, reverse=True):
            if folder in place.parents:
                place.rmdir()


def files_in(folder: Path) -> list[str]:
    """Returns all files in `folder`, named relative to it."""
    return sorted(file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file())


def _files_of_report(folder: Path, option: str) -> list[Path]:
    """Returns the files of the report in `folder`; empty if there is no report yet."""
    if not folder.is_dir():
        return []
    found = [name for name in files_in(folder) if not name.startswith(".")]
    ours = _manifest(folder / MANIFEST)
    for name in found:
        if name not in ours:
            raise InvalidInputError(
                f"{option}: folder '{folder}' holds '{name}', which no earlier report put there; "
                "name an empty folder or a new one"
            )
    return [folder / name for name in found]


def _manifest(file: Path) -> set[str]:
    try:
        return set(json.loads(file.read_text(encoding="utf-8"))["files"])
    except (OSError, ValueError, KeyError, TypeError):
        return set()
