"""Checks a source distribution and a wheel before they are published: `python tools/check_wheel.py FOLDER`.

`make release-check` builds both into the folder. Metadata and the long description are checked by twine.
"""

import re
import sys
import tarfile
import tomllib
from email import message_from_bytes
from email.message import Message
from pathlib import Path
from zipfile import ZipFile

ROOT = Path(__file__).parents[1]
PROMISES = ROOT / "docs" / "stability.md"
_OF_CORE = ["numpy"]  # requirements of the wheel without extras
_MODULE = ("beetle_ik/_core.abi3.so", "beetle_ik/_core.pyd")


def problems(folder: Path) -> list[str]:
    """Returns everything that prevents publishing the files in the folder, as sentences."""
    wheels, sources = list(folder.glob("*.whl")), list(folder.glob("*.tar.gz"))
    if len(wheels) != 1 or len(sources) != 1:
        return [f"{folder} must have one wheel and one source distribution."]
    return [*_of_sources(sources[0]), *_of_wheel(wheels[0])]


def _of_sources(file: Path) -> list[str]:
    with tarfile.open(file) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    wanted = ["Cargo.lock", "README.md", "docs/index.md", "tests/python/test_solve.py", *_licences()]
    return [f"{file.name} has no {name}." for name in wanted if name not in names]


def _of_wheel(file: Path) -> list[str]:
    with ZipFile(file) as archive:
        names = archive.namelist()
        described = next(name for name in names if name.endswith(".dist-info/METADATA"))
        metadata = message_from_bytes(archive.read(described))
    info = Path(described).parent.as_posix()
    wanted = ["beetle_ik/py.typed", "beetle_ik/_core.pyi", *(f"{info}/licenses/{name}" for name in _licences())]
    found = [f"{file.name} has no {name}." for name in wanted if name not in names]
    if not set(_MODULE) & set(names):
        found.append(f"{file.name} has no compiled module.")
    return [*found, *_of_metadata(file, metadata), *_of_tag(file)]


def _of_metadata(file: Path, metadata: Message) -> list[str]:
    """Checks that a plain `pip install` brings numpy alone."""
    needed = [text for text in metadata.get_all("Requires-Dist", []) if "extra ==" not in text]
    names = [re.match(r"[\w-]+", text)[0] for text in needed]  # type: ignore[index]
    return [] if names == _OF_CORE else [f"{file.name} needs {', '.join(needed)}, but should need numpy alone."]


def _of_tag(file: Path) -> list[str]:
    """Checks that a wheel for Linux runs where the page on stability says."""
    tag = re.search(r"manylinux_(\d+)_(\d+)", file.name)
    promised = re.search(r"manylinux (\d+)\.(\d+)", PROMISES.read_text(encoding="utf-8"))
    if tag is None or promised is None:
        return []
    built, allowed = tuple(map(int, tag.groups())), tuple(map(int, promised.groups()))
    if built <= allowed:
        return []
    return [f"{file.name} needs glibc {built[0]}.{built[1]}; {PROMISES.name} promises {allowed[0]}.{allowed[1]}."]


def _licences() -> list[str]:
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    return list(pyproject["project"]["license-files"])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python tools/check_wheel.py FOLDER")
    if found := problems(Path(sys.argv[1])):
        sys.exit("\n".join(found))
    print("the wheel and the source distribution can be published")
