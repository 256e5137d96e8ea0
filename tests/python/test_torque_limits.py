"""Limits of joint torques, judged by Pinocchio at many instants of each motion."""

import pickle
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import beetle_ik as bik

pin = pytest.importorskip("pinocchio")
api: Any = bik  # wrong calls on purpose

JOINT = """<joint name="j{0}" type="{1}"><parent link="l{0}"/><child link="l{2}"/><origin xyz="{3}" rpy="{4}"/>
<axis xyz="{5}"/><limit lower="-3" upper="3" velocity="3" effort="{6}"/></joint>"""
LINK = """<link name="l{0}"><inertial><origin xyz="{1}"/><mass value="{2}"/>
<inertia ixx="0.02" iyy="0.03" izz="0.015" ixy="0.001" ixz="0" iyz="-0.002"/></inertial></link>"""
ARM = (
    '<robot name="heavy">'
    + LINK.format(0, "0 0 0", 5)
    + JOINT.format(0, "revolute", 1, "0 0 0.3", "0 0 0", "0 0 1", 60)
    + LINK.format(1, "0 0 0.1", 3)
    + JOINT.format(1, "revolute", 2, "0 0.05 0.1", "0.2 0 0", "0 1 0", 70)
    + LINK.format(2, "0.2 0 0.02", 2.5)
    + JOINT.format(2, "revolute", 3, "0.45 0 0", "0 0 0.1", "0 1 0", 35)
    + LINK.format(3, "0.15 0 0", 1.5)
    + JOINT.format(3, "prismatic", 4, "0.2 0 0", "0 0.3 0", "1 0 0", 60)
    + LINK.format(4, "0.02 0.01 0", 1.0)
    + JOINT.format(4, "revolute", 5, "0.1 0 0", "0 0 0", "1 0 0", 5)
    + LINK.format(5, "0.03 0.02 0", 0.5)
    + "</robot>"
)
ROBOT = bik.Robot.from_urdf(ARM)
MODEL = pin.buildModelFromXML(ARM)
MOTORS = ROBOT.torque_limit


def limits(torque: Any = None, **others: Any) -> bik.Limits:
    others = {"velocity": 6.0, "acceleration": 60.0, "lower": -2.0, "upper": 2.0} | others
    return bik.Limits(torque=torque, **others)


def largest(trajectory: bik.Trajectory, model: Any = MODEL, samples: int = 3_000) -> np.ndarray:
    """Largest torque of each joint (N m, N)."""
    data = model.createData()
    at = zip(*trajectory.at(np.linspace(0, trajectory.duration, samples)), strict=True)
    return np.max([np.abs(pin.rnea(model, data, q, qd, qdd)) for q, qd, qdd in at], axis=0)


def timed(path: np.ndarray, motors: np.ndarray, jerk: float | None = None) -> bik.Trajectory | None:
    """The fastest motion; None where the path cannot be held."""
    try:
        return bik.time_optimal(path, limits(motors, jerk=jerk), robot=ROBOT)
    except bik.InfeasibleError as error:
        if "to hold the arm" not in str(error):
            raise
        return None


def waypoints(rng: np.random.Generator) -> np.ndarray:
    """Waypoints that the motors can hold, drawn from round numbers as often as from others."""
    rows: list[np.ndarray] = []
    while len(rows) < 4:
        q = rng.choice([rng.uniform(-1.5, 1.5, 5), rng.choice([-np.pi / 2, -1, 0, 0.5, 1, np.pi / 2], 5)])
        q[3] = np.clip(q[3], 0, 0.3)
        if (np.abs(ROBOT.torques(q)) < 0.8 * MOTORS).all():
            rows.append(q)
    return np.array(rows)


@pytest.mark.parametrize("jerk", [None, 300.0])
def test_torques_are_kept_at_every_instant_and_where_they_bind_reached(jerk: float | None) -> None:
    rng, bound = np.random.default_rng(4), 0
    for _ in range(8):
        path = waypoints(rng)
        motion = timed(path, MOTORS, jerk)
        if motion is None:
            continue
        free = bik.time_optimal(path, limits(jerk=jerk), robot=ROBOT)
        share = np.max(largest(motion) / MOTORS)
        assert share <= 1 + 1e-9
        assert motion.duration >= free.duration * (1 - 2e-3)
        if np.max(largest(free) / MOTORS) > 1.02:
            bound += 1
            assert share > 0.97, share
    assert bound >= 3


def test_looser_limits_are_never_slower() -> None:
    rng = np.random.default_rng(5)
    for _ in range(4):
        path = waypoints(rng)
        motions = [timed(path, factor * MOTORS) for factor in (1.0, 1.25, 2.0, 10.0, np.inf)]
        durations = [np.inf if motion is None else motion.duration for motion in motions]
        assert all(later <= earlier * (1 + 1e-3) for earlier, later in pairwise(durations))
        assert durations[-1] == bik.time_optimal(path, limits(), robot=ROBOT).duration


def test_a_payload_slows_a_motion_and_gravity_may_come_from_anywhere() -> None:
    path = waypoints(np.random.default_rng(6))
    loaded = ROBOT.with_payload(1.0, center=(0.0, 0.0, 0.05))
    motors = np.maximum(1.4 * MOTORS, 20)
    light = bik.time_optimal(path, limits(motors), robot=ROBOT)
    heavy = bik.time_optimal(path, limits(motors), robot=loaded)
    assert heavy.duration >= light.duration
    assert (np.abs(loaded.torques(*heavy.at(np.linspace(0, heavy.duration, 3000)))) <= motors * (1 + 1e-9)).all()
    tilted = ROBOT.with_gravity((3.0, -2.0, 4.0))
    motion = bik.time_optimal(path, limits(motors), robot=tilted)
    assert (np.abs(tilted.torques(*motion.at(np.linspace(0, motion.duration, 3000)))) <= motors * (1 + 1e-9)).all()


@pytest.mark.parametrize("jerk", [None, 300.0])
def test_friction_counts_where_it_acts_against_the_motion(jerk: float | None) -> None:
    rubbing = bik.Robot.from_urdf(ARM.replace("<limit", '<dynamics damping="1.5" friction="0.7"/><limit'))
    rng, slower = np.random.default_rng(8), 0
    for _ in range(5):
        path = waypoints(rng)
        motors = np.maximum(1.6 * np.abs(ROBOT.torques(path)).max(axis=0), 12)
        motion, free = (bik.time_optimal(path, limits(motors, jerk=jerk), robot=robot) for robot in (rubbing, ROBOT))
        t = np.linspace(0, motion.duration, 3000)
        assert (np.abs(rubbing.torques(*motion.at(t))) <= motors * (1 + 1e-9)).all()
        assert (np.abs(ROBOT.torques(*motion.at(t))) <= motors * (1 + 1e-9)).all()
        assert motion.duration >= free.duration * (1 - 1e-3)
        slower += motion.duration > 1.01 * free.duration
    assert slower


def test_a_path_that_cannot_be_held_is_refused_with_place_and_joint() -> None:
    stretched = [[0, -1.2, 0, 0, 0], [0, 0, 0, 0, 0], [0, 1.0, 0, 0, 0]]
    expected = r"at s = .* of the path joint 'j1' needs .* N m to hold the arm, its limit is 20.00 N m"
    with pytest.raises(bik.InfeasibleError, match=expected):
        bik.time_optimal(stretched, limits([60, 20, 35, 60, 5]), robot=ROBOT)


def test_planned_motions_keep_torques_and_go_round_what_cannot_be_held() -> None:
    motors = np.array([60.0, 22.0, 35.0, 60.0, 5.0])
    start, end = [0.0, -1.5, 0.0, 0.0, 0.0], [0.5, 1.6, 0.0, 0.0, 0.0]
    assert np.max(np.abs(ROBOT.torques(np.linspace(start, end, 200))) / motors) > 1  # on the straight way
    for jerk in (None, 500.0):
        plan = bik.plan_point_to_point(ROBOT, start_q=start, end_q=end, limits=limits(motors, jerk=jerk))
        assert plan.success, plan.message
        assert plan.violations == []
        assert np.max(largest(plan.trajectory) / motors) <= 1 + 1e-9
        slower = plan.retime(limits(motors * 1.01, velocity=0.5, jerk=jerk))
        assert np.max(largest(slower.trajectory) / motors) <= 1.01 + 1e-9


def test_an_end_that_cannot_be_held_is_refused_by_joint_and_torque() -> None:
    with pytest.raises(
        bik.InfeasibleError,
        match=r"^infeasible: at end_q joint 'j1' needs 23.57 N m to hold the arm, its limit is 20.00",
    ):
        bik.plan_point_to_point(
            ROBOT, start_q=[0, -1.5, 0, 0, 0], end_q=[0, 0, 0, 0, 0], limits=limits([60, 20, 35, 60, 5])
        )


def test_along_a_path_and_in_programs_torques_are_kept() -> None:
    arm = ROBOT
    q = [0.1, -0.8, 1.2, 0.1, 0.0]
    motors = np.maximum(1.05 * np.abs(arm.torques(q)), 12)
    here = arm.fk(q)
    points = here[:3, 3] + np.linspace(0, 0.1, 30)[:, None] * [0.0, 1.0, 0.3]
    plan = bik.plan_along_path(
        arm, points, start_q=q, limits=limits(1.3 * motors, velocity=3.0), task=bik.tasks.Position()
    )
    assert plan.success, plan.message
    assert np.max(largest(plan.trajectory) / (1.3 * motors)) <= 1 + 1e-9


def test_along_a_path_postures_are_chosen_that_motors_can_hold() -> None:
    panda = bik.Robot.named("panda").with_payload(3.0)
    acceleration = [15, 7.5, 10, 12.5, 15, 20, 20]
    rng = np.random.default_rng(1)
    planned = 0
    for _ in range(14):
        start = panda.fk(rng.uniform(0.6 * panda.lower, 0.6 * panda.upper))
        path = np.repeat(start[np.newaxis], 20, axis=0)
        path[:, :3, 3] += np.linspace(0, 1, 20)[:, np.newaxis] * [0, 0.15, 0.05]
        try:
            free = bik.plan_along_path(panda, path, limits=bik.Limits(acceleration=acceleration))
        except bik.InvalidInputError:  # out of reach
            continue
        postures, *_ = free.trajectory.at(np.linspace(0, free.trajectory.duration, 100))
        hold = np.max(np.abs(panda.torques(postures)), axis=0)
        motors = panda.torque_limit.copy()
        weakest = int(np.argmax(hold / motors))
        motors[weakest] = 0.9 * hold[weakest]
        try:
            plan = bik.plan_along_path(panda, path, limits=bik.Limits(acceleration=acceleration, torque=motors))
        except bik.InfeasibleError:
            continue
        assert plan.success, plan.message
        needed = np.abs(plan.torques(np.linspace(0, plan.trajectory.duration, 1000)))
        assert np.max(needed - motors) <= 1e-9
        planned += 1
    assert planned >= 3


PANDA = bik.Robot.named("panda").with_payload(3.0, center=(0, 0, 0.05))
RATED = [15, 7.5, 10, 12.5, 15, 20, 20]


def test_joint_moves_of_programs_go_round_what_cannot_be_held() -> None:
    motors = np.array([60.0, 22.0, 35.0, 60.0, 5.0])
    start, end = [0.0, -1.5, 0.0, 0.0, 0.0], [0.5, 1.6, 0.0, 0.0, 0.0]
    plan = bik.plan_moves(ROBOT, [bik.moves.Joints(end)], start_q=start, limits=limits(motors))
    assert plan.success, plan.message
    assert np.max(largest(plan.trajectory) / motors) <= 1 + 1e-9


def test_breaks_leave_out_what_cannot_be_held() -> None:
    here = PANDA.fk([0, -0.5, 0, -2.2, 0, 1.8, 0.8])
    path = np.array([bik.pose([x, 0, 0]) @ here for x in np.linspace(0, 0.3, 40)])
    given = bik.Limits(acceleration=RATED, torque=0.5 * PANDA.torque_limit)
    with pytest.raises(bik.InfeasibleError, match=r"joint 'panda_joint2' needs .* N m to hold the arm"):
        bik.plan_along_path(PANDA, path, limits=given)
    plan = bik.plan_along_path(PANDA, path, limits=given, breaks=True)
    assert plan.success, plan.message
    (only,) = plan.breaks
    assert 5 < only.at < 39
    assert only.until == 39
    assert "joint 'panda_joint2' needs" in only.reason
    share = np.abs(plan.torques(np.linspace(0, plan.trajectory.duration, 2000))) / given.torque
    assert share.max() <= 1 + 1e-9


def test_a_start_velocity_is_braked_as_mildly_as_the_motors_need() -> None:
    motors = 0.7 * PANDA.torque_limit
    given = bik.Limits(acceleration=RATED, torque=motors)
    q = [-1.742, -0.075, 2.271, -1.437, -2.338, 1.821, 1.012]
    end = np.add(q, [0.2, 0.1, 0, 0.1, 0, 0, 0])
    qd = [0, 0, 0, -1.64, 0, 1.25, 0]
    plan = bik.plan_point_to_point(PANDA, start_q=q, end_q=end, start_qd=qd, limits=given)
    assert plan.success, plan.message
    share = np.abs(plan.torques(np.linspace(0, plan.trajectory.duration, 2000))) / motors
    assert share.max() <= 1 + 1e-9
    np.testing.assert_allclose(plan.trajectory.at(0.0)[1], qd)
    expected = r"in the easiest stop found, torque of joint 'panda_joint2' is .* N m, allowed 60.90 N m"
    falling = [0, 2.0, 0, 2.0, 0, 0, 0]
    with pytest.raises(bik.InfeasibleError, match=expected):
        bik.plan_point_to_point(PANDA, start_q=[0, 0.3, 0, -1.6, 0, 1.8, 0.8], end_q=q, start_qd=falling, limits=given)


def test_calls_that_cannot_keep_torques_refuse_them_by_name() -> None:
    given = limits(MOTORS)
    with pytest.raises(bik.UnsupportedLimit, match="torque"):
        bik.solve(ROBOT, [0.4, 0, 0.5], limits=bik.Limits(torque=1.0))
    with pytest.raises(bik.UnsupportedLimit, match="torque"):
        bik.time_optimal([[0, 0], [1, 1]], bik.Limits(acceleration=1.0, torque=1.0))
    with pytest.raises(bik.UnsupportedLimit, match="torque"):
        bik.state_to_state([0] * 5, [0.1] * 5, given, robot=ROBOT)
    with pytest.raises(bik.InvalidInputError, match="no link has a mass"):
        bik.time_optimal([[0, 0], [1, 1]], bik.Limits(acceleration=1.0, torque=1.0), robot=bik.Robot.planar([1, 1]))


def test_limits_show_compare_and_pickle_their_torques() -> None:
    given = bik.Limits(torque=[1.0, 2.0])
    assert repr(given) == "Limits(torque=[1, 2])" or repr(given) == "Limits(torque=[1.0, 2.0])"
    assert pickle.loads(pickle.dumps(given)) == given
    assert given != bik.Limits(torque=1.0)
    assert hash(given) == hash(bik.Limits(torque=[1.0, 2.0]))
    np.testing.assert_array_equal(given.torque, [1, 2])
    for value, message in ((0.0, "torque limit is 0"), ([1.0, -2.0], "torque limit of joint 2 is -2")):
        with pytest.raises(bik.LimitError, match=message):
            bik.Limits(torque=value)
    with pytest.raises(bik.InvalidInputError, match="torque limit"):
        api.Limits(torque="much")
