"""The arms whose geometry `ssik` carries, as URDF files: some seventy real ones, most of them in no catalog of ours."""

from __future__ import annotations

import importlib
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from .chain import Chain

# Every structure that has a closed form, and arms without one.
SIX_JOINTS = (
    *("irb120", "irb6700", "vs060", "lrmate200id", "kr6_r900", "rv4fr", "rx160", "viperx300s", "puma560", "gp8"),
    *("ur3e", "ur5", "ur5e", "ur16e", "z1", "standardbots_core"),
    *("cr5", "m1013", "piper", "fanuc_crx10ia", "xarm6", "jaco2", "gen3_lite", "xmatesr3"),
)
SEVEN_JOINTS = ("franka_panda", "fr3", "iiwa7", "iiwa14", "gen3", "xarm7", "rizon4")


def carried_chains(names: Iterable[str], scratch: Path) -> list[Chain]:
    """The chains of these arms, with files in `scratch`."""
    import ssik

    paths = {arm.name.removesuffix("_ik"): arm.import_path for arm in ssik.list_arms()}
    if unknown := set(names) - set(paths):
        raise SystemExit(f"no arm {', '.join(sorted(unknown))}; there are {', '.join(paths)}")
    return [_chain(name, paths[name], scratch) for name in names]


def _chain(name: str, import_path: str, scratch: Path) -> Chain:
    module = importlib.import_module(import_path)
    robot = ET.Element("robot", name=name)
    link = module.BASE_LINK
    ET.SubElement(robot, "link", name=link)
    for i, joint in enumerate(_joints(module)):
        before, axis, limits, after = joint
        lower, upper = limits or (-np.pi, np.pi)
        turning = _add(robot, f"joint_{i + 1}", "revolute", link, f"turning_{i + 1}", before)
        ET.SubElement(turning, "axis", xyz=_text(axis))
        ET.SubElement(turning, "limit", lower=repr(lower), upper=repr(upper), velocity="1", effort="0")
        last = i + 1 == module.DOF
        link = module.EE_LINK if last else f"link_{i + 1}"
        _add(robot, f"fixed_{i + 1}", "fixed", f"turning_{i + 1}", link, after)
    path = scratch / f"{name}.urdf"
    ET.ElementTree(robot).write(path)
    return Chain(name, path, module.BASE_LINK, module.EE_LINK, import_path)


def _joints(module: Any) -> Iterable[tuple[np.ndarray, np.ndarray, tuple[float, float] | None, np.ndarray]]:
    """Placement before the joint, axis, limits and placement after it, of each joint."""
    return zip(module._JOINT_T_LEFTS, module._JOINT_AXES, module._JOINT_LIMITS, module._JOINT_T_RIGHTS, strict=True)


def _add(robot: ET.Element, name: str, kind: str, parent: str, child: str, placement: np.ndarray) -> ET.Element:
    """A joint and the link that it carries."""
    joint = ET.SubElement(robot, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    ET.SubElement(
        joint,
        "origin",
        xyz=_text(placement[:3, 3]),
        rpy=_text(pin.rpy.matrixToRpy(np.ascontiguousarray(placement[:3, :3]))),
    )
    ET.SubElement(robot, "link", name=child)
    return joint


def _text(vector: np.ndarray) -> str:
    return " ".join(repr(float(value)) for value in vector)
