"""All URDFs of the package example-robot-data: they load, their links stand where Pinocchio puts them, targets are reached."""

import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROBOTS, Entry, table

import beetle_ik as bik

sys.path.append(str(Path(__file__).parents[1] / "python"))
from oracle import Oracle  # noqa: E402

# Files without an arm, and the sentence that says so.
REFUSED = {
    "hector_description/robots/quadrotor_base.urdf": (
        "URDF line 6: <robot> has no <joint>: a chain needs at least one that moves"
    ),
    "iris_description/robots/iris_simple.urdf": (
        "URDF: no joint moves between base 'iris__base_link' and tip 'iris__/imu_link'"
    ),
    "ur_description/urdf/ur3.urdf": "URDF line 6: <robot> has no <joint>: a chain needs at least one that moves",
}


def test_every_file_is_in_the_table_or_refused() -> None:
    found = {path.relative_to(ROBOTS).as_posix() for path in ROBOTS.rglob("*.urdf")}
    assert found == {entry.urdf for entry in table()} | set(REFUSED)


@pytest.mark.parametrize(("urdf", "sentence"), REFUSED.items(), ids=list(REFUSED))
def test_files_without_an_arm_are_refused_with_a_reason(urdf: str, sentence: str) -> None:
    with pytest.raises(bik.UrdfError) as told:
        bik.Robot.from_urdf(ROBOTS / urdf)
    assert str(told.value) == sentence


def test_all_links_stand_where_pinocchio_puts_them(entry: Entry) -> None:
    robot = bik.Robot.from_urdf(entry.path, tip=entry.tip)
    oracle = Oracle(entry.path.read_text(), robot.link_names[0], robot.link_names[-1])
    for q in robot.random_configurations(3, seed=1):
        values = dict(zip(robot.joint_names, q, strict=True)) | robot.held_joints
        expected = oracle.link_poses(robot.all_link_names, values)
        np.testing.assert_allclose(robot.all_link_poses(q), expected, rtol=0, atol=1e-12)


def test_a_hundred_targets_are_reached(entry: Entry) -> None:
    robot = bik.Robot.from_urdf(entry.path, tip=entry.tip)
    solved = bik.solve_batch(robot, robot.fk(robot.random_configurations(100, seed=2)))
    assert np.all(solved.success)


def test_robots_keep_clear_of_themselves_in_the_stances_of_their_srdf(entry: Entry) -> None:
    for srdf in sorted(entry.path.parents[1].rglob("*.srdf")):
        robot = bik.Robot.from_urdf(entry.path, tip=entry.tip)
        try:
            robot = robot.with_srdf(srdf)
        except bik.UrdfError as error:
            assert "it is for another robot" in str(error)
            continue
        assert all(stance.shape == (robot.dof,) for stance in robot.stances.values())
        assert set(sum(robot.collision_pairs, ())) <= set(robot.all_link_names)
