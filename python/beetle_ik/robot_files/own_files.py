"""Limits on untrusted files: refused actions, and the files that belong to a package."""

from collections.abc import Iterable
from pathlib import Path

REMEDY = (
    "is not allowed in a file from anyone: trusted=True lets your own files execute code, and read the environment "
    "and other files"
)
_MARK = "package.xml"


class RefusedError(Exception):
    """An action that an untrusted file may not take."""


def is_package(folder: Path) -> bool:
    """Whether a folder is a package of ROS."""
    return (folder / _MARK).is_file()


def package_of(file: Path) -> Path:
    """Returns the folder of the package that a file belongs to; its own folder if it is in none."""
    return next((folder for folder in file.parents if is_package(folder)), file.parent)


def require_inside(folders: Iterable[Path], file: Path, shown: str) -> Path:
    """Resolves the links of a file, and checks that it is in one of the folders.

    Raises:
        RefusedError: the file is elsewhere; the message names it as `shown`.
    """
    try:
        real = file.resolve()
    except RecursionError:
        raise
    except (OSError, RuntimeError, ValueError):  # links in a circle, a name that no file can have
        raise RefusedError(f"the file '{shown:.200}', which cannot be found,") from None
    if not any(real.is_relative_to(folder.resolve()) for folder in folders):
        raise RefusedError(f"the file '{shown:.200}', which is outside of the package,")
    return real
