"""What reports need beyond the package itself."""

from importlib.util import find_spec

from .._core import BeetleIkError


def check_installed() -> None:
    """Raise where a library is missing that the extra `report` brings: before any work is done for nothing."""
    for library in ("jinja2", "matplotlib"):
        if find_spec(library) is None:
            raise BeetleIkError(f"reports need {library}, which is not installed: pip install 'beetle-ik[report]'")
