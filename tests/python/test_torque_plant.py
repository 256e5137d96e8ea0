"""The arm in MuJoCo whose motors take torques. Skipped where MuJoCo is not installed."""

from typing import Any

import numpy as np
import pytest
from mistakes import assert_told
from numpy.typing import NDArray
from pair_of_pandas import pair_of_pandas
from test_dynamics import with_masses

import beetle_ik as bik
from beetle_ik.sim import TorquePlant

pytest.importorskip("mujoco", reason="MuJoCo is not installed (extra 'sim')")

Array = NDArray[np.float64]

PANDA = bik.Robot.named("panda")
HEAVY = PANDA.with_payload(3.0, center=(0.02, 0.0, 0.05))
START = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])
END = np.array([1.2, 0.8, 0.3, -1.0, 0.2, 1.5, 0.8])
RUBBED = """
<robot name="rubbed">
  <link name="base"/>
  <link name="rail"><inertial><origin xyz="0.1 0 0"/><mass value="2"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="arm"><inertial><origin xyz="0 0.1 0.2"/><mass value="1.5"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0.001" ixz="0.002" iyz="0.003"/></inertial></link>
  <link name="hand"><inertial><mass value="0.5"/>
    <inertia ixx="0.002" iyy="0.003" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="rail"/><origin xyz="0 0 0.5"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" velocity="1" effort="80"/>
    <dynamics damping="3" friction="1.5"/></joint>
  <joint name="swing" type="revolute"><parent link="rail"/><child link="arm"/><origin xyz="0 0 0.3" rpy="0 0.4 0"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="40"/>
    <dynamics damping="0.5" friction="0.25"/></joint>
  <joint name="flange" type="fixed"><parent link="arm"/><child link="hand"/>
    <origin xyz="0.2 0 0.4" rpy="1 0 0"/></joint>
</robot>
"""


def plan(robot: bik.Robot) -> bik.Plan:
    """A motion within 90 % of the torques of the arm with its payload."""
    limits = bik.Limits(acceleration=[15, 7.5, 10, 12.5, 15, 20, 20], torque=0.9 * robot.torque_limit)
    found = bik.plan_point_to_point(robot, start_q=START, end_q=END, limits=limits)
    assert found.success
    return found


@pytest.mark.parametrize(
    "robot",
    [
        PANDA,
        HEAVY,
        HEAVY.with_base(bik.pose([0, 0, 1], rpy=[0, np.pi / 2, 0])),
        HEAVY.with_gravity((1.0, -2.0, -9.0)),
        with_masses(bik.Robot.named("ur5e"), 3),
        bik.Robot.from_urdf(RUBBED),
    ],
    ids=["panda", "3 kg", "wall", "gravity", "ur5e", "rubbed"],
)
def test_accelerations_are_those_of_the_robot(robot: bik.Robot) -> None:
    plant = TorquePlant(robot)
    rng = np.random.default_rng(1)
    for q in robot.random_configurations(10, seed=2):
        qd = rng.choice([0.0, 1.0, -0.7], robot.dof)
        torques = rng.uniform(-5, 5, robot.dof)
        plant.reset(q)
        plant._data.qvel[:] = qd
        plant._data.qfrc_applied[:] = torques
        plant._mujoco.mj_forward(plant._model, plant._data)
        expected = robot.accelerations(q, qd, torques)
        moving = qd != 0.0
        scale = 1.0 + np.abs(expected).max()
        if moving.all() or not np.any(plant._model.dof_frictionloss):
            # MuJoCo's dry friction gives way a little before it slips.
            near = 1e-6 if not np.any(plant._model.dof_frictionloss) else 0.02
            assert np.abs(plant._data.qacc - expected).max() < near * scale


def test_a_plan_is_followed_where_the_payload_is_known() -> None:
    motion = plan(HEAVY)
    plant = TorquePlant(HEAVY)
    known = plant.follow(motion, hold=0.5)
    assert known.error.max() < 2e-4
    assert known.error[-1] < 1e-6
    np.testing.assert_allclose(known.q[-1], END, atol=1e-6)
    share = np.abs(known.torques) / HEAVY.torque_limit
    assert share.max() < 0.95
    unknown = plant.follow(motion, model=PANDA, hold=0.5)
    assert unknown.error.max() > 50 * known.error.max()
    assert unknown.error[-1] > 5e-3


def test_a_stiffer_arm_sags_less_under_a_payload_unknown() -> None:
    plant = TorquePlant(HEAVY)
    still = bik.Trajectory.from_samples([0.0, 1.0], [START, START])
    sags = [plant.follow(still, model=PANDA, bandwidth=w, hold=1.0).error[-1] for w in (10.0, 20.0, 40.0)]
    # The force of the feedback grows with the square of the bandwidth.
    assert sags[0] > 2.5 * sags[1] > 6.0 * sags[2] > 0.0


def test_torques_beyond_the_motors_are_cut_off() -> None:
    plant = TorquePlant(PANDA)
    plant.reset(START)
    plant.step(np.full(7, 1e4))
    np.testing.assert_array_equal(plant._data.qfrc_applied, PANDA.torque_limit)
    assert plant.time == pytest.approx(1e-3)


def test_an_arm_that_is_held_up_stays() -> None:
    plant = TorquePlant(HEAVY)
    plant.reset(START)
    for _ in range(100):
        plant.step(HEAVY.torques(START))
    np.testing.assert_allclose(plant.q, START, atol=1e-9)
    assert np.abs(plant.qd).max() < 1e-8


def follow(motion: Any, **options: Any) -> None:
    TorquePlant(PANDA).follow(motion, **options)


STILL = bik.Trajectory.from_samples([0.0, 1.0], [START, START])
MIMIC = RUBBED.replace('name="swing"', 'name="turn"', 1).replace(
    "</robot>",
    '<link name="end"/><joint name="follows" type="revolute"><parent link="hand"/><child link="end"/>'
    '<axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/>'
    '<mimic joint="turn" multiplier="0.5"/></joint></robot>',
)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: TorquePlant(bik.Robot.named("ur5e")),
            "robot 'ur5e' has no dynamics: no link has a mass: give them by robot.with_inertias({link: Inertia(link, "
            "mass, center, matrix)})",
        ),
        (
            lambda: TorquePlant(with_masses(bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"]), 1)),
            "TorquePlant takes robots with one tip; this one has left_tool and right_tool: load the robot with one of "
            "them as tip=",
        ),
        (
            lambda: TorquePlant(bik.Robot.from_urdf(MIMIC)),
            "robot 'rubbed' has mimic joints, which cannot be simulated",
        ),
        (lambda: TorquePlant(PANDA, timestep=0.0), "timestep must be positive and finite, got 0.0"),
        (lambda: follow(STILL, bandwidth=-1.0), "bandwidth must be zero or more and finite, got -1.0"),
        (lambda: follow(STILL, hold=np.inf), "hold must be zero or more and finite, got inf"),
        (lambda: follow(STILL, model=bik.Robot.named("ur5e")), "model has 6 joints, and robot 'panda' has 7"),
        (
            lambda: follow(bik.Trajectory.from_samples([0.0, 1.0], [[0.0], [1.0]])),
            "motion has 1 joints, and robot 'panda' has 7",
        ),
        (lambda: follow("plan"), "motion must be a Plan or a Trajectory, got 'plan'"),
        (lambda: TorquePlant(PANDA).reset([0.0]), "q of the plant: expected shape (7,), got (1,)"),
        (
            lambda: TorquePlant(PANDA).step(np.full((1, 7), 0.0)),
            "torques of the plant: expected shape (7,), got (1, 7)",
        ),
        (
            lambda: TorquePlant(PANDA).step([np.nan] * 7),
            "torques of the plant must be finite, got [nan, nan, nan, nan, nan, nan, nan]",
        ),
    ],
)
def test_mistakes_are_told(call: object, message: str) -> None:
    assert_told(call, bik.InvalidInputError, message)
