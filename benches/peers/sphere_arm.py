"""Arm as spheres, read from URDF and SRDF by numpy alone, for a judge that shares no code with any planner."""

# ruff: noqa: D107

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class Joint:
    """Joint of the file: the constant transform before it, and its axis if it turns the arm."""

    child: str
    parent: str
    rotation: np.ndarray  # (3, 3)
    offset: np.ndarray  # (3,)
    axis: np.ndarray | None  # None: fixed
    column: int  # of q


class SphereArm:
    """Spheres of an arm, and the pairs of them that must not touch.

    Two spheres are tested if their links are on different sides of a joint and the SRDF does not leave the pair out.
    Joints other than `moving` stay at zero. Positions are in the frame of the root link.
    """

    def __init__(
        self, urdf: Path, srdf: Path, moving: list[str], never_tested: Iterable[frozenset[str]] = frozenset()
    ) -> None:
        robot = ET.parse(urdf).getroot()
        self.moving = moving
        elements = {joint.get("name"): joint for joint in robot.findall("joint")}
        self.joints = _sorted([_joint(name, joint, moving) for name, joint in elements.items()])
        limits = [elements[name].find("limit") for name in moving]
        self.lower, self.upper, self.velocity = (
            np.array([float(limit.get(field)) for limit in limits]) for field in ("lower", "upper", "velocity")
        )
        self.root = self.joints[0].parent
        spheres = [
            (link.get("name"), _numbers(body.find("origin"), "xyz"), float(sphere.get("radius")))
            for link in robot.findall("link")
            for body in link.findall("collision")
            for sphere in body.iter("sphere")
        ]
        self.links = [link for link, _, _ in spheres]
        self.local = np.array([center for _, center, _ in spheres])
        self.radii = np.array([radius for *_, radius in spheres])
        left_out = {
            frozenset((pair.get("link1"), pair.get("link2"))) for pair in ET.parse(srdf).iter("disable_collisions")
        } | set(never_tested)
        body = self._bodies()
        tested = [
            (i, j)
            for j in range(len(spheres))
            for i in range(j)
            if body[self.links[i]] != body[self.links[j]] and frozenset((self.links[i], self.links[j])) not in left_out
        ]
        self.pairs = np.array(tested).reshape(-1, 2)

    def tested_links(self) -> set[frozenset[str]]:
        """Pairs of links that must not touch."""
        return {frozenset((self.links[i], self.links[j])) for i, j in self.pairs}

    def centers(self, q: np.ndarray) -> np.ndarray:
        """Centres of the spheres (m, k, 3) at configurations (m, n)."""
        turns, places = self.poses(q)
        return np.stack(
            [turns[link] @ center + places[link] for link, center in zip(self.links, self.local, strict=True)], axis=1
        )

    def poses(self, q: np.ndarray) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        """Rotations (m, 3, 3) and origins (m, 3) of all links at configurations (m, n)."""
        turns = {self.root: np.broadcast_to(np.eye(3), (len(q), 3, 3))}
        places = {self.root: np.zeros((len(q), 3))}
        for joint in self.joints:
            turn = turns[joint.parent]
            places[joint.child] = turn @ joint.offset + places[joint.parent]
            turn = turn @ joint.rotation
            turns[joint.child] = turn if joint.axis is None else turn @ about(joint.axis, q[:, joint.column])
        return turns, places

    def _bodies(self) -> dict[str, str]:
        """First link of the rigid body that each link belongs to."""
        carrier = {self.root: self.root}
        for joint in self.joints:
            carrier[joint.child] = carrier[joint.parent] if joint.axis is None else joint.child
        return carrier


def about(axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Rotations (m, 3, 3) about a unit axis (Rodrigues)."""
    cross = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    sine, cosine = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + sine * cross + (1.0 - cosine) * (cross @ cross)


def _joint(name: str, joint: ET.Element, moving: list[str]) -> Joint:
    origin = joint.find("origin")
    roll, pitch, yaw = (np.array([angle]) for angle in _numbers(origin, "rpy"))
    x, y, z = np.eye(3)
    rotation = (about(z, yaw) @ about(y, pitch) @ about(x, roll))[0]
    axis, column = None, -1
    if name in moving:
        if joint.get("type") not in ("revolute", "continuous"):
            raise ValueError(f"joint {name} is {joint.get('type')}: only joints that turn are judged")
        axis, column = _numbers(joint.find("axis"), "xyz"), moving.index(name)
        axis = axis / np.linalg.norm(axis)
    parent, child = joint.find("parent").get("link"), joint.find("child").get("link")
    return Joint(child, parent, rotation, _numbers(origin, "xyz"), axis, column)


def _sorted(joints: list[Joint]) -> list[Joint]:
    """Joints sorted so that each follows the one that carries it."""
    children = {joint.child for joint in joints}
    known, rest, sorted_joints = {joint.parent for joint in joints} - children, joints, []
    while rest:
        ready = [joint for joint in rest if joint.parent in known]
        known |= {joint.child for joint in ready}
        sorted_joints += ready
        rest = [joint for joint in rest if joint.child not in known]
    return sorted_joints


def _numbers(element: ET.Element | None, field: str) -> np.ndarray:
    text = None if element is None else element.get(field)
    return np.array([float(number) for number in (text or "0 0 0").split()])
