"""Search for packages, and the files that an untrusted file may include."""

import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from ..own_files import RefusedError, is_package, package_of, require_inside

_NAME = re.compile(r"[0-9A-Za-z_][0-9A-Za-z_.-]*")


class Packages:
    """The packages that a file may name, and the folders whose files it may include."""

    def __init__(self, file: Path, given: Sequence[str]) -> None:
        """Starts with the package of the file, or its folder outside a package, and the given folders."""
        self._around = list(file.absolute().parents)
        self._given = [Path(each).absolute() for each in given]
        self._open = [package_of(file.absolute()), package_of(file.resolve()), *self._given]

    def find(self, name: str) -> Path | None:
        """Returns the folder of a package, searched as for `package://`; its files may be included from then on.

        Above the file only folders with a package.xml count: any folder of the system may be above it.
        """
        if not _NAME.fullmatch(name):
            raise RefusedError(f"'$(find {name:.60})', which is no name of a package,")
        for folder in self._candidates(name):
            if folder.is_dir():
                self._open.append(folder)
                return folder
        return None

    def _candidates(self, name: str) -> Iterator[Path]:
        installed = [Path(each) for each in _listed("ROS_PACKAGE_PATH")]
        installed += [Path(each) / "share" for each in _listed("AMENT_PREFIX_PATH")]
        for root in (*self._given, *installed):
            yield from (root,) if root.name == name else ()
            yield root / name
        for above in self._around:
            for folder in (above, above / name):
                if folder.name == name and is_package(folder):
                    yield folder

    def require_open(self, file: str) -> Path:
        """Resolves the links of a file, and checks that it is in one of the folders.

        Raises:
            RefusedError: the file is elsewhere.
        """
        return require_inside(self._open, Path(file), file)


def _listed(variable: str) -> list[str]:
    return [each for each in os.environ.get(variable, "").split(os.pathsep) if each]
