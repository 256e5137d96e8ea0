"""The call that reads G-code."""

import math
import os
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..._core import InvalidInputError, pose
from ...calls.wording import worded_call
from ..checks import MOST_POSES, Array, direction, number, point
from .lines import lines, refused
from .machine import Machine, Part
from .program import GcodeMove, GcodeProgram

_PARALLEL = 1e-6  # sine


@worded_call
def from_gcode(
    file: str | os.PathLike[str],
    *,
    frame: ArrayLike | None = None,
    axis: ArrayLike = (0.0, 0.0, -1.0),
    start: ArrayLike | None = (0.0, 0.0, 0.0),
    feed: float | None = None,
    tolerance: float = 1e-5,
    rotary: bool = False,
) -> GcodeProgram:
    r"""Reads a program of a machine tool or printer: lines and arcs of the tip, with their speeds.

    It reads G0 to G3, arcs by centre (I, J, K) or radius (R) in the planes of G17 to G19, also as helices, inches and
    millimetres (G20, G21), absolute and relative positions (G90, G91; centres G90.1, G91.1), feeds per minute (F), and
    lengths of filament (E; M82, M83, G92 E). Millimetres and absolute positions hold at first. After homing (G28) the
    position is not known; the path goes on, by a rapid move, where X, Y and Z have been given again. Commands that move
    nothing are listed in `ignored`. All else is refused, by its line: canned cycles, splines, tool compensation, new
    origins, parameters and subprograms.

    Args:
        file: a file; or the program itself, a text of at least two lines.
        frame: pose (4, 4) of the program's origin in the frame of the robot's base; None: they agree.
        axis: direction (3,) of the tool's z axis, in the frame of the program; the default points down. The tool's x
            axis is as near to the program's X as it can be, or to Y where `axis` is along X.
        start: position (3,) (m) of the tip before the first line, in the frame of the program, where the path begins;
            None: not known, and the path begins where X, Y and Z have all been given.
        feed: speed before the first F (m/s); None: a move without it is refused.
        tolerance: largest distance of the steps of an arc from it (m).
        rotary: whether to read A, B and C, rotations (deg) of the tool relative to the part about the program's X, Y
            and Z, applied in this order. X, Y and Z are then the tip in the frame of the part, as under tool centre
            point control; programs for a table that turns without it have another meaning.

    Returns:
        A `GcodeProgram`.

    Raises:
        InvalidInputError: a file that cannot be read, a program without moves, or a word that cannot be followed; the
            message names the line.

    For example:

        >>> text = "G0 X0 Y0 Z0\nG1 X10 F600\nG3 X10 Y20 J10"
        >>> program = bik.paths.from_gcode(text, frame=bik.pose([0.5, 0.0, 0.2]))
        >>> [move.kind for move in program.moves], round(program.length, 4), program.feeds[0].round(4).item()
        (['line', 'arc'], 0.0414, 0.01)
    """
    name, text = _text(file)
    if not isinstance(rotary, bool):
        raise InvalidInputError(f"rotary must be True or False, got {rotary!r:.60}")
    machine = Machine(
        None if start is None else point("start", start),
        None if feed is None else number("feed", feed, above=True),
        number("tolerance", tolerance, above=True),
        rotary=rotary,
    )
    base, tool = np.eye(4) if frame is None else _frame(frame), _tool(direction("axis", axis))
    try:
        return _program(machine, text, base, tool)
    except InvalidInputError as error:
        raise InvalidInputError(f"{name}{error}") from None


def _text(file: object) -> tuple[str, str]:
    """Returns what messages call the program, and its text."""
    if isinstance(file, str) and "\n" in file:
        return "", file
    if not isinstance(file, str | os.PathLike):
        raise InvalidInputError(f"file must be a file, or the text of a program, got {file!r:.60}")
    try:
        return f"{os.fspath(file)}: ", Path(file).read_text(encoding="utf-8-sig", errors="replace")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        hint = "; a program given as text has at least two lines" if isinstance(file, str) else ""
        raise InvalidInputError(f"cannot read file '{os.fspath(file)}': {reason}{hint}") from None


def _frame(frame: ArrayLike) -> Array:
    try:
        return np.asarray(pose(matrix=frame))
    except InvalidInputError as error:
        raise InvalidInputError(f"frame: {error}") from None


def _tool(axis: Array) -> Array:
    """Returns the rotation (3, 3) of a tool whose z axis is `axis`."""
    x = np.eye(3)[0] - axis[0] * axis
    if np.linalg.norm(x) < _PARALLEL:
        x = np.eye(3)[1] - axis[1] * axis
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(axis, x), axis], axis=1) + 0.0


def _program(machine: Machine, text: str, base: Array, tool: Array) -> GcodeProgram:
    parts, began, count = list[Part](), machine.place, 0
    for line in lines(text):
        began = began if parts else machine.place
        part = machine.run(line)
        if part is not None:
            parts.append(part)
            count += len(part.places)
        if count > MOST_POSES:
            raise refused(
                line.number, f"more than {MOST_POSES:,} poses: give a larger tolerance=, or a part of the program"
            )
        if machine.ended:
            break
    if math.isnan(sum(began)) and parts:  # the first known place is where the path begins
        began, parts = parts[0].places[-1], parts[1:]
    if not parts:
        raise InvalidInputError("no move between two known positions: the program draws no path")
    counts = np.array([len(part.places) for part in parts])
    places = np.array([began, *(place for part in parts for place in part.places)])
    points, angles = places[:, :3], places[:, 3:]
    lasts = np.cumsum(counts)
    moves = [
        GcodeMove(part.kind, int(last - count), int(last), part.feed, part.line)
        for part, last, count in zip(parts, lasts, counts, strict=True)
    ]
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return GcodeProgram(
        poses=_poses(points, angles, base, tool),
        moves=moves,
        rapid=np.repeat([part.kind == "rapid" for part in parts], counts),
        feeds=np.repeat([part.feed for part in parts], counts),
        extrusion=_shared(np.array([part.extruded for part in parts]), counts, lengths),
        ignored=machine.told,
    )


def _shared(totals: Array, counts: NDArray[np.int64], lengths: Array) -> Array:
    """Returns the part of each step in what its move extrudes, by length."""
    of_move = np.repeat(np.arange(len(counts)), counts)
    whole = np.bincount(of_move, lengths)[of_move]
    return np.asarray(totals[of_move] * np.divide(lengths, whole, out=np.zeros_like(lengths), where=whole > 0.0))


def _poses(points: Array, angles: Array, base: Array, tool: Array) -> Array:
    """Returns poses (m, 4, 4): the tool turned about the program's X, then Y, then Z, at points of the program."""
    turned = np.eye(3)
    for axis in range(3):
        turned = _about(axis, angles[:, axis]) @ turned
    poses = np.tile(np.eye(4), (len(points), 1, 1))
    poses[:, :3, :3], poses[:, :3, 3] = turned @ tool, points
    return np.asarray(base @ poses)


def _about(axis: int, angles: Array) -> Array:
    """Returns rotations (m, 3, 3) about an axis of the frame."""
    one, other = (axis + 1) % 3, (axis + 2) % 3
    turns = np.tile(np.eye(3), (len(angles), 1, 1))
    turns[:, one, one] = turns[:, other, other] = np.cos(angles)
    turns[:, other, one] = np.sin(angles)
    turns[:, one, other] = -turns[:, other, one]
    return turns
