"""Limits of the speed, acceleration and turn speed of tips, judged by Jacobians and finite differences."""

import pickle
import re
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik

api: Any = bik  # wrong calls on purpose
UR5 = bik.Robot.named("ur5e")
PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
START, END = [0.0, -1.5, 1.5, 0.0, 0.0, 0.0], [1.0, -1.0, 1.0, 0.5, 0.0, 0.0]
LINE = np.array([bik.pose([0.45, y, 0.15], rpy=[np.pi, 0, 0]) for y in np.linspace(-0.25, 0.25, 101)])
JOINT = """<joint name="{1}{2}" type="{0}"><parent link="{1}"/><child link="{2}"/><origin xyz="{3}"/><axis xyz="{4}"/>
<limit lower="-3" upper="3" velocity="3" effort="1"/></joint>"""
SLIDING = (
    '<robot name="gantry"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>'
    + JOINT.format("prismatic", "a", "b", "0 0 0", "1 0 0")
    + JOINT.format("revolute", "b", "c", "0 0.2 0.4", "0 0 1")
    + JOINT.format("revolute", "c", "d", "0.5 0 0", "0 1 0")
    + "</robot>"
)


def limits(**tips: Any) -> bik.Limits:
    return bik.Limits(velocity=2.0, acceleration=8.0, **tips)


def rates(robot: bik.Robot, trajectory: bik.Trajectory, samples: int = 10_000, tip: str | None = None) -> np.ndarray:
    """Speed (m/s), acceleration (m/s^2) and turn speed (rad/s) of a tip, in columns."""
    t = np.linspace(0, trajectory.duration, samples + 1)[:-1] + 0.5 * trajectory.duration / samples
    at = {} if tip is None else {"link": tip}

    def twist(t: np.ndarray) -> np.ndarray:
        q, qd, _ = trajectory.at(t)
        return np.array([robot.jacobian(x, **at) @ v for x, v in zip(q, qd, strict=True)])

    here = twist(t)
    step = 1e-4 * trajectory.duration / samples
    change = (twist(t + step)[:, :3] - twist(t - step)[:, :3]) / (2 * step)
    size = np.linalg.norm
    return np.stack([size(here[:, :3], axis=1), size(change, axis=1), size(here[:, 3:], axis=1)], axis=1)


def kept(robot: bik.Robot, trajectory: bik.Trajectory, *most: float, tip: str | None = None) -> np.ndarray:
    found = rates(robot, trajectory, 2500, tip).max(axis=0)
    allowed = np.array(most) * (1 + np.array([1e-9, 1e-5, 1e-9]))
    assert (found <= allowed).all(), (found, most)
    return found / np.array(most)


def test_a_line_runs_at_the_tip_speed_and_no_faster() -> None:
    plan = bik.plan_along_path(UR5, LINE, limits=limits(tip_speed=0.25))
    assert plan.success
    assert plan.violations == []
    kept(UR5, plan.trajectory, 0.25, np.inf, np.inf)
    t = np.linspace(0.15, plan.trajectory.duration - 0.15, 500)
    q, qd, _ = plan.trajectory.at(t)
    speed = [np.linalg.norm((UR5.jacobian(x) @ v)[:3]) for x, v in zip(q, qd, strict=True)]
    assert min(speed) > 0.25 * 0.999, min(speed)


@pytest.mark.parametrize("tips", [{"tip_speed": 0.25}, {"tip_acceleration": 0.5}, {"tip_turn_speed": 0.3}])
def test_each_limit_is_kept_and_reached_by_each_call(tips: dict[str, float]) -> None:
    most = [tips.get(name, np.inf) for name in ("tip_speed", "tip_acceleration", "tip_turn_speed")]
    free = bik.plan_point_to_point(UR5, start_q=START, end_q=END, limits=limits())
    turning = LINE.copy()
    turning[:, :3, :3] = [bik.pose([0, 0, 0], rpy=[np.pi, 0, a])[:3, :3] for a in np.linspace(0, 1, 101)]
    path = bik.plan_along_path(UR5, turning, limits=limits())
    waypoints = path.trajectory.sample(0.05)[1]
    motions = [
        bik.plan_point_to_point(UR5, start_q=START, end_q=END, limits=limits(**tips)),
        free.retime(limits(**tips)),
        free.retime(bik.Limits(velocity=2.0, acceleration=8.0, **tips)),
        path.retime(limits(**tips)),
        bik.plan_along_path(UR5, turning, limits=limits(**tips)),
        bik.plan_point_to_point(
            UR5, start_q=START, end_q=END, limits=bik.Limits(velocity=2.0, acceleration=8.0, jerk=40.0, **tips)
        ),
    ]
    trajectories = [plan.trajectory for plan in motions]
    trajectories.append(bik.time_optimal(waypoints, limits(**tips), robot=UR5))
    for trajectory in trajectories:
        assert kept(UR5, trajectory, *most).max() > 0.98
    kept(UR5, bik.time_optimal(waypoints, bik.Limits(velocity=2, acceleration=8, jerk=40, **tips), robot=UR5), *most)


def test_a_loose_limit_changes_no_bit() -> None:
    for loose in (
        {"tip_speed": 19.0},
        {"tip_turn_speed": 44.0},
        {"tip_speed": np.inf},
        {"tip_speed": {UR5.tips[0]: 19.0}},
    ):
        calls = (
            lambda given: bik.plan_point_to_point(UR5, start_q=START, end_q=END, limits=given).trajectory,
            lambda given: bik.plan_along_path(UR5, LINE, limits=given).trajectory,
        )
        for call in calls:
            with_limit, without = call(limits(**loose)), call(limits())
            assert np.array_equal(with_limit.coefficients, without.coefficients)
            assert np.array_equal(with_limit.time, without.time)


def test_a_looser_limit_is_never_slower() -> None:
    rng = np.random.default_rng(4)
    for _ in range(8):
        ends = UR5.random_configurations(2, seed=int(rng.integers(1000)))
        name = ["tip_speed", "tip_acceleration", "tip_turn_speed"][rng.integers(3)]
        base = float(rng.choice([0.1, 0.25, 0.5, 1.0, rng.uniform(0.05, 1)]))
        durations = [
            bik.plan_point_to_point(
                UR5, start_q=ends[0], end_q=ends[1], limits=limits(**{name: base * f})
            ).trajectory.duration
            for f in (1.0, 1.1, 2.0, 10.0)
        ]
        assert all(b <= a * (1 + 1e-3) for a, b in pairwise(durations)), (name, base, durations)


def test_two_tips_keep_limits_of_their_own() -> None:
    start = PAIR.random_configurations(1, seed=3)[0]
    end = PAIR.random_configurations(1, seed=4)[0]
    both = limits(tip_speed={"left_tool": 0.2, "right_tool": 0.5}, tip_turn_speed={"left_tool": 1.0})
    trajectory = bik.plan_point_to_point(PAIR, start_q=start, end_q=end, limits=both).trajectory
    left = kept(PAIR, trajectory, 0.2, np.inf, 1.0, tip="left_tool")
    right = kept(PAIR, trajectory, 0.5, np.inf, np.inf, tip="right_tool")
    assert max(left.max(), right.max()) > 0.98


def test_slides_bases_and_tools_count() -> None:
    gantry = bik.Robot.from_urdf(SLIDING)
    moving = UR5.with_mobile_base("planar", lower=[-3, -3, -3.1], upper=[3, 3, 3.1], velocity=[0.8, 0.8, 1.0])
    tool = UR5.with_tool(bik.pose([0.0, 0.1, 0.3]))
    driven = [0, 0, 0, *START], [1, 1, 2, *END]
    for robot, start, end in [(gantry, [-1.5, 0, 0], [1.5, 2, -1]), (tool, START, END), (moving, *driven)]:
        trajectory = bik.plan_point_to_point(robot, start_q=start, end_q=end, limits=limits(tip_speed=0.3)).trajectory
        assert kept(robot, trajectory, 0.3, np.inf, np.inf).max() > 0.98
    floating = UR5.with_mobile_base("floating", lower=[-1] * 6, upper=[1] * 6)
    q = np.zeros(floating.dof)
    with pytest.raises(
        bik.UnsupportedLimit, match="cannot honour tip speed limits: a base that floats turns by a rotation vector"
    ):
        bik.plan_point_to_point(floating, start_q=q, end_q=q + 0.1, limits=limits(tip_speed=0.3))


def test_limits_hold_among_obstacles_and_with_keep() -> None:
    wall = bik.obstacles.Box((0.5, 0.0, 0.1), (0.4, 0.04, 0.4))
    start = bik.solve(UR5, bik.pose([0.5, -0.3, 0.3], rpy=[np.pi, 0, 0])).q
    arm = UR5.with_capsules(radius=0.05)
    end = bik.solve(UR5, bik.pose([0.5, 0.3, 0.3], rpy=[np.pi, 0, 0]), start_q=start).q
    plan = bik.plan_point_to_point(
        arm, start_q=start, end_q=end, obstacles=[wall], limits=limits(tip_speed=0.25), keep=bik.upright(arm, tilt=0.6)
    )
    assert plan.success, plan.message
    assert kept(UR5, plan.trajectory, 0.25, np.inf, np.inf)[0] > 0.98
    assert plan.clearance is not None


@pytest.mark.parametrize("rated", [{}, {"acceleration": 8.0}, {"acceleration": 8.0, "jerk": 100.0}])
def test_a_track_keeps_tip_speeds_in_every_tick(rated: dict[str, float]) -> None:
    fast = np.array([bik.pose([0.45, y, 0.25], rpy=[np.pi, 0, 0]) for y in np.linspace(-0.25, 0.25, 51)])
    path = bik.paths.from_samples(np.linspace(0, 1.0, 51), fast)
    result = bik.track(UR5, path, dt=0.01, limits=bik.Limits(velocity=3.0, **rated, tip_speed=0.25))
    speed = np.linalg.norm(np.diff(UR5.fk(result.q)[:, :3, 3], axis=0), axis=1) / 0.01
    assert speed.max() <= 0.25 * (1 + 1e-9), speed.max()
    assert np.sort(speed)[-20:].min() > 0.24, np.sort(speed)[-30:]
    slow = bik.paths.from_samples(np.linspace(0, 4.0, 51), fast)
    result = bik.track(UR5, slow, dt=0.01, limits=bik.Limits(velocity=3.0, **rated, tip_speed=0.25))
    free = bik.track(UR5, slow, dt=0.01, limits=bik.Limits(velocity=3.0, **rated))
    assert result.status == free.status
    assert abs(result.q[-1] - free.q[-1]).max() < 1e-3


def test_an_arm_at_rest_whose_first_command_is_too_fast_is_slowed() -> None:
    q = bik.solve(UR5, bik.pose([0.45, 0.0, 0.25], rpy=[np.pi, 0, 0])).q
    limits = bik.Limits(velocity=1.0, acceleration=200.0, tip_speed=0.25)  # at its velocity after one tick
    tracker = bik.Tracker(UR5, q, dt=0.01, limits=limits)
    rows = [q, *(tracker.step([0.3, 0.4, 0.5]).q for _ in range(50))]
    speed = np.linalg.norm(np.diff(UR5.fk(np.array(rows))[:, :3, 3], axis=0), axis=1) / 0.01
    assert 0.24 < speed.max() <= 0.25 * (1 + 1e-9)


@pytest.mark.parametrize("rated", [{}, {"acceleration": 6.0}, {"acceleration": 6.0, "jerk": 80.0}])
def test_a_tracker_and_its_stop_keep_tip_speeds(rated: dict[str, float]) -> None:
    q = bik.solve(UR5, bik.pose([0.45, 0.0, 0.25], rpy=[np.pi, 0, 0])).q
    rng = np.random.default_rng(2)
    most = bik.Limits(velocity=3.0, **rated, tip_speed=0.3, tip_turn_speed=0.8)
    tracker = bik.Tracker(UR5, q, dt=0.01, limits=most)
    rows = [q]
    for _ in range(12):
        target = bik.pose(rng.uniform([0.3, -0.4, 0.1], [0.6, 0.4, 0.6]), rpy=[np.pi, *rng.uniform(-0.5, 0.5, 2)])
        rows.extend(tracker.step(target).q for _ in range(25))
        if rng.random() < 0.5:
            tracker.stop()
            rows.extend(tracker.step(None).q for _ in range(20))
    poses = UR5.fk(np.array(rows))
    speed = np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1) / 0.01
    turned = np.einsum("mji,mjk->mik", poses[:-1, :3, :3], poses[1:, :3, :3])
    turn = np.arccos(np.clip((np.trace(turned, axis1=1, axis2=2) - 1) / 2, -1, 1)) / 0.01
    assert speed.max() <= 0.3 * (1 + 1e-9)
    assert turn.max() <= 0.8 * (1 + 1e-6)
    assert max(speed.max() / 0.3, turn.max() / 0.8) > 0.98


def test_limits_are_values() -> None:
    one = bik.Limits(tip_speed=0.25, tip_turn_speed={"right": 1.0, "left": 2.0})
    assert repr(one) == "Limits(tip_speed=0.25, tip_turn_speed={'left': 2.0, 'right': 1.0})"
    assert (one.tip_speed, one.tip_acceleration, one.tip_turn_speed) == (0.25, None, {"left": 2.0, "right": 1.0})
    again = pickle.loads(pickle.dumps(one))
    assert again == one
    assert hash(again) == hash(one)
    assert one != bik.Limits(tip_speed=0.25)
    assert bik.Limits(tip_speed=0.25) != bik.Limits(tip_speed=0.3)
    plan = bik.plan_point_to_point(UR5, start_q=START, end_q=END, limits=limits(tip_speed=0.25))
    assert plan.limits.tip_speed == 0.25


def test_units_that_look_wrong_warn() -> None:
    with pytest.warns(
        bik.UnitsWarning, match=re.escape("tip speed limit is 250 m/s (no arm is as fast), which looks like")
    ):
        bik.plan_point_to_point(UR5, start_q=START, end_q=END, limits=limits(tip_speed=250))
    with pytest.warns(bik.UnitsWarning, match="tip turn speed limit is 90 rad/s"):
        bik.plan_point_to_point(UR5, start_q=START, end_q=END, limits=limits(tip_turn_speed=90))


NO_LIMIT = "it must be positive; None means no limit"


def out(name: str) -> str:
    return f", or leave out limits=Limits({name}=...)"


Limit, Invalid, Unsupported = bik.LimitError, bik.InvalidInputError, bik.UnsupportedLimit
MESSAGES = {
    "number": "tip_speed must be a number, or a dict of numbers by tip, got 'fast'",
    "timing": "time_optimal cannot honour tip speed limits: give the robot whose tips they are",
    "solve": "solve cannot honour tip speed limits: plan a motion, because a single configuration has none",
    "states": "state_to_state cannot honour tip turn speed limits: use plan_point_to_point, "
    "because here each joint has its own time",
    "track": "Tracker cannot honour tip acceleration limits: plan the motion, which keeps them",
}
REFUSED = [
    (lambda: api.Limits(tip_speed=0), Limit, f"tip_speed is 0: {NO_LIMIT}"),
    (lambda: api.Limits(tip_speed=-0.1), Limit, f"tip_speed is -0.1: {NO_LIMIT}"),
    (lambda: api.Limits(tip_acceleration=np.nan), Limit, f"tip_acceleration is NaN: {NO_LIMIT}"),
    (lambda: api.Limits(tip_speed="fast"), Invalid, MESSAGES["number"]),
    (lambda: api.Limits(tip_speed={}), Invalid, "tip_speed: the dict is empty; name one tip at least"),
    (lambda: api.Limits(tip_speed={1: 0.2}), Invalid, "keys of tip_speed are names of tips, got 1"),
    (lambda: api.Limits(tip_speed={"a": 0}), Limit, f"tip_speed of tip 'a' is 0: {NO_LIMIT}"),
    (
        lambda: api.time_optimal([[0.0], [1.0]], limits(tip_speed=0.2)),
        Unsupported,
        MESSAGES["timing"] + out("tip_speed"),
    ),
    (
        lambda: api.solve(UR5, LINE[0], limits=api.Limits(tip_speed=0.2)),
        Unsupported,
        MESSAGES["solve"] + out("tip_speed"),
    ),
    (
        lambda: api.state_to_state(START, END, limits(tip_turn_speed=0.2), robot=UR5),
        Unsupported,
        MESSAGES["states"] + out("tip_turn_speed"),
    ),
    (
        lambda: api.Tracker(UR5, START, dt=0.01, limits=limits(tip_acceleration=1.0)),
        Unsupported,
        MESSAGES["track"] + out("tip_acceleration"),
    ),
]


@pytest.mark.parametrize(("call", "error", "message"), REFUSED)
def test_what_cannot_be_kept_is_refused_by_name(call: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        call()
    assert str(raised.value) == message


def test_an_unknown_tip_is_named_with_the_others() -> None:
    with pytest.raises(bik.BeetleIkError, match=UR5.tips[0]):
        bik.plan_point_to_point(UR5, start_q=START, end_q=END, limits=limits(tip_speed={"tool": 0.2}))
