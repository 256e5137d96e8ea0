"""Motions within jerk limits: state to state, plans with other limits, approaches onto moving paths, exports."""

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import beetle_ik as bik
from beetle_ik.cli.app import app

LIMITS = bik.Limits(velocity=1.5, acceleration=5.0, jerk=50.0)
HOME = np.array([0.0, -0.5, 0.0, -2.0, 0.0, 1.5, 0.8])
THERE = HOME + np.array([0.6, 0.2, -0.3, 0.4, 0.0, -0.2, 0.5])
CIRCLE = bik.paths.circle((0.4, 0.2, 0.4), diameter=0.3, duration=5.0)


def test_a_motion_from_state_to_state_ends_there_and_keeps_the_limits() -> None:
    rng = np.random.default_rng(1)
    for _ in range(50):
        qd0, qd1 = rng.uniform(-1.0, 1.0, (2, 7))
        qdd0, qdd1 = rng.uniform(-2.0, 2.0, (2, 7))
        motion = bik.state_to_state(HOME, THERE, LIMITS, start_qd=qd0, start_qdd=qdd0, end_qd=qd1, end_qdd=qdd1)
        for t, state in ((0.0, (HOME, qd0, qdd0)), (motion.duration, (THERE, qd1, qdd1))):
            np.testing.assert_allclose(motion.at(t), state, atol=1e-10)
        assert np.all(motion.max_velocity() <= 1.5 * (1 + 1e-9))
        assert np.all(motion.max_acceleration() <= 5.0 * (1 + 1e-9))
        assert np.all(motion.max_jerk() <= 50.0 * (1 + 1e-9))


def test_no_motion_takes_longer_than_that_of_ruckig() -> None:
    ruckig = pytest.importorskip("ruckig")
    rng = np.random.default_rng(2)
    for _ in range(300):
        given = ruckig.InputParameter(7)
        given.current_position, given.target_position = rng.uniform(-2.0, 2.0, (2, 7))
        given.current_velocity, given.target_velocity = rng.uniform(-1.2, 1.2, (2, 7))
        given.current_acceleration, given.target_acceleration = rng.uniform(-3.0, 3.0, (2, 7))
        given.max_velocity, given.max_acceleration, given.max_jerk = [1.5] * 7, [5.0] * 7, [50.0] * 7
        theirs = ruckig.Trajectory(7)
        assert ruckig.Ruckig(7).calculate(given, theirs) == ruckig.Result.Working
        ours = bik.state_to_state(
            given.current_position,
            given.target_position,
            LIMITS,
            start_qd=given.current_velocity,
            start_qdd=given.current_acceleration,
            end_qd=given.target_velocity,
            end_qdd=given.target_acceleration,
        )
        assert ours.duration <= theirs.duration * (1 + 1e-6)


def test_mistakes_are_named() -> None:
    with pytest.raises(bik.InvalidInputError, match=r"^end_q: expected 7 joints, got 3$"):
        bik.state_to_state(HOME, THERE[:3], LIMITS)
    with pytest.raises(bik.InvalidInputError, match=r"^start_qd must be finite, but joint 'q2' is NaN$"):
        bik.state_to_state(HOME, THERE, LIMITS, start_qd=[0.0, np.nan, 0.0, 0.0, 0.0, 0.0, 0.0])
    with pytest.raises(bik.UnsupportedLimit, match=r"^state_to_state cannot honour time-varying velocity limits"):
        bik.state_to_state(HOME, THERE, bik.Limits(velocity=bik.Sinusoid(mean=1, amplitude=0.1, angular_frequency=1)))
    with pytest.raises(bik.InfeasibleError, match=r"beyond its upper limit"):
        bik.state_to_state([0.98], [0.5], bik.Limits(upper=1.0, acceleration=4.0), start_qd=[1.0])


def test_a_retimed_plan_keeps_its_path_and_survives_pickling() -> None:
    panda = bik.Robot.named("panda")
    plan = bik.plan_point_to_point(panda, start_q=HOME, end_q=THERE, limits=bik.Limits(acceleration=5.0))
    slow = plan.retime(bik.Limits(velocity=0.5, acceleration=2.0, jerk=20.0))
    assert slow.success
    assert slow.cost == slow.trajectory.duration > plan.cost
    assert np.all(slow.trajectory.max_jerk() <= 20.0)
    share = np.linspace(0.0, 1.0, 50)
    here, there = (motion.at(share * motion.duration)[0] for motion in (plan.trajectory, slow.trajectory))
    np.testing.assert_allclose(here, there, atol=1e-12)
    np.testing.assert_array_equal(slow.limits.jerk, 20.0)

    says = r"^limits must be a Limits, such as Limits\(velocity=1.5, acceleration=5.0\), got 3$"
    for call in (plan.retime, lambda limits: bik.state_to_state(HOME, THERE, limits)):
        with pytest.raises(TypeError, match=says):
            call(3)  # type: ignore[arg-type, operator]

    along = bik.plan_along_path(bik.Robot.named("ur5e"), CIRCLE, limits=bik.Limits(acceleration=5.0))
    again = pickle.loads(pickle.dumps(along)).retime(bik.Limits(acceleration=5.0, jerk=50.0))
    assert np.all(again.trajectory.max_jerk() <= 50.0)


def test_a_plan_begins_at_the_given_velocity() -> None:
    panda, qd = bik.Robot.named("panda"), np.array([0.2, 0.1, -0.3, 0.2, 0.1, 0.0, 0.4])
    limits = bik.Limits(acceleration=5.0, jerk=50.0)
    plan = bik.plan_point_to_point(panda, start_q=HOME, end_q=THERE, start_qd=qd, limits=limits)
    assert plan.success
    np.testing.assert_allclose(plan.trajectory.at(0.0)[1], qd, atol=1e-12)


def test_an_eased_track_exports_what_was_commanded(tmp_path: Path) -> None:
    robot = bik.Robot.named("ur5e")
    limits = bik.Limits(acceleration=5.0)
    result = bik.track(robot, CIRCLE, dt=0.01, limits=limits, position_tolerance=1e-5, ease=True)
    assert result.success, result.message
    trajectory = result.trajectory
    assert 0 < trajectory.max_acceleration().max() <= 5.0 * (1 + 1e-9)
    np.testing.assert_allclose(trajectory.at(result.time)[0], result.q, atol=5.0 * 0.01**2 / 6)
    trajectory.to_csv(tmp_path / "track.csv")
    read = bik.Trajectory.from_csv(tmp_path / "track.csv")
    np.testing.assert_allclose(read.at(result.time[:-1])[2], trajectory.at(result.time[:-1])[2], atol=1e-9)
    names = [f"left_{name}" for name in robot.joint_names]
    message = bik.interop.to_ros(trajectory, joint_names=names)
    assert message["joint_names"][0] == "left_shoulder_pan_joint"
    assert all(len(point["accelerations"]) == 6 for point in message["points"])
    with pytest.raises(bik.InvalidInputError, match=r"^joint_names: expected 6, one per joint, got 2$"):
        bik.interop.to_ros(trajectory, joint_names=["a", "b"])


def test_rated_limits_are_the_makers_and_opt_in() -> None:
    panda = bik.Robot.named("panda")
    rated = panda.rated_limits
    np.testing.assert_array_equal(rated.acceleration, [15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0])
    np.testing.assert_array_equal(rated.jerk, [7500.0, 3750.0, 5000.0, 6250.0, 7500.0, 10000.0, 10000.0])
    np.testing.assert_array_equal(rated.velocity, panda.velocity_limit)
    assert (panda.limits.acceleration, panda.limits.jerk) == (None, None)
    assert bik.Robot.named("ur5e").rated_limits == bik.Robot.named("ur5e").limits
    plan = bik.plan_point_to_point(panda, start_q=HOME, end_q=THERE, limits=rated)
    assert np.all(plan.trajectory.max_acceleration() <= rated.acceleration)


@pytest.mark.parametrize(
    ("name", "first"),
    [("panda", "panda_joint1"), ("fr3", "fr3_joint1"), ("iiwa14", "joint_a1"), ("ur10", "shoulder_pan_joint")],
)
def test_built_in_robots_carry_their_makers_joint_names(name: str, first: str) -> None:
    assert bik.Robot.named(name).joint_names[0] == first


def test_ease_from_the_command_line() -> None:
    command = "track ur5e --curve circle --duration 5 --dt 0.01 --acceleration-limit 5 --json"
    plain = CliRunner().invoke(app, command.split())
    assert plain.exit_code == 1
    assert "at rest: --ease begins with an approach" in json.loads(plain.stdout)["message"]
    eased = CliRunner().invoke(app, [*command.split(), "--ease"])
    summary: dict[str, Any] = json.loads(eased.stdout)
    assert (eased.exit_code, summary["success"]) == (0, True), summary["message"]


def test_a_plan_under_jerk_limits_from_the_command_line() -> None:
    ends = ["--start-q=0,-0.5,0,-2,0,1.5,0.8", "--end-q=0.6,-0.3,-0.3,-1.6,0,1.3,1.3"]
    command = ["plan", "point-to-point", "panda", *ends, "--acceleration-limit", "5", "--json"]
    quick, smooth = (
        json.loads(CliRunner().invoke(app, [*command, *more]).stdout) for more in ([], ["--jerk-limit", "50"])
    )
    assert smooth["success"]
    assert smooth["cost"] != quick["cost"]


def test_joints_limited_on_one_side_follow_a_path() -> None:
    joints, parent = "", "base"
    for i, axis in enumerate(("1 0 0", "0 1 0", "0 0 1", "1 0 0")):
        joints += (
            f"<link name='l{i}'/><joint name='j{i}' type='continuous'><parent link='{parent}'/><child link='l{i}'/>"
            f"<origin xyz='0.3 0 0'/><axis xyz='{axis}'/><limit velocity='2' effort='50'/></joint>"
        )
        parent = f"l{i}"
    robot = bik.Robot.from_urdf(f"<robot name='arm'><link name='base'/>{joints}</robot>")
    poses = robot.fk(np.array([0.3, 0.5, -0.4, 0.2]) + np.linspace(0, 8, 80)[:, None] * np.array([1, 0.5, 0.3, 1]))
    for upper in (np.inf, 3.0, [np.inf, 3.0, np.inf, np.inf]):
        limits = bik.Limits(velocity=2.0, acceleration=8.0, lower=-np.inf, upper=upper)
        plan = bik.plan_along_path(robot, poses, limits=limits)
        assert plan.success, plan.message
        assert (plan.trajectory.q <= np.asarray(upper) + 1e-9).all()
