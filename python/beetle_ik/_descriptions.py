"""Robots of the package robot_descriptions, which downloads them at first use."""

from collections.abc import Mapping
from difflib import get_close_matches
from importlib import import_module
from typing import Any

from ._arguments import require_text
from ._core import InvalidInputError, Robot, UnknownNameError
from ._needs import library


def robot(name: str, options: Mapping[str, Any], trusted: bool) -> Robot:
    """Returns `Robot.from_description`."""
    require_text("name", name)
    package = library("robot_descriptions", "robot_descriptions", f"the robot named '{name:.60}'", extra="robots")
    known = sorted(_names(package))
    try:
        described = import_module(f"robot_descriptions.{name}") if name in known else None
    except ModuleNotFoundError:
        described = None
    if described is None:
        near = get_close_matches(name, known, n=3, cutoff=0.8)
        hint = f"; did you mean {' or '.join(near)}?" if near else f"; it has {len(known)} others"
        raise UnknownNameError(f"robot_descriptions has no robot named '{name:.60}'{hint}")
    if hasattr(described, "URDF_PATH"):
        return Robot.from_urdf(described.URDF_PATH, trusted=trusted, **options)
    if hasattr(described, "XACRO_PATH"):
        return Robot.from_urdf(described.XACRO_PATH, trusted=trusted, **options)
    if hasattr(described, "MJCF_PATH"):
        if "srdf" in options:
            raise InvalidInputError(f"the description '{name}' is a MuJoCo model, which takes no srdf=")
        return Robot.from_mjcf(described.MJCF_PATH, trusted=trusted, **options)
    raise InvalidInputError(f"the description '{name}' is neither URDF nor MJCF")


def _names(package: Any) -> list[str]:
    """Returns the names of all descriptions."""
    listed = import_module(f"{package.__name__}._descriptions")
    return list(listed.DESCRIPTIONS)
