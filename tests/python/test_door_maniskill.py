"""The door for ManiSkill: the calls of mplib. Its shapes, poses and signatures are compared where it is installed."""

import ast
import importlib.util
import inspect
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from generated import chain
from gripper_arm import GRIPPER_ARM, READY

import beetle_ik as bik
from beetle_ik.interop import maniskill as mplib
from beetle_ik.interop.maniskill import Pose, fcl
from beetle_ik.interop.maniskill.screw import rotation_vector, screw
from beetle_ik.interop.urdf_joints import moving_joints

NAMES = [*(f"joint{i}" for i in range(1, 8)), "left_finger_joint", "right_finger_joint"]
ARM = bik.Robot.from_urdf(GRIPPER_ARM, tip="hand")
START = np.array(READY)
ABOVE = [0.4, 0.3, 0.32, 0, 1, 0, 0]  # as in the first example of mplib's documentation
BLUE_BOX = fcl.CollisionObject(fcl.Box([0.1, 0.4, 0.4]), Pose(p=[0.5, 0.0, 0.2]))


def planner(**arguments: Any) -> mplib.Planner:
    return mplib.Planner(GRIPPER_ARM, "hand", **arguments)


def assert_motion(result: dict[str, Any], start: np.ndarray, step: float, most: float = 1.0) -> None:
    """The motion begins at start, is sampled every step, and keeps velocities, accelerations and positions."""
    assert result["status"] == "Success"
    time, q = result["time"], result["position"]
    np.testing.assert_allclose(q[0], start[:7], atol=1e-12)
    np.testing.assert_allclose(np.diff(time)[:-1], step)
    assert time[-1] == pytest.approx(result["duration"])
    assert np.abs(result["velocity"]).max() <= most * (1 + 1e-9)
    assert np.abs(result["acceleration"]).max() <= most * (1 + 1e-9)
    assert np.all((ARM.lower - 1e-9 <= q) & (q <= ARM.upper + 1e-9))
    np.testing.assert_allclose(result["velocity"][[0, -1]], 0.0, atol=1e-9)


# --- the examples of mplib's documentation ------------------------------------------------------


def test_the_first_example_of_the_documentation_runs() -> None:
    table = fcl.CollisionObject(fcl.Box([0.8, 0.8, 0.05]), Pose(p=[0.56, 0, -0.025]))
    plan, q = planner(objects=[("table", table)]), START
    for place in ([0.4, 0.3, 0.12], [0.2, -0.3, 0.08], [0.6, 0.1, 0.14]):
        pose = [*place, 0, 1, 0, 0]
        for axis, shift in ((2, 0.2), (2, -0.12), (2, 0.12), (0, 0.1), (2, -0.12), (2, 0.12)):
            pose[axis] += shift
            result = plan.plan_screw(pose, q, time_step=1 / 250)
            if result["status"] != "Success":
                result = plan.plan_pose(Pose(pose[:3], pose[3:]), q, time_step=1 / 250)
            assert_motion(result, q, 1 / 250)
            q = np.concatenate((result["position"][-1], START[7:]))
            np.testing.assert_allclose(ARM.fk(q[:7])[:3, 3], pose[:3], atol=2e-6)
            clear = bik.obstacles.clearance(plan.robot.arm_at(q), result["position"], plan.planning_world.obstacles)
            assert clear.min() >= -1e-9


def test_a_plan_goes_around_the_box_of_the_documentation() -> None:
    plan = planner()
    plan.planning_world.add_object("blue", BLUE_BOX)
    start = plan.IK([0.4, 0.4, 0.2, 0, 1, 0, 0], START)[1][0]
    straight = plan.plan_screw([0.4, -0.4, 0.2, 0, 1, 0, 0], start)
    assert straight == {"status": "screw plan failed: link 'link7' meets object 'blue' (Box)"}
    result = plan.plan_pose([0.4, -0.4, 0.2, 0, 1, 0, 0], start, time_step=0.01)
    assert_motion(result, start, 0.01)
    around = plan.planning_world.obstacles
    assert bik.obstacles.clearance(plan.robot.arm_at(start), result["position"], around).min() >= -1e-9
    assert result["plan"].success
    ignored = plan.plan_pose([0.4, -0.4, 0.2, 0, 1, 0, 0], start, use_point_cloud=False)
    assert ignored["duration"] < result["duration"]


def test_collisions_are_found_as_in_the_documentation() -> None:
    plan = planner()
    plan.planning_world.add_object("floor", fcl.CollisionObject(fcl.Box([2, 2, 0.1]), Pose(p=[0, 0, -0.1])))
    low = [0, 1.7, 0, -1.0, 0, 1.5, 0]
    assert plan.check_for_self_collision(START) == []
    assert plan.check_for_env_collision(START) == []
    assert {found.link_name2 for found in plan.check_for_env_collision(low)} == {"floor"}
    status = plan.plan_qpos([low], START)["status"]
    assert status.startswith("RRTConnect Failed. end_q: link '")
    assert "inside object 'floor' (Box)" in status
    assert plan.remove_object("floor")
    assert not plan.remove_object("floor")
    assert plan.check_for_env_collision(low) == []


def test_the_base_may_stand_elsewhere() -> None:
    plan, base = planner(), [1, 1, 0, 0.8, 0, 0, 0.6]
    plan.set_base_pose(base)
    moved = Pose(base) * Pose(ABOVE)
    there = plan.plan_pose(moved, START)
    same = plan.plan_pose(ABOVE, START, wrt_world=False)
    np.testing.assert_allclose(there["position"][-1], same["position"][-1], atol=1e-6)
    np.testing.assert_allclose(ARM.fk(there["position"][-1])[:3, 3], ABOVE[:3], atol=2e-6)
    for goal in plan.IK(ABOVE, START)[1]:
        np.testing.assert_allclose(ARM.fk(goal[:7])[:3, 3], ABOVE[:3], atol=2e-6)
    assert plan.plan_screw(moved, START)["status"] == "Success"


# --- joints and poses ---------------------------------------------------------------------------


def test_joints_may_come_in_the_order_of_a_simulator() -> None:
    order = [8, 3, 0, 4, 1, 7, 2, 6, 5]
    mixed = planner(user_joint_names=[NAMES[i] for i in order])
    assert [order[i] for i in mixed.move_group_joint_indices] == list(range(7))
    result = mixed.plan_pose(ABOVE, START[order])
    np.testing.assert_array_equal(result["position"], planner().plan_pose(ABOVE, START)["position"])
    (goal, *_) = mixed.IK(ABOVE, START[order])[1]
    np.testing.assert_array_equal(goal, planner().IK(ABOVE, START)[1][0][order])


def test_configurations_may_be_of_the_move_group_alone() -> None:
    plan = planner()
    plan.robot.set_qpos(START)
    np.testing.assert_array_equal(plan.pad_move_group_qpos(START[:7] + 0.1)[7:], START[7:])
    alone = plan.plan_pose(ABOVE, START[:7])
    np.testing.assert_array_equal(alone["position"], plan.plan_pose(ABOVE, START)["position"])


def test_poses_come_in_many_forms() -> None:
    class Sapien:
        p, q = np.array(ABOVE[:3], dtype=np.float32), np.array([0, 2.0, 0, 0], dtype=np.float32)

    matrix = bik.pose(ABOVE[:3], xyzw=[1, 0, 0, 0])
    ends = [
        planner().plan_pose(pose, START)["position"][-1]
        for pose in (ABOVE, np.array([ABOVE]), Pose(ABOVE), Pose(p=ABOVE[:3], q=[0, 1, 0, 0]), matrix, Sapien())
    ]
    for end in ends[1:]:
        np.testing.assert_allclose(end, ends[0], atol=1e-6)


def test_poses_agree_with_scipy() -> None:
    rotation = pytest.importorskip("scipy.spatial.transform", reason="scipy is not installed").Rotation
    rng = np.random.default_rng(1)
    for i in range(300):
        q = rng.normal(size=4) if i % 2 else rng.integers(-1, 2, 4) + 1e-9 * (i % 3)
        if np.linalg.norm(q) < 1e-6:
            continue
        p = rng.normal(size=3)
        pose, turn = Pose(p, q), rotation.from_quat(np.roll(q, -1))
        np.testing.assert_allclose(pose.to_transformation_matrix()[:3, :3], turn.as_matrix(), atol=1e-12)
        np.testing.assert_allclose(rotation.from_quat(np.roll(pose.q, -1)).as_matrix(), turn.as_matrix(), atol=1e-12)
        np.testing.assert_allclose((pose * pose.inv()).to_transformation_matrix(), np.eye(4), atol=1e-12)
        np.testing.assert_allclose(pose * [1.0, 2.0, 3.0], turn.apply([1.0, 2.0, 3.0]) + p, atol=1e-12)
        turned = rotation.from_rotvec(rotation_vector(turn.as_matrix()))
        np.testing.assert_allclose(turned.as_matrix(), turn.as_matrix(), atol=1e-7)
        assert pose.distance(pose) == pytest.approx(0.0)


# --- goals --------------------------------------------------------------------------------------


def test_inverse_kinematics_lists_configurations_nearest_first() -> None:
    status, goals = planner().IK(ABOVE, START)
    assert status == "Success"
    far = [np.linalg.norm(goal - START) for goal in goals]
    assert far == sorted(far)
    assert len(goals) > 4
    for goal in goals:
        np.testing.assert_allclose(ARM.fk(goal[:7])[:3, 3], ABOVE[:3], atol=1e-6)
        np.testing.assert_array_equal(goal[7:], START[7:])
    np.testing.assert_array_equal(planner().IK(ABOVE, START, return_closest=True)[1], goals[0])


def test_inverse_kinematics_says_why_it_fails() -> None:
    status, goals = planner().IK([3, 0, 0, 1, 0, 0, 0], START)
    assert goals is None
    assert status.startswith("IK Failed! ")
    assert "out of reach" in status
    assert planner().plan_pose([3, 0, 0, 1, 0, 0, 0], START)["status"] == status


def test_masked_joints_stay_where_they_are() -> None:
    plan = planner()
    wanted = START.copy()
    wanted[[1, 3, 5]] += [0.1, 0.2, -0.1]
    goal = Pose(ARM.fk(wanted[:7]))
    mask = [True, False, True, False, True, False, False, False, False]
    status, goals = plan.IK(goal, START, mask)
    assert status == "Success"
    np.testing.assert_array_equal(np.array(goals)[:, [0, 2, 4]], np.broadcast_to(START[[0, 2, 4]], (len(goals), 3)))
    result = plan.plan_pose(goal, START, mask)
    np.testing.assert_allclose(result["position"][-1][[0, 2, 4]], START[[0, 2, 4]], atol=1e-9)


def test_fixed_joints_do_not_move_at_all() -> None:
    plan, goal = planner(), START + 0.3
    result = plan.plan_qpos([goal], START, fixed_joint_indices=range(2))
    np.testing.assert_allclose(result["position"][:, :2], np.broadcast_to(START[:2], (len(result["time"]), 2)))
    np.testing.assert_allclose(result["position"][-1, 2:], goal[2:7], atol=1e-9)


def test_the_nearest_of_several_goals_is_taken() -> None:
    result = planner().plan_qpos([START + 0.4, START + 0.05, START - 0.4], START)
    np.testing.assert_allclose(result["position"][-1], START[:7] + 0.05, atol=1e-9)


@pytest.mark.parametrize("call", ["plan_qpos", "plan_pose", "plan_screw"])
def test_a_goal_that_is_reached_already_takes_no_time(call: str) -> None:
    goal = [START] if call == "plan_qpos" else Pose(ARM.fk(START[:7]))
    result = getattr(planner(), call)(goal, START)
    assert result["status"] == "Success"
    assert result["duration"] == pytest.approx(0.0, abs=1e-3)
    np.testing.assert_allclose(result["position"][-1], START[:7], atol=1e-6)


def test_limits_are_those_of_the_planner() -> None:
    fast = planner(joint_vel_limits=np.full(7, 3.0), joint_acc_limits=np.full(7, 8.0))
    result = fast.plan_pose(ABOVE, START, time_step=0.01)
    assert 1.0 < np.abs(result["velocity"]).max() <= 3.0 + 1e-9
    assert_motion(result, START, 0.01, most=8.0)
    time, q, qd, qdd, duration = planner().TOPP(np.array([START[:7], START[:7] + 0.5, START[:7] + 0.2]), 0.02)
    assert len(time) == len(q) == len(qd) == len(qdd)
    assert time[-1] == duration
    assert max(np.abs(qd).max(), np.abs(qdd).max()) <= 1.0 + 1e-9


def test_what_must_hold_is_kept() -> None:
    plan = planner()
    down = bik.Keep(bik.pose([0, 0, 0], xyzw=[1, 0, 0, 0]), bik.tasks.Pointing(tolerance=[np.inf, np.inf, np.inf, 0.1]))
    start = plan.IK([0.5, 0.2, 0.4, 0, 1, 0, 0], START)[1][0]
    result = plan.plan_pose([0.5, -0.2, 0.4, 0, 1, 0, 0], start, time_step=0.02, keep=down)
    assert result["status"] == "Success"
    assert np.arccos(-ARM.fk(result["position"])[:, 2, 2]).max() < 0.1


# --- screws -------------------------------------------------------------------------------------


def test_a_screw_turns_uniformly_about_one_axis() -> None:
    rng = np.random.default_rng(2)
    for i in range(50):
        turn = [rng.normal(size=3), np.zeros(3), [np.pi, 0, 0], [0, 0, 1e-7]][i % 4]
        start, end = bik.pose(rng.normal(size=3), rotvec=rng.normal(size=3)), bik.pose(rng.normal(size=3), rotvec=turn)
        poses = screw(start, end)
        np.testing.assert_allclose(poses[[0, -1]], [start, end], atol=1e-7)
        steps = [second @ np.linalg.inv(first) for first, second in pairwise(poses)]
        np.testing.assert_allclose(steps, np.broadcast_to(steps[0], np.shape(steps)), atol=1e-7)


def test_the_hand_follows_the_screw() -> None:
    result = planner().plan_screw(ABOVE, START, time_step=0.02)
    assert_motion(result, START, 0.02)
    ideal = screw(ARM.fk(START[:7]), Pose(ABOVE).to_transformation_matrix(), finer=10)[:, :3, 3]
    for place in ARM.fk(result["position"])[:, :3, 3]:
        assert np.linalg.norm(ideal - place, axis=1).min() < 1e-3


def test_a_screw_out_of_reach_fails() -> None:
    assert planner().plan_screw([2, 0, 0.3, 0, 1, 0, 0], START)["status"].startswith("screw plan failed: ")


# --- the world ----------------------------------------------------------------------------------


def test_a_point_cloud_is_replaced_and_removed() -> None:
    plan = planner()
    there = np.array([ARM.fk(START[:7])[:3, 3]])
    plan.update_point_cloud(there, resolution=0.02)
    assert {found.link_name1 for found in plan.check_for_env_collision(START)} >= {"hand"}
    plan.update_point_cloud(there + 2.0, resolution=0.02)
    assert plan.check_for_env_collision(START) == []
    assert plan.remove_point_cloud()
    assert not plan.remove_point_cloud()


def test_a_carried_box_keeps_clear_until_it_is_let_go() -> None:
    plan = planner()
    plan.robot.set_qpos(START, True)
    plan.update_attached_box([0.04, 0.04, 0.3], [0, 0, 0.2, 1, 0, 0, 0])
    (name,) = plan.planning_world.get_object_names()
    assert name == "gripper_arm_8_box"
    floor = fcl.CollisionObject(fcl.Box([2, 2, 0.1]), Pose(p=[0, 0, -0.16]))
    plan.planning_world.add_object("floor", floor)
    low = [0.4, 0.3, 0.15, 0, 1, 0, 0]
    assert plan.plan_pose(low, START)["status"].startswith("IK Failed! ")
    assert plan.plan_pose(low, START, use_attach=False)["status"] == "Success"
    assert plan.detach_object(name)
    assert not plan.detach_object(name)
    assert plan.planning_world.get_object_names() == ["floor", name]
    (box,) = plan.planning_world.obstacles[1:]
    np.testing.assert_allclose(box.center, (ARM.fk(START[:7]) @ [0, 0, 0.2, 1])[:3], atol=1e-9)
    plan.update_attached_sphere(0.03, [0, 0, 0.15, 1, 0, 0, 0])
    assert plan.detach_object("gripper_arm_8_sphere", also_remove=True)


def test_a_carried_part_may_touch_what_it_touches_now() -> None:
    plan, folded = planner(), [1.1, 0.9, 0.5, -2.8, 1.4, 0.4, 0.8]
    plan.robot.set_qpos(folded)
    plan.update_attached_object(fcl.Sphere(0.12), Pose(p=[0, 0, 0.1]), name="large")
    assert plan.robot.attached["large"][2] == ["link5", "link4"]
    assert plan.check_for_self_collision() == []
    plan.robot.set_qpos(START)
    plan.update_attached_object(fcl.Sphere(0.12), Pose(p=[0, 0, 0.1]), name="large")
    assert {found.link_name1 for found in plan.check_for_self_collision(folded)} == {"large"}


def test_a_mesh_is_carried_as_its_hull(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed")
    file = tmp_path / "part.stl"
    trimesh.creation.icosphere(radius=0.03).export(file)
    plan = planner()
    plan.update_attached_mesh(str(file), [0, 0, 0.1, 1, 0, 0, 0])
    assert plan.planning_world.is_object_attached("gripper_arm_8_mesh")


def test_lists_of_collisions_are_complete() -> None:
    plan = planner()
    balls = {f"ball{i}": bik.obstacles.Sphere(place, 0.1) for i, place in enumerate(np.eye(3) * 0.4)}
    for name, ball in balls.items():
        plan.planning_world.add_object(name, ball)
    robot, found = plan.robot.arm_at(START), 0
    for q in ARM.random_configurations(60, seed=3):
        pairs = {frozenset((one.link_name1, one.link_name2)) for one in plan.check_for_self_collision(q)}
        assert pairs == {
            frozenset(pair)
            for pair in robot.collision_pairs
            if bik.obstacles.clearance(robot.with_collision_pairs([pair]), q, []) <= 0.0
        }
        touched = {one.object_name2 for one in plan.check_for_env_collision(q)}
        alone = robot.with_collision_pairs([])
        assert touched == {name for name, ball in balls.items() if bik.obstacles.clearance(alone, q, [ball]) <= 0.0}
        found += len(pairs) + len(touched)
    assert found > 10


def test_the_gripper_is_where_it_is_said_to_be() -> None:
    plan = planner()
    beside = bik.obstacles.Sphere((ARM.fk(START[:7]) @ [0, 0.05, 0.1, 1])[:3], 0.015)
    plan.planning_world.add_object("ball", beside)
    wide = np.concatenate((START[:7], [0.04, 0.04]))
    closed = np.concatenate((START[:7], [0.0, 0.0]))
    assert plan.check_for_env_collision(closed) == []
    assert [found.link_name1 for found in plan.check_for_env_collision(wide)] == ["left_finger"]


# --- what is refused ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: planner(user_joint_names=NAMES[1:]),
            bik.InvalidInputError,
            "user_joint_names: joint 'joint1' is missing, and moves the frame 'hand'",
        ),
        (
            lambda: planner(user_link_names=["palm"]),
            bik.UnknownNameError,
            "user_link_names: no link 'palm'; links: link0, link1, link2, link3, link4, link5, link6, link7, hand, "
            "left_finger, right_finger",
        ),
        (
            lambda: planner(joint_vel_limits=[1.0]),
            bik.InvalidInputError,
            "joint_vel_limits: expected 7, one per joint of the move group, got shape (1,)",
        ),
        (
            lambda: planner().plan_pose(ABOVE, START, constraint_function=print),
            bik.InvalidInputError,
            "constraint_function: functions of one's own are not taken; give keep=, such as "
            "beetle_ik.upright(robot, tilt=0.1)",
        ),
        (
            lambda: planner().plan_pose([1, 2, 3], START),
            bik.InvalidInputError,
            "goal_pose: expected a pose with p and q, a 7-vector (x, y, z, qw, qx, qy, qz) or a matrix (4, 4), "
            "got shape (3,)",
        ),
        (
            lambda: planner().plan_pose("up", START),
            bik.InvalidInputError,
            "goal_pose: expected a pose with p and q, a 7-vector (x, y, z, qw, qx, qy, qz) or a matrix (4, 4), "
            "got 'up'",
        ),
        (
            lambda: planner().plan_qpos([], START),
            bik.InvalidInputError,
            "goal_qposes: at least one is needed, got none",
        ),
        (
            lambda: planner().plan_pose(ABOVE, np.zeros(8)),
            bik.InvalidInputError,
            "current_qpos: expected 9 joints, or the 7 of the move group, got shape (8,)",
        ),
        (
            lambda: planner().plan_pose(ABOVE, np.full(9, np.nan)),
            bik.InvalidInputError,
            "current_qpos: joint 'joint1' must be finite, got nan",
        ),
        (
            lambda: planner().planning_world.add_object("thing", object()),
            bik.InvalidInputError,
            "a object is no shape that can be read: give one of beetle_ik.obstacles, such as Mesh(vertices, faces)",
        ),
        (
            lambda: planner().pinocchio_model,
            AttributeError,
            "the Planner of beetle_ik has no 'pinocchio_model': use planner.robot.arm_at(qpos), whose fk and jacobian "
            "take the joints of the move group",
        ),
        (
            lambda: planner().robot.get_pinocchio_model(),
            AttributeError,
            "there is no Pinocchio model: use arm_at(qpos), whose fk and jacobian take the move group",
        ),
    ],
)
def test_wrong_calls_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    with pytest.raises(error) as caught:
        call()
    assert str(caught.value) == message


def test_obstacles_do_not_pass_unseen_by_a_robot_without_shapes() -> None:
    bare = planner(collision=None)
    assert bare.plan_pose(ABOVE, START)["status"] == "Success"
    bare.planning_world.add_object("blue", BLUE_BOX)
    for call in (bare.plan_pose, bare.plan_screw, bare.IK):
        with pytest.raises(bik.InvalidInputError) as caught:
            call(ABOVE, START)
        assert str(caught.value) == (
            "the robot 'gripper_arm' has no collision shapes, so it cannot keep clear of 1 obstacle: "
            'give a URDF with shapes and collision="hulls"'
        )


def test_shapes_that_are_not_read_are_told(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    lost = "<geometry><mesh filename='package://lost/hand.stl'/></geometry>"
    file.write_text(GRIPPER_ARM.replace("<geometry><sphere radius='0.045'/></geometry>", lost))
    told = "the mesh 'package://lost/hand.stl' of link 'hand' is not found: give new_package_keyword, or collision="
    with pytest.raises(bik.UrdfError, match=told):
        mplib.Planner(file, "hand")
    with pytest.warns(UserWarning, match=r"^not checked for collisions: a mesh of link 'hand'; collision=\"hulls\" "):
        mplib.Planner(file, "hand", collision="primitives")


def test_an_srdf_beside_the_file_is_found(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(GRIPPER_ARM)
    pairs = "<disable_collisions link1='link5' link2='hand'/>"
    (tmp_path / "arm.srdf").write_text(f"<robot name='gripper_arm'>{pairs}</robot>")
    plan = mplib.Planner(tmp_path / "arm.urdf", "hand")
    assert plan.srdf == tmp_path / "arm.srdf"
    assert ("link5", "hand") not in plan.robot.arm_at(START).collision_pairs


@pytest.mark.parametrize("place", ["root", "inside", "branch"])
def test_joints_are_in_the_order_of_pinocchio(place: str) -> None:
    pinocchio = pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
    for seed in range(10):
        urdf, _, _ = chain(5, place, seed)
        assert list(moving_joints(urdf)) == list(pinocchio.buildModelFromXML(urdf).names)[1:]
    assert moving_joints(GRIPPER_ARM)["joint4"] == (-3.07, -0.07)
    assert moving_joints(GRIPPER_ARM)["right_finger_joint"] == (0.0, 0.04)


# --- mplib itself -------------------------------------------------------------------------------


def test_the_calls_are_those_of_mplib() -> None:
    found = importlib.util.find_spec("mplib")
    if found is None or not found.submodule_search_locations:
        pytest.skip("mplib is not installed")
    text = (Path(found.submodule_search_locations[0]) / "planner.py").read_text(encoding="utf-8")
    (theirs,) = (node for node in ast.parse(text).body if isinstance(node, ast.ClassDef))
    left_out = {"wrap_joint_limit", "check_for_collision", "_transform_goal_to_wrt_base"}
    for call in (node for node in theirs.body if isinstance(node, ast.FunctionDef)):
        if call.name in left_out:
            continue
        ours = inspect.signature(getattr(mplib.Planner, call.name)).parameters
        wanted = [argument.arg for argument in (*call.args.args, *call.args.kwonlyargs)]
        assert [name for name in ours if name in wanted] == wanted, call.name


def test_shapes_and_poses_of_mplib_are_taken() -> None:
    theirs = pytest.importorskip("mplib", reason="mplib is not installed")
    shapes = pytest.importorskip("mplib.collision_detection.fcl", reason="mplib is not installed")
    plan, pose = planner(), theirs.Pose([0.5, 0.1, 0.2], [0.8, 0, 0, 0.6])
    np.testing.assert_allclose(Pose(pose).to_transformation_matrix(), pose.to_transformation_matrix(), atol=1e-12)
    for shape in (shapes.Box([0.1, 0.2, 0.3]), shapes.Sphere(0.1), shapes.Cylinder(0.1, 0.2), shapes.Capsule(0.1, 0.2)):
        plan.planning_world.add_object("thing", shapes.CollisionObject(shape, pose))
        (taken,) = plan.planning_world.obstacles
        ours = fcl.placed(fcl.obstacle_of(shape), Pose(pose).to_transformation_matrix())
        assert taken == ours
    whole = shapes.FCLObject("two", pose, [shapes.CollisionObject(shapes.Sphere(0.1), theirs.Pose())], [pose])
    plan.planning_world.add_object(whole)
    np.testing.assert_allclose(plan.planning_world.obstacles[-1].center, (pose * pose).p)
    assert plan.plan_pose(theirs.Pose(ABOVE[:3], ABOVE[3:]), START, use_point_cloud=False)["status"] == "Success"
