"""Starts and joint positions as sensors, controllers and files deliver them."""

import itertools
import pickle
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from mistakes import INSIDE as INSIDE_ADVICE
from mistakes import SLACK, TURNED, Invalid, Limit, Unknown, assert_told, told
from numpy.typing import NDArray

import beetle_ik as bik

Array = NDArray[np.float64]

PANDA = bik.Robot.named("panda")
UR = bik.Robot.named("ur5e")
INSIDE = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
LIMITS = bik.Limits(velocity=1.0, acceleration=5.0)
JERK = bik.Limits(velocity=1.0, acceleration=5.0, jerk=50.0)
DT = 0.01
ROUNDING = (1e-12, 1e-9, 1e-6)
BEYOND = (1e-4, 0.01, float(np.radians(3.0)), float(np.radians(5.0)) - 1e-9)


def below(beyond: float, joint: int = 1) -> Array:
    start = INSIDE.copy()
    start[joint] = PANDA.lower[joint] - beyond
    return start


def roller(*kinds: str) -> bik.Robot:
    """An arm of vertical and horizontal axes in turn, of these kinds of joints."""
    xml, parent = "<robot name='roller'><link name='base'/>", "base"
    for i, kind in enumerate(kinds):
        axis, slides = "0 0 1" if i % 2 == 0 else "0 1 0", kind == "prismatic"
        bounds = "" if kind == "continuous" else f"lower='{0.0 if slides else -2.2}' upper='{0.5 if slides else 2.2}'"
        xml += f"<link name='l{i}'/><joint name='j{i}' type='{kind}'><parent link='{parent}'/><child link='l{i}'/>"
        xml += f"<origin xyz='0.1 0 0.2'/><axis xyz='{axis}'/><limit {bounds} velocity='1.4' effort='1'/></joint>"
        parent = f"l{i}"
    return bik.Robot.from_urdf(xml + "</robot>", tip=parent)


ROLLER = roller("continuous", "revolute", "revolute", "continuous", "revolute", "continuous")


def assert_kept(q: Array, limits: bik.Limits, dt: float, *, start: Array, robot: bik.Robot = PANDA) -> None:
    """Checks a motion by finite differences: no jump, within its limits, never farther out than it begins."""
    at_rest = np.concatenate((start[None], start[None], q))
    for order, (name, slack) in enumerate((("velocity", 1e-9), ("acceleration", 1e-6), ("jerk", 1e-3)), 1):
        bound = getattr(limits, name)
        if bound is not None:
            largest = np.abs(np.diff(at_rest, order, axis=0)).max() / dt**order
            assert largest <= np.max(bound) + slack * (1 + np.max(bound)), name
    lower, upper = np.minimum(robot.lower, start), np.maximum(robot.upper, start)
    assert np.all(q >= lower - 1e-9)
    assert np.all(q <= upper + 1e-9)


@pytest.mark.filterwarnings("ignore::beetle_ik.UnitsWarning")
@pytest.mark.parametrize("beyond", [*ROUNDING, *BEYOND, 1.0, 100.0, 1e6])
def test_solve_takes_any_finite_start_as_a_hint(beyond: float) -> None:
    for start in (below(beyond), 2 * INSIDE - below(beyond)):
        target = PANDA.fk(INSIDE)
        solution = bik.solve(PANDA, target, start_q=start)
        assert solution.success
        assert np.all((PANDA.lower <= solution.q) & (solution.q <= PANDA.upper))
        batch = bik.solve_batch(PANDA, target[None], start_q=start[None])
        assert batch.success.all()
        assert np.all((PANDA.lower <= batch.q) & (batch.q <= PANDA.upper))
        found = bik.solve_all(PANDA, target, start_q=start).q
        assert np.all((PANDA.lower <= found) & (found <= PANDA.upper))
        clear = bik.solve(PANDA, target, start_q=start, prefer="nearest")
        assert clear.success
        assert np.all((PANDA.lower <= clear.q) & (clear.q <= PANDA.upper))


def test_a_start_outside_is_not_returned_as_the_solution() -> None:
    capsules = PANDA.with_capsules(radius=0.03)
    start = below(0.05)
    solution = bik.solve(capsules, PANDA.fk(start), start_q=start, obstacles=[])
    assert np.all((PANDA.lower <= solution.q) & (solution.q <= PANDA.upper))


@pytest.mark.parametrize("limits", [bik.Limits(velocity=1.0), LIMITS, JERK])
@pytest.mark.parametrize("beyond", [*ROUNDING, *BEYOND])
def test_a_tracker_leads_a_start_inside_without_a_jump(beyond: float, limits: bik.Limits) -> None:
    for joint, side in itertools.product((1, 3, 6), (-1, 1)):
        start = INSIDE.copy()
        start[joint] = (PANDA.upper if side > 0 else PANDA.lower)[joint] + side * beyond
        tracker = bik.Tracker(PANDA, start, dt=DT, limits=limits)
        taken = tracker.q
        assert abs(taken - start).max() <= 1e-6 * (PANDA.upper - PANDA.lower).max()
        if beyond in BEYOND:
            np.testing.assert_array_equal(taken, start)
            ((name, value, limit),) = tracker.start_outside
            assert name == PANDA.joint_names[joint]
            assert value == start[joint]
            assert limit == (PANDA.upper if side > 0 else PANDA.lower)[joint]
        else:
            assert tracker.start_outside == []
        steps = [tracker.step(PANDA.fk(INSIDE)) for _ in range(300)]
        q = np.array([step.q for step in steps])
        assert_kept(q, limits, DT, start=taken)
        assert np.all((PANDA.lower <= q[-1]) & (q[-1] <= PANDA.upper))
        assert tracker.start_outside == []
        if beyond in BEYOND:
            said = f"it began with joint '{PANDA.joint_names[joint]}' at "
            assert said in steps[0].message
            assert said not in steps[-1].message
            assert pickle.loads(pickle.dumps(steps[0])).message == steps[0].message


@pytest.mark.parametrize("limits", [bik.Limits(velocity=1.0), JERK])
def test_a_start_outside_never_moves_into_an_obstacle(limits: bik.Limits) -> None:
    robot = PANDA.with_capsules(radius=0.05)
    start = below(np.radians(4.0))
    ahead = robot.fk(start)[:3, 3] + 0.072 * np.array([1.0, 0.0, 0.0])
    wall = bik.obstacles.Sphere(robot.fk(robot.clip(start))[:3, 3], 0.01)
    for obstacle in (wall, bik.obstacles.Sphere(ahead, 0.02)):
        clear_at_start = bik.obstacles.clearance(robot, start, [obstacle])
        if clear_at_start < 2e-3:
            continue
        tracker = bik.Tracker(robot, start, dt=DT, limits=limits, obstacles=[obstacle])
        steps = [tracker.step(PANDA.fk(INSIDE)) for _ in range(200)]
        assert min(step.clearance for step in steps) >= 1e-3 - 1e-9
        assert_kept(np.array([step.q for step in steps]), limits, DT, start=start)


def test_a_stop_outside_the_limits_goes_no_farther_out() -> None:
    start = below(0.05)
    tracker = bik.Tracker(PANDA, start, dt=DT, limits=JERK)
    for _ in range(3):
        tracker.step(PANDA.fk(INSIDE))
    tracker.stop()
    q = np.array([tracker.step(None).q for _ in range(100)])
    assert np.ptp(q[-20:], axis=0).max() < 1e-12
    assert np.all(q[:, 1] >= start[1] - 1e-12)


def test_a_tracker_without_a_target_stays_outside() -> None:
    start = below(0.05)
    tracker = bik.Tracker(PANDA, start, dt=DT, limits=JERK)
    np.testing.assert_array_equal(tracker.step(None).q, start)


def test_reset_takes_a_reading_outside_too() -> None:
    tracker = bik.Tracker(PANDA, INSIDE, dt=DT, limits=JERK)
    tracker.reset(below(0.05))
    assert [outside[0] for outside in tracker.start_outside] == ["panda_joint2"]
    with pytest.raises(bik.LimitError, match=r"q: joint 'panda_joint2' at -1.96\d* is outside its limits"):
        tracker.reset(below(0.2))
    assert tracker.q[1] == below(0.05)[1]
    with pytest.raises(bik.InvalidInputError, match="cannot stop inside its limits"):
        tracker.reset(below(0.05), qd=[0.0, -0.5, 0.0, 0.0, 0.0, 0.0, 0.0])


@pytest.mark.parametrize("beyond", BEYOND)
def test_track_leads_a_start_inside_and_says_so(beyond: float) -> None:
    start = below(beyond)
    path = bik.paths.circle(PANDA.fk(INSIDE)[:3, 3], 0.02, 2.0)
    for limits in (bik.Limits(velocity=1.0), JERK):
        result = bik.track(PANDA, path, start, dt=DT, limits=limits, task=bik.tasks.Position())
        np.testing.assert_array_equal(result.q[0], start)
        assert_kept(result.q[1:], limits, DT, start=start)
        assert result.max_violation == 0.0
        assert np.all(result.q[-1] >= PANDA.lower)
        assert "; it begins with joint 'panda_joint2' at " in result.message
        assert result.start_outside == [("panda_joint2", start[1], PANDA.lower[1])]


@pytest.mark.parametrize("limits", [LIMITS, JERK])
@pytest.mark.parametrize("beyond", BEYOND)
def test_a_plan_begins_at_the_reading_and_goes_inside(beyond: float, limits: bik.Limits) -> None:
    start = below(beyond)
    for more in ({"end_q": INSIDE}, {"end": PANDA.fk(INSIDE)}, {"end_q": INSIDE, "start_qd": np.zeros(7)}):
        plan = bik.plan_point_to_point(PANDA, start_q=start, limits=limits, **more)  # type: ignore[arg-type]
        assert plan.success
        assert plan.start_outside == [("panda_joint2", start[1], PANDA.lower[1])]
        _, q, qd, qdd = plan.trajectory.sample(1e-3)
        np.testing.assert_allclose(q[0], start, rtol=0.0, atol=1e-15)
        assert np.all(np.diff(q[:, 1]) >= -1e-12), "it goes inside at once"
        assert abs(qd).max() <= 1.0 + 1e-9
        assert abs(qdd).max() <= 5.0 + 1e-9
        assert "; it begins with joint 'panda_joint2' at -1." in plan.message
        assert pickle.loads(pickle.dumps(plan)).message == plan.message
        assert plan.retime(bik.Limits(velocity=0.5, acceleration=5.0)).success


def test_a_plan_among_obstacles_begins_at_the_reading() -> None:
    robot = PANDA.with_capsules(radius=0.04)
    start, end = below(0.06), np.array([1.2, 0.3, 0.0, -2.0, 0.0, 1.9, 0.8])
    wall = bik.obstacles.Box([0.3, 0.25, 0.5], [0.1, 0.1, 1.0])
    plan = bik.plan_point_to_point(robot, start_q=start, end_q=end, limits=LIMITS, obstacles=[wall])
    assert plan.success, plan.message
    q = plan.trajectory.sample(1e-2)[1]
    np.testing.assert_allclose(q[0], start, rtol=0.0, atol=1e-15)
    assert bik.obstacles.clearance(robot, q, [wall]).min() >= 1e-3 - 1e-9
    assert_kept(q[1:], bik.Limits(velocity=1.0), 1e-2, start=start)


def test_rounding_of_starts_and_ends_is_taken() -> None:
    for beyond in ROUNDING:
        plan = bik.plan_point_to_point(PANDA, start_q=below(beyond), end_q=below(beyond, 3), limits=LIMITS)
        assert plan.success
        assert plan.start_outside == []
        assert plan.trajectory.q[0][1] == PANDA.lower[1]
        assert plan.trajectory.q[-1][3] == PANDA.lower[3]
        motion = bik.state_to_state([-beyond], [1.0 + beyond], bik.Limits(lower=0.0, upper=1.0, velocity=1.0))
        assert motion.q[0] == [0.0]
        assert motion.q[-1] == [1.0]
    batch = bik.plan_batch(PANDA, [{"start_q": below(0.05), "end_q": INSIDE}], limits=LIMITS)
    assert batch.success.all()
    assert batch.plans[0].start_outside


def test_an_end_outside_is_refused_with_the_remedy() -> None:
    with pytest.raises(bik.LimitError) as caught:
        bik.plan_point_to_point(PANDA, start_q=INSIDE, end_q=below(0.05), limits=LIMITS)
    assert str(caught.value) == (
        "end_q: joint 'panda_joint2' at -1.8128 is outside its limits [-1.7628, 1.7628] by 0.05000 rad: "
        f"{INSIDE_ADVICE}"
    )


def test_several_ends_pass_over_one_outside() -> None:
    ends = [below(0.05), INSIDE]
    assert bik.plan_point_to_point(PANDA, start_q=PANDA.clip(np.zeros(7)), end_q=ends, limits=LIMITS).chosen_end == 1


@pytest.mark.parametrize("beyond", BEYOND)
def test_plans_along_a_path_begin_at_the_reading(beyond: float) -> None:
    start = below(beyond)
    there = PANDA.fk(start)[:3, 3]
    path = np.linspace(there, there + np.array([0.1, 0.0, 0.05]), 12)
    plan = bik.plan_along_path(PANDA, path, start_q=start, limits=LIMITS)
    q = plan.trajectory.sample(1e-2)[1]
    np.testing.assert_allclose(q[0], start, rtol=0.0, atol=1e-12)
    assert plan.success, plan.message
    assert plan.start_outside
    assert np.all(q[-1] >= PANDA.lower - 1e-9)
    assert np.all(q[:, 1] >= start[1] - 1e-9)


def test_a_program_of_moves_takes_rounding_alone() -> None:
    moves = [bik.moves.Joints(INSIDE)]
    assert bik.plan_moves(PANDA, moves, start_q=below(1e-7), limits=LIMITS).success
    with pytest.raises(Limit, match=r"^start_q: joint 'panda_joint2' at -1\.77\d* is outside its limits"):
        bik.plan_moves(PANDA, moves, start_q=below(0.01), limits=LIMITS)


def test_a_retreat_begins_at_the_reading() -> None:
    start = below(0.05)
    plan = bik.plan_point_to_point(PANDA, start_q=start, end_q=INSIDE, retreat=0.05, limits=LIMITS)
    q = plan.trajectory.sample(1e-2)[1]
    assert plan.success
    assert q[0][1] == pytest.approx(start[1])
    assert np.all(q[:, 1] >= start[1] - 1e-9)


@pytest.mark.parametrize("beyond", BEYOND)
def test_bare_motions_say_what_they_lead_inside(beyond: float) -> None:
    start, around = below(beyond), bik.Limits(lower=PANDA.lower, upper=PANDA.upper, velocity=1.0, acceleration=5.0)
    led = ("panda_joint2", start[1], PANDA.lower[1])
    direct = bik.state_to_state(start, INSIDE, LIMITS, robot=PANDA)
    for motion in (direct, bik.time_optimal([start, INSIDE], LIMITS, robot=PANDA), direct.then(direct_back(direct))):
        assert motion.start_outside == [led]
        assert repr(motion).endswith(" knots, leads 'panda_joint2' inside>")
        assert pickle.loads(pickle.dumps(motion)).start_outside == [led]
        assert motion == bik.Trajectory(motion.time, motion.coefficients, joint_names=motion.joint_names)
    for motion in (bik.state_to_state(start, INSIDE, around), bik.time_optimal([start, INSIDE], around)):
        assert motion.start_outside == [("q2", *led[1:])]
    plan = bik.plan_point_to_point(PANDA, start_q=start, end_q=INSIDE, limits=LIMITS)
    assert plan.trajectory.start_outside == plan.start_outside == [led]


@pytest.mark.parametrize("beyond", [*ROUNDING, 0.0])
def test_bare_motions_from_inside_lead_nothing(beyond: float) -> None:
    start = below(beyond)
    for motion in (
        bik.state_to_state(start, INSIDE, LIMITS, robot=PANDA),
        bik.time_optimal([start, INSIDE], LIMITS, robot=PANDA),
        bik.Trajectory.from_samples([0.0, 1.0], [start, INSIDE]),
    ):
        assert motion.start_outside == []
        assert repr(motion).endswith(" knots>")


def direct_back(motion: bik.Trajectory) -> bik.Trajectory:
    """A motion from the end of another to a configuration inside."""
    return bik.state_to_state(motion.q[-1], PANDA.clip(np.zeros(7)), LIMITS, joint_names=motion.joint_names)


def test_state_to_state_leads_a_start_inside() -> None:
    limits = bik.Limits(lower=-1.0, upper=1.0, velocity=1.0, acceleration=5.0, jerk=50.0)
    motion = bik.state_to_state([-1.05], [0.5], limits)
    assert motion.q[0] == [-1.05]
    assert np.all(np.diff(motion.sample(1e-3)[1][:, 0]) >= -1e-12)
    slid = roller("prismatic")
    outside = r"start_q: joint 'j0' at -0.01 is outside its limits \[0, 0.5\] by 0.01000 m"
    with pytest.raises(bik.LimitError, match=outside):
        bik.state_to_state([-0.01], [0.2], LIMITS, robot=slid)
    assert bik.state_to_state([-0.004], [0.2], LIMITS, robot=slid).q[0] == [-0.004]
    assert bik.state_to_state([-0.01], [0.2], LIMITS, robot=slid, start_slack=0.02).joint_names == ["j0"]


def test_a_timed_path_may_begin_outside() -> None:
    limits = bik.Limits(lower=-1.0, upper=1.0, velocity=1.0, acceleration=5.0)
    assert bik.time_optimal([[-1.05], [0.0], [0.5]], limits).q[0] == [-1.05]
    with pytest.raises(bik.InfeasibleError, match="beyond its lower limit -1"):
        bik.time_optimal([[-1.2], [0.0]], limits)
    with pytest.raises(bik.InfeasibleError, match="beyond its lower limit -1"):
        bik.time_optimal([[0.0], [-1.05], [0.0]], limits)


SLACK_CALLS: list[Any] = [
    lambda slack: bik.Tracker(PANDA, below(0.2), dt=DT, limits=JERK, start_slack=slack).q,
    lambda slack: bik.plan_point_to_point(
        PANDA, start_q=below(0.2), end_q=INSIDE, limits=LIMITS, start_slack=slack
    ).trajectory.q[0],
    lambda slack: (
        bik.plan_batch(PANDA, [{"start_q": below(0.2), "end_q": INSIDE, "start_slack": slack}], limits=LIMITS)
        .plans[0]
        .trajectory.q[0]
    ),
    lambda slack: bik.track(
        PANDA, bik.paths.circle([0.4, 0.0, 0.4], 0.1, 1.0), below(0.2), dt=DT, limits=JERK, start_slack=slack
    ).q[0],
    lambda slack: bik.state_to_state(below(0.2), INSIDE, JERK, robot=PANDA, start_slack=slack).q[0],
]


@pytest.mark.parametrize("slack", [0.2 + 1e-9, 1.0, np.inf, [0.0, 0.3, 0.0, 0.0, 0.0, 0.0, 0.0]])
@pytest.mark.parametrize("call", SLACK_CALLS)
def test_the_slack_decides_what_is_taken(call: Any, slack: Any) -> None:
    np.testing.assert_allclose(call(slack), below(0.2), rtol=0.0, atol=1e-15)


REFUSED = f"joint 'panda_joint2' at -1.9627999999999999 is outside its limits [-1.7628, 1.7628] by 0.2000 rad: {SLACK}"


@told(
    [
        (lambda: bik.Tracker(PANDA, below(0.2), dt=DT), Limit, f"start_q: {REFUSED}"),
        (
            lambda: bik.plan_point_to_point(PANDA, start_q=below(0.2), end_q=INSIDE, limits=LIMITS),
            Limit,
            f"start_q: {REFUSED}",
        ),
        (
            lambda: bik.plan_along_path(PANDA, np.eye(3), start_q=below(0.2), limits=LIMITS),
            Limit,
            f"start_q: {REFUSED}",
        ),
        (
            lambda: bik.Tracker(PANDA, below(1e-3), dt=DT, start_slack=0.0),
            Limit,
            "start_q: joint 'panda_joint2' at -1.7637999999999998 is outside its limits [-1.7628, 1.7628] by "
            f"1.000e-3 rad: {SLACK}",
        ),
        (
            lambda: bik.Tracker(PANDA, np.radians([350.0, 0, 0, -90, 0, 90, 45]), dt=DT),
            Limit,
            "start_q: joint 'panda_joint1' at 6.1086523819801535 is outside its limits [-2.8973, 2.8973] by 3.211 rad: "
            + TURNED,
        ),
        (
            lambda: bik.Tracker(PANDA, below(0.0), dt=DT, start_slack=-1.0),
            Invalid,
            "start_slack must be zero or more, got -1",
        ),
        (
            lambda: bik.Tracker(PANDA, below(0.0), dt=DT, start_slack=[0.1, 0.2]),
            Invalid,
            "start_slack: expected one number, or 7 (one per joint), got 2",
        ),
        (
            lambda: bik.plan_point_to_point(PANDA, start_q=INSIDE, end_q=INSIDE, end_turns="near"),
            Invalid,
            "end_turns must be one of 'nearest', 'as_given', got 'near'",
        ),
        (
            lambda: bik.state_to_state(INSIDE, INSIDE + 0.1, LIMITS, robot=PANDA, joint_names=list("abcdefg")),
            Invalid,
            "robot has joint_names of its own: leave one out",
        ),
    ]
)
def test_a_start_too_far_out_is_told_the_remedy(call: Any, error: Any, message: str) -> None:
    assert_told(call, error, message)


# Whole turns.


@pytest.mark.parametrize("robot", [PANDA, UR, ROLLER], ids=["panda", "ur5e", "roller"])
def test_wrap_keeps_the_pose_and_comes_inside(robot: bik.Robot) -> None:
    random = np.random.default_rng(1)
    lower, upper = np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)
    round_ones = np.pi * np.array([-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0])
    for _ in range(300):
        q = random.uniform(lower, upper)
        q = np.where(random.random(robot.dof) < 0.3, np.clip(random.choice(round_ones, robot.dof), lower, upper), q)
        q = np.where(random.random(robot.dof) < 0.1, random.choice([lower, upper]), q)
        turned = q + 2 * np.pi * random.integers(-3, 4, robot.dof)
        near = random.uniform(2 * lower, 2 * upper)
        for wrapped in (robot.wrap(turned), robot.wrap(turned, near=near)):
            assert np.all((robot.lower <= wrapped) & (wrapped <= robot.upper))
            np.testing.assert_allclose(robot.fk(wrapped), robot.fk(q), atol=1e-9)
        # Independent: of all turns inside, the nearest to `near`.
        turns = turned[:, None] + 2 * np.pi * np.arange(-9, 10)
        inside = (robot.lower[:, None] - 1e-9 <= turns) & (turns <= robot.upper[:, None] + 1e-9)
        nearest = np.where(inside, np.abs(turns - near[:, None]), np.inf).min(axis=1)
        np.testing.assert_allclose(np.abs(robot.wrap(turned, near=near) - near), nearest, atol=1e-8)
        np.testing.assert_array_equal(robot.wrap(turned[None]), robot.wrap(turned)[None])


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (np.pi, np.pi), (-np.pi, np.pi), (3 * np.pi, np.pi), (-3 * np.pi, np.pi), (2 * np.pi, 0.0), (0.0, 0.0),
        (-np.pi + 1e-12, -np.pi + 1e-12), (np.radians(270), -np.pi / 2), (100 * np.pi, 0.0),
    ],
)  # fmt: skip
def test_wrap_brings_a_joint_without_limits_to_one_turn(value: float, expected: float) -> None:
    wrapped = float(ROLLER.wrap([value, 0.1, 0.2, 0.3, 0.4, 0.5])[0])
    assert -np.pi < wrapped <= np.pi
    assert wrapped == pytest.approx(expected, abs=1e-12)


def test_wrap_leaves_joints_inside_their_limits_alone() -> None:
    q = np.array([2 * np.pi, -2 * np.pi, np.pi, -np.pi, 6.0, -4.0])
    q[2] = np.clip(q[2], UR.lower[2], UR.upper[2])
    np.testing.assert_array_equal(UR.wrap(q), q)
    assert UR.wrap(q + 1e-12)[0] == 2 * np.pi, "rounding is taken off, not a turn"
    slides = roller("continuous", "prismatic")
    np.testing.assert_array_equal(slides.wrap([7.0, 0.25])[1:], [0.25])


@told(
    [
        (
            lambda: PANDA.wrap([0.0, 0.0, 0.0, 0.5, 0.0, 1.0, 0.0]),
            Limit,
            "q: joint 'panda_joint4' at 0.5 is outside its limits [-3.0718, -0.0698] by 0.5698 rad: no whole turn "
            f"brings it inside, the nearest is 0.5698 rad beyond; {INSIDE_ADVICE}",
        ),
        (
            lambda: roller("continuous", "prismatic").wrap([0.0, 0.75]),
            Limit,
            "q: joint 'j1' at 0.75 is outside its limits [0, 0.5] by 0.2500 m: whole turns do not apply to it; "
            "move it inside",
        ),
        (lambda: PANDA.wrap([0.0] * 6), Invalid, "q of robot 'panda': expected 7 joints, got 6"),
        (
            lambda: PANDA.wrap(INSIDE, near=[np.nan] * 7),
            Invalid,
            "near must be finite, but joint 'panda_joint1' is NaN",
        ),
    ]
)
def test_wrap_names_a_joint_that_no_turn_brings_inside(call: Any, error: Any, message: str) -> None:
    assert_told(call, error, message)


def test_wrap_leaves_the_play_of_a_start() -> None:
    """One joint is outside by its play, another by whole turns: the result is a start."""
    reading = INSIDE.copy()
    reading[3] = PANDA.upper[3] + 0.01
    np.testing.assert_array_equal(PANDA.wrap(reading), reading)
    turned = reading + np.array([2 * np.pi, 0, 0, 0, 0, 0, -4 * np.pi])
    np.testing.assert_allclose(PANDA.wrap(turned), reading, atol=1e-12)
    turned[3] += 2 * np.pi
    np.testing.assert_allclose(PANDA.wrap(turned, near=INSIDE), reading, atol=1e-12)
    start = PANDA.wrap(turned)
    plan = bik.plan_point_to_point(PANDA, start_q=start, end_q=INSIDE, limits=LIMITS)
    assert [outside[0] for outside in plan.start_outside] == ["panda_joint4"]
    slides = roller("continuous", "prismatic")
    np.testing.assert_array_equal(slides.wrap([7.0, 0.504])[1:], [0.504])
    for values in ([0.0, 0.506], [0.0, -0.006]):
        with pytest.raises(Limit, match="whole turns do not apply"):
            slides.wrap(values)


def test_a_start_that_is_turned_and_has_play_is_told_to_wrap() -> None:
    reading = INSIDE.copy()
    reading[0] = PANDA.upper[0] + 0.0027 + 2 * np.pi
    with pytest.raises(Limit) as told:
        bik.plan_point_to_point(PANDA, start_q=reading, end_q=INSIDE, limits=LIMITS)
    assert f"{TURNED}, but for 0.002700 rad, from where a motion may begin" in str(told.value)
    bik.plan_point_to_point(PANDA, start_q=PANDA.wrap(reading), end_q=INSIDE, limits=LIMITS)
    with pytest.raises(Limit) as told:
        bik.plan_point_to_point(PANDA, start_q=reading, end_q=INSIDE, limits=LIMITS, start_slack=0.001)
    assert TURNED not in str(told.value)


def test_a_controller_that_reports_0_to_360_degrees_is_usable() -> None:
    reading = np.radians([350.0, 340.0, 5.0, 250.0, 10.0, 100.0, 40.0])
    q = PANDA.wrap(reading)
    np.testing.assert_allclose(PANDA.fk(q), PANDA.fk(reading), atol=1e-12)
    assert bik.Tracker(PANDA, q, dt=DT).step(PANDA.fk(q)).success


# The short way round.


@pytest.mark.parametrize("degrees", [(359.9, 3.0), (3.0, 359.9), (-170.0, 170.0), (720.0, 1.0), (180.0, -180.0)])
def test_joints_without_limits_go_the_short_way(degrees: tuple[float, float]) -> None:
    here, there = (np.array([np.radians(angle), 0.4, 0.9, 0.1, 0.6, 0.0]) for angle in degrees)
    there[1] += 0.05
    apart = abs((there[0] - here[0] + np.pi) % (2 * np.pi) - np.pi)
    limits = bik.Limits(acceleration=5.0)
    plans = [
        bik.plan_point_to_point(ROLLER, start_q=here, end_q=there, limits=limits),
        bik.plan_batch(ROLLER, [{"start_q": here, "end_q": there}], limits=limits).plans[0],
        bik.plan_point_to_point(ROLLER.with_capsules(radius=0.01), start_q=here, end_q=there, limits=limits),
        bik.plan_point_to_point(ROLLER, start=ROLLER.fk(here), end_q=there, limits=limits),
    ]
    for plan in plans[:3]:
        q = plan.trajectory.q
        assert np.abs(np.diff(q[:, 0])).sum() <= apart + 0.2
    for plan in plans:
        np.testing.assert_allclose(ROLLER.fk(plan.trajectory.q[-1]), ROLLER.fk(there), atol=1e-9)
    turned = plans[0].end_turned
    if abs(there[0] - here[0]) > np.pi + 1e-9:
        ((name, value, given),) = turned
        assert name == "j0"
        assert given == there[0]
        assert value == plans[0].trajectory.q[-1][0]
        assert "; joint 'j0' goes the short way and ends at " in plans[0].message
    motion = bik.state_to_state(here, there, limits, robot=ROLLER)
    assert np.abs(np.diff(motion.q[:, 0])).sum() <= apart + 1e-9
    kept = bik.plan_point_to_point(ROLLER, start_q=here, end_q=there, limits=limits, end_turns="as_given")
    np.testing.assert_allclose(kept.trajectory.q[-1], there, atol=1e-12)
    assert kept.end_turned == []
    as_given = bik.state_to_state(here, there, limits, robot=ROLLER, end_turns="as_given")
    np.testing.assert_allclose(as_given.q[-1], there, atol=1e-12)


@pytest.mark.parametrize("more", [{"approach": 0.05}, {"retreat": 0.05}])
def test_straight_ends_go_the_short_way_too(more: dict[str, float]) -> None:
    arm = bik.Robot.named("gen3")
    here = np.array([3.0, 0.4, 0.1, 1.2, 0.2, 0.9, 0.3])
    there = np.array([-3.0, 0.5, *here[2:]])
    limits = bik.Limits(acceleration=5.0)
    plan = bik.plan_point_to_point(arm, start_q=here, end_q=there, limits=limits, **more)  # type: ignore[arg-type]
    assert plan.success
    assert np.abs(np.diff(plan.trajectory.q[:, 0])).sum() < 0.4
    assert plan.end_turned == [("joint_1", plan.trajectory.q[-1][0], -3.0)]


def test_limits_of_the_call_keep_the_given_turn() -> None:
    here, there = np.zeros((2, 6))
    here[0], there[0] = 3.0, -3.0
    limits = bik.Limits(lower=-3.1, upper=3.1, acceleration=5.0)
    plan = bik.plan_point_to_point(ROLLER, start_q=here, end_q=there, limits=limits)
    np.testing.assert_allclose(plan.trajectory.q[-1], there, atol=1e-12)


def test_the_long_way_is_taken_where_the_short_one_is_blocked() -> None:
    arm = roller("continuous", "revolute").with_capsules([("l1", (0, 0, 0), (0.6, 0, 0), 0.03)])
    here, there = np.array([-0.6, 0.0]), np.array([0.6, 0.0])
    tip = arm.fk([0.0, 0.0])[:3, 3]
    wall = bik.obstacles.Box([tip[0] + 0.4, 0.0, tip[2]], [0.3, 0.05, 2.0])
    plan = bik.plan_point_to_point(
        arm, start_q=here, end_q=there, limits=bik.Limits(acceleration=5.0), obstacles=[wall]
    )
    assert plan.success, plan.message
    assert np.abs(np.diff(plan.trajectory.sample(1e-2)[1][:, 0])).sum() > 4.0
    assert plan.end_turned


# Names.


def named(q: Array) -> tuple[list[str], list[float]]:
    order = np.random.default_rng(3).permutation(7)
    return [PANDA.joint_names[i] for i in order], [float(q[i]) for i in order]


def test_values_with_names_come_in_the_order_of_the_joints() -> None:
    names, values = named(INSIDE)
    message = SimpleNamespace(name=names, position=values)
    structured = np.array(tuple(values), dtype=[(name, float) for name in names])
    for q in (
        PANDA.q_from(names, values), PANDA.q_from(dict(zip(names, values, strict=True))), PANDA.q_from(message),
        PANDA.q_from(structured), PANDA.q_from(names, np.degrees(values), degrees=True),
        PANDA.q_from([*names, "finger"], [*values, 0.04], ignore_extra=True),
    ):  # fmt: skip
        np.testing.assert_allclose(q, INSIDE, rtol=1e-15)
        assert q.dtype == np.float64
    table = np.array([values, np.multiply(2, values)])
    np.testing.assert_array_equal(PANDA.q_from(names, table), [INSIDE, 2 * INSIDE])
    lengths = roller("continuous", "prismatic").q_from(["j1", "j0"], [0.25, 90.0], degrees=True)
    np.testing.assert_allclose(lengths, [np.pi / 2, 0.25])


def test_tables_whose_columns_have_names_are_put_in_order() -> None:
    pandas = pytest.importorskip("pandas")
    names, values = named(INSIDE)
    table = pandas.DataFrame([values, values], columns=names)
    np.testing.assert_array_equal(PANDA.fk(table), PANDA.fk(np.array([INSIDE, INSIDE])))
    np.testing.assert_array_equal(PANDA.q_from(table), [INSIDE, INSIDE])
    np.testing.assert_array_equal(PANDA.fk(table.iloc[0]), PANDA.fk(INSIDE))
    np.testing.assert_array_equal(bik.Tracker(PANDA, table.iloc[0], dt=DT).q, INSIDE)
    plan = bik.plan_point_to_point(PANDA, start_q=table.iloc[0], end_q=PANDA.clip(INSIDE + 0.1), limits=LIMITS)
    np.testing.assert_array_equal(plan.trajectory.q[0], INSIDE)
    np.testing.assert_array_equal(PANDA.q_from(bik.interop.to_dataframe(plan.trajectory))[0], INSIDE)
    np.testing.assert_array_equal(PANDA.fk(pandas.DataFrame([INSIDE])), PANDA.fk(INSIDE)[None])
    with pytest.raises(bik.UnknownNameError, match="has no joint 'panda_joint9' in q"):
        PANDA.fk(table.rename(columns={"panda_joint2": "panda_joint9"}))
    for call in (
        lambda: bik.time_optimal(table, LIMITS),
        lambda: bik.state_to_state(table.iloc[0], table.iloc[1], LIMITS),
    ):
        with pytest.raises(bik.InvalidInputError, match=r"has names: robot\.q_from puts its numbers in the order"):
            call()
    motion = bik.Trajectory.from_samples([0.0, 1.0], table)
    assert motion.joint_names == names


JOINTS = ", ".join(PANDA.joint_names)


@told(
    [
        (
            lambda: PANDA.q_from([*PANDA.joint_names[:6], "panda_jont7"], INSIDE),
            Unknown,
            f"robot 'panda' has no joint 'panda_jont7' in q (did you mean 'panda_joint7'?); its joints: {JOINTS}; "
            "ignore_extra=True leaves out values of other joints",
        ),
        (
            lambda: PANDA.q_from(PANDA.joint_names[:5], INSIDE[:5]),
            Invalid,
            "names: joints 'panda_joint6' and 'panda_joint7' of robot 'panda' missing; given: "
            + ", ".join(PANDA.joint_names[:5]),
        ),
        (
            lambda: PANDA.q_from([*PANDA.joint_names, "panda_joint1"], [*INSIDE, 0.0]),
            Invalid,
            "names: joint 'panda_joint1' is there twice",
        ),
        (
            lambda: PANDA.q_from(PANDA.joint_names, [0.0] * 6),
            Invalid,
            "values: expected shape (7,) or (m, 7), one per name, got (6,)",
        ),
        (
            lambda: PANDA.q_from(PANDA.joint_names),
            Invalid,
            "values are missing: give names and values, or values with names (a dict, a JointState, a table), got "
            "['panda_joint1', 'panda_joint2', 'panda_joint3', 'panda_j...",
        ),
        (lambda: PANDA.q_from(3, [0.0]), Invalid, "names must be a list of joint names, got 3"),
        (
            lambda: PANDA.q_from(PANDA.joint_names, [*INSIDE[:6], np.nan]),
            Invalid,
            "values must be finite, but joint 'panda_joint7' is NaN",
        ),
    ]
)
def test_wrong_names_are_told(call: Any, error: Any, message: str) -> None:
    assert_told(call, error, message)
