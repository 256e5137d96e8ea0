"""Joints of an arm as MuJoCo needs them, with all frames parallel to the base at q = 0; MuJoCo itself."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from ..installed.needs import library

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .._core import Robot


def mujoco_library() -> Any:
    """Returns the module mujoco.

    Raises:
        BeetleIkError: it is not installed.
    """
    # Selects EGL, the only way to render without a display; MuJoCo reads the variable at its import.
    if sys.platform == "linux" and not os.environ.get("DISPLAY"):
        os.environ.setdefault("MUJOCO_GL", "egl")
    return library("mujoco", "mujoco", "simulation", extra="sim")


def joints_of(
    robot: Robot,
) -> tuple[list[str], list[NDArray[np.float64]], list[NDArray[np.float64]], NDArray[np.float64]]:
    """Returns joint kinds, joint axes, a point on each axis, and the tip at q = 0, all from the Jacobian."""
    zero = np.zeros(robot.dof)
    jacobian, tip = robot.jacobian(zero), robot.fk(zero)[:3, 3]
    origins = robot.link_poses(zero)[:, :3, 3]
    axes, anchors = [], []
    for i, kind in enumerate(robot.joint_kinds):
        linear, angular = jacobian[:3, i], jacobian[3:, i]
        near = origins[min(i + 1, len(origins) - 1)]
        if kind == "prismatic":
            axes.append(linear / np.linalg.norm(linear))
            anchors.append(near)
            continue
        axis = angular / np.linalg.norm(angular)
        on_axis = tip - np.cross(linear, axis)  # v = w x (tip - p), solved for p
        axes.append(axis)
        anchors.append(on_axis + axis * (axis @ (near - on_axis)))
    return robot.joint_kinds, axes, anchors, tip
