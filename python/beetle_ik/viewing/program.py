"""The state of a viewer as a program in Python."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import Obstacle, Robot

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .arm import Arm, Targets

    Array = NDArray[np.float64]

_DECIMALS = 9
_MOST = 60  # numbers of a shape that are written out


def program(arm: Arm, q: Array, targets: Targets, acceleration: float) -> str:
    """Returns a program that makes robot, configuration, targets and obstacles, and plans from start to targets."""
    arguments = ["robot", "start_q=q", "end=target", f"limits=bik.Limits(acceleration={acceleration:g})"]
    if arm.keeps_clear:
        arguments.insert(3, "obstacles=scene")
    if arm.part == "pointing":
        arguments.insert(3, "task=bik.tasks.Pointing()")
    return "\n".join(
        [
            "import beetle_ik as bik",
            "",
            *_robot(arm.robot),
            f"q = {_numbers(q)}",
            f"target = {_target(targets, position=arm.part == 'position')}",
            *_scene(arm.obstacles),
            "",
            f"plan = bik.plan_point_to_point({', '.join(arguments)})",
            "print(plan.message)",
            "",
        ]
    )


def _robot(robot: Robot) -> list[str]:
    """Returns the lines that make a built-in robot with capsules; a placeholder for any other robot."""
    if robot.name in Robot.names():
        plain = Robot.named(robot.name)
        as_made = robot.dof == plain.dof and np.array_equal(
            robot.fk(np.zeros(robot.dof)), plain.fk(np.zeros(plain.dof))
        )
        if as_made and len(robot.bodies) == len(robot.capsules):
            made = f'robot = bik.Robot.named("{robot.name}")'
            radii = {radius for *_, radius in robot.capsules}
            if len(radii) == 1 and _same(plain.with_capsules(radius=min(radii)).capsules, robot.capsules):
                return [f"{made}.with_capsules(radius={min(radii):.9g})"]
            capsules = [f"    ({link!r}, {_numbers(a)}, {_numbers(b)}, {r:.9g})," for link, a, b, r in robot.capsules]
            return [f"{made}.with_capsules([", *capsules, "])"]
    return [f"robot = ...  # as you made {robot.name!r}, or viewer.robot"]


def _same(one: list[Any], other: list[Any]) -> bool:
    flat = [[(link, *a.tolist(), *b.tolist(), radius) for link, a, b, radius in each] for each in (one, other)]
    return flat[0] == flat[1]


def _target(targets: Targets, *, position: bool) -> str:
    from viser.transforms import SO3

    def written(pose: Array) -> str:
        place = _numbers(pose[:3, 3])
        return place if position else f"bik.pose({place}, wxyz={_numbers(SO3.from_matrix(pose[:3, :3]).wxyz)})"

    if len(targets) == 1:
        return written(next(iter(targets.values())))
    return "{" + ", ".join(f"{tip!r}: {written(pose)}" for tip, pose in targets.items()) + "}"


def _scene(obstacles: list[Obstacle]) -> list[str]:
    if not obstacles:
        return ["scene = bik.Scene()"]
    written = [_obstacle(each) for each in obstacles]
    if None in written:
        return ['scene = bik.Scene.load("scene.json")  # "Save scene" writes it']
    return ["scene = bik.Scene([", *(f"    {each}," for each in written), "])"]


def _obstacle(shape: Obstacle) -> str | None:
    """Returns the call that makes a shape; None if it is long."""
    kind = type(shape)
    given = {name: np.asarray(getattr(shape, name)) for name in inspect.signature(kind).parameters if name != "touch"}
    if sum(value.size for value in given.values()) > _MOST:
        return None
    if "rotation" in given and np.array_equal(given["rotation"], np.eye(3)):
        del given["rotation"]
    arguments = [f"{name}={_numbers(value)}" for name, value in given.items()]
    arguments += [f"touch={list(shape.touch)!r}"] if shape.touch else []
    return f"bik.obstacles.{kind.__name__}({', '.join(arguments)})"


def _numbers(values: Any) -> str:
    """Formats numbers in Python syntax, without rounding noise."""
    array = np.asarray(values)
    return repr((array.astype(float).round(_DECIMALS) + 0.0 if array.dtype.kind == "f" else array).tolist())
