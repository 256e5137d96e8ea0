"""All URDFs of the package example-robot-data: loaded, compared with Pinocchio link by link, and solved."""

import re
import sys
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from conftest import ROBOTS, Entry, table

import beetle_ik as bik

sys.path.append(str(Path(__file__).parents[1] / "python"))
from oracle import Oracle

# Files without an arm, and the sentence that says so.
REFUSED = {
    "hector_description/robots/quadrotor_base.urdf": (
        "URDF line 6: <robot> has no <joint>: a chain needs at least one that moves"
    ),
    "iris_description/robots/iris_simple.urdf": (
        "robot 'iris' ends in 5 links: say which one is the tip; leaves, by number of joints: iris__/imu_link (0), "
        "iris__rotor_0 (0), iris__rotor_1 (0), iris__rotor_2 (0), iris__rotor_3 (0)"
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
    of_file = f"{ROBOTS / urdf}: " if sentence.startswith("URDF") else ""
    assert str(told.value) == of_file + sentence


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


def test_an_srdf_beside_the_file_is_read_or_refused_with_a_reason(entry: Entry) -> None:
    robot = bik.Robot.from_urdf(entry.path, tip=entry.tip)
    for srdf in sorted(entry.path.parents[1].rglob("*.srdf")):
        try:
            described = robot.with_srdf(srdf)
        except bik.UrdfError as error:
            described, reason = robot, str(error)
            assert re.match(r"SRDF: it is for another robot: ", reason), reason
        assert all(stance.shape == (robot.dof,) for stance in described.stances.values())
        links = {link for pair in described.collision_pairs for link in pair}
        assert links <= {link for link, *_ in described.capsules}


# Twenty of those whose meshes are in the package.
FITTED = [
    "a1", "allegro_left_hand", "b1-z1", "baxter", "double_pendulum", "finger_edu", "go2", "kinova", "laikago", "panda",
    "panda_collision", "so100", "solo12", "talos_left_arm", "tiago", "tiago_pro", "ur10_robot", "ur5_robot",
    "xarm7", "z1",
]  # fmt: skip


def with_bodies(name: str, collision: Literal["fit", "hulls"]) -> bik.Robot:
    (entry,) = (entry for entry in table() if Path(entry.urdf).stem == name)
    return bik.Robot.from_urdf(entry.path, tip=entry.tip, collision=collision, package_dirs=ROBOTS.parent)


@pytest.mark.parametrize("name", FITTED)
def test_bodies_are_fitted_to_meshes(name: str) -> None:
    robot = with_bodies(name, "fit")
    assert robot.capsules
    assert not any("a mesh" in shape for shape in robot.unread_collision_shapes)
    assert all(largest < 0.3 for *_, largest in robot.mesh_fits)


@pytest.mark.parametrize("name", FITTED)
def test_hulls_hold_their_meshes(name: str) -> None:
    robot = with_bodies(name, "hulls")
    assert not any("a mesh" in shape for shape in robot.unread_collision_shapes)
    rng, q = np.random.default_rng(3), robot.random_configurations(1, seed=3)[0]
    places = dict(zip(robot.all_link_names, robot.all_link_poses(q), strict=True))
    for link, mesh in robot.collision_meshes():
        corners = mesh.vertices[rng.integers(len(mesh.vertices), size=5)]
        for corner in corners @ places[link][:3, :3].T + places[link][:3, 3]:
            assert bik.obstacles.clearance(robot, q, [bik.obstacles.Sphere(corner, 1e-6)]) <= 0.0
