"""Models of the Robotics Toolbox for Python."""

from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import InvalidInputError, Robot, pose
from .chain import ChainReader, Kind, Matrix, Motion, parts
from .needs import library

if TYPE_CHECKING:
    import roboticstoolbox as rtb

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def from_roboticstoolbox(robot: "rtb.Robot | rtb.DHRobot | rtb.ETS", *, tip: str | None = None) -> Robot:
    """The chain of a robot of the Robotics Toolbox: a `DHRobot`, a `Robot` (`ERobot`) or an `ETS`.

    Args:
        robot: revolute and prismatic joints; base and tool of a `DHRobot` go along.
        tip: name of the link at the end, for robots with several; None: the toolbox's own choice.

    A joint without limits in the toolbox has none here. It knows no velocity limits.

    Raises:
        InvalidInputError: an object without elementary transforms.
    """
    if hasattr(robot, "ets"):
        transforms = robot.ets() if tip is None else robot.ets(end=tip)
    elif tip is None and hasattr(robot, "joints") and hasattr(robot, "qlim"):
        transforms = robot
    else:
        raise InvalidInputError(f"expected a robot or an ETS of the Robotics Toolbox, got {robot!r}")
    chain = ChainReader(getattr(robot, "name", "") or "roboticstoolbox", "base")
    # A DHRobot's transforms are those of its links alone.
    with_ends = hasattr(robot, "links") and type(robot).__name__ not in ("ERobot", "Robot")
    if with_ends and hasattr(robot, "base"):
        chain.fixed(robot.base.A)
    count = 0
    for transform in transforms:
        if transform.isjoint:
            _add_joint(chain, transform, count)
            count += 1
            chain.link(f"link_{count}")
        else:
            chain.fixed(transform.A())
    chain.link("tip")
    made = chain.robot()
    return made.with_tool(robot.tool.A) if with_ends and hasattr(robot, "tool") else made


def to_roboticstoolbox(robot: Robot) -> "rtb.Robot":
    """A `Robot` of the Robotics Toolbox, of elementary transforms: joints and position limits, base and tool folded in.

    Raises:
        InvalidInputError: mimic joints.
    """
    rtb = library("roboticstoolbox", "roboticstoolbox-python", "a model of the Robotics Toolbox")
    base, elements, tool = parts(robot, "the Robotics Toolbox")
    transforms = rtb.ETS(rtb.ET.SE3(base))
    for element in elements:
        if isinstance(element, Motion):
            turn = _turning_z_onto(element.axis)
            limits = [robot.lower[element.joint], robot.upper[element.joint]]
            qlim = limits if np.all(np.isfinite(limits)) else None
            joint = (rtb.ET.Rz if element.turns else rtb.ET.tz)(jindex=element.joint, qlim=qlim)
            offset = (rtb.ET.Rz if element.turns else rtb.ET.tz)(element.offset)
            transforms = transforms * rtb.ET.SE3(turn) * offset * joint * rtb.ET.SE3(turn.T)
        elif isinstance(element, np.ndarray):
            transforms = transforms * rtb.ET.SE3(element)
    return rtb.Robot(transforms * rtb.ET.SE3(tool), name=robot.name)


def _add_joint(chain: ChainReader, transform: Any, index: int) -> None:
    kind: str = transform.kind if hasattr(transform, "kind") else transform.axis  # before 1.4 it was called so
    axis = np.array(_AXES[kind[1]]) * (-1.0 if transform.isflip else 1.0)
    limits = transform.qlim
    lower, upper = (-np.inf, np.inf) if limits is None else limits
    joint: Kind = "prismatic" if kind[0] == "t" else "revolute"
    chain.moving(f"joint_{index + 1}", joint, axis, lower=lower, upper=upper)


def _turning_z_onto(axis: Matrix) -> Matrix:
    """A rotation (4, 4) of the z axis onto a unit vector: half a turn about what lies between them."""
    between = axis + np.array([0.0, 0.0, 1.0])
    length = np.linalg.norm(between)
    half_way = between / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])
    return pose(np.zeros(3), rotvec=np.pi * half_way)
