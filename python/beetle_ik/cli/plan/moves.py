"""`beetle-ik plan moves`: plans a program of moves from a file."""

import json
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from ... import InvalidInputError, Scene, plan_moves, pose, tasks
from ...moves import Arc, Joints, Line, Move, Wait
from ...tasks import Task
from ..options import (
    Acceleration,
    AsJson,
    BaseLink,
    Jerk,
    LinkRadius,
    Margin,
    Payload,
    RobotName,
    SceneFile,
    Seed,
    TipLinks,
    TipSpeed,
    TorqueLimits,
    Trusted,
    UrdfFile,
    Velocity,
    load_robot,
    loaded,
    numbers,
)
from .planned import Animated, Budget, Out, options, report

_POSE = 6
_KEYS: dict[str, tuple[set[str], set[str]]] = {
    "joints": ({"to"}, {"blend", "tip", "name"}),
    "line": ({"to"}, {"speed", "blend", "tip", "name"}),
    "arc": ({"via", "to"}, {"speed", "blend", "angle", "tip", "name"}),
    "wait": ({"seconds"}, {"name"}),
}
_MOVES: dict[str, Callable[..., Move]] = {"joints": Joints, "line": Line, "arc": Arc, "wait": Wait}
_TASK_KEYS = {
    "pose": {"weights", "tolerance", "tool"},
    "position": {"weights", "tolerance", "tool"},
    "pointing": {"axis", "weights", "tolerance", "tool"},
}
_TASKS: dict[str, Callable[..., Task]] = {
    "pose": tasks.Pose,
    "position": tasks.Position,
    "pointing": tasks.Pointing,
}


@dataclass(frozen=True)
class Program:
    """Moves, and the tasks at their poses."""

    moves: list[Move]
    task: Task | dict[str, Task] | None = None


def moves(
    program: Annotated[
        Path,
        typer.Argument(
            help='A JSON file: a list of moves, such as {"move": "line", "to": [0.4, 0, 0.2, 0, 0, 0], "speed": 0.05}, '
            'or {"moves": [...], "task": {"kind": "pointing", "axis": [0, 0, 1]}}.'
        ),
    ],
    robot: RobotName = None,
    *,
    start_q: Annotated[str, typer.Option(metavar="Q1,Q2,...", help="Joint positions at the start.")],
    scene: SceneFile = None,
    margin: Margin = None,
    link_radius: LinkRadius = None,
    velocity: Velocity = None,
    acceleration: Acceleration = None,
    jerk: Jerk = None,
    tip_speed: TipSpeed = None,
    payload: Payload = None,
    torque_limits: TorqueLimits = False,
    max_evaluations: Budget = None,
    seed: Seed = 0,
    out: Out = None,
    animation: Animated = False,
    urdf: UrdfFile = None,
    tip: TipLinks = None,
    base: BaseLink = None,
    trusted: Trusted = False,
    as_json: AsJson = False,
) -> None:
    """Plan a program of joint moves, lines, arcs and waits.

    Poses are six numbers, x, y, z (m), roll, pitch, yaw (rad); "to" of a joint move is a pose, or {"q": [...]}, joint
    positions; "via" of an arc is a point. A task says what of the poses counts: its kind is pose, position or pointing,
    with "weights", "tolerance", "tool" (six numbers) and "axis" as for `beetle_ik.tasks`. With several tips each move
    to a pose names its "tip", and there may be a task for each: {"left": {"kind": "position"}}.
    """
    arm, torque = loaded(load_robot(robot, urdf, base, tip, link_radius, trusted=trusted), payload, torque_limits)
    read = read_program(program)
    chosen = options(velocity, acceleration, jerk, tip_speed, torque, max_evaluations)
    obstacles = None if scene is None else Scene.load(scene)
    report(
        lambda: plan_moves(
            arm,
            read.moves,
            start_q=numbers("--start-q", start_q),
            task=read.task,
            obstacles=obstacles,
            margin=margin,
            seed=seed,
            progress=not as_json,
            **chosen,
        ),
        "moves",
        seed,
        out,
        animation,
        as_json,
    )


def read_program(file: Path) -> Program:
    """Returns the program of a JSON file; errors name the move, counted from 0, and the key."""
    try:
        given = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, RecursionError, ValueError) as error:  # not UTF-8, no JSON, nested too deep, numbers too long
        raise InvalidInputError(f"{file}: not a readable JSON file: {error}") from error
    task = None
    if isinstance(given, dict):
        if "moves" not in given:
            raise InvalidInputError(f"{file}: a program needs 'moves', a list; it may have a 'task'")
        _allow(f"{file}", "program", given, {"moves", "task"})
        task = _tasks(f"{file}: task", given["task"]) if "task" in given else None
        given = given["moves"]
    if not isinstance(given, list):
        raise InvalidInputError(f"{file}: expected a list of moves, got {type(given).__name__}")
    return Program([_move(f"{file}: move {i}", each) for i, each in enumerate(given)], task)


def _tasks(where: str, given: Any) -> Task | dict[str, Task]:
    """Returns the task of an object that has a kind, or the tasks of one that has an object for each of some tips."""
    if isinstance(given, dict) and given and all(isinstance(each, dict) for each in given.values()):
        return {tip: _task(f"{where} of '{tip}'", each) for tip, each in given.items()}
    return _task(where, given)


def _task(where: str, given: Any) -> Task:
    kind, rest = _taken(where, given, "kind", _TASKS)
    _allow(where, f"{kind} task", rest, _TASK_KEYS[kind])
    read: dict[str, np.ndarray] = {key: _numbers(where, key, value, None) for key, value in rest.items()}
    if "tool" in read:
        read["tool"] = _pose(where, "tool", rest["tool"])
    try:
        return _TASKS[kind](**read)
    except InvalidInputError as error:
        raise type(error)(f"{where}: {error}") from error


def _taken(where: str, given: Any, key: str, known: Collection[str]) -> tuple[str, dict[str, Any]]:
    """Returns which of the known kinds an object names by `key`, and the rest of the object."""
    if not isinstance(given, dict):
        raise InvalidInputError(f"{where}: expected an object with the key '{key}', got {given!r}")
    rest = dict(given)
    kind = rest.pop(key, None)
    if not isinstance(kind, str) or kind not in known:
        raise InvalidInputError(f"{where}: '{key}' must be one of {', '.join(known)}, got {kind!r}")
    return kind, rest


def _allow(where: str, what: str, given: dict[str, Any], allowed: set[str]) -> None:
    for key in sorted(given.keys() - allowed):
        raise InvalidInputError(f"{where}: unknown key '{key}'; a {what} takes {', '.join(sorted(allowed))}")


def _move(where: str, given: Any) -> Move:
    kind, rest = _taken(where, given, "move", _KEYS)
    needed, allowed = _KEYS[kind]
    for key in sorted(needed - rest.keys()):
        raise InvalidInputError(f"{where}: a {kind} needs '{key}'")
    _allow(where, kind, rest, needed | allowed)
    for key, value in rest.items():
        if key in ("name", "tip") and not isinstance(value, str):
            raise InvalidInputError(f"{where}: '{key}' must be a text, got {value!r}")
        if key in ("speed", "blend", "angle", "seconds"):
            _number(where, key, value)
    if "via" in rest:
        rest["via"] = _numbers(where, "via", rest["via"], 3)
    if "to" in rest:
        to = rest.pop("to")
        rest |= {"q_or_pose": _goal(where, to)} if kind == "joints" else {"pose": _pose(where, "to", to)}
    try:
        return _MOVES[kind](**rest)
    except InvalidInputError as error:
        raise type(error)(f"{where}: {error}") from error


def _number(where: str, key: str, value: Any) -> None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InvalidInputError(f"{where}: '{key}' must be a number, got {value!r}")


def _numbers(where: str, key: str, value: Any, count: int | None) -> np.ndarray:
    wanted = "numbers" if count is None else f"{count} numbers"
    if not isinstance(value, list) or (count is not None and len(value) != count):
        raise InvalidInputError(f"{where}: '{key}' must be a list of {wanted}, got {value!r}")
    for each in value:
        _number(where, key, each)
    return np.array(value, dtype=float)


def _pose(where: str, key: str, value: Any) -> np.ndarray:
    place = _numbers(where, key, value, _POSE)
    return pose(place[:3], rpy=place[3:])


def _goal(where: str, value: Any) -> np.ndarray:
    if not isinstance(value, dict):
        return _pose(where, "to", value)
    if list(value) != ["q"]:
        raise InvalidInputError(f"{where}: 'to' must be six numbers or an object with the key 'q', got {value!r}")
    return _numbers(where, "q", value["q"], None)
