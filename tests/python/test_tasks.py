"""Tasks, goals in the remaining freedom, and the choice among solutions."""

import copy
import pickle

import numpy as np
import pytest
from mistakes import Invalid, assert_told, told, with_entry

import beetle_ik as bik
from beetle_ik import goals, tasks

IIWA = bik.Robot.named("iiwa14")
UR = bik.Robot.named("ur5e")
Q = np.array([0.3, 0.5, -0.2, 0.9, 0.4, -0.6, 0.1])
POSE = IIWA.fk(Q)
TOOL = bik.pose([0.0, 0.05, 0.1], rpy=[0.1, 0.2, 0.3])
ROOM = [[-np.inf] * 3, [np.inf] * 3]
TASKS = [
    tasks.Pose(),
    tasks.Pose(weights=[1, 1, 1, 1, 1, 0], tolerance=[1e-3, 1e-3, 1e-3, 1e-2, 1e-2, np.inf], tool=TOOL),
    tasks.Position(weights=[1, 0, 2]),
    tasks.Orientation(tolerance=[1e-2, 1e-3, 1e-3]),
    tasks.Pointing(),
    tasks.Pointing(axis=[1, 0, 1], tolerance=[1e-3, 1e-3, 1e-3, 1e-2]),
    tasks.Position(region=[[-np.inf, -1.5, -1.0], [np.inf, 1.5, 2.0]]),
]
GOALS = [
    goals.Posture(Q, weight=2.0),
    goals.Centring(),
    goals.Manipulability(motion="position", weight=0.5),
]


@pytest.mark.parametrize("value", [*TASKS, *GOALS], ids=repr)
def test_values_copy_pickle_and_show_how_to_rebuild_them(value: tasks.Task | goals.Goal) -> None:
    names = {"tasks": tasks, "goals": goals}
    for same in (copy.deepcopy(value), pickle.loads(pickle.dumps(value)), eval(repr(value), names)):
        assert same == value
        assert type(same) is type(value)
    assert [other == value for other in [*TASKS, *GOALS]].count(True) == 1


def test_properties_say_what_was_given() -> None:
    task = TASKS[1]
    np.testing.assert_array_equal(task.weights, [1, 1, 1, 1, 1, 0])
    np.testing.assert_array_equal(task.tolerance, [1e-3, 1e-3, 1e-3, 1e-2, 1e-2, np.inf])
    np.testing.assert_allclose(task.tool, TOOL, atol=1e-15)
    assert (tasks.Pose().weights, tasks.Pose().tolerance, tasks.Pose().tool) == (None, None, None)
    np.testing.assert_array_equal(tasks.Pointing().axis, [0, 0, 1])
    np.testing.assert_array_equal(goals.Posture(Q).posture, Q)
    assert isinstance(task, tasks.Task)
    assert isinstance(goals.Centring(), goals.Goal)


@pytest.mark.parametrize("length", [1e-320, 1e-200, 1e200, 1e308])
def test_an_axis_may_be_of_any_length(length: float) -> None:
    axis = np.array([0.6, 0.0, 0.8])
    expected = bik.solve(IIWA, POSE, start_q=Q, task=tasks.Pointing(axis=axis))
    found = bik.solve(IIWA, POSE, start_q=Q, task=tasks.Pointing(axis=length * axis))
    assert found.success
    np.testing.assert_allclose(found.q, expected.q, atol=1e-5)


def test_a_tool_may_do_part_of_a_pose() -> None:
    found = bik.solve(IIWA, POSE, task=tasks.Pointing(tool=TOOL))
    assert found.success, found.message
    tip = IIWA.fk(found.q) @ TOOL
    np.testing.assert_allclose(tip[:3, 3], POSE[:3, 3], atol=1.1e-6)
    np.testing.assert_allclose(tip[:3, 2], POSE[:3, 2], atol=2e-6)
    assert not np.allclose(tip[:3, 0], POSE[:3, 0], atol=1e-3)


def test_what_was_not_asked_is_nan() -> None:
    orientation = bik.solve(IIWA, POSE, task=tasks.Orientation())
    assert orientation.success
    assert np.isnan(orientation.position_error)
    assert orientation.message.startswith("solved to ")
    assert orientation.message.endswith(" rad")
    position = bik.solve(IIWA, POSE, task=tasks.Position())
    assert np.isnan(position.rotation_error)


def test_one_batch_of_every_task_agrees_with_solve() -> None:
    poses = IIWA.fk(IIWA.random_configurations(5, seed=3) * 0.8)
    for task in TASKS:
        batch = bik.solve_batch(IIWA, poses, task=task, threads=1)
        assert batch.success.all(), batch.message
        np.testing.assert_array_equal(batch.q[0], bik.solve(IIWA, poses[0], task=task).q)


def test_the_tip_is_kept_in_its_region() -> None:
    low = np.array([-np.inf, -np.inf, 0.2])
    high = np.array([np.inf, np.inf, 0.9])
    task = tasks.Position(region=[low, high])
    np.testing.assert_array_equal(task.region, [low, high])
    assert tasks.Position().region is None
    assert bik.solve(IIWA, [0.4, 0.3, 0.8], task=task).success
    held = bik.solve(IIWA, [0.4, 0.3, 1.0], task=task)
    assert (held.success, held.status) == (False, bik.Status.HELD_IN_REGION)
    assert held.message == (
        "as near as its region allows, 0.1000 m away (its region keeps z below 0.9): "
        "move the target into the region, or widen the region"
    )
    batch = bik.solve_batch(IIWA, [[0.4, 0.3, 0.8], [0.4, 0.3, 1.0]], task=task, threads=1)
    np.testing.assert_array_equal(batch.status, [bik.Status.SOLVED, bik.Status.HELD_IN_REGION])
    tracker = bik.Tracker(IIWA, held.q, dt=0.01, task=task)
    for height in np.linspace(0.9, 0.95, 20):
        step = tracker.step([0.4, 0.3, height])
        assert IIWA.fk(step.q)[2, 3] < 0.9
    assert step.status == bik.Status.HELD_IN_REGION
    assert step.message.startswith("as near as its region allows, 0.05000 m away: move the target")
    with pytest.raises(bik.LimitError, match=r"^q: z of the tip, .* m, is outside its region \(0\.2, 0\.9\)$"):
        tracker.reset(Q)


def test_the_nearest_solution_is_nearest() -> None:
    start = Q + 0.1
    nearest = bik.solve(IIWA, POSE, start_q=start, prefer="nearest")
    assert nearest.success
    assert np.linalg.norm(nearest.q - start) <= np.linalg.norm(Q - start) + 1e-6
    batch = bik.solve_batch(IIWA, POSE[None], start_q=start, prefer="nearest")
    np.testing.assert_array_equal(batch.q[0], nearest.q)


def test_goals_change_the_solution_as_asked() -> None:
    posture = Q + 0.2
    plain = bik.solve(IIWA, POSE, start_q=Q)
    near = bik.solve(IIWA, POSE, start_q=Q, goals=goals.Posture(posture))
    best = bik.solve(IIWA, POSE, start_q=Q, goals=[goals.Manipulability()])
    assert near.success
    assert best.success
    assert np.linalg.norm(near.q - posture) < np.linalg.norm(plain.q - posture)
    assert IIWA.manipulability(best.q) > IIWA.manipulability(plain.q)


def test_a_tracker_drifts_towards_its_goal() -> None:
    posture = Q + 0.2 * np.linalg.svd(IIWA.jacobian(Q))[2][-1]  # along the self-motion
    tracker = bik.Tracker(IIWA, Q, dt=0.01, goals=goals.Posture(posture))
    steps = [tracker.step(POSE) for _ in range(200)]
    assert all(step.success for step in steps)
    assert np.linalg.norm(tracker.q - posture) < 0.3 * np.linalg.norm(Q - posture)


def test_a_path_is_followed_as_far_as_the_task_asks() -> None:
    circle = bik.paths.circle(POSE[:3, 3], diameter=0.05, duration=2.0).with_orientation(POSE[:3, :3])
    track = bik.track(IIWA, circle, dt=0.02, task=tasks.Pointing(), goals=goals.Centring())
    assert track.success, track.message
    assert np.nanmax(track.rotation_error) <= 1e-6
    only = bik.track(IIWA, circle, dt=0.02, task=tasks.Position())
    assert np.isnan(only.rotation_error).all()


def test_all_solutions_of_a_six_joint_arm() -> None:
    q = np.array([0.4, -1.1, 1.3, 0.2, 0.9, -0.5])
    pose = UR.fk(q)
    found = bik.solve_all(UR, pose, start_q=q)
    assert len(found) == 8, found.message
    assert found.success
    assert found.status == bik.Status.SOLVED
    assert found.miss is None
    assert repr(found) == "<SolutionSet: 8 distinct solutions, no others inside the limits>"
    assert found.q.shape == (8, 6)
    assert found.evaluations >= 8
    np.testing.assert_allclose(UR.fk(found.q), np.broadcast_to(pose, (8, 4, 4)), atol=3e-6)
    np.testing.assert_allclose(found[0].q, q, atol=1e-6)
    assert [solution.success for solution in found] == [True] * 8
    distances = np.linalg.norm(found.q - q, axis=1)
    assert (np.diff(distances) >= 0).all()
    np.testing.assert_array_equal(found[-1].q, found.q[-1])
    with pytest.raises(IndexError, match="index 8 is outside a set of 8"):
        found[8]
    np.testing.assert_array_equal([solution.q for solution in found[2::3]], found.q[2::3])


def test_no_solution_comes_with_the_best_miss() -> None:
    found = bik.solve_all(UR, [3.0, 0.0, 0.5])
    assert (len(found), found.success, found.q.shape) == (0, False, (0, 6))
    assert found.status == bik.Status.OUT_OF_REACH
    assert found.miss is not None
    assert found.message.startswith("no solution; best miss: out of reach, the nearest found is ")
    assert "(out of reach by at least " in found.message


def test_out_of_reach_says_by_how_much() -> None:
    found = bik.solve(IIWA, [0.0, 0.0, 0.36 + 0.946 + 0.21])
    assert found.status == bik.Status.OUT_OF_REACH
    np.testing.assert_allclose(found.position_error, 0.21, rtol=1e-2)
    assert "(out of reach by at least 0.2100 m" in found.message
    assert "(out of reach by at least 8." in bik.solve_batch(IIWA, [[9.0, 0, 0]])[0].message


def test_a_start_is_brought_inside_where_the_user_says_so() -> None:
    outside = with_entry(0, 3.0)
    inside = IIWA.clip(outside)
    np.testing.assert_array_equal(inside, [IIWA.upper[0], 0, 0, 0, 0, 0, 0])
    assert bik.solve(IIWA, POSE, start_q=inside).success
    both = IIWA.clip([outside, with_entry(1, -9.0)])
    np.testing.assert_array_equal(both[1], [0, IIWA.lower[1], 0, 0, 0, 0, 0])


def solve(**options: object) -> bik.Solution:
    return bik.solve(IIWA, POSE, **options)


@told(
    [
        (
            lambda: bik.solve(IIWA, [0.3, 0.3, 0.5], task=tasks.Pose()),
            Invalid,
            "task Pose needs a target pose (4, 4), got a position (3,)",
        ),
        (lambda: solve(task="Pose"), Invalid, "task must be one of beetle_ik.tasks, got 'Pose'"),
        (
            lambda: solve(task=tasks.Pose),
            Invalid,
            "task must be one of beetle_ik.tasks, got the class Pose itself: did you mean Pose()?",
        ),
        (
            lambda: tasks.Pose(weights=[1, 1, 1]),
            Invalid,
            "weights of task Pose: expected 6 entries (x, y, z and the rotation's three), got 3",
        ),
        (
            lambda: tasks.Pose(tolerance=1e-3),
            Invalid,
            "tolerance of task Pose: expected 6 entries (x, y, z and the rotation's three), got 1",
        ),
        (
            lambda: tasks.Pointing(tolerance=[1e-3]),
            Invalid,
            "tolerance of task Pointing: expected 4 entries (x, y, z and the angle), got 1",
        ),
        (
            lambda: tasks.Orientation(weights=[1, 0, -2]),
            Invalid,
            "weights[2] must be zero or more, and finite, got -2",
        ),
        (lambda: tasks.Position(weights=[0, 0, 0]), Invalid, "the largest of weights must be positive, got 0"),
        (lambda: tasks.Position(tolerance=[1e-3, 0, 1e-3]), Invalid, "tolerance[1] must be positive, got 0"),
        (lambda: tasks.Orientation(tolerance=[1e-3, 1e-3, np.nan]), Invalid, "tolerance[2] must be positive, got NaN"),
        (
            lambda: tasks.Position(region=[0, 0, 1]),
            Invalid,
            "region: expected shape (2, 3), got (3,)",
        ),
        (
            lambda: tasks.Position(region=[[0, 0, 1], [1, 1, 1]]),
            Invalid,
            "lower z of region must be below its upper one, 1, got 1",
        ),
        (
            lambda: bik.Tracker(IIWA, Q, dt=0.1, task=tasks.Position(region=ROOM), limits=bik.Limits(acceleration=9.0)),
            bik.UnsupportedLimit,
            "a task with a region cannot honour acceleration limits: an arm that may not stop at once can be carried "
            "out of it; leave one of the two out",
        ),
        (lambda: tasks.Pointing(axis=[0, 0, 0]), Invalid, "the length of axis must be positive, got 0"),
        (lambda: tasks.Pointing(axis=[0, np.nan, 0]), Invalid, "axis must be finite, but entry 1 is NaN"),
        (
            lambda: tasks.Pose(tool=2 * np.eye(4)),
            Invalid,
            "tool is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)",
        ),
        (lambda: goals.Centring(weight=0.0), Invalid, "weight of a goal must be positive and finite, got 0"),
        (
            lambda: goals.Manipulability(motion="up"),
            Invalid,
            "motion must be one of 'pose', 'position', 'rotation', got 'up'",
        ),
        (
            lambda: solve(goals=goals.Posture([0.0] * 6)),
            Invalid,
            "posture of robot 'iiwa14': expected 7 joints, got 6",
        ),
        (
            lambda: solve(goals=goals.Posture(with_entry(2, np.inf))),
            Invalid,
            "posture must be finite, but joint 'joint_a3' is inf",
        ),
        (
            lambda: solve(goals="Centring"),
            Invalid,
            "goals must be one or several of beetle_ik.goals, got 'Centring'",
        ),
        (lambda: solve(goals=3), Invalid, "goals must be one or several of beetle_ik.goals, got 3"),
        (lambda: solve(prefer="near"), Invalid, "prefer must be one of 'any', 'nearest', 'best', got 'near'"),
        (lambda: solve(prefer="nearest"), Invalid, 'prefer="nearest" needs a start to measure distances from'),
        (
            lambda: solve(prefer="nearest", start_q=Q, goals=goals.Centring()),
            Invalid,
            'prefer="nearest" takes no goals: the distance to the start is its goal',
        ),
        (
            lambda: bik.Tracker(IIWA, Q, dt=0.1, solver=bik.papers.BAS(), goals=goals.Centring()),
            Invalid,
            "goals need the library's own rule, with solver left out, or WeightedPseudoInverse",
        ),
        (lambda: bik.solve_all(IIWA, POSE, limit=0), Invalid, "limit must be at least 1, got 0"),
        (
            lambda: bik.solve_all(IIWA, POSE, separation=0.0),
            Invalid,
            "separation must be positive and finite, got 0",
        ),
        (
            lambda: bik.solve_all(IIWA, POSE, start_q=with_entry(1, np.nan)),
            Invalid,
            "start_q must be finite, but joint 'joint_a2' is NaN",
        ),
        (lambda: IIWA.clip([0.0] * 3), Invalid, "joint angles of robot 'iiwa14': expected 7 joints, got 3"),
    ]
)
def test_mistakes_are_told(call: object, error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


@pytest.mark.parametrize("tolerance", [[0.1, 1e-3, 1e-3], [np.inf, 1e-2, 1e-2], [0.1, 0.1, 1e-3]])
@pytest.mark.parametrize("start", [True, False])
def test_what_is_within_region_and_tolerance_is_solved(tolerance: list[float], start: bool) -> None:
    panda = bik.Robot.named("panda")
    q = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])
    tip = panda.fk(q)
    region = [[-np.inf] * 3, [tip[0, 3] + 0.01, np.inf, np.inf]]
    target = tip @ bik.pose([0.0, 0.0, 0.0], rpy=[0.3, 0.2, 0.0])
    target[:3, 3] += 0.05 * target[:3, 0]
    assert target[0, 3] > region[1][0]  # outside the box, which the tolerance along x reaches into
    task = tasks.Pose(tolerance=[*tolerance, np.inf, np.inf, np.inf], region=region)
    found = bik.solve(panda, target, task=task, start_q=q if start else None)
    assert found.status == bik.Status.SOLVED, found.message
    reached = panda.fk(found.q)[:3, 3]
    assert (np.abs(target[:3, :3].T @ (reached - target[:3, 3])) <= tolerance).all()
    assert reached[0] < region[1][0]
    beyond = [[-np.inf] * 3, [tip[0, 3] - 0.1, np.inf, np.inf]]
    if np.isfinite(tolerance[0]):
        task = tasks.Pose(tolerance=[*tolerance, np.inf, np.inf, np.inf], region=beyond)
        assert bik.solve(panda, target, task=task).status == bik.Status.HELD_IN_REGION
