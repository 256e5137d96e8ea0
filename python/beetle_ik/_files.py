"""Files and folders that are either whole or not there."""

import errno
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from ._core import InvalidInputError


def path_of(file: str | os.PathLike[str]) -> Path:
    """The path that an argument `file` names.

    Raises:
        InvalidInputError: it names none.
    """
    try:
        path = Path(file)
    except TypeError:
        raise InvalidInputError(f"file must be a path, got {file!r:.60}") from None
    if not path.name or "\0" in str(path):
        raise InvalidInputError(f"file must be the path of a file, got {file!r:.60}")
    return path


@contextmanager
def whole_file(file: str | os.PathLike[str]) -> Iterator[BinaryIO]:
    """Open `file` for writing: it appears when the block ends well; otherwise what was there before stays."""
    path = path_of(file)
    if not path.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "No such folder", str(path.parent))
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with unfinished.open("wb") as stream:
            yield stream
        unfinished.replace(path)
    except BaseException:
        unfinished.unlink(missing_ok=True)
        raise


@contextmanager
def whole_folder(folder: Path, *, option: str = "out") -> Iterator[Path]:
    """Yield a place to write; what is in it moves into `folder` when the block ends well and vanishes otherwise.

    Raises:
        InvalidInputError: on entering, where `folder` cannot be written: no work is done for nothing. Names `option`.
    """
    created = [place for place in (folder, *folder.parents) if not place.exists()]
    try:
        with _staging(folder, option) as staging:
            yield Path(staging)
            for entry in Path(staging).iterdir():
                entry.replace(folder / entry.name)
    except BaseException:
        for place in created:
            if place.exists():
                place.rmdir()
        raise


def _staging(folder: Path, option: str) -> tempfile.TemporaryDirectory[str]:
    """A temporary folder in `folder`: on the same disk, so that moving its files cannot fail half-way through one."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return tempfile.TemporaryDirectory(prefix=".beetle-ik-", dir=folder)
    except OSError as error:
        raise InvalidInputError(f"{option}: folder '{folder}' cannot be written: {error.strerror}") from error
