"""Names and limits of the moving joints of a URDF, those beside the chain included."""

import os
from pathlib import Path
from typing import TypeAlias
from xml.etree import ElementTree

import numpy as np

_MOVING = ("revolute", "continuous", "prismatic")
Bounds: TypeAlias = tuple[float, float]


def moving_joints(path_or_xml: str | os.PathLike[str]) -> dict[str, Bounds]:
    """Returns lower and upper limits (rad, m) of the joints of a URDF that move, mimic joints included.

    They are in the order of Pinocchio: from the root outward, branch after branch, branches sorted by joint names.
    """
    is_text = isinstance(path_or_xml, str) and "<" in path_or_xml
    root = ElementTree.fromstring(str(path_or_xml) if is_text else Path(path_or_xml).read_bytes())
    joints = [joint for joint in root.iter("joint") if joint.find("child") is not None]
    behind: dict[str, list[ElementTree.Element]] = {}
    for joint in sorted(joints, key=lambda joint: joint.get("name", "")):
        behind.setdefault(_link(joint, "parent"), []).append(joint)
    children = {_link(joint, "child") for joint in joints}
    found: dict[str, Bounds] = {}
    waiting = [joint for link, joints in behind.items() if link not in children for joint in joints][::-1]
    while waiting:
        joint = waiting.pop()
        if joint.get("type") in _MOVING:
            found[joint.get("name", "")] = _bounds(joint)
        waiting += behind.get(_link(joint, "child"), [])[::-1]
    return found


def _link(joint: ElementTree.Element, end: str) -> str:
    element = joint.find(end)
    return "" if element is None else element.get("link", "")


def _bounds(joint: ElementTree.Element) -> Bounds:
    limit = joint.find("limit")
    if limit is None or joint.get("type") == "continuous" or limit.get("upper") is None:
        return -np.inf, np.inf
    return float(limit.get("lower", 0.0)), float(limit.get("upper", 0.0))
