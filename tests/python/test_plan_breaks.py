"""Paths that the tool must leave: the fewest breaks by a search of its own, what is followed, and the reasons."""

from __future__ import annotations

import itertools
import json

import numpy as np
import pytest
from numpy.typing import NDArray
from oracle import SHARED, needs_shared

import beetle_ik as bik

Array = NDArray[np.float64]

UR5E = bik.Robot.named("ur5e")
FAST = {"acceleration": 8.0}
STEP = 0.6  # rad, the largest change of a joint from one point to the next
ON_PATH = 1e-3  # m, rad: the default accuracy of these paths, and more


def bounds(span: float, joint: int, other: float = 2 * np.pi) -> tuple[Array, Array]:
    """Position limits that leave `joint` this span about zero."""
    upper = np.full(6, other)
    upper[joint] = 0.5 * span
    return -upper, upper


def turned(turns: float, points: int = 41) -> Array:
    """A line on which the tool turns about its own axis."""
    angles = np.linspace(0.0, 2 * np.pi * turns, points)
    places = np.linspace([0.45, -0.15, 0.3], [0.45, 0.15, 0.3], points)
    return np.array([bik.pose(at, rpy=[np.pi, 0.0, angle]) for at, angle in zip(places, angles, strict=True)])


def drawn(random: np.random.Generator) -> Array:
    """A line or an arc with a turn of the tool, of round numbers as often as of others."""
    number = lambda low, high: (  # noqa: E731
        float(random.uniform(low, high)) if random.random() < 0.5 else round(float(random.uniform(low, high)), 1)
    )
    radius, turn = number(0.1, 0.3), number(-7.0, 7.0)
    swept = random.choice([0.0, np.pi / 2, np.pi, number(0.5, 3.0)])
    middle = np.array([number(0.35, 0.6), number(-0.2, 0.2), number(0.2, 0.5)])
    share = np.linspace(0.0, 1.0, 41)
    if swept == 0.0:
        places = middle + np.outer(2 * share - 1, [0.0, radius, 0.0])
    else:
        places = middle + radius * np.column_stack([np.cos(swept * share), np.sin(swept * share), 0 * share])
    rpy = [np.pi, number(-0.5, 0.5), 0.0]
    return np.array([bik.pose(at, rpy=[*rpy[:2], turn * part]) for at, part in zip(places, share, strict=True)])


def configurations(robot: bik.Robot, pose: Array, lower: Array, upper: Array) -> Array:
    """All branches of a pose at all whole turns inside the limits."""
    found = bik.solve_all(robot, pose, limits=bik.Limits(lower=np.full(6, -7.0), upper=np.full(6, 7.0))).q
    every = [np.zeros((0, 6))]
    for q in found % (2 * np.pi):
        values = [value + 2 * np.pi * np.arange(-2, 3) for value in q]
        inside = [v[(low <= v) & (v <= high)] for v, low, high in zip(values, lower, upper, strict=True)]
        every.append(np.array(list(itertools.product(*inside))).reshape(-1, 6))
    return np.unique(np.concatenate(every).round(9), axis=0)


def fewest_breaks(robot: bik.Robot, poses: Array, lower: Array, upper: Array) -> int:
    """The smallest number of jumps over configurations at the points, by dynamic programming."""
    breaks, before = None, None
    pending = 0  # whether points have been left out since
    for pose in poses:
        here = configurations(robot, pose, lower, upper)
        if not len(here):
            pending = 1
            continue
        if before is None or breaks is None:
            breaks = np.full(len(here), pending)
        else:
            jump = breaks.min() + 1
            costs = np.full(len(here), jump)
            if not pending:
                near = np.abs(here[:, None] - before[None]).max(axis=2) < STEP
                reached = np.where(near, breaks[None], len(poses)).min(axis=1)
                costs = np.minimum(costs, reached)
            breaks = costs
        before, pending = here, 0
    assert breaks is not None
    return int(breaks.min()) + pending


def followed(plan: bik.Plan, poses: Array) -> Array:
    """Whether each pose is met by the motion between its breaks."""
    robot, motion = plan.robot, plan.trajectory
    begins = [0.0, *(each.end for each in plan.breaks)]
    ends = [*(each.start for each in plan.breaks), motion.duration]
    met = np.zeros(len(poses), dtype=bool)
    for begin, end in zip(begins, ends, strict=True):
        tips = robot.fk(motion.at(np.linspace(begin, end, 4001))[0])
        apart = np.linalg.norm(tips[None, :, :3, 3] - poses[:, None, :3, 3], axis=2)
        turned = np.linalg.norm(tips[None, :, :3, :3] - poses[:, None, :3, :3], axis=(2, 3))
        met |= ((apart < 3 * ON_PATH) & (turned < 0.02)).any(axis=1)
    return met


def require_sound(plan: bik.Plan, poses: Array, lower: Array, upper: Array, acceleration: float = 8.0) -> None:
    """Checks limits, rest at the breaks, order, and that all but the parts left out is followed."""
    motion = plan.trajectory
    q, qd, qdd = motion.at(np.linspace(0.0, motion.duration, 5001))
    assert (q >= lower - 1e-9).all()
    assert (q <= upper + 1e-9).all()
    assert (np.abs(qd) <= np.asarray(plan.limits.velocity) * (1 + 1e-9)).all()
    assert (np.abs(qdd) <= acceleration * (1 + 1e-9)).all()
    edges = [time for each in plan.breaks for time in (each.start, each.end)]
    assert edges == sorted(edges)
    assert np.abs(motion.at(np.array(edges))[1]).max(initial=0.0) < 1e-9
    places = [place for each in plan.breaks for place in (each.at, each.until)]
    assert places == sorted(places)
    met, points = followed(plan, poses), np.arange(len(poses))
    left_out = np.zeros(len(poses), dtype=bool)
    for each in plan.breaks:
        left_out |= (each.at < points) & (points < each.until)
        left_out[0] |= each.at == 0 and each.end == 0.0  # it begins behind the first point
        left_out[-1] |= each.until == points[-1] and each.start == motion.duration  # or ends before the last one
        assert each.reason
    assert met[~left_out].all()


@pytest.mark.parametrize(
    ("turns", "span", "least"), [(0.4, 2 * np.pi, 0), (1.5, 2 * np.pi, 1), (2.5, 2 * np.pi, 2), (2.5, 4 * np.pi, 1)]
)
def test_whole_turns_run_out_as_rarely_as_possible(turns: float, span: float, least: int) -> None:
    poses = turned(turns)
    lower, upper = bounds(span, 5)
    plan = bik.plan_along_path(UR5E, poses, limits=bik.Limits(lower=lower, upper=upper, **FAST), breaks=True)
    assert plan.success
    assert len(plan.breaks) == least
    require_sound(plan, poses, lower, upper)
    assert fewest_breaks(UR5E, poses, lower, upper) == least
    for each in plan.breaks:
        assert each.until - each.at < 1e-3
        assert "joint 'wrist_3_joint' would have to" in each.reason


@pytest.mark.parametrize("seed", range(8))
def test_breaks_are_as_few_as_a_search_of_its_own(seed: int) -> None:
    random = np.random.default_rng(seed)
    poses = drawn(random)
    joint = int(random.integers(6))
    counts = []
    for span in (float(random.choice([1.5, np.pi, 4.0])), 2 * np.pi, 4 * np.pi):
        lower, upper = bounds(span, joint, other=np.pi)
        limits = bik.Limits(lower=lower, upper=upper, **FAST)
        fewest = None
        try:
            fewest = fewest_breaks(UR5E, poses, lower, upper)
            plan = bik.plan_along_path(UR5E, poses, limits=limits, breaks=True)
        except (bik.InvalidInputError, AssertionError):
            assert fewest is None
            continue
        assert plan.success, plan.message
        require_sound(plan, poses, lower, upper)
        assert len(plan.breaks) <= fewest
        counts.append(len(plan.breaks))
    assert counts == sorted(counts, reverse=True)  # wider limits never need more


def test_a_path_that_can_be_followed_has_no_break() -> None:
    poses = turned(0.25)
    limits = bik.Limits(**FAST)
    plain, plan = (bik.plan_along_path(UR5E, poses, limits=limits, breaks=breaks) for breaks in (False, True))
    assert plan.breaks == [] == plain.breaks
    assert (plan.trajectory.q == plain.trajectory.q).all()


def test_points_out_of_reach_are_left_out() -> None:
    places = np.linspace([0.4, -0.1, 0.3], [0.4, 0.1, 0.3], 41)
    places[15:26, 0] += np.sin(np.linspace(0.0, np.pi, 11)) * 0.9
    poses = np.array([bik.pose(at, rpy=[np.pi, 0.0, 0.0]) for at in places])
    limits = bik.Limits(**FAST)
    with pytest.raises(
        bik.InvalidInputError, match=r"of the path cannot be reached.*; try breaks=True, which lets the tool"
    ):
        bik.plan_along_path(UR5E, poses, limits=limits)
    plan = bik.plan_along_path(UR5E, poses, limits=limits, breaks=True)
    assert plan.success
    assert len(plan.breaks) == 1
    alone = [bik.solve(UR5E, pose).success for pose in poses]
    [only] = plan.breaks
    missed = np.flatnonzero(~np.array(alone))
    assert missed[0] - 1 <= only.at <= missed[0]
    assert missed[-1] <= only.until <= missed[-1] + 1
    require_sound(plan, poses, np.full(6, -2 * np.pi), np.full(6, 2 * np.pi))


def test_a_corner_at_the_end_of_what_can_be_followed_is_no_part_of_its_own() -> None:
    robot = bik.Robot.planar([0.5, 0.5])
    angles = np.radians([-90.0, 0.0, 90.0, 90.0, 135.0, 180.0])
    radii = np.array([0.7934444427764789, 0.5, 1.0, 0.7124960762313146, 0.5, 1.0])
    points = np.column_stack([radii * np.cos(angles), radii * np.sin(angles), np.zeros(6)])
    limits = bik.Limits(velocity=2.0, acceleration=10.0, lower=[-3.0, -0.5], upper=[3.0, 0.5])
    plan = bik.plan_along_path(robot, points, limits=limits, accuracy=0.002, breaks=True)
    assert plan.success
    assert plan.breaks
    q = plan.trajectory.at(np.linspace(0.0, plan.trajectory.duration, 500))[0]
    assert np.all(np.abs(q[:, 1]) <= 0.5 + 1e-9)


def test_bodies_in_the_way_are_named_and_passed() -> None:
    robot = UR5E.with_capsules(radius=0.03)
    poses = turned(0.0)
    wall = bik.obstacles.Box([0.45, 0.0, 0.3], [0.2, 0.02, 0.1])
    limits = bik.Limits(**FAST)
    blocked = bik.plan_along_path(robot, poses, limits=limits, obstacles=[wall])
    assert not blocked.success
    assert "obstacle 0 (Box)" in blocked.message
    assert "breaks=True" in blocked.message
    plan = bik.plan_along_path(robot, poses, limits=limits, obstacles=[wall], breaks=True)
    assert plan.success
    assert len(plan.breaks) == 1
    assert plan.clearance >= 1e-3
    assert "obstacle 0 (Box)" in plan.breaks[0].reason
    q = plan.trajectory.at(np.linspace(0.0, plan.trajectory.duration, 2000))[0]
    assert min(bik.obstacles.clearance(robot, each, [wall]) for each in q) >= 1e-3 - 1e-9
    require_sound(plan, poses, np.full(6, -2 * np.pi), np.full(6, 2 * np.pi))


def test_what_is_kept_holds_at_breaks_too() -> None:
    poses = turned(1.5)
    lower, upper = bounds(2 * np.pi, 5)
    limits = bik.Limits(lower=lower, upper=upper, **FAST)
    cup = bik.upright(UR5E, axis=(0, 0, 1), direction=(0, 0, -1), tilt=0.2)
    plan = bik.plan_along_path(UR5E, poses, limits=limits, keep=cup, breaks=True)
    assert plan.success
    assert len(plan.breaks) == 1
    tips = UR5E.fk(plan.trajectory.at(np.linspace(0.0, plan.trajectory.duration, 3000))[0])
    assert np.arccos(np.clip(-tips[:, 2, 2], -1.0, 1.0)).max() <= 0.2 + 1e-9


def test_the_start_given_is_where_it_begins() -> None:
    poses = turned(0.9)
    lower, upper = bounds(4 * np.pi, 5)
    limits = bik.Limits(lower=lower, upper=upper, **FAST)
    starts = configurations(UR5E, poses[0], lower, upper)
    for start in (starts[starts[:, 5].argmin()], starts[starts[:, 5].argmax()]):
        plan = bik.plan_along_path(UR5E, poses, start_q=start, limits=limits, breaks=True)
        assert plan.success
        assert np.abs(plan.trajectory.q[0] - start).max() < 1e-12


def test_tip_and_jerk_limits_hold_at_breaks() -> None:
    poses = turned(1.5)
    lower, upper = bounds(2 * np.pi, 5)
    limits = bik.Limits(lower=lower, upper=upper, acceleration=8.0, jerk=100.0, tip_speed=0.1)
    plan = bik.plan_along_path(UR5E, poses, limits=limits, breaks=True)
    assert plan.success
    assert len(plan.breaks) == 1
    motion = plan.trajectory
    t = np.linspace(0.0, motion.duration, 20001)
    speed = np.linalg.norm(np.diff(UR5E.fk(motion.at(t)[0])[:, :3, 3], axis=0), axis=1) / t[1]
    assert speed.max() <= 0.1 * (1 + 1e-6)
    assert motion.max_acceleration().max() <= 8.0 * (1 + 1e-9)


def test_a_slower_timing_keeps_the_breaks() -> None:
    lower, upper = bounds(2 * np.pi, 5)
    plan = bik.plan_along_path(UR5E, turned(1.5), limits=bik.Limits(lower=lower, upper=upper, **FAST), breaks=True)
    slow = plan.retime(bik.Limits(velocity=0.3, acceleration=1.0))
    factor = slow.trajectory.duration / plan.trajectory.duration
    [before], [after] = plan.breaks, slow.breaks
    assert after.start == pytest.approx(factor * before.start)
    assert after.end == pytest.approx(factor * before.end)
    assert (after.at, after.until, after.reason) == (before.at, before.until, before.reason)


def test_the_published_method_takes_no_breaks() -> None:
    planar = bik.Robot.planar([1.0, 1.0, 1.0])
    star = bik.paths.pentagram((1.0, 1.0, 0.0), 5.0, radius=0.5)
    said = 'leaving the path at breaks needs method="timed"'
    with pytest.raises(bik.InvalidInputError, match=said):
        bik.plan_along_path(planar, star, method="tpbso", breaks=True)


@needs_shared
def test_the_square_of_cppflow_is_followed_with_one_break() -> None:
    problem = json.loads((SHARED / "cppflow/panda__square.json").read_text())
    rows = np.loadtxt(SHARED / "cppflow/panda__square.csv", delimiter=",", skiprows=1)
    poses = np.array([bik.pose(row[:3], wxyz=row[3:]) for row in rows])
    file = SHARED / "motionbenchmaker/robots/panda/panda.urdf"
    robot = bik.Robot.from_urdf(file, base=problem["base"], tip=problem["tip"], collision=None)
    limits = bik.Limits(acceleration=5.0, lower=problem["lower"], upper=problem["upper"])
    with pytest.raises(
        bik.InvalidInputError, match=r"points 15\d to 18\d of the path.*joint 'panda_joint5' at its limit"
    ):
        bik.plan_along_path(robot, poses, limits=limits)
    plan = bik.plan_along_path(robot, poses, limits=limits, breaks=True)
    assert plan.success
    assert len(plan.breaks) == 1
    [only] = plan.breaks
    assert 150 < only.at < 155
    assert 180 < only.until < 183
    assert "'panda_joint5'" in only.reason
    require_sound(plan, poses, np.array(problem["lower"]), np.array(problem["upper"]), acceleration=5.0)


@needs_shared
@pytest.mark.parametrize(("name", "longest"), [("panda__1cube", 7.6), ("panda__2cubes", 12.6)])
def test_paths_of_cppflow_among_boxes_are_short(name: str, longest: float) -> None:
    problem = json.loads((SHARED / f"cppflow/{name}.json").read_text())
    rows = np.loadtxt(SHARED / f"cppflow/{name}.csv", delimiter=",", skiprows=1)
    poses = np.array([bik.pose(row[:3], wxyz=row[3:]) for row in rows])
    files = SHARED / "motionbenchmaker/robots/panda"
    robot = bik.Robot.from_urdf(
        files / "panda_spherized.urdf", base=problem["base"], tip=problem["tip"], srdf=files / "panda.srdf"
    )
    limits = bik.Limits(acceleration=5.0, lower=problem["lower"], upper=problem["upper"])
    plan = bik.plan_along_path(
        robot,
        poses,
        limits=limits,
        obstacles=[bik.obstacles.Box(box["center"], box["size"]) for box in problem["boxes"]],
        margin=1e-4,
        accuracy=1e-4,
        objective="joint_travel",
        stop=bik.Stop(max_evaluations=1),
    )
    assert plan.success
    assert plan.breaks == []
    tips = robot.fk(q := plan.trajectory.at(np.linspace(0.0, plan.trajectory.duration, 20001))[0])
    at = [int(np.linalg.norm(tips[:, :3] - pose[:3], axis=(1, 2)).argmin()) for pose in poses]
    assert at == sorted(at)
    assert np.linalg.norm(tips[at, :3, 3] - poses[:, :3, 3], axis=1).max() < 2e-4  # sampled in time
    assert np.abs(np.diff(q[at], axis=0)).sum() <= longest
    assert np.degrees(np.abs(np.diff(q[at], axis=0)).max()) <= 7.0
