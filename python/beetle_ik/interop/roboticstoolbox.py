"""Robots from and to the Robotics Toolbox for Python."""

from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import InvalidInputError, Robot, pose
from ..installed.needs import library
from .chain import ChainReader, Kind, Matrix, Motion, parts

if TYPE_CHECKING:
    import roboticstoolbox as rtb

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def from_roboticstoolbox(robot: "rtb.Robot | rtb.DHRobot | rtb.ETS", *, tip: str | None = None) -> Robot:
    """Makes a robot from a `DHRobot`, a `Robot` (`ERobot`) or an `ETS` of the Robotics Toolbox.

    Args:
        robot: a robot of revolute and prismatic joints; its base and tool are kept.
        tip: name of the end link of a `Robot` with several, without its tool; None: the default of the toolbox.

    A joint without limits in the toolbox has none here. The toolbox has no velocity limits.

    Raises:
        InvalidInputError: another type, or a `tip` for a type without named links.
    """
    transforms, base, tool = _transforms(robot, tip)
    chain = ChainReader(getattr(robot, "name", "") or "roboticstoolbox", "base")
    count = 0
    for transform in transforms:
        if transform.isjoint:
            count += 1
            _add_joint(chain, transform, count)
            chain.link(f"link_{count}")
        else:
            chain.fixed(transform.A())
    chain.link("tip")
    return chain.robot().with_base(base).with_tool(tool)


def to_roboticstoolbox(robot: Robot) -> "rtb.Robot":
    """Makes a `Robot` of the Robotics Toolbox from elementary transforms, with position limits, base and tool.

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


def _transforms(robot: Any, tip: str | None) -> tuple[Any, Matrix, Matrix]:
    """Returns the elementary transforms, and base and tool if the transforms do not include them."""
    rtb = library("roboticstoolbox", "roboticstoolbox-python", "a model of the Robotics Toolbox")
    nowhere = np.eye(4)
    if not isinstance(robot, rtb.DHRobot) and isinstance(robot, rtb.Robot):
        return robot.ets(end=tip), robot.base.A, robot.tool.A if tip is None else nowhere
    if tip is not None:
        raise InvalidInputError(
            f"tip: only a Robot of the Robotics Toolbox has named links, got {type(robot).__name__}"
        )
    if isinstance(robot, rtb.DHRobot):
        return robot.ets(), nowhere, nowhere
    if isinstance(robot, rtb.ETS):
        return robot, nowhere, nowhere
    raise InvalidInputError(f"expected a robot or an ETS of the Robotics Toolbox, got {robot!r:.60}")


def _add_joint(chain: ChainReader, transform: Any, number: int) -> None:
    kind: str = transform.kind if hasattr(transform, "kind") else transform.axis  # its name before 1.4
    axis = np.array(_AXES[kind[1]]) * (-1.0 if transform.isflip else 1.0)
    limits = transform.qlim
    lower, upper = (-np.inf, np.inf) if limits is None else limits
    joint: Kind = "prismatic" if kind[0] == "t" else "revolute"
    chain.moving(f"joint_{number}", joint, axis, lower=lower, upper=upper)


def _turning_z_onto(axis: Matrix) -> Matrix:
    """Returns the rotation (4, 4) of the z axis onto a unit vector: half a turn about their bisector."""
    between = axis + np.array([0.0, 0.0, 1.0])
    length = np.linalg.norm(between)
    half_way = between / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])
    return pose(np.zeros(3), rotvec=np.pi * half_way)
