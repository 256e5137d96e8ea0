"""Robots in the form that every library gets: one serial chain, one file, one set of limits."""

# ruff: noqa: D102

from __future__ import annotations

import json
import math
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pinocchio as pin

SEED = 20250
TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Chain:
    """Serial robot of revolute and prismatic joints, with Pinocchio's model of it as the judge."""

    name: str
    urdf: Path
    base: str
    tip: str
    carried_as: str = ""  # the module of `ssik` for this arm, where it carries one

    @cached_property
    def model(self) -> pin.Model:
        return pin.buildModelFromUrdf(str(self.urdf))

    @cached_property
    def tip_frame(self) -> int:
        return self.model.getFrameId(self.tip)

    @property
    def lower(self) -> np.ndarray:
        return self.model.lowerPositionLimit

    @property
    def upper(self) -> np.ndarray:
        return self.model.upperPositionLimit

    @property
    def dof(self) -> int:
        return self.model.nq

    @cached_property
    def _data(self) -> pin.Data:
        return self.model.createData()

    def pose(self, q: np.ndarray) -> np.ndarray:
        """Pose of the tip in the base frame, (4, 4)."""
        pin.framesForwardKinematics(self.model, self._data, q)
        return self._data.oMf[self.tip_frame].homogeneous.copy()

    def unwound(self, q: np.ndarray) -> np.ndarray:
        """Shifts joints (n,) or (k, n) by whole turns to their least values not below the limits."""
        return q + TURN * np.ceil((self.lower - q) / TURN)

    def targets(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Reachable poses (count, 4, 4) and one random start for each (count, n), the same in every run."""
        random = np.random.default_rng(SEED)
        goals = random.uniform(self.lower, self.upper, (count, self.dof))
        starts = random.uniform(self.lower, self.upper, (count, self.dof))
        return np.array([self.pose(q) for q in goals]), starts


def load_chains(places: Iterable[Path], scratch: Path) -> list[Chain]:
    """Loads the chain of every URDF file named or in a directory; `robots.json` beside it may name base and tip."""
    chains = []
    for place in places:
        files = [place] if place.suffix == ".urdf" else sorted(place.glob("*.urdf"))
        if not files:
            raise SystemExit(f"no .urdf file in {place}: give a directory that has some with --robots")
        for urdf in files:
            index = urdf.with_name("robots.json")
            ends = json.loads(index.read_text()).get(urdf.stem, {}) if index.exists() else {}
            chains.append(cut(urdf, ends.get("base"), ends.get("tip"), scratch))
    return chains


def cut(urdf: Path, base: str | None, tip: str | None, scratch: Path) -> Chain:
    """Writes the chain from base to tip alone, without shapes, continuous joints as one turn about zero.

    Libraries differ in how they choose a tip, order the joints of a tree and draw restarts for a joint without limits.
    This takes the difference away.
    """
    robot = ET.parse(urdf).getroot()
    joint_above = {joint.find("child").get("link"): joint for joint in robot.findall("joint")}
    if tip is None:
        parents = {joint.find("parent").get("link") for joint in joint_above.values()}
        leaves = [link for link in joint_above if link not in parents]
        if len(leaves) != 1:
            raise SystemExit(f"{urdf.name} has {len(leaves)} tips ({', '.join(leaves)}): choose one in robots.json")
        tip = leaves[0]
    joints, link = [], tip
    while link != base and link in joint_above:
        joints.append(joint_above[link])
        link = joints[-1].find("parent").get("link")

    chain = ET.Element("robot", name=urdf.stem)
    ET.SubElement(chain, "link", name=link)
    for joint in reversed(joints):
        if joint.get("type") == "continuous":
            joint.set("type", "revolute")
            limit = joint.find("limit")
            limit = ET.SubElement(joint, "limit", effort="0", velocity="1") if limit is None else limit
            limit.set("lower", str(-math.pi))
            limit.set("upper", str(math.pi))
        chain.append(joint)
        moved = ET.SubElement(chain, "link", name=joint.find("child").get("link"))
        moved.append(some_mass())
    path = scratch / urdf.name
    ET.ElementTree(chain).write(path)
    return Chain(urdf.stem, path, link, tip)


def some_mass() -> ET.Element:
    """Adds some mass to a link, which the simulators among the libraries require."""
    inertial = ET.Element("inertial")
    ET.SubElement(inertial, "mass", value="1")
    ET.SubElement(inertial, "inertia", ixx="1", ixy="0", ixz="0", iyy="1", iyz="0", izz="1")
    return inertial
