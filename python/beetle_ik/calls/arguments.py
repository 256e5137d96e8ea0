"""Checks of arguments in Python, with errors of this library."""

from collections.abc import Iterable
from numbers import Integral
from typing import Any

from .._core import InvalidInputError, Robot
from .wording import example, with_article


def require(name: str, value: object, *kinds: type) -> None:
    """Raises `InvalidInputError` unless the value is an instance of one of `kinds`."""
    if not isinstance(value, kinds):
        wanted = " or ".join(with_article(kind.__name__) for kind in kinds)
        made = example("Robot", value) if kinds == (Robot,) and isinstance(value, str) else ""
        raise InvalidInputError(f"{name} must be {wanted}{made}, got {value!r:.60}")


def require_one_tip(call: str, robot: Robot) -> None:
    """Raises `InvalidInputError` if the robot has several tips, which `call` does not take."""
    if len(robot.tips) > 1:
        tips = f"{', '.join(robot.tips[:-1])} and {robot.tips[-1]}"
        raise InvalidInputError(
            f"{call} takes robots with one tip; this one has {tips}: load the robot with one of them as tip="
        )


def require_text(name: str, value: object) -> None:
    """Raises `InvalidInputError` unless the value is text without unpaired surrogates."""
    require(name, value, str)
    try:
        str(value).encode()
    except UnicodeEncodeError:
        raise InvalidInputError(f"{name} must be valid Unicode, got {value!r:.60}") from None


def require_count(name: str, value: object) -> None:
    """Raises `InvalidInputError` unless the value is a whole number, zero or more."""
    if not isinstance(value, Integral) or value < 0:
        raise InvalidInputError(f"{name} must be a whole number, zero or more, got {value!r:.60}")


def read_once(things: Any) -> Any:
    """Returns an iterable as a list, which can be read again; other values unchanged, for the core to refuse."""
    return list(things) if isinstance(things, Iterable) and not isinstance(things, str) else things
