"""Robots and results as HTML, which notebooks show in place of the repr."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import Robot, Status
from ..calls.text import counted
from . import sketch
from .shapes import joints_to_tip

if TYPE_CHECKING:
    from .._core import Obstacle, Trajectory

_MOST_NUMBERS = 12  # entries of an array that is written out
_MOST_ROWS = 12  # rows of a table
_SAMPLES = 120  # samples of a motion
_SNAPSHOTS = 4  # snapshots of a moving arm
_ANGLE = 1.0  # rad: drawn angle of a joint without limits
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
    """Returns name, chain, a drawing and a table of the joints."""
    ends = f"{robot.link_names[0]} to {robot.link_names[-1]}"
    columns = (robot.joint_names, robot.joint_kinds, robot.lower, robot.upper, robot.velocity_limit)
    rows = [[shown(value) for value in row] for row in zip(*columns, strict=True)]
    head = ("joint", "kind", "lower [rad, m]", "upper [rad, m]", "velocity limit [rad/s, m/s]")
    held = "; ".join(f"{name} at {shown(value)}" for name, value in robot.held_joints.items())
    chain = f"{robot.dof} joints, {ends}" + (f"; held: {held}" if held else "")
    return f"<b>{escape(robot.name)}</b>: {escape(chain)}<div>{_drawn(robot)}</div>{table(rows, head)}"


def _drawn(robot: Robot) -> str:
    """Draws a robot in the middle of its limits; joints without limits, and straight arms, are bent a little."""
    limited = np.isfinite(robot.lower) & np.isfinite(robot.upper)
    middle = np.where(limited, (np.where(limited, robot.lower, 0) + np.where(limited, robot.upper, 0)) / 2, _ANGLE)
    return sketch.views([joints_to_tip(robot, np.clip(middle + _ANGLE / 3, robot.lower, robot.upper))])


def result(result: Any) -> str:
    """Returns kind, status, message, a drawing of a motion and the main numbers of a result."""
    rows = [
        [f"{name} [{unit}]" if unit else name, shown(getattr(result, name))]
        for name, unit in _SHOWN.items()
        if _is_known(getattr(result, name, None))
    ]
    kind, message = type(result).__name__, str(result.message)
    # The statuses of a batch are an array, which its message sums up.
    state = f" {result.status.name}" if isinstance(result.status, Status) else ""
    return f"<b>{kind}{state}</b>: {escape(message)}{_moved(result)}{table(rows)}"


def _moved(result: Any) -> str:
    """Draws the motion of a result with a robot among its obstacles, and its joints over time."""
    robot, motion = getattr(result, "robot", None), getattr(result, "trajectory", None)
    if robot is None or motion is None:
        return ""
    time = np.linspace(0.0, motion.duration, _SAMPLES)
    q = motion.at(time)[0]
    arms = [joints_to_tip(robot, q[i]) for i in np.linspace(0, _SAMPLES - 1, _SNAPSHOTS).astype(int)]
    tips = robot.fk(q).reshape(_SAMPLES, -1, 4, 4)[:, :, :3, 3]
    views = sketch.views(arms, [tips[:, i] for i in range(tips.shape[1])], getattr(result, "obstacles", []))
    return f"<div>{views}{_joints(time, q)}</div>"


def _joints(time: Any, q: Any) -> str:
    return sketch.curves(time, q, f"joints [rad, m] over {time[-1]:.6g} s")


def trajectory(motion: Trajectory) -> str:
    """Returns the duration, the joints over time, and a table of the extremes of each joint."""
    time = np.linspace(0.0, motion.duration, _SAMPLES)
    q = motion.at(time)[0]
    reached = (q.min(axis=0), q.max(axis=0), motion.max_velocity(), motion.max_acceleration())
    rows = [[name, *map(shown, map(float, row))] for name, *row in zip(motion.joint_names, *reached, strict=True)]
    head = ("joint", "least [rad, m]", "largest [rad, m]", "velocity [rad/s, m/s]", "acceleration [rad/s², m/s²]")
    text = f"{counted(len(rows), 'joint')}, {motion.duration:.6g} s, {counted(len(motion.time), 'knot')}"
    return f"<b>Trajectory</b>: {text}<div>{_joints(time, q)}</div>{table(rows, head)}"


def scene(obstacles: tuple[Obstacle, ...]) -> str:
    """Returns the number of obstacles, drawings of them, and a table of the first."""
    title = f"<b>Scene</b>: {counted(len(obstacles), 'obstacle')}"
    if not obstacles:
        return title
    rows = [[str(i), type(shape).__name__, f"{shape!r:.100}"] for i, shape in enumerate(obstacles[:_MOST_ROWS])]
    if len(obstacles) > _MOST_ROWS:
        rows.append(["…", "", f"{len(obstacles) - _MOST_ROWS} more"])
    views = sketch.views([], [], obstacles)
    return f"{title}<div>{views}</div>{table(rows, ('', 'shape', 'as made'))}"


def reachability_map(map: Any) -> str:  # noqa: A002
    """Returns the contents of a map, and the fraction of orientations reached, seen from the side and from above."""
    reached = map.index / max(float(map.index.max()), 1e-12)
    side, above = reached.max(axis=1).T, reached.max(axis=2).T
    drawn = sketch.heat(side, "from the side (x, z)") + sketch.heat(above, "from above (x, y)")
    rows = [
        ["voxels", f"{' × '.join(str(number) for number in map.shape)} of {map.voxel:g} m"],
        ["voxels reached", str(int(np.count_nonzero(map.index)))],
        ["orientations of each", str(map.orientations)],
        ["largest share of them reached", f"{100 * float(map.index.max()):.3g} %"],
        ["share of all poses", f"{100 * float(map.index.mean()):.3g} %"],
    ]
    return f"<b>ReachabilityMap</b> of {escape(map.robot.name)}<div>{drawn}</div>{table(rows)}"


def _is_known(value: Any) -> bool:
    """Whether there is a value: a free orientation has no error, a plan without obstacles no clearance."""
    return value is not None and not (isinstance(value, float) and np.isnan(value))


def shown(value: Any) -> str:
    """Returns a value with six digits, an array with all its entries if they are few."""
    if isinstance(value, np.ndarray):
        if value.size > _MOST_NUMBERS:
            return f"array of shape {value.shape}"
        return ", ".join(f"{number:.6g}" for number in value.ravel())
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def table(rows: Iterable[list[str]], head: Iterable[str] = ()) -> str:
    """Returns a table of rows under titles."""
    titles = "".join(f"<th>{escape(title)}</th>" for title in head)
    cells = ("".join(f"<td>{escape(entry)}</td>" for entry in row) for row in rows)
    body = "".join(f"<tr>{row}</tr>" for row in ([titles] if titles else []) + list(cells))
    return f"<table>{body}</table>"
