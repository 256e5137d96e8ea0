"""Kinematics against Pinocchio, to 1e-12."""

import json
from pathlib import Path

import numpy as np
import pytest
from generated import chain
from oracle import SHARED, Oracle, needs_shared

import beetle_ik as bik

pytest.importorskip("pinocchio", reason="Pinocchio is not installed")

ROBOTS = json.loads((SHARED / "robots" / "robots.json").read_text()) if SHARED.is_dir() else {}
URDFS = sorted((SHARED / "robots").rglob("*.urdf"))


def assert_same_kinematics(robot: bik.Robot, oracle: Oracle, configurations: int, seed: int = 0) -> None:
    for q in robot.random_configurations(configurations, seed):
        pose, jacobian = oracle.fk_and_jacobian(robot.joint_names, q)
        np.testing.assert_allclose(robot.fk(q), pose, rtol=0, atol=1e-12)
        np.testing.assert_allclose(robot.jacobian(q), jacobian, rtol=0, atol=1e-12)


@needs_shared
@pytest.mark.parametrize("file", URDFS, ids=lambda file: f"{file.parent.name}/{file.stem}")
def test_real_robots_agree_with_pinocchio(file: Path) -> None:
    described = ROBOTS[file.stem]
    robot = bik.Robot.from_urdf(file, base=described["base"], tip=described["tip"])
    assert robot.dof == described["dof"]
    assert_same_kinematics(robot, Oracle(file.read_text(), described["base"], described["tip"]), configurations=50)


@pytest.mark.filterwarnings("ignore::beetle_ik.UnitsWarning")  # drawn limits may look like degrees
@pytest.mark.parametrize("joints", range(1, 13))
@pytest.mark.parametrize("place", ["root", "inside", "branch"])
def test_generated_chains_agree_with_pinocchio(joints: int, place: str) -> None:
    for seed in range(20):
        xml, base, tip = chain(joints, place, seed)
        robot = bik.Robot.from_urdf(xml, base=base, tip=tip)
        assert 1 <= robot.dof <= joints
        assert_same_kinematics(robot.with_limits(lower=-3.0, upper=3.0), Oracle(xml, base, tip), 2, seed)


@needs_shared
@pytest.mark.parametrize("file", sorted((SHARED / "targets").glob("*.npz")), ids=lambda file: file.stem)
def test_stored_targets_are_reached(file: Path) -> None:
    described = ROBOTS[file.stem]
    urdf = SHARED / "robots" / f"{file.stem}.urdf"
    robot = bik.Robot.from_urdf(urdf, base=described["base"], tip=described["tip"])
    with np.load(file) as targets:
        np.testing.assert_allclose(robot.fk(targets["q_goal"]), targets["pose"], rtol=0, atol=1e-12)
