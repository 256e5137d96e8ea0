"""Kinematics by Pinocchio, in the conventions of this library.

Pinocchio has no base but the root, represents continuous joints by (cos, sin), and leaves mimic joints free. This
module converts all three, so that tests compare like with like.
"""

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

Array = NDArray[np.float64]

SHARED = Path(__file__).parents[3] / "shared"

needs_shared = pytest.mark.skipif(not SHARED.is_dir(), reason="no folder ../shared beside the repository")


class Oracle:
    """The kinematics of a URDF between two links."""

    def __init__(self, xml: str, base: str, tip: str) -> None:
        self.pin = pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
        self.model = self.pin.buildModelFromXML(xml)
        self.data = self.model.createData()
        self.base, self.tip = (self.model.getFrameId(link, self.pin.BODY) for link in (base, tip))
        self.couplings = {
            joint.attrib["name"]: joint.find("mimic")
            for joint in ET.fromstring(xml).iter("joint")
            if "name" in joint.attrib
        }

    def drive(self, joint: str) -> tuple[str, float, float]:
        """The independent joint behind `joint`, and factor and offset of its motion."""
        mimic = self.couplings[joint]
        if mimic is None or mimic.attrib["joint"] not in self.couplings:
            return joint, 1.0, 0.0
        master, factor, offset = self.drive(mimic.attrib["joint"])
        multiplier = float(mimic.get("multiplier", 1.0))
        return master, multiplier * factor, multiplier * offset + float(mimic.get("offset", 0.0))

    def fk_and_jacobian(self, joints: list[str], q: Array) -> tuple[Array, Array]:
        """Pose of the tip in the base link's frame, and its Jacobian, for independent `joints` at `q` (n,)."""
        full = self._configuration(dict(zip(joints, q, strict=True)))
        self.pin.computeJointJacobians(self.model, self.data, full)
        self.pin.updateFramePlacements(self.model, self.data)
        base, tip = (self.data.oMf[frame] for frame in (self.base, self.tip))
        j_base, j_tip = (self._independent(joints, self._jacobian(frame)) for frame in (self.base, self.tip))
        # The tip as seen from the base link, which may itself be moved by joints between root and base.
        lever = tip.translation - base.translation
        linear = j_tip[:3] - j_base[:3] + np.cross(lever, j_base[3:], axisb=0, axisc=0)
        angular = j_tip[3:] - j_base[3:]
        jacobian = np.vstack((base.rotation.T @ linear, base.rotation.T @ angular))
        return base.actInv(tip).homogeneous, jacobian

    def link_poses(self, links: list[str], values: Mapping[str, float]) -> Array:
        """Poses of links in the base link's frame, with the independent joints at these values."""
        self.pin.framesForwardKinematics(self.model, self.data, self._configuration(values))
        frames = [self.data.oMf[self.model.getFrameId(link, self.pin.BODY)] for link in links]
        return np.array([self.data.oMf[self.base].actInv(frame).homogeneous for frame in frames])

    def _configuration(self, values: Mapping[str, float]) -> Array:
        """Pinocchio's q: joints that are not on the chain stand at zero."""
        full = self.pin.neutral(self.model)
        for name, joint in zip(self.model.names[1:], list(self.model.joints)[1:], strict=True):
            if joint.nv > 1:
                continue  # a floating or planar joint
            master, factor, offset = self.drive(name)
            angle = factor * values.get(master, 0.0) + offset
            full[joint.idx_q : joint.idx_q + joint.nq] = [angle] if joint.nq == 1 else [np.cos(angle), np.sin(angle)]
        return full

    def _jacobian(self, frame: int) -> Array:
        # Of a single joint Pinocchio returns a vector.
        return self.pin.getFrameJacobian(self.model, self.data, frame, self.pin.LOCAL_WORLD_ALIGNED).reshape(6, -1)

    def _independent(self, joints: list[str], columns: Array) -> Array:
        """Sums the columns of joints that move together."""
        summed = np.zeros((6, len(joints)))
        for name, joint in zip(self.model.names[1:], list(self.model.joints)[1:], strict=True):
            master, factor, _ = self.drive(name)
            if master in joints:
                summed[:, joints.index(master)] += factor * columns[:, joint.idx_v]
        return summed
