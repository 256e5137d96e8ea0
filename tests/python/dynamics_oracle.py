"""Dynamics by Pinocchio, in the conventions of this library.

Mimic joints are reflected to their masters, and joints beside the chain stand still.
"""

import xml.etree.ElementTree as ET
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from oracle import Oracle

import beetle_ik as bik

Array = NDArray[np.float64]


class DynamicsOracle:
    """The dynamics of a robot from a URDF whose base is the root."""

    def __init__(self, xml: str, robot: bik.Robot) -> None:
        self.kinematics = Oracle(xml, robot.link_names[0], robot.link_names[-1])
        self.pin, self.model, self.data = self.kinematics.pin, self.kinematics.model, self.kinematics.data
        self.model.gravity.linear = robot.gravity
        self.robot = robot
        self.followed = self._followed()
        self.damping, self.dry = (self._friction(xml, name) for name in ("damping", "friction"))

    def torques(self, q: Array, qd: Array, qdd: Array) -> Array:
        full, rates = self._configuration(q), self.followed @ qd
        torques = self.pin.rnea(self.model, self.data, full, rates, self.followed @ qdd)
        # Pinocchio reads friction, but leaves it out.
        return np.asarray(self.followed.T @ (torques + self.damping * rates + self.dry * np.sign(rates)))

    def mass_matrix(self, q: Array) -> Array:
        full = self.pin.crba(self.model, self.data, self._configuration(q))
        full = np.triu(full) + np.triu(full, 1).T
        return np.asarray(self.followed.T @ full @ self.followed)

    def center_of_mass(self, q: Array) -> Array:
        """Centre of all masses, the base included."""
        self.pin.forwardKinematics(self.model, self.data, self._configuration(q))
        placed = zip(self.model.inertias, self.data.oMi, strict=True)
        parts = [(body.mass, place.act(body.lever)) for body, place in placed]
        return np.asarray(sum(mass * center for mass, center in parts) / sum(mass for mass, _ in parts))

    def _configuration(self, q: Array) -> Array:
        values: Mapping[str, float] = dict(zip(self.robot.joint_names, q, strict=True)) | self.robot.held_joints
        return self.kinematics._configuration(values)

    def _friction(self, xml: str, name: str) -> Array:
        """Friction of each joint of Pinocchio (nv,)."""
        values = np.zeros(self.model.nv)
        for joint in ET.fromstring(xml).iter("joint"):
            element = joint.find("dynamics")
            if element is not None and self.model.existJointName(joint.get("name", "")):
                index = self.model.joints[self.model.getJointId(joint.attrib["name"])].idx_v
                values[index] = float(element.get(name, 0.0))
        return values

    def _followed(self) -> Array:
        """How fast each joint of Pinocchio moves per unit rate of each joint of the robot (nv, n)."""
        rates = np.zeros((self.model.nv, self.robot.dof))
        for name, joint in zip(self.model.names[1:], list(self.model.joints)[1:], strict=True):
            if joint.nv > 1:
                continue
            master, factor, _ = self.kinematics.drive(name)
            if master in self.robot.joint_names:
                rates[joint.idx_v, self.robot.joint_names.index(master)] = factor
        return rates


def states(robot: bik.Robot, count: int, seed: int) -> list[tuple[Array, Array, Array]]:
    """Positions, velocities and accelerations: reals, zeros, right angles and limits, mixed within each state."""
    rng = np.random.default_rng(seed)
    drawn = []
    for q in robot.random_configurations(count, seed):
        lower, upper = np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)
        round_q = np.clip(rng.choice([0.0, np.pi / 2, -np.pi / 2, np.pi, 1.0], robot.dof), lower, upper)
        rates = [
            rng.choice([0.0, 1.0, -1.0, rng.normal(scale=2.0)], robot.dof) * rng.integers(0, 2, robot.dof)
            for _ in range(2)
        ]
        drawn.append((np.where(rng.random(robot.dof) < rng.random(), round_q, q), *rates))
    return drawn


def assert_near(found: Array, expected: Array, scale: float, tolerance: float = 1e-10) -> None:
    np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * max(scale, 1e-12))
