"""Humanoids: feet fixed, hands placed, against Pinocchio. Balance is not considered."""

import numpy as np
import pytest
from conftest import ROBOTS

import beetle_ik as bik

HUMANOIDS = {
    "talos": (
        "talos_data/robots/talos_reduced_corrected.urdf",
        "left_sole_link",
        ["right_sole_link", "gripper_left_base_link", "gripper_right_base_link"],
    ),
    "g1": (
        "g1_description/urdf/g1_29dof_rev_1_0.urdf",
        "left_ankle_roll_link",
        ["right_ankle_roll_link", "left_rubber_hand", "right_rubber_hand"],
    ),
}


@pytest.mark.parametrize("name", HUMANOIDS)
def test_hands_go_where_they_are_sent_while_the_feet_stand(name: str) -> None:
    pin = pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
    urdf, foot, tips = HUMANOIDS[name]
    robot = bik.Robot.from_urdf(ROBOTS / urdf, base=foot, tip=tips)
    model = pin.buildModelFromUrdf(str(ROBOTS / urdf))
    data, entries = model.createData(), {name: model.joints[i].idx_q for i, name in enumerate(model.names)}
    standing = np.clip(np.zeros(robot.dof), robot.lower, robot.upper)
    feet_and_hands = dict(zip(tips, robot.fk(standing), strict=True))
    rng = np.random.default_rng(0)
    for seed in range(50):
        wanted = {tip: pose.copy() for tip, pose in feet_and_hands.items()}
        for hand in tips[1:]:
            wanted[hand][:3, 3] += rng.uniform(-0.1, 0.1, 3)
        s = bik.solve(robot, wanted, start_q=standing, seed=seed)
        assert s.success, s.message
        theirs = np.zeros(model.nq)
        theirs[[entries[joint] for joint in robot.joint_names]] = s.q
        pin.framesForwardKinematics(model, data, theirs)
        ground = data.oMf[model.getFrameId(foot)].inverse()
        for tip, pose in wanted.items():
            seen = (ground * data.oMf[model.getFrameId(tip)]).homogeneous
            np.testing.assert_allclose(seen, pose, rtol=0, atol=2e-6)


@pytest.mark.parametrize("name", HUMANOIDS)
def test_random_poses_of_all_limbs_are_reached(name: str) -> None:
    urdf, foot, tips = HUMANOIDS[name]
    robot = bik.Robot.from_urdf(ROBOTS / urdf, base=foot, tip=tips)
    for seed, poses in enumerate(robot.fk(robot.random_configurations(100, seed=1))):
        assert bik.solve(robot, dict(zip(tips, poses, strict=True)), seed=seed).success
