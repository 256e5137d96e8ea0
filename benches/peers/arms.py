"""Seventy-two arms whose geometry is part of `ssik`, as URDF files; most are not in our own catalog."""

from __future__ import annotations

import argparse
import importlib
import xml.etree.ElementTree as ET
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from .chain import Chain, load_chains, some_mass

# Structures with a closed form, and arms without one.
SIX_JOINTS = (
    *("irb120", "irb6700", "vs060", "lrmate200id", "kr6_r900", "rv4fr", "rx160", "viperx300s", "puma560", "gp8"),
    *("ur3e", "ur5", "ur5e", "ur16e", "z1", "standardbots_core"),
    *("cr5", "m1013", "piper", "fanuc_crx10ia", "xarm6", "jaco2", "gen3_lite", "xmatesr3"),
)
SEVEN_JOINTS = ("franka_panda", "fr3", "iiwa7", "iiwa14", "gen3", "xarm7", "rizon4")


def add_arguments(parser: argparse.ArgumentParser, *, arms: Iterable[str] = (), robots: Iterable[Path] = ()) -> None:
    """Adds the options that choose the arms."""
    parser.add_argument("--arms", nargs="*", default=arms, help="names of arms in ssik")
    parser.add_argument(
        "--robots",
        nargs="*",
        type=Path,
        default=robots,
        help="URDF files or directories of them; a robots.json beside them may give base and tip: "
        "{NAME: {base: LINK, tip: LINK}}",
    )


def chosen(arguments: argparse.Namespace, scratch: Path) -> list[Chain]:
    """Returns the chains of the chosen arms, with files in `scratch`."""
    return [*carried_chains(arguments.arms, scratch), *load_chains(arguments.robots, scratch)]


def carried_chains(names: Collection[str], scratch: Path) -> list[Chain]:
    """Returns the chains of these arms of `ssik`, with files in `scratch`."""
    if not names:
        return []
    import ssik

    paths = {arm.name.removesuffix("_ik"): arm.import_path for arm in ssik.list_arms()}
    if unknown := set(names) - set(paths):
        raise SystemExit(f"no arm {', '.join(sorted(unknown))}; there are {', '.join(paths)}")
    return [_chain(name, paths[name], scratch) for name in names]


def _chain(name: str, import_path: str, scratch: Path) -> Chain:
    """Writes the arm with each joint about its own z axis: not all libraries read other axes exactly."""
    module = importlib.import_module(import_path)
    robot = ET.Element("robot", name=name)
    link = module.BASE_LINK
    ET.SubElement(robot, "link", name=link)
    placement = np.eye(4)
    for i, joint in enumerate(_joints(module)):
        before, axis, limits, after = joint
        lower, upper = limits or (-np.pi, np.pi)
        turn = _frame_about(axis)
        moving = _add(robot, f"joint_{i + 1}", "revolute", link, f"moved_{i + 1}", placement @ before @ turn)
        ET.SubElement(moving, "axis", xyz="0 0 1")
        ET.SubElement(moving, "limit", lower=repr(lower), upper=repr(upper), velocity="1", effort="0")
        link, placement = f"moved_{i + 1}", turn.T @ after
    _add(robot, "to_tip", "fixed", link, module.EE_LINK, placement)
    path = scratch / f"{name}.urdf"
    ET.ElementTree(robot).write(path)
    return Chain(name, path, module.BASE_LINK, module.EE_LINK, import_path)


def _frame_about(axis: np.ndarray) -> np.ndarray:
    """Frame (4, 4) at the origin with this z axis."""
    z = axis / np.linalg.norm(axis)
    x = np.cross(np.eye(3)[np.argmin(np.abs(z))], z)
    x /= np.linalg.norm(x)
    frame = np.eye(4)
    frame[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    return frame


def _joints(module: Any) -> Iterable[tuple[np.ndarray, np.ndarray, tuple[float, float] | None, np.ndarray]]:
    """Transform before the joint, axis, limits and transform after it, for each joint."""
    return zip(module._JOINT_T_LEFTS, module._JOINT_AXES, module._JOINT_LIMITS, module._JOINT_T_RIGHTS, strict=True)


def _add(robot: ET.Element, name: str, kind: str, parent: str, child: str, placement: np.ndarray) -> ET.Element:
    """Adds a joint and the link that it carries, with the mass that simulators require."""
    joint = ET.SubElement(robot, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    rotation = pin.rpy.matrixToRpy(np.ascontiguousarray(placement[:3, :3]))
    ET.SubElement(joint, "origin", xyz=_text(placement[:3, 3]), rpy=_text(rotation))
    ET.SubElement(robot, "link", name=child).append(some_mass())
    return joint


def _text(vector: np.ndarray) -> str:
    return " ".join(repr(float(value)) for value in vector)
