"""Poses of which one part comes first, tolerances that are aimed at, and joints that are to stay."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from arms_of_few_joints import ARMS, FOUR, HOBBY, OFF_AXIS, ROUND, Array, errors, least_angle, turned
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

import beetle_ik as bik

GIVEN_UP = bik.Status.ROTATION_GIVEN_UP
QUARTERS = np.array([0.0, 0.5, 1.0, 2.0, -1.0]) * np.pi / 2


def of_joints(joints: list[tuple[str, str, str, str, str]]) -> bik.Robot:
    """An arm of these joints: kind, place and turn seen from the one before, axis, and range."""
    text = "".join(
        f"<link name='l{i + 1}'/><joint name='j{i}' type='{kind}'><parent link='l{i}'/><child link='l{i + 1}'/>"
        f"<origin xyz='{xyz}' rpy='{rpy}'/><axis xyz='{axis}'/><limit {limit} velocity='1' effort='1'/></joint>"
        for i, (kind, xyz, rpy, axis, limit) in enumerate(joints)
    )
    return bik.Robot.from_urdf(f"<robot name='arm'><link name='l0'/>{text}</robot>")


@pytest.mark.parametrize("name", ARMS)
def test_the_place_is_met_and_the_turn_least(name: str) -> None:
    robot, random = ARMS[name], np.random.default_rng(1)
    for i, q in enumerate(robot.random_configurations(12, seed=2)):
        # Half of the turns are of round numbers.
        vector = random.choice(QUARTERS, 3) if i % 2 else random.normal(0.0, 0.6, 3)
        target = turned(robot.fk(q), vector)
        found = bik.solve(robot, target)
        away, angle = errors(robot, found.q, target)
        assert away < 1e-6, (i, found.message)
        assert ((robot.lower <= found.q) & (found.q <= robot.upper)).all()
        assert found.status == (bik.Status.SOLVED if angle < 1e-6 else GIVEN_UP)
        assert angle <= least_angle(robot, target, 6, seed=i) + 1e-3, (i, found.message)


def test_a_branch_between_two_limits_is_found() -> None:
    """Branches that limits leave a few milliradians of the fourth joint."""
    random, robot = np.random.default_rng(5), ARMS["hobby"]
    for _ in range(60):
        q = robot.random_configurations(1, seed=int(random.integers(1 << 30)))[0]
        width = 10.0 ** random.uniform(-5.0, -1.0)
        lower, upper = robot.lower.copy(), robot.upper.copy()
        for joint in random.choice(3, 2, replace=False):
            if random.random() < 0.5:
                lower[joint] = q[joint] - width
            else:
                upper[joint] = q[joint] + width
        turn = 0.01 * random.normal(size=3)
        limits = bik.Limits(lower=lower, upper=upper)
        found = bik.solve(robot, turned(robot.fk(q), turn), limits=limits)
        assert found.position_error < 1e-6, found.message
        assert found.rotation_error <= np.linalg.norm(turn) + 1e-3, (q, lower, upper)


def test_a_branch_beside_the_end_of_another_is_found() -> None:
    """The best branch keeps the fourth joint within 0.03 rad, and one of its ends is where another branch ends too."""
    robot = of_joints(
        [
            ("continuous", "0 0 0", "0 -2 0", "1 0 0", ""),
            ("revolute", "0 0.24 -0.09", "-2.59 -1.29 -1.48", "0.494 -0.26 0.89", "lower='1' upper='2.31'"),
            ("revolute", "-0.2589 0.091549 0.397697", "0 -1.5708 0", "1 0 0", "lower='-2.48442' upper='1.1439'"),
            (
                "revolute",
                "-0.209961 -0.31448 -0.139364",
                "0.351479 -0.707416 -1.14696",
                "1.59882 -0.117097 -0.667275",
                "lower='-2.05235' upper='0.631979'",
            ),
            (
                "continuous",
                "-0.2659 -0.115808 -0.342359",
                "-2.40308 -1.93872 0.135844",
                "0.123568 0.829574 0.464269",
                "",
            ),
        ]
    )
    turn = np.array([-0.2947, 0.6847, 0.6605])
    found = bik.solve(robot, turned(robot.fk([-1.897, 2.2139, -0.0455, 0.246, -2.5886]), turn))
    assert found.position_error < 1e-6, found.message
    assert found.rotation_error <= np.linalg.norm(turn) + 1e-3


def test_few_poses_of_random_arms_are_missed() -> None:
    """Optima between two values of the scan: every seed of it is descended from."""
    random, missed = np.random.default_rng(2), 0
    for _ in range(40):
        joints = [
            (
                "revolute",
                " ".join(map(str, random.uniform(-0.4, 0.4, 3))),
                " ".join(map(str, random.uniform(-3.1, 3.1, 3))),
                " ".join(map(str, random.normal(size=3))),
                f"lower='{random.uniform(-2.8, -0.3)}' upper='{random.uniform(0.3, 2.8)}'",
            )
            for _ in range(5)
        ]
        robot = of_joints(joints)
        for q in robot.random_configurations(50, seed=int(random.integers(1 << 30))):
            turn = random.normal(0.0, 0.03, 3)
            found = bik.solve(robot, turned(robot.fk(q), turn))
            assert found.position_error < 1e-6, found.message
            missed += found.rotation_error > np.linalg.norm(turn) + 1e-3
    assert missed <= 1


def test_a_place_in_a_corner_of_the_limits_is_found() -> None:
    """An arm with a sliding joint, which searches: four of its joints are at their limits there."""
    robot = of_joints(
        [
            ("revolute", "-0.288 0.192 0.205", "0 -1.5708 1.5708", "0 1 0", "lower='-1.02' upper='2.63'"),
            (
                "revolute",
                "0.386 0.0536 -0.0585",
                "2.342 -2.895 1.159",
                "1.504 -0.205 0.454",
                "lower='-1.12' upper='1.08'",
            ),
            ("revolute", "-0.286 0.394 0.235", "2.72 0.2 1.323", "-0.466 -0.245 -0.057", "lower='-1.64' upper='1.09'"),
            ("prismatic", "0.367 -0.309 0.256", "-1.5708 1.5708 0", "0 1 0", "lower='-0.11' upper='0.165'"),
            ("revolute", "-0.173 -0.29 -0.08", "0 1.5708 1.5708", "1 0 0", "lower='-2.65' upper='1.47'"),
        ]
    )
    target = turned(robot.fk([2.63, 1.08, -1.64, 0.165, -1.928]), np.array([0.7263, 0.8708, 2.0515]))
    for seed in range(8):
        found = bik.solve(robot, target, seed=seed)
        assert found.position_error < 1e-6, (seed, found.message)


def test_three_joints_carry_a_tool_to_its_place() -> None:
    """An arm whose tip is on its last axis, so that the last joint moves the tool alone, and not far."""
    arm = of_joints(
        [
            ("continuous", "0.02 0.27 -0.33", "1.57 -1.57 0", "1 0 0", ""),
            ("revolute", "0.3 -0.26 -0.05", "-1.57 1.57 -1.57", "0 1 0", "lower='-2.67' upper='2.22'"),
            ("revolute", "0.28 0.06 -0.06", "-2.46 1.03 -0.01", "0.3 -1.58 -0.12", "lower='-0.3' upper='0.1'"),
        ]
    )
    robot = arm.with_tool(bik.pose([0.0, 0.05, -0.01]))
    for q in robot.random_configurations(300, seed=6):
        found = bik.solve(robot, turned(robot.fk(q), np.array([0.5, 0.0, -0.4])))
        assert found.position_error < 1e-6, found.message


@pytest.mark.parametrize(("name", "most"), [("hobby", 5.0), ("off_axis", 24.0), ("four", 4.0), ("round", 8.0)])
def test_the_place_is_met_in_few_evaluations(name: str, most: float) -> None:
    robot, random = ARMS[name], np.random.default_rng(3)
    targets = [turned(robot.fk(q), random.normal(0.0, 0.3, 3)) for q in robot.random_configurations(100, seed=8)]
    assert np.mean([bik.solve(robot, target).evaluations for target in targets]) < most


def test_a_start_chooses_among_equal_branches() -> None:
    for q in HOBBY.random_configurations(20, seed=3):
        target = turned(HOBBY.fk(q), np.array([0.2, -0.1, 0.3]))
        free = bik.solve(HOBBY, target)
        near = bik.solve(HOBBY, target, start_q=q)
        assert near.rotation_error == pytest.approx(free.rotation_error, abs=1e-4)
        assert np.linalg.norm(near.q - q) <= np.linalg.norm(free.q - q) + 1e-9


def test_a_batch_gives_up_like_single_solves() -> None:
    targets = np.array(
        [turned(HOBBY.fk(q), np.array([0.3, 0.1, 0.0])) for q in HOBBY.random_configurations(20, seed=4)]
    )
    batch = bik.solve_batch(HOBBY, targets, threads=2)
    alone = [bik.solve(HOBBY, target) for target in targets]
    np.testing.assert_array_equal(batch.q, [found.q for found in alone])
    np.testing.assert_array_equal(batch.status, [found.status for found in alone])
    assert not batch.success.any()


def test_the_message_says_what_was_given_up() -> None:
    target = turned(HOBBY.fk(np.array([0.1, 0.2, 0.3, 0.4, 0.5])), np.array([0.3, 0.1, 0.4]))
    found = bik.solve(HOBBY, target)
    assert found.status == GIVEN_UP
    assert found.message.startswith("position met to ")
    assert " m, rotation given up: the nearest found is 0." in found.message
    assert found.message.endswith(
        " rad away: turn the target, give the rotation a tolerance, "
        "or take a task that leaves it free, such as Position or Pointing"
    )


def test_beyond_reach_the_place_is_nearest_then_the_turn() -> None:
    for robot in (HOBBY, FOUR, ROUND):
        target = np.eye(4)
        target[:3, 3] = 0.9 * np.array([1.0, 0.3, 0.9]) * (3.0 if robot is ROUND else 1.0)
        target[:3, :3] = Rotation.from_rotvec([0.7, 0.2, -0.4]).as_matrix()
        found = bik.solve(robot, target)
        away, _ = errors(robot, found.q, target)
        random = np.random.default_rng(0)
        least = np.inf
        for _ in range(20):

            def missing(q: Array, robot: bik.Robot = robot, place: Array = target[:3, 3]) -> Array:
                return robot.fk(q)[:3, 3] - place

            start = random.uniform(robot.lower, robot.upper)
            fit = least_squares(missing, start, bounds=(robot.lower, robot.upper))
            least = min(least, float(np.linalg.norm(fit.fun)))
        assert found.status == bik.Status.OUT_OF_REACH, found.message
        assert away <= least + 1e-6
        # No turn of the last joint alone brings the orientation nearer.
        if robot is not FOUR:
            for value in np.linspace(robot.lower[4], robot.upper[4], 50):
                q = found.q.copy()
                q[4] = value
                assert errors(robot, q, target)[1] >= found.rotation_error - 1e-6
        assert found.message.startswith("out of reach, the nearest found is ")


def test_an_order_holds_on_arms_with_more_joints() -> None:
    robot = bik.Robot.named("ur5e")
    q = np.array([0.3, -1.2, 1.5, -0.8, 1.1, 0.4])
    target = robot.fk(q).copy()
    target[:3, 3] *= 1.6
    both = bik.solve(robot, target)
    turn = bik.solve(robot, target, task=bik.tasks.Pose(first="orientation"))
    assert both.rotation_error > 1e-3
    assert turn.rotation_error < 1e-6
    assert turn.status == bik.Status.POSITION_GIVEN_UP, turn.message
    assert turn.position_error <= both.position_error + 0.5
    place = bik.solve(robot, robot.fk(q), task=bik.tasks.Pose(first="position"))
    assert place.success
    random, least = np.random.default_rng(0), np.inf
    for _ in range(8):  # four of them end at the least that forty find
        q0 = random.uniform(np.maximum(robot.lower, -3), np.minimum(robot.upper, 3))

        def residual(q: Array) -> Array:
            pose = robot.fk(q)
            angle = Rotation.from_matrix(pose[:3, :3].T @ target[:3, :3]).as_rotvec()
            return np.r_[pose[:3, 3] - target[:3, 3], 3e3 * angle]

        fit = least_squares(residual, q0, bounds=(robot.lower, robot.upper))
        away, angle = errors(robot, fit.x, target)
        least = min(least, away) if angle < 1e-4 else least
    assert turn.position_error <= least + 1e-3


def test_a_task_with_an_order_is_a_value() -> None:
    task = bik.tasks.Pose(first="position", tolerance=[0.1] * 6)
    assert task.first == "position"
    assert bik.tasks.Pose().first is None
    assert repr(task).endswith(", first='position')")
    assert pickle.loads(pickle.dumps(task)) == task
    assert task != bik.tasks.Pose(first="orientation", tolerance=[0.1] * 6)


def test_orders_that_make_no_sense_are_refused() -> None:
    with pytest.raises(bik.InvalidInputError, match=r"^first must be one of 'position', 'orientation', got 'place'$"):
        bik.tasks.Pose(first="place")
    with pytest.raises(bik.InvalidInputError, match=r"takes no weights, which balance them: leave one out$"):
        bik.tasks.Pose(first="position", weights=[1, 1, 1, 0.5, 0.5, 0.5])
    with pytest.raises(bik.InvalidInputError, match=r"takes no region: leave one out$"):
        bik.tasks.Pose(first="position", region=((-1, -1, -1), (1, 1, 1)))


def test_a_plan_ends_at_the_place_if_told_so() -> None:
    start, q = np.zeros(5), np.array([0.5, 0.3, -0.4, 0.6, 0.2])
    end = turned(HOBBY.fk(q), np.array([0.3, 0.2, 0.1]))
    with pytest.raises(
        bik.InvalidInputError, match=r"^end cannot be reached: position met to .* rotation given up"
    ) as caught:
        bik.plan_point_to_point(HOBBY, start_q=start, end=end)
    assert str(caught.value).endswith('or give task=tasks.Pose(first="position") to end there')
    plan = bik.plan_point_to_point(HOBBY, start_q=start, end=end, task=bik.tasks.Pose(first="position"))
    assert plan.success, plan.message
    away, angle = errors(HOBBY, plan.trajectory.at(plan.trajectory.duration)[0], end)
    assert away < 1e-6
    assert angle <= bik.solve(HOBBY, end).rotation_error + 1e-4


@pytest.mark.parametrize("rate", [30, 1000])
def test_a_tracker_keeps_the_place_where_the_turn_cannot_follow(rate: int) -> None:
    for robot in (HOBBY, OFF_AXIS):
        q0 = np.array([0.2, 0.4, 0.3, 0.5, 0.1])
        middle = robot.fk(q0)
        dt = 1.0 / rate
        tracker = bik.Tracker(robot, q0, dt=dt)
        seen: set[bik.Status] = set()
        before = q0
        for i in range(int(2.0 / dt)):
            angle = 0.6 * np.sin(2.0 * np.pi * 0.5 * i * dt)
            target = turned(middle, angle * np.array([0.5, 0.2, 1.0]))
            target[:3, 3] += 0.01 * np.array([0.0, np.sin(2.0 * i * dt), 0.0])
            step = tracker.step(target)
            assert np.linalg.norm(robot.fk(step.q)[:3, 3] - target[:3, 3]) < 1e-4, (i, step.message)
            assert (np.abs(step.q - before) <= 3.0 * dt * (1 + 1e-9)).all()
            before = step.q
            seen.add(step.status)
        assert GIVEN_UP in seen


def test_a_track_says_what_it_gave_up() -> None:
    q0 = np.array([0.2, 0.4, 0.3, 0.5, 0.1])
    time = np.linspace(0.0, 2.0, 101)
    poses = np.array([turned(HOBBY.fk(q0), np.array([0.0, 0.0, 0.3 * np.sin(3.0 * t)])) for t in time])
    result = bik.track(HOBBY, bik.paths.from_samples(time, poses), q0, dt=0.02)
    assert result.status == GIVEN_UP
    assert np.nanmax(result.position_error) < 1e-4
    assert result.message.startswith("position met to ")
    assert "; rotation given up in " in result.message


def test_wider_tolerances_never_lose_a_target() -> None:
    random = np.random.default_rng(5)
    for robot in (HOBBY, FOUR, bik.Robot.named("ur5e"), bik.Robot.named("panda")):
        for q in robot.random_configurations(15, seed=6):
            target = turned(robot.fk(q), random.normal(0.0, 0.2, 3))
            tolerance = np.r_[10.0 ** random.uniform(-6, -2, 3), 10.0 ** random.uniform(-6, 0.2, 3)]
            met = [
                bik.solve(robot, target, task=bik.tasks.Pose(tolerance=factor * tolerance)).success
                for factor in (1.0, 3.0, 10.0, 100.0)
            ]
            assert met == sorted(met), (robot.name, met)
            scalar = [
                bik.solve(robot, target, position_tolerance=factor * 1e-4, rotation_tolerance=factor * 2e-2).success
                for factor in (1.0, 3.0, 10.0)
            ]
            assert scalar == sorted(scalar), (robot.name, scalar)


@pytest.mark.parametrize("name", ["hobby", "four", "ur5e", "panda"])
def test_whatever_is_within_the_tolerances_is_met(name: str) -> None:
    robot = ARMS[name] if name in ARMS else bik.Robot.named(name)
    random = np.random.default_rng(7)
    for q in robot.random_configurations(60, seed=8):
        tolerance = np.r_[10.0 ** random.uniform(-4, -2, 3), 10.0 ** random.uniform(-2, 0, 3)]
        pose = robot.fk(q)
        # The components of the pose that is met, along the axes of the target, are at most 0.95 of the tolerances.
        turn = Rotation.from_rotvec(0.95 * tolerance[3:] * random.uniform(-1, 1, 3))
        target = pose.copy()
        target[:3, :3] = pose[:3, :3] @ turn.as_matrix().T
        target[:3, 3] -= target[:3, :3] @ (0.95 * tolerance[:3] * random.uniform(-1, 1, 3))
        found = bik.solve(robot, target, task=bik.tasks.Pose(tolerance=tolerance))
        assert found.success, (name, found.message)


def test_joints_of_a_large_weight_stay() -> None:
    limits = {"lower": [-3, -3, -3.1], "upper": [3, 3, 3.1], "velocity": [0.8, 0.8, 1.0]}
    robot = bik.Robot.named("panda").with_mobile_base("planar", **limits)
    start = np.array([0.5, -0.2, 0.4, 0, -0.4, 0, -2.0, 0, 1.6, 0.8])
    target = robot.fk(start).copy()
    target[0, 3] += 0.01
    weight = np.r_[[100.0] * 3, np.ones(7)]
    goal = bik.goals.Posture(start, weight=weight)
    np.testing.assert_array_equal(goal.weight, weight)
    assert pickle.loads(pickle.dumps(goal)) == goal
    found = bik.solve(robot, target, start_q=start, goals=[goal])
    assert found.success
    assert np.linalg.norm(found.q[:2] - start[:2]) < 1e-4
    plain = bik.solve(robot, target, start_q=start, goals=[bik.goals.Posture(start, weight=2.0)])
    assert np.linalg.norm(plain.q[:2] - start[:2]) > 3e-3
    same = bik.solve(robot, target, start_q=start, goals=[bik.goals.Posture(start, weight=np.full(10, 2.0))])
    np.testing.assert_allclose(same.q, plain.q, atol=1e-5)
    with pytest.raises(bik.InvalidInputError, match=r"^weight\[1\] of a goal must be zero or more, and finite, got -1"):
        bik.goals.Posture(start[:3], weight=[1.0, -1.0, 1.0])
    with pytest.raises(bik.InvalidInputError, match=r"^weight of a goal of robot .*: expected 10 joints, got 2$"):
        bik.solve(robot, target, start_q=start, goals=[bik.goals.Posture(start, weight=[1.0, 2.0])])


@pytest.mark.parametrize("name", ["panda", "iiwa14", "ur5e"])
def test_most_poses_with_tolerances_are_met_by_a_branch(name: str) -> None:
    robot = bik.Robot.named(name)
    task = bik.tasks.Pose(tolerance=[0.001, 0.001, 0.001, 0.2, 0.2, 0.2])
    found = [bik.solve(robot, robot.fk(q), task=task) for q in robot.random_configurations(50, seed=6)]
    assert all(one.success for one in found)
    assert sum(max(one.position_error, one.rotation_error) < 1e-8 for one in found) >= 40


def test_a_place_that_something_blocks_is_in_collision_not_out_of_reach() -> None:
    robot = HOBBY.with_capsules(radius=0.02)
    target = turned(robot.fk(np.array([0.3, 0.4, 0.2, 0.3, 0.1])), np.array([0.0, 0.0, 0.3]))
    free = bik.solve(robot, target, obstacles=[])
    assert free.status == GIVEN_UP
    ball = bik.obstacles.Sphere(target[:3, 3], 0.03)
    blocked = bik.solve(robot, target, obstacles=[ball])
    assert blocked.status == bik.Status.IN_COLLISION
    assert "inside obstacle 0 (Sphere) at the best of" in blocked.message
    assert errors(robot, blocked.q, target)[0] < 1e-6


@pytest.mark.parametrize("preference", [{"prefer": "nearest"}, {"prefer": "best", "goals": bik.goals.Centring()}])
@pytest.mark.parametrize("first", ["position", "orientation"])
def test_an_order_holds_beside_a_preference(preference: dict[str, object], first: str) -> None:
    panda, start = bik.Robot.named("panda"), [0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8]
    target = bik.pose((0.85, 0.0, 0.3))
    found = bik.solve(panda, target, start_q=start, task=bik.tasks.Pose(first=first), **preference)  # type: ignore[arg-type]
    given_up = {"position": GIVEN_UP, "orientation": bik.Status.POSITION_GIVEN_UP}
    assert found.status == given_up[first], found.message
    assert (found.position_error if first == "position" else found.rotation_error) < 1e-6


def test_a_straight_approach_ends_at_the_place_if_told_so() -> None:
    start, rng, planned = np.array([-0.3, 0.2, 0.4, 0.3, 0.1]), np.random.default_rng(3), 0
    line, limits = (
        bik.StraightLine(0.01, direction=(0, 0, -1), frame="base"),
        bik.Limits(velocity=1.0, acceleration=4.0),
    )
    for _ in range(20):
        target = HOBBY.fk(start + rng.uniform(-0.4, 0.4, HOBBY.dof))
        target[:3, :3] = target[:3, :3] @ Rotation.from_rotvec([0.1, 0.2, 0.1]).as_matrix()
        nearest = HOBBY.fk(bik.solve(HOBBY, target, start_q=start).q)

        def plan(end: Array, task: bik.tasks.Task | None = None) -> bik.Plan | None:
            try:
                return bik.plan_point_to_point(HOBBY, start_q=start, end=end, task=task, approach=line, limits=limits)
            except bik.InvalidInputError:
                return None

        expected, found = plan(nearest), plan(target, bik.tasks.Pose(first="position"))
        assert (found is None) == (expected is None)
        if found is not None:
            planned += 1
            end = HOBBY.fk(found.trajectory.at(found.trajectory.duration)[0])
            np.testing.assert_allclose(end[:3, 3], target[:3, 3], atol=1e-6)
    assert planned > 2


def test_an_order_without_an_effect_is_refused() -> None:
    task, pose = bik.tasks.Pose(first="position"), HOBBY.fk(np.zeros(HOBBY.dof))
    with pytest.raises(bik.InvalidInputError, match="has no effect where all solutions are asked for"):
        bik.solve_all(HOBBY, pose, task=task)
    with pytest.raises(bik.InvalidInputError, match="has no effect along a path"):
        bik.plan_along_path(HOBBY, [HOBBY.fk(np.zeros(HOBBY.dof)), HOBBY.fk(np.full(HOBBY.dof, 0.1))], task=task)


@pytest.mark.parametrize("name", ["panda", "ur5e", "iiwa14"])
def test_an_unreachable_pose_is_approached_as_near_as_descents_come(name: str) -> None:
    robot, rng = bik.Robot.named(name), np.random.default_rng(8)
    worse = []
    for _ in range(12):
        start = rng.uniform(robot.lower, robot.upper) * 0.3
        target = robot.fk(start)
        target[:3, 3] *= 1.5 / np.linalg.norm(target[:3, 3])  # m
        found = bik.solve(robot, target, start_q=start)
        assert found.status == bik.Status.OUT_OF_REACH
        descent = bik.solve(robot, target, start_q=start, solver=bik.LevenbergMarquardt())
        worse.append(found.position_error / descent.position_error)
    assert np.median(worse) < 1.1
    assert max(worse) < 1.5
