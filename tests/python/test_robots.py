"""Robots: forward kinematics, Jacobians, changed copies, and poses."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

import beetle_ik as bik

Array = NDArray[np.float64]

# From the notes to Cheng et al. (2020): DH d = .36, 0, .42, 0, .4, 0, .126.
IIWA_ANGLES = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]
IIWA_TIP = [0.04133656, -0.00431495, 1.27874931]


def rotation(axis: str, angle: float) -> Array:
    """A turn about a coordinate axis, (4, 4)."""
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix = np.eye(4)
    matrix[i, i] = matrix[j, j] = np.cos(angle)
    matrix[j, i], matrix[i, j] = np.sin(angle), -np.sin(angle)
    return matrix


def translation(x: float, y: float, z: float) -> Array:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


@pytest.fixture(scope="module", params=bik.Robot.names())
def robot(request: pytest.FixtureRequest) -> bik.Robot:
    return bik.Robot.named(request.param)


def test_iiwa14_stands_where_the_paper_puts_it() -> None:
    robot = bik.Robot.named("iiwa14")
    np.testing.assert_allclose(robot.fk(np.zeros(7))[:3, 3], [0.0, 0.0, 1.306], rtol=0, atol=1e-15)
    np.testing.assert_allclose(robot.fk(IIWA_ANGLES)[:3, 3], IIWA_TIP, rtol=0, atol=5e-9)


def test_a_built_in_robot_describes_itself(robot: bik.Robot) -> None:
    n = robot.dof
    assert len(robot.joint_names) == len(set(robot.joint_names)) == len(robot.joint_kinds) == n
    assert set(robot.joint_kinds) <= {"revolute", "continuous", "prismatic"}
    assert robot.lower.shape == robot.upper.shape == robot.velocity_limit.shape == (n,)
    assert np.all(robot.lower < robot.upper)
    np.testing.assert_array_equal(robot.limits.lower, robot.lower)
    np.testing.assert_array_equal(robot.limits.velocity, robot.velocity_limit)
    assert repr(robot) == f"<Robot '{robot.name}': {n} joints, {robot.link_names[0]} to {robot.link_names[-1]}>"


def test_a_batch_has_the_bits_of_its_items(robot: bik.Robot) -> None:
    q = robot.random_configurations(37, seed=1)
    for method in (robot.fk, robot.jacobian, robot.manipulability):
        np.testing.assert_array_equal(method(q), [method(row) for row in q])


def test_link_poses_run_from_base_to_tip(robot: bik.Robot) -> None:
    q = robot.random_configurations(1)[0]
    poses = robot.link_poses(q)
    assert poses.shape == (len(robot.link_names), 4, 4)
    np.testing.assert_allclose(poses[-1], robot.fk(q), rtol=0, atol=1e-14)


def test_jacobian_is_the_derivative_of_fk(robot: bik.Robot) -> None:
    step = 1e-6
    for q in robot.random_configurations(5, seed=2):
        jacobian = robot.jacobian(q)
        for j, offset in enumerate(step * np.eye(robot.dof)):
            before, after = robot.fk(q - offset), robot.fk(q + offset)
            np.testing.assert_allclose(jacobian[:3, j], (after - before)[:3, 3] / (2 * step), rtol=0, atol=1e-8)
            spin = (after - before)[:3, :3] @ robot.fk(q)[:3, :3].T / (2 * step)
            np.testing.assert_allclose(jacobian[3:, j], [spin[2, 1], spin[0, 2], spin[1, 0]], rtol=0, atol=1e-8)


def test_configurations_lie_within_the_limits_and_repeat(robot: bik.Robot) -> None:
    q = robot.random_configurations(200, seed=3)
    assert q.shape == (200, robot.dof)
    assert np.all((robot.lower <= q) & (q <= robot.upper))
    np.testing.assert_array_equal(q, robot.random_configurations(200, seed=3))
    assert not np.array_equal(q, robot.random_configurations(200, seed=4))


def test_joints_without_limits_get_a_finite_range() -> None:
    robot = bik.Robot.from_dh(a=[1, 0], alpha=[0, 0], d=[0, 0], kinds=["continuous", "prismatic"])
    np.testing.assert_array_equal(robot.lower, [-np.inf, -np.inf])
    assert np.all(np.abs(robot.random_configurations(500)) <= [np.pi, 1.0])


@pytest.mark.parametrize(
    "form",
    [
        list,
        tuple,
        lambda q: np.repeat(q, 2)[::2],
        lambda q: np.asfortranarray(np.tile(q, (3, 1)))[1],
        lambda q: q.astype(">f8"),
    ],
    ids=["list", "tuple", "strided", "column", "big-endian"],
)
def test_any_array_like_is_taken(form: Callable[[Array], object]) -> None:
    robot = bik.Robot.named("iiwa14")
    q = np.array(IIWA_ANGLES)
    np.testing.assert_array_equal(robot.fk(form(q)), robot.fk(q))
    np.testing.assert_array_equal(robot.jacobian(form(q)), robot.jacobian(q))


def test_other_number_types_are_converted() -> None:
    robot = bik.Robot.named("iiwa14")
    half = np.array(IIWA_ANGLES, dtype=np.float32)
    np.testing.assert_array_equal(robot.fk(half), robot.fk(half.astype(np.float64)))
    np.testing.assert_array_equal(robot.fk(np.ones(7, dtype=np.int8)), robot.fk(np.ones(7)))


def test_batches_may_have_any_memory_order() -> None:
    robot = bik.Robot.named("iiwa14")
    q = robot.random_configurations(20)
    expected = robot.fk(q)
    np.testing.assert_array_equal(robot.fk(np.asfortranarray(q)), expected)
    np.testing.assert_array_equal(robot.fk(q[::2]), expected[::2])
    np.testing.assert_array_equal(robot.fk(q[::-1]), expected[::-1])
    assert robot.fk(q[:0]).shape == (0, 4, 4)
    assert robot.jacobian(q[:0]).shape == (0, 6, 7)


def test_input_is_left_alone_and_attributes_are_read_only() -> None:
    robot = bik.Robot.named("iiwa14")
    q = np.array(IIWA_ANGLES)
    results = [robot.fk(q), robot.fk(q[None]), robot.jacobian(q), robot.link_poses(q)]
    results += [robot.random_configurations(2), bik.pose([0, 0, 0]), robot.manipulability(q[None])]
    for result in results:
        assert result.dtype == np.float64
        result[...] = 0.0
    for attribute in (robot.lower, bik.solve(robot, [0.4, 0.1, 0.6]).q):
        with pytest.raises(ValueError, match="read-only"):
            attribute[...] = 0.0
    np.testing.assert_array_equal(q, IIWA_ANGLES)
    assert q.flags.writeable


def test_tool_and_base_multiply() -> None:
    robot = bik.Robot.named("panda")
    tool = bik.pose([0.1, -0.2, 0.3], rpy=[0.4, 0.5, 0.6])
    base = bik.pose([-1.0, 2.0, 0.5], rotvec=[0.3, -1.0, 2.0])
    q = robot.random_configurations(1)[0]
    placed = robot.with_tool(tool).with_base(base)
    np.testing.assert_allclose(placed.fk(q), base @ robot.fk(q) @ tool, rtol=0, atol=1e-14)
    np.testing.assert_allclose(placed.link_poses(q)[0], base, rtol=0, atol=1e-15)
    # A tool replaces the one before; it does not add up.
    np.testing.assert_array_equal(placed.with_tool(np.eye(4)).with_base(np.eye(4)).fk(q), robot.fk(q))
    assert placed != robot


def test_changed_limits_leave_the_original() -> None:
    robot = bik.Robot.named("iiwa14")
    before = robot.upper.copy()
    changed = robot.with_limits(upper=1.0, velocity=np.arange(7.0))
    np.testing.assert_array_equal(changed.upper, np.ones(7))
    np.testing.assert_array_equal(changed.velocity_limit, np.arange(7.0))
    np.testing.assert_array_equal(changed.lower, robot.lower)
    np.testing.assert_array_equal(robot.upper, before)


def test_planar_arms_stay_in_the_plane() -> None:
    robot = bik.Robot.planar([1.0, 0.5, 0.25], velocity=0.2)
    q = np.array([0.3, -0.7, 1.1])
    direction = np.cumsum(q)
    expected = [1.0, 0.5, 0.25] @ np.column_stack((np.cos(direction), np.sin(direction)))
    np.testing.assert_allclose(robot.fk(q)[:2, 3], expected, rtol=0, atol=1e-15)
    np.testing.assert_allclose(robot.fk(q) @ [0, 0, 1, 0], [0, 0, 1, 0], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(robot.lower, -np.pi * np.ones(3))
    np.testing.assert_array_equal(robot.velocity_limit, [0.2] * 3)


@pytest.mark.parametrize("convention", ["modified", "standard"])
def test_dh_tables_are_products_of_four_transforms(convention: str) -> None:
    rng = np.random.default_rng(5)
    kinds = ["revolute", "prismatic", "continuous", "prismatic", "revolute"]
    a, alpha, d, theta, q = rng.normal(size=(5, 5))
    base, tool = bik.pose([1, 2, 3], rpy=[0.1, 0.2, 0.3]), bik.pose([0, 0, 0.2], rpy=[1, 0, 0])
    robot = bik.Robot.from_dh(
        a=a, alpha=alpha, d=d, theta=theta, kinds=kinds, convention=convention, base=base, tool=tool, name="arm"
    )
    expected = base
    for i, kind in enumerate(kinds):
        slides = kind == "prismatic"
        joint = rotation("z", theta[i] + (0.0 if slides else q[i])) @ translation(
            0, 0, d[i] + (q[i] if slides else 0.0)
        )
        link = rotation("x", alpha[i]) @ translation(a[i], 0, 0)
        expected = expected @ (link @ joint if convention == "modified" else joint @ link)
    np.testing.assert_allclose(robot.fk(q), expected @ tool, rtol=0, atol=1e-13)
    assert (robot.name, robot.joint_kinds) == ("arm", kinds)


def test_manipulability_is_yoshikawas() -> None:
    robot = bik.Robot.named("panda")
    q = robot.random_configurations(1)[0]
    jacobian = robot.jacobian(q)
    expected = np.sqrt(np.linalg.det(jacobian @ jacobian.T))
    assert robot.manipulability(q) == pytest.approx(expected, rel=1e-9)
    elbow = np.array([0.2, 1.1])
    assert bik.Robot.planar([1.0, 1.0]).manipulability(elbow) > 0.0
    with np.errstate(all="raise"):
        assert robot.manipulability(np.zeros(7)) == pytest.approx(0.0, abs=1e-9)


def test_pose_agrees_with_every_way_to_write_a_rotation() -> None:
    roll, pitch, yaw = 0.3, -0.8, 2.1
    expected = translation(1, 2, 3) @ rotation("z", yaw) @ rotation("y", pitch) @ rotation("x", roll)
    matrix = expected[:3, :3]
    angle = np.arccos((np.trace(matrix) - 1) / 2)
    vee = np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]])
    axis = vee / (2 * np.sin(angle))
    x, y, z, w = *(np.sin(angle / 2) * axis), np.cos(angle / 2)
    ways = {
        "rpy": [roll, pitch, yaw],
        "rotvec": angle * axis,
        "matrix": matrix,
        "xyzw": [3 * x, 3 * y, 3 * z, 3 * w],  # of any length
        "wxyz": [-w, -x, -y, -z],
    }
    for way, value in ways.items():
        np.testing.assert_allclose(bik.pose([1, 2, 3], **{way: value}), expected, rtol=0, atol=1e-15, err_msg=way)
    np.testing.assert_array_equal(bik.pose([1, 2, 3]), translation(1, 2, 3))


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-5, np.pi - 1e-9, np.pi, 7.0])
def test_pose_by_rotation_vector_at_any_angle(angle: float) -> None:
    np.testing.assert_allclose(bik.pose([0, 0, 0], rotvec=[0, angle, 0]), rotation("y", angle), rtol=0, atol=1e-15)


def test_a_follower_beyond_the_tip_limits_its_leader() -> None:
    joint = (
        "<joint name='{0}' type='revolute'><parent link='{1}'/><child link='{2}'/><origin xyz='0.3 0 0'/>"
        "<axis xyz='0 0 1'/><limit lower='-{3}' upper='{3}' velocity='{4}' effort='1'/>{5}</joint><link name='{2}'/>"
    )
    follows = joint.format("finger", "hand", "nail", 0.1, 0.01, "<mimic joint='wrist' multiplier='0.5'/>")
    wrist = joint.format("wrist", "base", "hand", 2, 1, "")
    urdf = f"<robot name='arm'><link name='base'/>{wrist}{follows}</robot>"
    for tip in ("hand", "nail"):
        robot = bik.Robot.from_urdf(urdf, tip=tip)
        np.testing.assert_allclose([robot.lower, robot.upper], [[-0.2], [0.2]])
        np.testing.assert_allclose(robot.limits.velocity, [0.02])
