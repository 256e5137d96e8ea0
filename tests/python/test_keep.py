"""What must hold along the way: `keep=` of the planners, judged by numpy at 5,000 samples of the timed motion."""

from __future__ import annotations

import pickle
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from kept_motions import INF, KINDS, Arm, allowed, arm, constraint, end_of, errors, samples
from mistakes import Invalid
from numpy import inf  # noqa: F401 -- texts of values are evaluated
from numpy.typing import NDArray
from pair_of_pandas import pair_of_pandas
from scipy.spatial.transform import Rotation

import beetle_ik as bik
from beetle_ik import Keep, tasks

Array = NDArray[np.float64]
api: Any = bik  # wrong calls on purpose
LIMITS = {
    "velocity": bik.Limits(velocity=1.0),
    "acceleration": bik.Limits(velocity=1.0, acceleration=4.0),
    "jerk": bik.Limits(velocity=1.0, acceleration=4.0, jerk=40.0),
}
BUDGET = bik.Stop(max_evaluations=100_000)
PANDA = bik.Robot.named("panda")
Q = np.array([0.0, -0.5, 0.0, -2.2, 0.0, 1.7, 0.8])  # the hand points down
ASIDE = np.array([1.2, -0.3, 0.0, -2.0, 0.0, 1.7, 0.8])
RATED = bik.Limits(acceleration=5.0)


def moved(q: Array, joint: int, by: float) -> Array:
    """The configuration with one joint moved (rad)."""
    return q + by * np.eye(len(q))[joint]


def judge(arm: Arm, plan: bik.Plan, keeps: list[Keep]) -> None:
    """Checks that everything holds at each sample, and that the bounds of the plan are true and tight."""
    poses = arm.poses(samples(plan))
    assert len(plan.kept) == len(keeps)
    for keep, (kept, bounds) in zip(keeps, plan.kept, strict=True):
        assert kept == keep
        found, most = errors(keep, poses), allowed(keep)
        assert not np.isinf(found).any(), f"outside of the region: {keep}"
        limited = np.isfinite(most)
        assert np.isnan(bounds[~limited]).all(), bounds
        largest, most, bounds = found.max(axis=0)[limited], most[limited], bounds[limited]
        assert (largest <= most * (1 + 1e-6) + 1e-9).all(), f"{largest} beyond {most}: {keep}"
        assert (bounds >= largest - 1e-9).all(), f"bounds {bounds} below {largest}: {keep}"
        assert (bounds <= 1.02 * largest + 0.02 * np.minimum(most, 0.1) + 1e-9).all(), f"{bounds} of {largest}: {keep}"


Problem = tuple[Arm, list[Keep], Array, Array]


def problem(
    name: str, seed: int, kinds: list[str], tolerance: float, *, bodies: bool = False, at_limit: bool = False
) -> Problem:
    """Returns the first problem from this seed on for which scipy finds an end."""
    for each in range(seed, seed + 1000, 100):
        random = np.random.default_rng([len(name), each])
        one = arm(name, random, bodies)
        lower, upper = (np.clip(bound, -3.0, 3.0) for bound in (one.robot.lower, one.robot.upper))
        start = lower + (upper - lower) * random.uniform(0.1, 0.9, one.robot.dof)
        pose = one.poses(start[None])[0]
        keeps = [constraint(kind, pose, tolerance, random, at_limit=at_limit) for kind in kinds]
        end = end_of(one, keeps, start, random)
        if end is not None:
            return one, keeps, start, end
    raise AssertionError("no end was found")


def planned(given: Problem, limits: bik.Limits = RATED, **options: Any) -> bik.Plan:
    one, keeps, start, end = given
    ends = {"start_q": start, "end_q": end} | options
    return bik.plan_point_to_point(one.robot, keep=keeps, limits=limits, stop=BUDGET, self_collision=False, **ends)


@pytest.mark.parametrize("name", ["panda", "ur5e", "7"])
@pytest.mark.parametrize("kind", KINDS)
def test_what_is_kept_holds_at_every_instant(name: str, kind: str) -> None:
    random = np.random.default_rng([len(name), KINDS.index(kind)])
    other = KINDS[(KINDS.index(kind) + random.integers(1, 6)) % 6]
    solved = 0
    for seed, kinds in enumerate([[kind], [kind], [kind, other]]):
        tolerance = float(random.choice([np.radians(3), 0.1, 0.2, np.radians(60)]))
        given = problem(name, seed, kinds, tolerance, bodies=seed == 1)
        plan = planned(given, list(LIMITS.values())[seed])
        if plan.success:
            judge(given[0], plan, given[1])
            solved += 1
        else:
            assert ": none found in " in plan.message
    assert solved >= 2


@pytest.mark.parametrize("kind", KINDS)
def test_a_start_exactly_at_its_tolerance_is_taken(kind: str) -> None:
    for name, tolerance in (("panda", 0.1), ("ur5e", 0.5)):
        given = problem(name, 7, [kind], tolerance, at_limit=True)
        plan = planned(given)
        assert plan.success, plan.message
        judge(given[0], plan, given[1])


def test_a_wider_tilt_never_loses_a_plan() -> None:
    tilts = np.radians([3, 5, 10, 20, 40, 60, 180])
    for seed in range(6):
        one, [narrow], start, end = problem("panda", seed, ["upright"], tilts[0])
        axis = narrow.task.axis if narrow.task else (0, 0, 1)
        direction = narrow.target[:3, :3] @ axis
        found = [
            planned((one, [bik.upright(one.robot, axis=axis, direction=direction, tilt=tilt)], start, end)).success
            for tilt in tilts
        ]
        assert found == sorted(found)


def test_a_planar_arm_keeps_a_line_among_obstacles() -> None:
    robot = bik.Robot.planar([1.0, 0.8, 0.6, 0.4], velocity=1.0)
    start = np.array([1.2, -0.8, -0.5, -0.3])

    def tip(q: Array) -> Array:
        angle = np.cumsum(q, axis=1)
        return np.stack([np.cos(angle) @ [1.0, 0.8, 0.6, 0.4], np.sin(angle) @ [1.0, 0.8, 0.6, 0.4]], axis=1)

    height = tip(start[None])[0, 1]
    keep = Keep((0.0, height, 0.0), tasks.Position(tolerance=[INF, 0.05, INF]))
    end = bik.solve(robot, (tip(start[None])[0, 0] - 1.0, height, 0.0), start_q=start).q
    ball = bik.obstacles.Sphere((0.7, 0.2, 0.0), 0.1)
    for options in ({}, {"obstacles": [ball]}):
        plan = bik.plan_point_to_point(robot, start_q=start, end_q=end, keep=keep, limits=RATED, **options)
        assert plan.success, plan.message
        off = np.abs(tip(samples(plan))[:, 1] - height).max()
        [(_, bounds)] = plan.kept
        assert off <= bounds[1] <= 0.05
        assert bounds[1] <= 1.02 * off + 0.001


def tilt_of(plan: bik.Plan) -> float:
    z = PANDA.fk(samples(plan))[:, :3, 2]
    return float(np.arctan2(np.hypot(z[:, 0], z[:, 1]), -z[:, 2]).max())


@pytest.mark.parametrize("bodies", [False, True])
def test_it_holds_with_obstacles_and_straight_ends(bodies: bool) -> None:
    robot = PANDA.with_capsules(radius=0.05) if bodies else PANDA
    wall = bik.obstacles.Box(center=(0.55, 0.3, 0.15), size=(0.4, 0.05, 0.3))
    keep = bik.upright(robot, tilt=0.15)
    scene = {"obstacles": [wall]} if bodies else {}
    plan = bik.plan_point_to_point(
        robot, start_q=Q, end_q=ASIDE, keep=keep, limits=RATED, approach=0.05,
        retreat=bik.StraightLine(0.05, direction=(0, 0, 1), frame="base"), **scene,
    )  # fmt: skip
    assert plan.success, plan.message
    assert tilt_of(plan) <= plan.kept[0][1][3] <= 0.15


def test_a_straight_end_that_breaks_it_is_an_error() -> None:
    plane = PANDA.fk(Q)[2, 3]
    keep = Keep((0, 0, plane), tasks.Position(tolerance=[INF, INF, 0.02]))
    with pytest.raises(Invalid) as refused:
        bik.plan_point_to_point(PANDA, start_q=Q, end_q=moved(Q, 0, 1), keep=keep, retreat=0.1)
    assert str(refused.value).startswith(
        "start_q cannot be reached: no straight retreat of 0.1000 m: what is to be kept on the way does not hold "
        "on it: "
        "deviation in z is 0."
    )


def test_it_holds_from_a_start_velocity() -> None:
    keep = bik.upright(PANDA, tilt=0.2)
    options: Any = {"start_q": Q, "end_q": ASIDE, "keep": keep, "limits": RATED}
    plan = bik.plan_point_to_point(PANDA, start_qd=[0.5, 0.1, -0.2, 0.1, 0.1, 0.1, 0.3], **options)
    assert plan.success, plan.message
    np.testing.assert_allclose(plan.trajectory.at(0.0)[1], [0.5, 0.1, -0.2, 0.1, 0.1, 0.1, 0.3], atol=1e-9)
    assert tilt_of(plan) <= plan.kept[0][1][3] <= 0.2
    with pytest.raises(bik.InfeasibleError, match=r"^infeasible: at start_qd the arm cannot stop"):
        bik.plan_point_to_point(PANDA, start_qd=[0, 0, 0, 0, 0, 2.0, 0], **options)
    tilted = moved(Q, 5, 0.3)
    with pytest.raises(Invalid, match=r"^start_q: .*: tilt 0\.30\d* rad of at most 0\.2000$"):
        bik.plan_point_to_point(PANDA, start_qd=[0.1] * 7, **(options | {"start_q": tilted}))


def test_ends_may_be_poses_and_alternatives() -> None:
    keep = bik.upright(PANDA, tilt=0.2)
    poses = [PANDA.fk(q) for q in (ASIDE, moved(Q, 0, -1))]
    tipped = poses[0] @ bik.pose(rpy=[0.5, 0, 0])
    for options in ({"end": poses[0]}, {"end": [tipped, *poses]}, {"end_q": [moved(ASIDE, 5, 0.5), ASIDE]}):
        plan = bik.plan_point_to_point(PANDA, start_q=Q, keep=keep, limits=RATED, **options)
        assert plan.success, plan.message
        assert tilt_of(plan) <= plan.kept[0][1][3] <= 0.2
        assert len(next(iter(options.values()))) == 4 or plan.chosen_end != 0


def test_a_batch_keeps_what_each_plan_keeps() -> None:
    cup, plane = bik.upright(PANDA, tilt=0.2), Keep((0, 0, 0.5), tasks.Position(tolerance=[INF, INF, 0.3]))
    problems: list[dict[str, Any]] = [
        {"start_q": Q, "end_q": ASIDE}, {"start_q": Q, "end_q": ASIDE, "keep": [cup, plane]},
        {"start_q": Q, "end_q": ASIDE, "keep": []}, {"start_q": moved(Q, 5, 0.5), "end_q": ASIDE},
    ]  # fmt: skip
    batch = bik.plan_batch(PANDA, problems, keep=cup, limits=RATED)
    assert [None if plan is None else [kept for kept, _ in plan.kept] for plan in batch] == [
        [cup], [cup, plane], [], None,
    ]  # fmt: skip
    assert "tilt 0.5" in str(batch.errors[3])
    alone = bik.plan_point_to_point(PANDA, start_q=Q, end_q=ASIDE, keep=cup, limits=RATED)
    np.testing.assert_array_equal(batch[0].trajectory.coefficients, alone.trajectory.coefficients)


def test_a_new_timing_is_certified_again() -> None:
    for seed in range(6):
        given = problem("panda", seed, ["upright"], 0.1)
        plan = planned(given)
        if not plan.success:
            continue
        for limits in (bik.Limits(velocity=0.5, acceleration=1.0), LIMITS["jerk"]):
            retimed = plan.retime(limits)
            assert [kept for kept, _ in retimed.kept] == given[1]
            judge(given[0], retimed, given[1])


def test_a_tilt_of_half_a_turn_allows_everything() -> None:
    plan = bik.plan_point_to_point(PANDA, start_q=Q, end_q=ASIDE, keep=bik.upright(PANDA, tilt=np.pi), limits=RATED)
    free = bik.plan_point_to_point(PANDA, start_q=Q, end_q=ASIDE, limits=RATED)
    assert plan.success
    np.testing.assert_allclose(plan.cost, free.cost, rtol=1e-3)


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -2), (1, 0, 0), (0.6, 0, 0.8)])
def test_upright_turns_the_axis_to_the_direction(axis: tuple[float, float, float]) -> None:
    unit = np.array(axis) / np.linalg.norm(axis)
    for direction in (unit, -unit, np.array([0, 0, -1.0]), np.array([0, 3.0, 0]), -unit + [1e-9, 0, 0]):
        keep = bik.upright(PANDA, axis=axis, direction=direction, tilt=0.1)
        turned = keep.target[:3, :3]
        np.testing.assert_allclose(turned @ unit, direction / np.linalg.norm(direction), atol=2e-9)
        np.testing.assert_allclose(turned @ turned.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(turned) > 0


def test_an_end_that_breaks_it_says_by_how_much() -> None:
    tipped = moved(Q, 5, 0.3)
    keep = bik.upright(PANDA, tilt=0.2)
    says = "what is to be kept on the way does not hold there: tilt 0.3000 rad of at most 0.2000"
    for name, ends in {"start_q": (tipped, Q), "end_q": (Q, tipped)}.items():
        with pytest.raises(Invalid) as refused:
            bik.plan_point_to_point(PANDA, start_q=ends[0], end_q=ends[1], keep=keep)
        assert str(refused.value) == f"{name}: {says}"


def test_no_way_is_none_found_and_never_impossible() -> None:
    robot = PANDA.with_capsules(radius=0.05)
    wall = bik.obstacles.Box(center=(0.55, 0.3, 0.3), size=(0.6, 0.05, 0.6))
    keep = bik.upright(robot, tilt=0.05)
    plan = bik.plan_point_to_point(
        robot, start_q=Q, end_q=ASIDE, keep=keep, obstacles=[wall], limits=RATED, stop=bik.Stop(max_evaluations=20)
    )
    assert not plan.success
    assert plan.message.startswith("no clear plan for the way from start to end: none found in ")
    assert "impossible" not in plan.message


def test_a_plan_that_keeps_nothing_has_an_empty_list() -> None:
    plan = bik.plan_point_to_point(PANDA, start_q=Q, end_q=ASIDE, limits=RATED)
    assert (plan.kept, plan.retime(LIMITS["jerk"]).kept) == ([], [])


def test_the_published_planner_keeps_nothing() -> None:
    with pytest.raises(Invalid) as refused:
        bik.plan_point_to_point(PANDA, start_q=Q, end_q=ASIDE, keep=bik.upright(PANDA), method="tpbso")
    assert str(refused.value) == ('keep is held by method="minmax": method="tpbso" checks nothing on the way')


POSE = bik.pose([0.1, -0.2, 1 / 3], rotvec=[0.1, 0.2, 0.3])
KEEPS = [
    Keep((0.1, 1 / 3, 0.3)),
    Keep(POSE),
    Keep(POSE, tasks.Pose(tolerance=[0.1, 0.1, 1 / 3, 1.0, INF, 7.0])),
    Keep(POSE, tasks.Orientation(tolerance=[0.1, 0.1, INF])),
    Keep((0, 0, 0.3), tasks.Position(tolerance=[INF, INF, 0.01])),
    Keep((0, 0, 0), tasks.Position(tolerance=[INF] * 3, region=[(-1, -1, 0), (1, 1, 1)])),
    Keep({"left": (0.1, 0.2, 0.3), ("left", "right"): POSE}),
    Keep({"it's": POSE}),
    bik.upright(PANDA, tilt=0.1),
    bik.upright(PANDA, axis=(0.6, 0, 0.8), direction=(1, 2, 3), tilt=np.pi),
]


@pytest.mark.parametrize("keep", KEEPS, ids=range(len(KEEPS)))
def test_a_keep_is_a_value(keep: Keep) -> None:
    again, read = pickle.loads(pickle.dumps(keep)), eval(repr(keep))
    assert (again, hash(again), repr(again)) == (keep, hash(keep), repr(keep))
    # A matrix that is read becomes a rotation, to the last bit but one.
    targets = [each.target if isinstance(each.target, dict) else {None: each.target} for each in (read, keep)]
    assert list(targets[0]) == list(targets[1])
    for key, target in targets[0].items():
        np.testing.assert_allclose(target, targets[1][key], rtol=0, atol=1e-15)
    assert (read.task, Keep(keep.target, keep.task).task) == (keep.task, keep.task)
    assert sum(keep == other for other in KEEPS) == 1
    assert keep != "keep"
    fixed: Any = keep
    with pytest.raises(AttributeError):
        fixed.target = POSE


def test_a_keep_says_what_it_was_given() -> None:
    np.testing.assert_array_equal(KEEPS[0].target, (0.1, 1 / 3, 0.3))
    np.testing.assert_allclose(KEEPS[1].target, POSE, atol=1e-15)
    assert (KEEPS[0].task, KEEPS[4].task) == (None, tasks.Position(tolerance=[INF, INF, 0.01]))
    assert list(KEEPS[6].target) == ["left", ("left", "right")]


WRONG = {
    "keep: expected a Keep or a list of them, got 5": lambda: plan_with(5),
    "keep: expected a Keep or a list of them, got None": lambda: plan_with([None]),
    "keep: expected a Keep or a list of them, got 'upright'": lambda: plan_with("upright"),
    "target: the dict is empty; name one tip, or a pair of tips, at least": lambda: Keep({}),
    "keys of target are names of tips, or pairs of them (from, of), got 1": lambda: api.Keep({1: POSE}),
    "task must be one of beetle_ik.tasks, got 5": lambda: api.Keep(POSE, 5),
    "robot 'panda' has no tip 'hand'; its tips: flange": lambda: plan_with(Keep({"hand": POSE})),
    "tilt must be positive, got -1.0": lambda: bik.upright(PANDA, tilt=-1.0),
    "tilt must be positive, got NaN": lambda: bik.upright(PANDA, tilt=np.nan),
    "tilt must be at most pi, at which any axis is allowed, got inf; np.radians converts degrees": lambda: bik.upright(
        PANDA, tilt=INF
    ),
    "tilt must be a number, got 'a'": lambda: api.upright(PANDA, tilt="a"),
    "axis: expected shape (3,), got (2,)": lambda: bik.upright(PANDA, axis=(0, 1)),
    "axis must be finite, but entry 2 is NaN": lambda: bik.upright(PANDA, axis=(0, 0, np.nan)),
    "direction must be finite, but entry 0 is inf": lambda: bik.upright(PANDA, direction=(INF, 0, 0)),
    "axis must be an array of numbers, got 'z'": lambda: api.upright(PANDA, axis="z"),
    "tip must be text, got 3": lambda: api.upright(PANDA, tip=3),
    "robot must be a Robot, such as Robot.named('panda'), got 'panda'": lambda: api.upright("panda"),
    "Keep() missing 1 required positional argument: 'target': call it as Keep(target, ...)": lambda: api.Keep(),
}


def plan_with(keep: Any) -> bik.Plan:
    return bik.plan_point_to_point(PANDA, start_q=Q, end_q=ASIDE, keep=keep)


@pytest.mark.parametrize("message", WRONG)
def test_wrong_input_is_named(message: str) -> None:
    with pytest.raises(bik.BeetleIkError) as refused:
        WRONG[message]()
    assert str(refused.value) == message


def test_a_robot_with_two_tips_names_the_one() -> None:
    pair = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
    start = np.array([0.2, 0.0, *Q, *Q])
    end = start + 0.1 * np.eye(16)[2] + 0.1 * np.eye(16)[9]
    plain = pair.fk(start)[0]
    left = bik.upright(pair, direction=plain[:3, 2], tilt=0.2, tip="left_tool")
    assert list(left.target) == ["left_tool"]
    plan = bik.plan_point_to_point(pair, start_q=start, end_q=end, keep=left, limits=RATED, self_collision=False)
    assert plan.success, plan.message
    z = pair.fk(samples(plan, 500))[:, 0, :3, 2]
    tilt = Rotation.align_vectors(z[-1:], plain[None, :3, 2])[0].magnitude()
    assert tilt <= plan.kept[0][1][3] <= 0.2
    with pytest.raises(Invalid) as refused:
        bik.plan_point_to_point(pair, start_q=start, end_q=end, keep=KEEPS[0], limits=RATED)
    assert str(refused.value) == (
        "keep: robot 'pair_of_pandas' has several tips, 'left_tool', 'right_tool': give Keep a dict from tips to "
        "targets, or upright one tip="
    )


def test_the_judge_notices_a_motion_that_breaks_it() -> None:
    given = problem("panda", 0, ["upright"], 0.1)
    one, _, start, end = given
    free = bik.plan_point_to_point(one.robot, start_q=start, end_q=end, limits=RATED)
    narrow = constraint("upright", one.poses(start[None])[0], 1e-3, np.random.default_rng(0))

    spoiled: Any = SimpleNamespace(
        trajectory=free.trajectory, kept=[(narrow, np.array([np.nan, np.nan, np.nan, 1e-3]))]
    )
    with pytest.raises(AssertionError, match="beyond"):
        judge(one, spoiled, [narrow])
