"""Planning along a path with redundancy and timing found together, the default of `plan_along_path`."""

import re

import numpy as np
import pytest

import beetle_ik as bik

ACCELERATION = bik.Limits(acceleration=10.0)
FREE = bik.Limits(lower=-np.inf, upper=np.inf, velocity=np.pi, acceleration=4 * np.pi)


def pentagram() -> np.ndarray:
    """51 points of Wang et al. (2019)'s star about (1, 1)."""
    angles = np.pi / 2 + 4 * np.pi * np.arange(6) / 5
    u = np.linspace(0, 5, 51)
    x, y = (np.interp(u, range(6), 1 + 0.5 * wave(angles)) for wave in (np.cos, np.sin))
    return np.column_stack((x, y, 0 * u))


def circle(poses: bool) -> np.ndarray:
    """41 points or poses in front of a seven-joint arm."""
    angles = np.linspace(0, 2 * np.pi, 41)
    points = np.column_stack((0.6 + 0 * angles, 0.2 * np.cos(angles), 0.5 + 0.2 * np.sin(angles)))
    return np.array([bik.pose(point, rpy=(0, np.pi / 2, 0)) for point in points]) if poses else points


def test_planar_arm_is_much_faster_than_in_uniform_time() -> None:
    plan = bik.plan_along_path(bik.Robot.planar([1, 1, 1]), pentagram(), limits=FREE)
    assert plan.success
    assert plan.cost == plan.trajectory.duration < 5.501 / 1.9  # the optimum in uniform time takes 5.501 s
    assert np.all(plan.trajectory.max_velocity() <= np.pi * (1 + 1e-9))
    assert np.all(plan.trajectory.max_acceleration() <= 4 * np.pi * (1 + 1e-9))


@pytest.mark.parametrize("poses", [True, False])
def test_seven_joints_follow_a_circle(poses: bool) -> None:
    robot = bik.Robot.named("iiwa14")
    plan = bik.plan_along_path(robot, circle(poses), limits=ACCELERATION, stop=bik.Stop(max_evaluations=300))
    assert plan.success, plan.message
    _, q, _, _ = plan.trajectory.sample(0.01)
    tips = robot.fk(q)
    radius = np.hypot(tips[:, 1, 3], tips[:, 2, 3] - 0.5)
    # The accuracy is that from the chords between the points, which leave the circle by 0.4 mm.
    np.testing.assert_allclose(radius, 0.2, atol=plan.accuracy + 5e-4)
    np.testing.assert_allclose(tips[:, 0, 3], 0.6, atol=plan.accuracy)
    assert np.all((robot.lower <= q) & (q <= robot.upper))
    if poses:
        np.testing.assert_allclose(tips[:, :3, :3], np.broadcast_to(circle(True)[0, :3, :3], (len(q), 3, 3)), atol=0.03)


def test_the_star_is_kept_to_everywhere_and_its_corners_are_met() -> None:
    robot = bik.Robot.planar([1, 1, 1])
    star = bik.paths.pentagram((1.0, 1.0, 0.0), 5.0, radius=0.5)
    plan = bik.plan_along_path(robot, star, limits=FREE, accuracy=5e-4, stop=bik.Stop(max_evaluations=150))
    assert plan.success, plan.message
    assert plan.accuracy <= 5e-4
    tip = robot.fk(plan.trajectory.sample(0.002)[1])[:, :3, 3]
    corners = star.position(np.arange(6.0))
    edges = np.diff(corners, axis=0)
    share = np.clip(np.einsum("tek,ek->te", tip[:, None] - corners[:-1], edges) / (edges**2).sum(axis=1), 0, 1)
    away = np.linalg.norm(corners[:-1] + share[:, :, None] * edges - tip[:, None], axis=2).min(axis=1)
    assert away.max() <= plan.accuracy + 1e-9
    assert np.linalg.norm(tip[:, None] - corners, axis=2).min(axis=0).max() < 1e-4


def test_a_function_of_time_is_followed_with_its_orientation() -> None:
    robot = bik.Robot.named("iiwa14")
    path = bik.paths.from_function(lambda t: (0.6, 0.2 * np.sin(t), 0.5 + 0.1 * np.sin(2 * t)), 2 * np.pi)
    path = path.with_orientation(lambda t: bik.pose((0, 0, 0), rpy=(0, np.pi / 2 + 0.1 * np.sin(t), 0))[:3, :3])
    plan = bik.plan_along_path(robot, path, limits=ACCELERATION, stop=bik.Stop(max_evaluations=60))
    assert plan.success, plan.message
    assert plan.reference.shape == (1001, 3)
    assert plan.accuracy < 4e-4


def test_same_seed_same_bits_and_a_given_start_is_kept() -> None:
    robot = bik.Robot.named("iiwa14")
    start = bik.solve(robot, circle(False)[0]).q
    plans = [
        bik.plan_along_path(
            robot, circle(False), start_q=start, limits=ACCELERATION, seed=3, stop=bik.Stop(max_evaluations=60)
        )
        for _ in range(2)
    ]
    np.testing.assert_array_equal(plans[0].trajectory.coefficients, plans[1].trajectory.coefficients)
    np.testing.assert_array_equal(plans[0].trajectory.q[0], start)


def test_a_seam_whose_quickest_motion_grazes_a_position_limit() -> None:
    seam = bik.paths.polyline([[0.5, -0.2, 0.4], [0.5, 0.2, 0.4], [0.6, 0.25, 0.4]], duration=5.0)
    downwards = seam.with_orientation(bik.pose((0, 0, 0), rpy=(np.pi, 0, 0))[:3, :3])
    plan = bik.plan_along_path(bik.Robot.named("iiwa14"), downwards, limits=bik.Limits(acceleration=4.0))
    assert plan.success, plan.message


def test_an_arm_without_redundancy_is_timed() -> None:
    plan = bik.plan_along_path(bik.Robot.named("ur5e"), circle(True), limits=ACCELERATION)
    assert plan.success, plan.message
    assert plan.evaluations == 1


def test_a_tolerance_is_used_and_kept() -> None:
    robot = bik.Robot.named("ur5e")
    path = circle(True)
    task = bik.tasks.Pose(tolerance=[0.003, 0.003, 0.003, 0.2, 0.2, 0.3])
    exact = bik.plan_along_path(robot, path, limits=ACCELERATION)
    plan = bik.plan_along_path(robot, path, task=task, limits=ACCELERATION)
    assert plan.success, plan.message
    assert plan.cost < 0.92 * exact.cost
    tips = robot.fk(plan.trajectory.sample(0.01)[1])
    upright, steps = path[0, :3, :3], np.linspace(0, 40, 4001)
    points = np.column_stack([np.interp(steps, range(41), path[:, k, 3]) for k in range(3)])
    apart = np.abs((points - tips[:, None, :3, 3]) @ upright)
    assert (apart <= 0.003 + 1e-5).all(axis=2).any(axis=1).all()
    turns = upright.T @ tips[:, :3, :3]
    sines = 0.5 * np.stack([turns[:, i, k] - turns[:, k, i] for i, k in ((2, 1), (0, 2), (1, 0))], axis=1)
    size = np.linalg.norm(sines, axis=1, keepdims=True)
    assert (np.abs(sines * np.arcsin(size) / size) <= np.array([0.2, 0.2, 0.3]) + 1e-5).all()
    with pytest.raises(bik.InvalidInputError, match=r"^accuracy .* is more than the smallest tolerance of the task"):
        bik.plan_along_path(robot, path, task=task, limits=ACCELERATION, accuracy=0.01)


def test_a_motion_whose_joints_jump_at_a_singularity_does_not_end_the_search() -> None:
    # Knots were added at the jump until its motion took 1e10 s, which raised an error.
    robot = bik.Robot.named("gen3")
    first = np.array([2.0978, -1.8765, 0.6394, -1.1239, -1.234, 0.7854, 0.1977])
    last = np.array([1.371, -0.8191, 0.2259, 0.1425, -0.812, 0.7854, -0.049])
    limits, stop = bik.Limits(velocity=1.0, acceleration=5.0), bik.Stop(max_evaluations=1)
    task = bik.tasks.Pose(tolerance=[1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3])
    poses = robot.fk(np.linspace(first, last, 18))
    plan = bik.plan_along_path(robot, poses, task=task, limits=limits, stop=stop)
    assert plan.success, plan.message


def test_mistakes_are_named() -> None:
    robot = bik.Robot.named("iiwa14")
    message = (
        "method=\"timed\" cannot honour infinite acceleration limits: joint 'joint_a1' could start at any speed; give "
        "acceleration limits"
    )
    with pytest.raises(bik.UnsupportedLimit, match=f"^{re.escape(message)}$"):
        bik.plan_along_path(robot, circle(False))
    far = circle(False) + np.array([3.0, 0.0, 0.0])
    with pytest.raises(bik.InvalidInputError, match=r"^points 0 to \d+ of the path cannot be reached: the nearest"):
        bik.plan_along_path(robot, far, limits=ACCELERATION)
    with pytest.raises(bik.InfeasibleError, match=r"^infeasible: start_q has the tip .* m from the path's first point"):
        bik.plan_along_path(robot, circle(False), start_q=np.full(7, 0.5), limits=ACCELERATION)


def test_poses_sampled_from_a_curve_are_followed_for_many_turns() -> None:
    """Between samples 0.3 rad apart the shortest turn is up to 1e-2 rad off the curve, more than the positions."""
    turn, height = np.linspace(0.0, 60.0 * np.pi, 600), np.linspace(0.0, 0.2, 600)
    out = np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
    tool = -np.array([0.0, 0.0, 1.0]) - 0.5 * out
    tool /= np.linalg.norm(tool, axis=1, keepdims=True)
    across = np.array([1.0, 0.0, 0.0]) - tool[:, :1] * tool
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    poses = np.tile(np.eye(4), (len(turn), 1, 1))
    poses[:, :3, :3] = np.stack([across, np.cross(tool, across), tool], axis=2)
    poses[:, :3, 3] = np.array([0.45, 0.0, 0.05]) + 0.06 * out + height[:, None] * np.array([0.0, 0.0, 1.0])
    robot = bik.Robot.named("ur5e").with_tool(bik.pose([0.0, 0.0, 0.10]))
    plan = bik.plan_along_path(robot, poses, limits=bik.Limits(acceleration=5.0))
    assert plan.success, plan.message
    q = plan.trajectory.at(np.linspace(0.0, plan.trajectory.duration, 2000))[0]
    reached = robot.fk(q)
    # The direction of the tool: a cone about the vertical.
    assert np.abs(reached[:, 2, 2] + 1.0 / np.hypot(1.0, 0.5)).max() < 1e-2
    radius = np.hypot(reached[:, 0, 3] - 0.45, reached[:, 1, 3])
    assert np.abs(radius - 0.06).max() < 2e-3
