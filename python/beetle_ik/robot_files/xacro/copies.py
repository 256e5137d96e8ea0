"""A copy of the package xacro for each call: its state and functions are global, and shared by all importers."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from itertools import count
from types import ModuleType

_numbers = count()


class NotInstalledError(Exception):
    """The package xacro is not installed."""


@contextmanager
def copied() -> Iterator[ModuleType]:
    """Loads the package xacro under another name, and forgets it afterwards.

    Raises:
        NotInstalledError: xacro is not installed.
    """
    try:
        found = find_spec("xacro")
    except ValueError:  # another object has that name
        found = None
    if found is None or found.origin is None:
        raise NotInstalledError
    name = f"_beetle_ik_xacro_{next(_numbers)}"
    spec = spec_from_file_location(name, found.origin, submodule_search_locations=found.submodule_search_locations)
    assert spec is not None, "found where a package is"
    assert spec.loader is not None, "found where a package is"
    module = sys.modules[name] = module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
        yield module
    finally:
        for loaded in [each for each in list(sys.modules) if each.split(".")[0] == name]:
            del sys.modules[loaded]
