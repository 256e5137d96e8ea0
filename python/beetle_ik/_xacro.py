"""Xacro files, expanded by the Python package xacro."""

from importlib import import_module

from ._core import UrdfError


def expand(path: str) -> str:
    """Returns the URDF of a xacro file."""
    try:
        xacro = import_module("xacro")
    except ModuleNotFoundError as error:
        urdf = path.removesuffix(".xacro").removesuffix(".urdf") + ".urdf"
        raise UrdfError(
            f"URDF: '{path}' is a xacro file: pip install 'beetle-ik[robots]', or run `xacro {path} > {urdf}` and load "
            "the result"
        ) from error
    try:
        return str(xacro.process_file(path).toxml())
    except Exception as error:  # xacro raises many kinds, also those of the expressions in the file
        raise UrdfError(f"URDF: xacro cannot expand '{path}': {error!s:.300}") from error
