"""Export of a robot of this library as a URDF file for others, with capsules and obstacles on request."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pinocchio as pin

import beetle_ik as bik

from .chain import some_mass
from .clear_streams import Thing, pose_of_capsule


def urdf(robot: bik.Robot, velocity: float, things: list[Thing] | None = None, *, for_mujoco: bool = False) -> str:
    """Returns the arm as URDF text, with a link "tip"; with `things`, also the bodies of all, as links of their own.

    Joints turn about axes as they are at zero, all frames of moved links being parallel to the base there.
    """
    zero = np.zeros(robot.dof)
    axes, poses = robot.jacobian(zero)[3:].T, dict(zip(robot.link_names, robot.link_poses(zero), strict=True))
    root, parent, here = ET.Element("robot", name="arm"), robot.link_names[0], np.zeros(3)
    ET.SubElement(root, "link", name=parent)
    for j, name in enumerate(robot.joint_names):
        link = robot.link_names[j + 1]
        place = poses[link]
        xyz = place[:3, 3] - here
        joint = add_joint(root, name, "revolute", parent, f"moved_{j}", xyz)
        ET.SubElement(joint, "axis", xyz=text(axes[j]))
        low, high = repr(float(robot.lower[j])), repr(float(robot.upper[j]))
        ET.SubElement(joint, "limit", lower=low, upper=high, velocity=repr(velocity), effort="0")
        turn = pin.rpy.matrixToRpy(np.ascontiguousarray(place[:3, :3]))
        add_joint(root, f"{link}_fixed", "fixed", f"moved_{j}", link, np.zeros(3), turn)
        parent, here = f"moved_{j}", place[:3, 3]
    tip = robot.fk(zero)
    turn = pin.rpy.matrixToRpy(np.ascontiguousarray(tip[:3, :3]))
    add_joint(root, "tip_fixed", "fixed", parent, "tip", tip[:3, 3] - here, turn)
    if things is not None:
        add_bodies(root, robot, things)
    if for_mujoco:
        ET.SubElement(ET.SubElement(root, "mujoco"), "compiler", fusestatic="false")
    written = ET.tostring(root, encoding="unicode")
    check(written, robot)
    return written


def add_bodies(root: ET.Element, robot: bik.Robot, things: list[Thing]) -> None:
    """Adds the capsules of the arm, and each thing as a link, the sphere on three sliding joints."""
    links = {link.get("name"): link for link in root.iter("link")}
    base = robot.link_names[0]
    for number, (link, a, b, radius) in enumerate(robot.capsules):
        at = pose_of_capsule(a, b)
        collision = ET.SubElement(links[link], "collision", name=f"capsule{number}")
        turn = pin.rpy.matrixToRpy(np.ascontiguousarray(at[:3, :3]))
        ET.SubElement(collision, "origin", xyz=text(at[:3, 3]), rpy=text(turn))
        length = repr(float(np.linalg.norm(b - a)))
        ET.SubElement(ET.SubElement(collision, "geometry"), "cylinder", radius=repr(radius), length=length)
        # Element by which Pinocchio recognises a cylinder as a capsule.
        told = links[link].find("collision_checking")
        told = ET.SubElement(links[link], "collision_checking") if told is None else told
        ET.SubElement(told, "capsule", name=f"capsule{number}")
    for number, thing in enumerate(things):
        name, parent = f"thing{number}", base
        if thing.moves:
            for axis, vector in zip("xyz", np.eye(3), strict=True):
                child = name if axis == "z" else f"{name}_on_{axis}"
                joint = add_joint(root, f"{name}_{axis}", "prismatic", parent, child, np.zeros(3))
                ET.SubElement(joint, "axis", xyz=text(vector))
                ET.SubElement(joint, "limit", lower="-10", upper="10", velocity="10", effort="0")
                parent = child
            shape, sizes = "sphere", {"radius": repr(thing.shape.radius)}
        else:
            turn = pin.rpy.matrixToRpy(np.ascontiguousarray(thing.at[:3, :3]))
            add_joint(root, f"{name}_fixed", "fixed", parent, name, thing.at[:3, 3], turn)
            shape, sizes = "box", {"size": text(2.0 * thing.shape.halfSide)}
        link = next(link for link in root.iter("link") if link.get("name") == name)
        ET.SubElement(ET.SubElement(ET.SubElement(link, "collision"), "geometry"), shape, sizes)


def add_joint(
    root: ET.Element, name: str, kind: str, parent: str, child: str, xyz: np.ndarray, rpy: np.ndarray | None = None
) -> ET.Element:
    """Adds a joint and the link that it carries, with the mass that simulators require."""
    joint = ET.SubElement(root, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    ET.SubElement(joint, "origin", xyz=text(xyz), rpy=text(np.zeros(3) if rpy is None else rpy))
    ET.SubElement(root, "link", name=child).append(some_mass())
    return joint


def check(written: str, robot: bik.Robot) -> None:
    """Rejects a file whose tip is not that of the robot."""
    model = pin.buildModelFromXML(written)
    data, tip = model.createData(), model.getFrameId("tip")
    q = robot.random_configurations(1, seed=0)[0]
    pin.framesForwardKinematics(model, data, np.concatenate([q, np.zeros(model.nq - robot.dof)]))
    if np.abs(data.oMf[tip].homogeneous - robot.fk(q)).max() > 1e-9:
        raise ValueError(f"the URDF file of {robot.name} is another arm")


def text(vector: np.ndarray) -> str:
    """Formats numbers for URDF."""
    return " ".join(repr(float(value)) for value in vector)
