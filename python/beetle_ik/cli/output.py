"""A folder that receives all files of a command, or none."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .. import InvalidInputError


@contextmanager
def output_folder(folder: Path) -> Iterator[Path]:
    """Yield a place to write; its files move into `folder` when the block ends well and vanish when it does not.

    Raises:
        InvalidInputError: on entering, where `folder` cannot be written: no work is done for nothing.
    """
    created = [place for place in (folder, *folder.parents) if not place.exists()]
    try:
        with _staging(folder) as staging:
            yield Path(staging)
            for file in Path(staging).iterdir():
                file.replace(folder / file.name)
    except BaseException:
        for place in created:
            if place.exists():
                place.rmdir()
        raise


def _staging(folder: Path) -> tempfile.TemporaryDirectory[str]:
    """A temporary folder in `folder`: on the same disk, so that moving its files cannot fail half-way through one."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return tempfile.TemporaryDirectory(prefix=".beetle-ik-", dir=folder)
    except OSError as error:
        raise InvalidInputError(f"--out: folder '{folder}' cannot be written: {error.strerror}") from error
