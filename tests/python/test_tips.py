"""Several tips: kinematics, targets of each, results, the command line, and refused arguments."""

import pickle
from collections.abc import Callable

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik
from beetle_ik import sim

URDF = pair_of_pandas()
TIPS = ["left_tool", "right_tool"]
PAIR = bik.Robot.from_urdf(URDF, tip=TIPS)
LEFT = bik.Robot.from_urdf(URDF, tip="left_tool")
Q = PAIR.random_configurations(60, seed=3)
POSES = PAIR.fk(Q)
BOTH = dict(zip(TIPS, POSES.swapaxes(0, 1), strict=True))


def of_row(i: int) -> dict[str, np.ndarray]:
    return {tip: poses[i] for tip, poses in BOTH.items()}


def test_tips_have_poses_and_jacobians_of_their_own() -> None:
    assert (PAIR.tips, LEFT.tips) == (TIPS, ["left_tool"])
    assert (PAIR.dof, PAIR.joint_names[:3], PAIR.joint_names[9]) == (
        16,
        ["lift", "turn", "left_joint1"],
        "right_joint1",
    )
    assert "floor to left_tool and right_tool" in repr(PAIR)
    assert (PAIR.fk(Q[0]).shape, POSES.shape) == ((2, 4, 4), (60, 2, 4, 4))
    assert (PAIR.jacobian(Q[0]).shape, PAIR.jacobian(Q).shape) == ((2, 6, 16), (60, 2, 6, 16))
    for i, tip in enumerate(TIPS):
        np.testing.assert_allclose(POSES[:, i], PAIR.fk(Q, link=tip), rtol=0, atol=1e-14)
        np.testing.assert_allclose(PAIR.jacobian(Q)[:, i], PAIR.jacobian(Q, link=tip), rtol=0, atol=1e-14)
    np.testing.assert_array_equal(POSES[:, 0], LEFT.fk(Q[:, :9]))


def test_kinematics_agree_with_pinocchio() -> None:
    pin = pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
    model = pin.buildModelFromXML(URDF)
    data = model.createData()
    entries = [model.joints[model.getJointId(name)].idx_q for name in PAIR.joint_names]
    for q in Q[:10]:
        theirs = np.empty(model.nq)
        theirs[entries] = q
        pin.computeJointJacobians(model, data, theirs)
        pin.updateFramePlacements(model, data)
        for i, tip in enumerate(TIPS):
            frame = model.getFrameId(tip)
            jacobian = pin.getFrameJacobian(model, data, frame, pin.LOCAL_WORLD_ALIGNED)[:, entries]
            np.testing.assert_allclose(PAIR.fk(q)[i], data.oMf[frame].homogeneous, rtol=0, atol=1e-12)
            np.testing.assert_allclose(PAIR.jacobian(q)[i], jacobian, rtol=0, atol=1e-12)


def test_both_hands_reach_their_poses() -> None:
    for i in range(10):
        s = bik.solve(PAIR, of_row(i))
        assert s.success, s.message
        np.testing.assert_allclose(PAIR.fk(s.q), POSES[i], rtol=0, atol=3e-6)
        assert list(s.errors) == TIPS
        assert s.position_error == max(position for position, _ in s.errors.values())
        assert s.rotation_error == max(rotation for _, rotation in s.errors.values())


def test_a_tray_in_both_hands_and_a_free_tip() -> None:
    left, right = POSES[0]
    seen = np.linalg.inv(left) @ right
    for targets in ({"left_tool": left, ("left_tool", "right_tool"): seen}, {("left_tool", "right_tool"): seen}):
        s = bik.solve(PAIR, targets)
        assert (s.success, list(s.errors)) == (True, list(targets)), s.message
        left_found, right_found = PAIR.fk(s.q)
        np.testing.assert_allclose(np.linalg.inv(left_found) @ right_found, seen, rtol=0, atol=4e-6)
    s = bik.solve(PAIR, {"right_tool": right[:3, 3]})
    assert s.success
    assert s.errors["right_tool"][0] <= 1e-6
    assert np.isnan(s.errors["right_tool"][1])


def test_tasks_and_tolerances_go_by_tip() -> None:
    s = bik.solve(
        PAIR,
        of_row(1),
        task={"right_tool": bik.tasks.Position()},
        position_tolerance={"left_tool": 1e-9, "right_tool": 1e-2},
    )
    assert s.success
    assert s.errors["left_tool"][0] <= 1e-9
    assert np.isnan(s.errors["right_tool"][1])
    everywhere = bik.solve(PAIR, of_row(1), task=bik.tasks.Position())
    assert all(np.isnan(rotation) for _, rotation in everywhere.errors.values())


def test_a_robot_with_one_tip_takes_its_name_too() -> None:
    pose = LEFT.fk(Q[0, :9])
    plain, named = bik.solve(LEFT, pose), bik.solve(LEFT, {"left_tool": pose}, position_tolerance={"left_tool": 1e-6})
    np.testing.assert_array_equal(plain.q, named.q)
    assert plain.errors == named.errors == {"left_tool": (plain.position_error, plain.rotation_error)}
    batch = bik.solve_batch(LEFT, {"left_tool": [pose, pose]})
    np.testing.assert_array_equal(batch.errors["left_tool"][0], batch.position_error)


def test_batches_keep_the_errors_of_each_tip() -> None:
    batch = bik.solve_batch(PAIR, BOTH, threads=2)
    assert batch.success.all(), batch.message
    np.testing.assert_array_equal(batch.q, bik.solve_batch(PAIR, BOTH, threads=1).q)
    np.testing.assert_array_equal(batch.q[0], bik.solve(PAIR, of_row(0)).q)
    assert [errors[0].shape for errors in batch.errors.values()] == [(60,), (60,)]
    largest = np.maximum(*(position for position, _ in batch.errors.values()))
    np.testing.assert_array_equal(batch.position_error, largest)
    assert batch[7].errors["right_tool"][0] == batch.errors["right_tool"][0][7]
    np.testing.assert_array_equal(batch[5:9].errors["left_tool"][1], batch.errors["left_tool"][1][5:9])
    again = pickle.loads(pickle.dumps(batch))
    np.testing.assert_array_equal(again.errors["left_tool"][0], batch.errors["left_tool"][0])
    assert pickle.loads(pickle.dumps(batch[0])).errors == batch[0].errors
    broken = {**BOTH, "right_tool": np.where(np.arange(60)[:, None, None] == 3, np.nan, BOTH["right_tool"])}
    skipped = bik.solve_batch(PAIR, broken, on_invalid="skip")
    assert bik.Status(skipped.status[3]) == bik.Status.INVALID
    assert np.isnan(skipped.errors["left_tool"][0][3])
    assert skipped.success.sum() == 59


def test_distinct_solutions() -> None:
    found = bik.solve_all(PAIR, of_row(2), limit=3)
    assert (len(found), found.complete) == (3, False)
    for s in found:
        assert s.errors["right_tool"][0] <= 1e-6
        np.testing.assert_allclose(PAIR.fk(s.q), POSES[2], rtol=0, atol=3e-6)
    assert pickle.loads(pickle.dumps(found))[1].errors == found[1].errors


def test_the_arms_keep_clear_of_obstacles_and_of_each_other() -> None:
    pairs = PAIR.collision_pairs
    assert any(a.startswith("left") and b.startswith("right") for a, b in pairs)
    post = bik.obstacles.Capsule((0.6, 0.0, 0.0), (0.6, 0.0, 1.6), radius=0.05)
    batch = bik.solve_batch(PAIR, BOTH, obstacles=[post])
    clear = bik.obstacles.clearance(PAIR, batch.q, [post])
    assert (clear[batch.success] >= 1e-3).all()
    assert {bik.Status(status) for status in batch.status[~batch.success]} <= {bik.Status.IN_COLLISION}
    assert batch.success.sum() >= 30
    near = bik.obstacles.nearest(PAIR, batch.q[batch.success][0], [post])
    assert near.distance == pytest.approx(clear[batch.success][0])


def test_goals_act_on_all_joints() -> None:
    start = Q[4]
    away = start * 0.9
    s = bik.solve(PAIR, of_row(4), start_q=start, goals=bik.goals.Posture(away))
    assert s.success
    assert np.linalg.norm(s.q - away) < np.linalg.norm(start - away)
    goal = bik.goals.Manipulability(tip="right_tool")
    assert repr(goal) == "goals.Manipulability(motion='pose', tip='right_tool', weight=1.0)"
    assert pickle.loads(pickle.dumps(goal)) == goal
    assert bik.solve(PAIR, of_row(4), goals=[goal, bik.goals.Centring()]).success


def test_motions_of_both_arms_keep_clear_of_obstacles_and_of_each_other() -> None:
    limits = bik.Limits(velocity=1.5, acceleration=5.0)
    post = bik.obstacles.Capsule((0.6, 0.0, 0.0), (0.6, 0.0, 1.6), radius=0.05)
    clear = bik.obstacles.clearance(PAIR, Q, [post]) > 2e-3
    first, second = Q[clear][:2]
    plan = bik.plan_point_to_point(PAIR, start_q=first, end_q=second, limits=limits, obstacles=[post])
    assert plan.success, plan.message
    t = np.linspace(0.0, plan.trajectory.duration, 200)
    assert (bik.obstacles.clearance(PAIR, plan.trajectory.at(t)[0], [post]) >= 1e-3).all()
    wanted = dict(zip(TIPS, PAIR.fk(second), strict=True))
    plan = bik.plan_point_to_point(PAIR, start_q=first, end=wanted, limits=limits, obstacles=[post])
    assert (plan.success, plan.chosen_end) == (True, 0), plan.message
    end = plan.trajectory.at(plan.trajectory.duration)[0]
    np.testing.assert_allclose(PAIR.fk(end), PAIR.fk(second), rtol=0, atol=3e-6)
    far = {"left_tool": bik.pose((9, 0, 0))}
    plan = bik.plan_point_to_point(
        PAIR, wanted, [far, {"right_tool": PAIR.fk(first)[1, :3, 3]}], limits=limits, self_collision=False
    )
    assert (plan.success, plan.chosen_end) == (True, 1), plan.message
    with pytest.raises(
        bik.InvalidInputError, match=r"^end cannot be reached: out of reach, .*tip 'left_tool': out of reach"
    ):
        bik.plan_point_to_point(PAIR, start_q=first, end=far, limits=limits)
    with pytest.raises(bik.InvalidInputError, match=r"^end: robot 'pair_of_pandas' has several tips"):
        bik.plan_point_to_point(PAIR, start_q=first, end=np.eye(4), limits=limits)
    bik.plot.plan(plan)


def test_robots_with_several_tips_are_drawn() -> None:
    figure = bik.plot.robot(PAIR, Q[0], bodies=True)
    tips = next(line for line in figure.axes[0].lines if line.get_label() == "tip")
    np.testing.assert_allclose(np.array(tips.get_data_3d()).T, PAIR.fk(Q[0])[:, :3, 3])


REFUSED = "takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as tip="
LINE = bik.paths.polyline([(0.3, 0.3, 1.0), (0.3, 0.31, 1.0)], duration=0.2)
CALLS: dict[str, Callable[[], object]] = {
    "a given solver": lambda: bik.track(PAIR, {"left_tool": LINE}, Q[0], dt=0.1, solver=bik.papers.BAS()),
    "WeightedPseudoInverse": lambda: bik.Tracker(PAIR, Q[0], dt=0.1, solver=bik.WeightedPseudoInverse()),
    "KinematicPlant": lambda: bik.KinematicPlant(PAIR),
    "plan_along_path": lambda: bik.plan_along_path(PAIR, LINE),
    "plan_point_to_point with approach, retreat or free_start": lambda: bik.plan_point_to_point(
        PAIR, start_q=Q[0], end_q=Q[1], approach=0.1
    ),
    'method="tpbso" of plan_point_to_point': lambda: bik.plan_point_to_point(
        PAIR, start_q=Q[0], end_q=Q[1], method="tpbso"
    ),
    "the objective 'tip_travel' of plan_point_to_point": lambda: bik.plan_point_to_point(
        PAIR, start_q=Q[0], end_q=Q[1], objective="tip_travel"
    ),
    "MujocoPlant": lambda: sim.MujocoPlant(PAIR),
    "self_motion": lambda: bik.self_motion(PAIR, POSES[0, 0]),
    "manipulability": lambda: PAIR.manipulability(Q[0]),
    "with_tool": lambda: PAIR.with_tool(np.eye(4)),
    "with_errors": lambda: PAIR.with_errors(length=1e-3),
    "with_capsules(radius=...)": lambda: PAIR.with_capsules(radius=0.05),
    "the goal LinkManipulability": lambda: bik.solve(PAIR, of_row(0), goals=bik.goals.LinkManipulability()),
}


@pytest.mark.parametrize("call", CALLS)
def test_calls_for_one_tip_say_so(call: str) -> None:
    with pytest.raises(bik.InvalidInputError) as told:
        CALLS[call]()
    assert str(told.value) == f"{call} {REFUSED}"


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: bik.solve(PAIR, {}),
            bik.InvalidInputError,
            "target: the dict is empty; name one tip at least: 'left_tool', 'right_tool'",
        ),
        (
            lambda: bik.solve(PAIR, np.eye(4)),
            bik.InvalidInputError,
            "target: robot 'pair_of_pandas' has several tips, 'left_tool', 'right_tool': give a dict, such as "
            "{'left_tool': target}",
        ),
        (
            lambda: bik.solve(PAIR, {"left_tol": np.eye(4)}),
            bik.UnknownNameError,
            "robot 'pair_of_pandas' has no tip 'left_tol' (did you mean 'left_tool'?); its tips: left_tool, right_tool",
        ),
        (
            lambda: bik.solve(LEFT, {"right_tool": np.eye(4)}),
            bik.UnknownNameError,
            "robot 'pair_of_pandas' has no tip 'right_tool' (did you mean 'left_tool'?); its tips: left_tool",
        ),
        (
            lambda: bik.solve(PAIR, {"left_tool": np.eye(3)}),
            bik.InvalidInputError,
            "target of 'left_tool': expected a pose (4, 4) or a position (3,), got shape (3, 3)",
        ),
        (
            lambda: bik.solve(PAIR, {3: np.eye(4)}),
            bik.InvalidInputError,
            "keys of target are names of tips, or pairs of them (from, of), got 3",
        ),
        (
            lambda: bik.solve(PAIR, {("left_tool", "left_tool"): np.eye(4)}),
            bik.InvalidInputError,
            "tip 'left_tool' cannot be seen from itself: name two tips",
        ),
        (
            lambda: bik.solve(PAIR, {"left_tool": np.eye(4)}, task={"right_tool": bik.tasks.Position()}),
            bik.InvalidInputError,
            "task names 'right_tool', which has no target",
        ),
        (
            lambda: bik.solve(PAIR, of_row(0), position_tolerance={"left_tool": -1.0}),
            bik.InvalidInputError,
            "position_tolerance must be positive, got -1",
        ),
        (
            lambda: bik.solve_batch(PAIR, {"left_tool": BOTH["left_tool"], "right_tool": BOTH["right_tool"][:3]}),
            bik.InvalidInputError,
            "targets of task 1: expected 60 as for the first tip, got 3",
        ),
        (
            lambda: bik.Robot.from_urdf(URDF, tip=[]),
            bik.InvalidInputError,
            "tip: the list is empty; name one link at least, or leave it out",
        ),
        (
            lambda: bik.Robot.from_urdf(URDF, tip=["left_tool", "left_link3"]),
            bik.InvalidInputError,
            "robot 'pair_of_pandas': tip 'left_link3' lies on the chain to tip 'left_tool': take one of them",
        ),
        (
            lambda: bik.Robot.from_urdf(URDF, tip=["left_tool", "left_tool"]),
            bik.InvalidInputError,
            "robot 'pair_of_pandas': tip 'left_tool' lies on the chain to tip 'left_tool': take one of them",
        ),
    ],
    ids=lambda case: case[:50] if isinstance(case, str) else "",
)
def test_mistakes_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    with pytest.raises(bik.BeetleIkError) as told:
        call()
    assert (type(told.value), str(told.value)) == (error, message)


def test_a_robot_with_several_tips_comes_back() -> None:
    assert pickle.loads(pickle.dumps(PAIR)) == PAIR


def test_mujoco_models_take_several_tips() -> None:
    pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    arm = '<body name="{0}"><joint axis="0 0 1"/><geom size="0.1"/><site name="{0}_end" pos="1 0 0"/></body>'
    model = f"<mujoco><worldbody>{arm.format('a')}{arm.format('b')}</worldbody></mujoco>"
    robot = bik.Robot.from_mjcf(model, tip=["a_end", "b"])
    assert robot.tips == ["a_end", "b"]
    np.testing.assert_allclose(robot.fk([np.pi / 2, 0.0])[:, :3, 3], [[0, 1, 0], [0, 0, 0]], rtol=0, atol=1e-12)
