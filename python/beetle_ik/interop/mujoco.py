"""Robots from MuJoCo models."""

import os
from typing import TYPE_CHECKING

from .._core import Robot

if TYPE_CHECKING:
    import mujoco


def from_mujoco(
    model: "mujoco.MjModel | str | os.PathLike[str]",
    *,
    base: str | None = None,
    tip: str | None = None,
    trusted: bool = False,
) -> Robot:
    """Makes a robot from a MuJoCo model; another name of `Robot.from_mjcf`, beside the other conversions."""
    return Robot.from_mjcf(model, base=base, tip=tip, trusted=trusted)
