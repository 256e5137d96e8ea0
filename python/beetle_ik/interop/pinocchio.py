"""Robots from and to Pinocchio models."""

from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import InvalidInputError, Robot, UnknownNameError, pose
from ..calls.arguments import require
from ..calls.text import listed
from ..installed.needs import library
from .chain import ChainReader, Kind, Link, Motion, only_leaf, parts

if TYPE_CHECKING:
    import pinocchio as pin


def from_pinocchio(model: "pin.Model", *, base: str | None = None, tip: str | None = None) -> Robot:
    """Makes a robot from the chain between two frames of a Pinocchio model.

    Args:
        model: a `pinocchio.Model` of revolute and prismatic joints about any axis; unbounded ones become continuous.
        base: frame at the start of the chain, the reference frame; None: "universe".
        tip: frame at the end of the chain; None: the only leaf body.

    Position and velocity limits are those of the model; masses and geometry are dropped.

    Raises:
        UnknownNameError: no frame of that name; the message lists them.
        InvalidInputError: not a model, several leaves and no `tip`, a tip that is not a descendant of the base, other
            joint types.
    """
    pin = library("pinocchio", "pin", "a Pinocchio model")
    require("model", model, pin.Model)
    names = [frame.name for frame in model.frames]
    start = model.frames[_frame(names, "universe" if base is None else base)]
    end = model.frames[_frame(names, _leaf(pin, model) if tip is None else tip)]
    joints = _joints_between(model, start, end)
    chain = ChainReader(model.name or "pinocchio", start.name)
    here = start.placement.inverse()
    for joint in joints:
        chain.fixed((here * model.jointPlacements[joint]).homogeneous)
        _add_joint(pin, chain, model, joint)
        chain.link(_body(pin, model, joint, {start.name, end.name}))
        here = pin.SE3.Identity()
    chain.fixed((here * end.placement).homogeneous)
    chain.link(end.name)
    return chain.robot()


def to_pinocchio(robot: Robot) -> "pin.Model":
    """Makes a Pinocchio model: joints and limits, a BODY frame for each link, and a frame "tool" for the tip.

    The configuration vectors are equal: a continuous joint becomes a revolute joint without limits. The model has no
    masses.

    Raises:
        InvalidInputError: mimic joints.
    """
    pin = library("pinocchio", "pin", "a Pinocchio model")
    base, elements, tool = parts(robot, "Pinocchio")
    model = pin.Model()
    model.name = robot.name
    joint, frame, placement = 0, 0, pin.SE3(base)
    for element in elements:
        if isinstance(element, Link):
            frame = model.addFrame(pin.Frame(element.name, joint, frame, placement, pin.FrameType.BODY))
        elif isinstance(element, Motion):
            kind = pin.JointModelRevoluteUnaligned if element.turns else pin.JointModelPrismaticUnaligned
            moved = element.offset * element.axis
            offset = pose(np.zeros(3), rotvec=moved) if element.turns else pose(moved)
            limits = (robot.velocity_limit, robot.lower, robot.upper)
            joint = model.addJoint(
                joint,
                kind(element.axis),
                placement * pin.SE3(offset),
                robot.joint_names[element.joint],
                np.array([np.inf]),
                *(np.array([values[element.joint]]) for values in limits),
            )
            frame, placement = model.addJointFrame(joint, frame), pin.SE3.Identity()
        else:
            placement = placement * pin.SE3(element)
    model.addFrame(pin.Frame("tool", joint, frame, placement * pin.SE3(tool), pin.FrameType.OP_FRAME))
    return model


def _frame(names: list[str], name: str) -> int:
    if name not in names:
        raise UnknownNameError(f"no frame '{name}' in the Pinocchio model; frames: {listed(names)}")
    return names.index(name)


def _leaf(pin: Any, model: Any) -> str:
    """Returns the only leaf body."""
    followed = {frame.parentFrame for frame in model.frames if frame.type != pin.FrameType.OP_FRAME}
    bodies = [
        frame.name
        for i, frame in enumerate(model.frames)
        if frame.type == pin.FrameType.BODY and i not in followed and frame.parentJoint not in set(model.parents)
    ]
    return only_leaf("Pinocchio", "bodies", bodies)


def _joints_between(model: Any, start: Any, end: Any) -> list[int]:
    """Returns the joints between `start` and `end`, in order."""
    joints: list[int] = []
    joint = end.parentJoint
    while joint != start.parentJoint:
        if joint == 0:
            raise InvalidInputError(
                f"frame '{end.name}' of the Pinocchio model is not a descendant of frame '{start.name}'"
            )
        joints.insert(0, joint)
        joint = model.parents[joint]
    return joints


def _add_joint(pin: Any, chain: ChainReader, model: Any, joint: int) -> None:
    described, name = model.joints[joint], model.names[joint]
    wrong = f"joint '{name}' of the Pinocchio model is a {described.shortname()}, but must be revolute or prismatic"
    if described.nv != 1 or "Mimic" in described.shortname():
        raise InvalidInputError(wrong)
    data = described.createData()
    neutral = pin.neutral(model)
    described.calc(data, neutral)
    linear, angular = np.split(np.asarray(data.S, dtype=float).reshape(6), 2)
    if np.any(linear) and np.any(angular):
        raise InvalidInputError(wrong)
    turns, bounded = bool(np.any(angular)), described.nq == 1
    kind: Kind = "prismatic" if not turns else "revolute" if bounded else "continuous"
    lower, upper = model.lowerPositionLimit, model.upperPositionLimit
    chain.moving(
        name,
        kind,
        angular if turns else linear,
        lower=lower[described.idx_q] if bounded else -np.inf,
        upper=upper[described.idx_q] if bounded else np.inf,
        velocity=model.velocityLimit[described.idx_v],
    )


def _body(pin: Any, model: Any, joint: int, taken: set[str]) -> str:
    """Returns the name of the link that a joint moves: the first body in its frame, else the joint's name."""
    for frame in model.frames:
        on_joint = frame.type == pin.FrameType.BODY and frame.parentJoint == joint and frame.name not in taken
        if on_joint and frame.placement.isIdentity(0.0):
            return str(frame.name)
    return f"link of {model.names[joint]}"
