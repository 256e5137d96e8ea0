"""Robots of the packages robot_descriptions, which downloads them at first use, and example-robot-data."""

from collections.abc import Mapping
from difflib import get_close_matches
from importlib import import_module
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Any

from .._core import BeetleIkError, InvalidInputError, Robot, UnknownNameError, UrdfError
from ..calls.arguments import require_text
from ..calls.names import nearest
from ..calls.text import listed
from ..installed.needs import library

_ENDING = "_description"
_SEVERAL_TIPS = "say which one is the tip"
_DATA = "cmeel.prefix/share/example-robot-data/robots"
_FILES = (".urdf", ".xacro", ".xml")


def robot(name: str, options: Mapping[str, Any], trusted: bool) -> Robot:
    """Loads a robot by its name; implements `Robot.from_description`."""
    require_text("name", name)
    if file := _data_file(name):
        return Robot.from_urdf(file, trusted=trusted, **options)
    if name in Robot.names() and not _has_descriptions():
        raise UnknownNameError(f"no description is named '{name}'; Robot.named('{name}') is built in")
    package = library("robot_descriptions", "robot_descriptions", f"the robot named '{name:.60}'", extra="robots")
    known = _names(package)
    described = _described(name) if name in known else None
    if described is None:
        raise UnknownNameError(f"robot_descriptions has no robot named '{name:.60}'{_hint(name, known)}")
    if hasattr(described, "URDF_PATH"):
        return Robot.from_urdf(described.URDF_PATH, trusted=trusted, **options)
    if hasattr(described, "XACRO_PATH"):
        return Robot.from_urdf(described.XACRO_PATH, trusted=trusted, **options)
    if hasattr(described, "MJCF_PATH"):
        if "srdf" in options:
            raise InvalidInputError(f"the description '{name}' is a MuJoCo model, which takes no srdf=")
        return Robot.from_mjcf(described.MJCF_PATH, trusted=trusted, **options)
    raise InvalidInputError(f"the description '{name}' is neither URDF nor MJCF")


def named(name: str, unknown: str) -> Robot:
    """Loads the description `name` for `Robot.named`; `unknown` is the message for a name that is not built in.

    Raises:
        UnknownNameError: no description of that name either; the message gives the nearest.
        UrdfError: the description has several tips; the message lists them.
    """
    if is_description(name):
        try:
            return robot(name, {}, trusted=False)
        except UrdfError as error:
            if _SEVERAL_TIPS not in str(error):
                raise
            raise UrdfError(f"{error}; Robot.from_description('{name}', tip=...) takes it") from None
    if name.lower().endswith(_FILES):
        raise UnknownNameError(f"no robot is named '{name:.60}'; a file is read by {_reader(name)}('{name:.60}')")
    stems = _stems(_names(import_module("robot_descriptions"))) if _has_descriptions() else []
    near = nearest(name, stems)
    also = "" if near is None or "did you mean" in unknown else f"; robot_descriptions has '{near}{_ENDING}'"
    raise UnknownNameError(unknown + also)


def is_description(name: str) -> bool:
    """Whether a name belongs to a description, or ends as only names of descriptions do."""
    known = _has_descriptions() and name in _names(import_module("robot_descriptions"))
    return known or name.endswith(_ENDING) or _data_file(name) is not None


def _reader(name: str) -> str:
    return "Robot.from_mjcf" if name.lower().endswith(".xml") else "Robot.from_urdf"


def _has_descriptions() -> bool:
    try:
        import_module("robot_descriptions")
    except ModuleNotFoundError:
        return False
    return True


def _names(package: Any) -> list[str]:
    """Returns the names of all descriptions."""
    return sorted(import_module(f"{package.__name__}._descriptions").DESCRIPTIONS)


def _stems(names: list[str]) -> list[str]:
    """Removes the ending common to all descriptions, which would make any two names similar."""
    return [name.removesuffix(_ENDING) for name in names]


def _described(name: str) -> Any:
    """Imports the module of a description, which downloads missing files; None if there is no such module.

    Raises:
        BeetleIkError: the files cannot be downloaded.
    """
    try:
        return import_module(f"robot_descriptions.{name}")
    except ModuleNotFoundError:
        return None
    except Exception as error:  # errors of git or of the network
        said = (str(error).strip().splitlines() or [type(error).__name__])[-1].rpartition("fatal: ")[2].strip(" '")
        raise BeetleIkError(
            f"robot_descriptions cannot download '{name:.60}': {said:.200}; only the first use needs the network"
        ) from error


def _hint(name: str, known: list[str]) -> str:
    """Suggests descriptions with a similar name, or the built-in robot of that name."""
    near = [other for other in known if other.startswith(f"{name}_")][:3]
    if _ENDING[:5] in name:  # a full name whose ending may be misspelt
        near = near or get_close_matches(name, known, n=3, cutoff=0.8)
    near = near or [f"{stem}{_ENDING}" for stem in get_close_matches(name, _stems(known), n=3, cutoff=0.8)]
    descriptions = f"; did you mean {' or '.join(near)}?" if near else f"; it has {len(known)} others"
    return f"{descriptions} Robot.named('{name}') is built in" if name in Robot.names() else descriptions


def _data_file(name: str) -> Path | None:
    """Returns the URDF of example-robot-data with this name, or in the folder of this name.

    Raises:
        UnknownNameError: several URDFs in the folder; the message lists them.
    """
    folder = _data_folder()
    if folder is None:
        return None
    files = sorted(folder.rglob("*.urdf"))
    within = [file for file in files if file.relative_to(folder).parts[0] == name]
    chosen = [file for file in within if file.stem == name.removesuffix(_ENDING)] or within
    chosen = chosen or [file for file in files if file.stem == name]
    if len(within) > 1 and len(chosen) > 1:
        stems = listed([file.stem for file in within])
        raise UnknownNameError(f"'{name:.60}' of example-robot-data has several robots: {stems}")
    return chosen[0] if chosen else None


def _data_folder() -> Path | None:
    """Returns the folder of the robots of example-robot-data; None if it is not installed."""
    try:
        folder = Path(str(distribution("example-robot-data").locate_file(_DATA)))
    except PackageNotFoundError:
        return None
    return folder if folder.is_dir() else None
