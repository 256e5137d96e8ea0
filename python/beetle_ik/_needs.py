"""Libraries that are asked for only when something needs them."""

from importlib import import_module
from typing import Any

from ._core import BeetleIkError


def library(module: str, package: str, purpose: str, *, extra: str | None = None) -> Any:
    """The module, or an error that says what to install; one that is broken speaks for itself."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        install = package if extra is None else f"'beetle-ik[{extra}]'"
        raise BeetleIkError(f"{purpose} needs {package}: pip install {install}") from error
