"""Expansion of one xacro file."""

from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from ..._core import BeetleIkError, UrdfError
from ..own_files import REMEDY
from .copies import NotInstalledError, copied
from .guard import Guard, found
from .packages import Packages


def expand(path: str, package_dirs: Sequence[str], trusted: bool) -> str:
    """Returns the URDF of a xacro file. An untrusted file executes nothing, and reads only its own packages.

    Raises:
        UrdfError: xacro is not installed, cannot expand the file, or a request of the file is refused.
    """
    guard = None
    packages = Packages(Path(path), package_dirs)
    try:
        with copied() as xacro:
            if trusted:
                _find_packages(xacro, packages)
            else:
                guard = Guard(xacro, packages)
            text = str(xacro.process_file(path).toxml())
    except NotInstalledError as error:
        urdf = path.removesuffix(".xacro").removesuffix(".urdf") + ".urdf"
        raise UrdfError(
            f"URDF: '{path}' is a xacro file: pip install 'beetle-ik[robots]', or run `xacro {path} > {urdf}` and load "
            "the result"
        ) from error
    except BeetleIkError:
        raise
    except Exception as error:  # xacro raises many kinds, also those of the expressions in the file
        _require_allowed(path, guard)
        raise UrdfError(f"URDF: xacro cannot expand '{path}': {_said(error):.300}") from error
    _require_allowed(path, guard)
    return text


def _require_allowed(path: str, guard: Guard | None) -> None:
    if guard is not None and guard.refusal is not None:
        raise UrdfError(f"URDF: xacro cannot expand '{path}': {guard.refusal} {REMEDY}") from None


def _said(error: Exception) -> str:
    return str(error) or type(error).__name__


def _find_packages(xacro: ModuleType, packages: Packages) -> None:
    """Lets `$(find package)` search where `package://` does; xacro alone finds only packages installed by ROS."""
    resolve = xacro.eval_extension

    def eval_extension(text: str) -> Any:
        match text[2:-1].split():
            case ["find", name] if packages.find(name) is not None:
                return found(xacro, packages, name)
        return resolve(text)

    xacro.__dict__["eval_extension"] = eval_extension
