"""Optional dependencies, imported on first use."""

from importlib import import_module
from typing import Any

from .._core import BeetleIkError


def library(module: str, package: str, purpose: str, *, extra: str | None = None) -> Any:
    """Imports a module, or raises an error that says what to install. Errors from within the module pass through."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        install = package if extra is None else f"'beetle-ik[{extra}]'"
        raise BeetleIkError(f"{purpose} needs {package}: pip install {install}") from error
