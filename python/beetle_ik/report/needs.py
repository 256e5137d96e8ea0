"""What reports need beyond the package itself."""

from collections.abc import Iterable
from importlib.util import find_spec

from .._core import BeetleIkError

# What each extra brings: how it is imported, and how it is called.
_BROUGHT = {
    "report": {"jinja2": "jinja2", "matplotlib": "matplotlib"},
    "sim": {"mujoco": "mujoco"},
    "vision": {"skimage": "scikit-image"},
}


def check_installed(extras: Iterable[str] = ()) -> None:
    """Raise where something is missing that the extra `report`, or one of `extras`, brings.

    To be called before any work is done for nothing.

    Raises:
        BeetleIkError: names all that is missing, and what to install.
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
