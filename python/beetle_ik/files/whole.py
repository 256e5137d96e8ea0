"""Atomic writing: a file or folder appears complete, or not at all."""

from __future__ import annotations

import errno
import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from .._core import InvalidInputError

if TYPE_CHECKING:
    from tempfile import TemporaryDirectory

_log = logging.getLogger(__name__)


def path_of(file: str | os.PathLike[str]) -> Path:
    """Returns the argument `file` as a path.

    Raises:
        InvalidInputError: the argument is not the path of a file.
    """
    try:
        path = Path(file)
    except TypeError:
        raise InvalidInputError(f"file must be a path, got {file!r:.60}") from None
    if not path.name or "\0" in str(path):
        raise InvalidInputError(f"file must be the path of a file, got {file!r:.60}")
    return path


def content_of(file: str | os.PathLike[str]) -> bytes:
    """Returns the content of a file that describes something, as a scene.

    Raises:
        InvalidInputError: the argument is not the path of a file, or the file cannot be read.
    """
    try:
        return path_of(file).read_bytes()
    except OSError as error:
        raise InvalidInputError(f"cannot read '{os.fspath(file)}': {error.strerror}") from error


@contextmanager
def whole_file(file: str | os.PathLike[str]) -> Iterator[BinaryIO]:
    """Opens `file` for writing. It is replaced when the block succeeds; if the block raises, the old file stays."""
    path = path_of(file)
    if not path.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "No such folder", str(path.parent))
    unfinished = path.with_name(f".beetle-ik-{os.urandom(8).hex()}.part")
    try:
        # "x" opens a new file or fails: neither a link nor a file of another thread is written.
        with unfinished.open("xb") as stream:
            yield stream
        unfinished.replace(path)
    except BaseException:
        unfinished.unlink(missing_ok=True)
        raise
    _log.info("wrote %s", path)


@contextmanager
def whole_folder(folder: Path, *, option: str = "out") -> Iterator[Path]:
    """Yields a temporary folder. Its files move into `folder` when the block succeeds; if it raises, they are deleted.

    Raises:
        InvalidInputError: `folder` is not writable. Raised on entry, before any work is done; names `option`.
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


def _staging(folder: Path, option: str) -> TemporaryDirectory[str]:
    """Makes a temporary folder inside `folder`: on the same disk, each file moves atomically."""
    from tempfile import TemporaryDirectory  # slow to import

    try:
        folder.mkdir(parents=True, exist_ok=True)
        return TemporaryDirectory(prefix=".beetle-ik-", dir=folder)
    except OSError as error:
        raise InvalidInputError(f"{option}: folder '{folder}' cannot be written: {error.strerror}") from error
