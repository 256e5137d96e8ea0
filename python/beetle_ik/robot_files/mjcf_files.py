"""Check of the files that a MuJoCo model names: MuJoCo would open any file."""

from collections.abc import Iterable
from itertools import product
from pathlib import Path
from typing import Any
from xml.parsers import expat

from .._core import InvalidInputError
from .own_files import REMEDY, RefusedError, package_of, require_inside

_FOLDERS = ("assetdir", "meshdir", "texturedir")  # attributes of the element `compiler`
_BINARY = ("flex", "flexcomp", "hfield", "mesh", "skin", "texture")
"""Elements whose files are not XML; files of other elements may name further files."""


def require_own_files(model: str) -> None:
    """Checks an untrusted file or text, which may name only files of its folder or package, and no plugins.

    Raises:
        InvalidInputError: the model names another file or a plugin; the message gives the file and the line.
    """
    if "<" in model:
        _Files(Path("text").absolute()).check(model.encode(), "the text")
        return
    file = Path(model).absolute()
    try:
        content = file.read_bytes()
    except (OSError, ValueError):  # a ValueError for a name with a null byte
        return  # MuJoCo reports the error itself
    _Files(file).check(content, model)


class _Files:
    """The files that a model names.

    MuJoCo searches several folders, by rules that depend on its version, so that every candidate must be inside.
    """

    def __init__(self, model: Path) -> None:
        self._roots = (package_of(model), package_of(model.resolve()))
        self._bases = {model.parent}
        self._folders, self._names, self._including, self._read = {""}, set[str](), set[str](), set[Path]()

    def check(self, content: bytes, shown: str) -> None:
        """Checks a file and its includes; folders and names add up over all files."""
        parser = expat.ParserCreate("utf-8")  # whatever encoding the file declares: MuJoCo reads UTF-8

        def started(tag: str, attributes: dict[str, str]) -> None:
            if tag.lower() == "plugin":
                raise RefusedError(f"the plugin '{attributes.get('plugin', '')!s:.60}'")
            for name, value in attributes.items():
                if name.lower() in _FOLDERS:
                    self._add_folder(value.replace("\\", "/"))
                elif name.lower().startswith("file"):
                    self._add_name(value.replace("\\", "/"))
                    self._including |= set() if tag.lower() in _BINARY else {value.replace("\\", "/")}

        def declared(name: str, *_: Any) -> None:
            raise RefusedError(f"the entity '{name:.60}'")

        parser.StartElementHandler, parser.EntityDeclHandler = started, declared
        try:
            parser.Parse(content, True)
        except RefusedError as error:
            where = f"{shown:.200} line {parser.CurrentLineNumber}"
            raise InvalidInputError(f"MuJoCo model: {where}: {error} {REMEDY}") from None
        except expat.ExpatError as error:
            raise InvalidInputError(f"MuJoCo cannot read the model: {shown:.200}: {error}") from None
        try:
            self._check_included()
        except RefusedError as error:
            raise InvalidInputError(f"MuJoCo model: {shown:.200}: {error} {REMEDY}") from None

    def _add_folder(self, folder: str) -> None:
        self._folders.add(folder)
        self._require_inside(self._bases, [folder], {"", *self._names}, folder)

    def _add_name(self, name: str) -> None:
        self._names |= {name, Path(name).name}  # MuJoCo may drop the folders
        self._require_inside(self._bases, self._folders, (name, Path(name).name), name)

    def _require_inside(
        self, bases: Iterable[Path], folders: Iterable[str], names: Iterable[str], shown: str | None = None
    ) -> None:
        for base, folder, name in product(bases, folders, names):
            require_inside(self._roots, base / folder / name, name if shown is None else shown)

    def _check_included(self) -> None:
        for base, folder, name in list(product(self._bases, self._folders, self._including)):
            place = base / folder / name
            if place.is_file() and place not in self._read:
                self._read.add(place)
                if place.parent not in self._bases:
                    self._bases.add(place.parent)
                    self._require_inside([place.parent], self._folders, self._names)
                self.check(place.read_bytes(), str(place))
