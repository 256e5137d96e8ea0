"""Checks of arguments that JAX and PyTorch share; shapes are known when JAX traces a program."""

from collections.abc import Iterable
from typing import Any

from ..._core import InvalidInputError, Robot
from ...calls.arguments import require
from ...scenes import Scene


def of_robot(robot: Robot) -> None:
    """Raises `InvalidInputError` if this is not a `Robot`."""
    require("robot", robot, Robot)


def shape_of_joints(name: str, shape: Iterable[int], robot: Robot) -> None:
    """Raises `InvalidInputError` unless the last axis is that of the joints."""
    shape = tuple(shape)
    if shape[-1:] != (robot.dof,):
        raise InvalidInputError(
            f"{name}: expected shape (..., {robot.dof}), one per joint of '{robot.name}', got {shape}"
        )


def rows_of_target(shape: Iterable[int], robot: Robot) -> tuple[int, int]:
    """Returns the components of a target, 6 of a pose or 3 of a position, and its number of axes.

    Raises:
        InvalidInputError: the shape of neither.
    """
    shape, tips = tuple(shape), len(robot.tips)
    if tips > 1:
        if shape[-3:] == (tips, 4, 4):
            return 6, 3
        raise InvalidInputError(f"target: expected poses (..., {tips}, 4, 4), one per tip, got shape {shape}")
    if shape[-2:] == (4, 4):
        return 6, 2
    if shape[-1:] == (3,):
        return 3, 1
    raise InvalidInputError(f"target: expected poses (..., 4, 4) or positions (..., 3), got shape {shape}")


def damping_of(value: float) -> float:
    """Returns the value as float.

    Raises:
        InvalidInputError: not a positive number.
    """
    if not isinstance(value, (int, float)) or not 0.0 < value < float("inf"):
        raise InvalidInputError(f"damping must be a positive number, got {value!r:.60}")
    return float(value)


def differences_of(shape: Iterable[int], order: int) -> None:
    """Checks the configurations of a path, and the order of their differences.

    Raises:
        InvalidInputError: an order other than 1, 2 or 3, or too few configurations.
    """
    shape = tuple(shape)
    if order not in (1, 2, 3):
        raise InvalidInputError(f"order must be 1, 2 or 3, got {order!r:.60}")
    if len(shape) < 2 or shape[-2] <= order:
        raise InvalidInputError(
            f"path: expected configurations (..., m, n) with m of at least {order + 1} for order {order}, got {shape}"
        )


def scene_of(scene: Any) -> Scene:
    """Returns obstacles as a `Scene`, which prepares them once; None: no obstacles, the robot's own links alone."""
    return scene if isinstance(scene, Scene) else Scene([] if scene is None else scene)


def axis_of_tips(robot: Robot, link: str | None) -> tuple[int, ...]:
    """Returns the length of the axis of the tips, if there are several."""
    return () if link is not None or len(robot.tips) == 1 else (len(robot.tips),)
