"""Dynamics of the URDFs of the package example-robot-data, beside Pinocchio's."""

import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import Entry

import beetle_ik as bik

sys.path.append(str(Path(__file__).parents[1] / "python"))
from dynamics_oracle import DynamicsOracle, assert_near, states

STATES = 100

# Files with an inertia that no body has, on a link that moves, and the link.
IMPOSSIBLE = {
    "alex_psyonic_hands": "LeftPsyonicAbilityBaseLink",
    "allegro_left_hand": "link_11.0",
    "allegro_right_hand": "link_3.0",
    "bolt": "FL_FOOT",
    "hyq_no_sensors": "lf_foot",
    "pr2": "sensor_mount_link",
    "romeo_laas_small": "LShoulderYaw_link",
    "romeo_small": "RShoulderYawLink",
}


def test_torques_and_masses_are_those_of_pinocchio(entry: Entry) -> None:
    robot = bik.Robot.from_urdf(entry.path, tip=entry.tip)
    if not robot.has_dynamics:
        with pytest.raises(bik.InvalidInputError) as told:
            robot.torques(np.zeros(robot.dof))
        assert f"<inertial> of link '{IMPOSSIBLE[entry.path.stem]}': " in str(told.value)
        return
    oracle = DynamicsOracle(entry.path.read_text(), robot)
    for q, qd, qdd in states(robot, STATES, seed=1):
        expected, mass = oracle.torques(q, qd, qdd), oracle.mass_matrix(q)
        assert_near(robot.torques(q, qd, qdd), expected, max(abs(expected).max(), 1e-6))
        assert_near(robot.mass_matrix(q), mass, abs(mass).max())
        assert_near(robot.center_of_mass(q), oracle.center_of_mass(q), 1.0)
        condition = np.linalg.cond(mass)
        if condition < 1e12:  # three axes that meet in a shoulder may be aligned
            accelerations = robot.accelerations(q, qd, expected)
            # Rounding of the torques, times the condition of the matrix.
            known = 1e-14 * condition * max(abs(np.linalg.solve(mass, expected)).max(), 1.0)
            assert_near(accelerations, qdd, 1.0, tolerance=max(1e-10, known))
