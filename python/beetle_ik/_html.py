"""Robots and results as HTML, which notebooks show in place of the repr."""

from collections.abc import Iterable
from html import escape
from typing import Any

import numpy as np

from ._core import Robot, Status

_MOST_NUMBERS = 12  # of an array that is written out
# Attributes of results in the order in which they are shown, with units.
_SHOWN = {
    "q": "rad, m",
    "x": "",
    "value": "",
    "position_error": "m",
    "rotation_error": "rad",
    "cost": "",
    "clearance": "m",
    "accuracy": "m",
    "max_violation": "rad, m",
    "evaluations": "",
    "elapsed": "s",
}


def robot(robot: Robot) -> str:
    """Returns name, chain and a table of the joints."""
    ends = f"{robot.link_names[0]} to {robot.link_names[-1]}"
    columns = (robot.joint_names, robot.joint_kinds, robot.lower, robot.upper, robot.velocity_limit)
    rows = [[_shown(value) for value in row] for row in zip(*columns, strict=True)]
    head = ("joint", "kind", "lower [rad, m]", "upper [rad, m]", "velocity limit [rad/s, m/s]")
    held = "; ".join(f"{name} at {_shown(value)}" for name, value in robot.held_joints.items())
    chain = f"{robot.dof} joints, {ends}" + (f"; held: {held}" if held else "")
    return f"<b>{escape(robot.name)}</b>: {escape(chain)}{_table(rows, head)}"


def result(result: Any) -> str:
    """Returns kind, status, message and the main numbers of a result."""
    rows = [
        [f"{name} [{unit}]" if unit else name, _shown(getattr(result, name))]
        for name, unit in _SHOWN.items()
        if _is_known(getattr(result, name, None))
    ]
    kind, message = type(result).__name__, str(result.message)
    # The statuses of a batch are an array, which its message sums up.
    state = f" {result.status.name}" if isinstance(result.status, Status) else ""
    return f"<b>{kind}{state}</b>: {escape(message)}{_table(rows)}"


def _is_known(value: Any) -> bool:
    """Whether there is a value: a free orientation has no error, a plan without obstacles no clearance."""
    return value is not None and not (isinstance(value, float) and np.isnan(value))


def _shown(value: Any) -> str:
    if isinstance(value, np.ndarray):
        if value.size > _MOST_NUMBERS:
            return f"array of shape {value.shape}"
        return ", ".join(f"{number:.6g}" for number in value.ravel())
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _table(rows: Iterable[list[str]], head: Iterable[str] = ()) -> str:
    titles = "".join(f"<th>{escape(title)}</th>" for title in head)
    cells = ("".join(f"<td>{escape(entry)}</td>" for entry in row) for row in rows)
    body = "".join(f"<tr>{row}</tr>" for row in ([titles] if titles else []) + list(cells))
    return f"<table>{body}</table>"
