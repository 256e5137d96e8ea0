"""Optional packages that reports need."""

from collections.abc import Iterable
from importlib.util import find_spec

from .._core import BeetleIkError

# Packages of each extra: module name, and name in messages.
_BROUGHT = {
    "report": {"jinja2": "jinja2", "matplotlib": "matplotlib"},
    "sim": {"mujoco": "mujoco"},
    "vision": {"skimage": "scikit-image"},
}


def check_installed(extras: Iterable[str] = ()) -> None:
    """Raises an error if a package of the extra `report`, or of one of `extras`, is missing.

    Call it before any work that would be lost.

    Raises:
        BeetleIkError: the message names all missing packages, and the extras to install.
    """
    lacking, missing = [], []
    for extra in dict.fromkeys(["report", *extras]):
        libraries = [name for module, name in _BROUGHT[extra].items() if find_spec(module) is None]
        if libraries:
            lacking.append(extra)
            missing += libraries
    if missing:
        raise BeetleIkError(
            f"reports need {' and '.join(missing)}, which {'is' if len(missing) == 1 else 'are'} not installed: "
            f"pip install 'beetle-ik[{','.join(lacking)}]'"
        )
