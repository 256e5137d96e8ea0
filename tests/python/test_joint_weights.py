"""Weights of joints: which joints make a motion, judged by numpy's weighted pseudo-inverse and by scipy."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from mistakes import Invalid
from numpy.typing import NDArray
from pair_of_pandas import pair_of_pandas
from scipy.optimize import minimize

import beetle_ik as bik

api: Any = bik  # wrong calls on purpose
ARM = np.array([0, -0.4, 0, -2.0, 0, 1.6, 0.8])
PANDA = bik.Robot.named("panda")
UR5 = bik.Robot.named("ur5e")
MOBILE = PANDA.with_mobile_base("planar", lower=[-3, -3, -3.1], upper=[3, 3, 3.1], velocity=[0.8, 0.8, 1.0])
FLOATING = PANDA.with_mobile_base("floating", lower=[-2, -2, -2, -3, -3, -3], upper=[2, 2, 2, 3, 3, 3], velocity=1.0)
PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
START = np.r_[0.5, -0.2, 0.4, ARM]
BASE = slice(0, 3)
RATED = bik.Limits(velocity=np.r_[0.8, 0.8, 1.0, np.full(7, 2.0)], acceleration=10.0)


def heavy_base(weight: float) -> NDArray[np.float64]:
    return np.r_[np.full(3, weight), np.ones(7)]


def shifted(robot: bik.Robot, q: NDArray[np.float64], *by: float) -> NDArray[np.float64]:
    target = robot.fk(q).copy()
    target[:3, 3] += by
    return target


def cheapest(
    robot: bik.Robot, q: NDArray[np.float64], twist: NDArray[np.float64], weights: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The motion of least sum of (weight * dq)^2 that moves the tip by the twist."""
    jacobian, compliance = robot.jacobian(q), np.diag(weights**-2.0)
    normal = jacobian @ compliance @ jacobian.T
    return compliance @ jacobian.T @ np.linalg.solve(normal, twist)


@pytest.mark.parametrize("weight", [1.0, 3.0, 10.0, 100.0, 1e3, 1e6])
def test_a_heavy_base_stays_where_the_arm_can_do_it(weight: float) -> None:
    target = shifted(MOBILE, START, 0.01, 0, 0)
    solution = bik.solve(MOBILE, target, start_q=START, joint_weights=heavy_base(weight))
    moved = solution.q - START
    expected = cheapest(MOBILE, START, np.r_[0.01, np.zeros(5)], heavy_base(weight))
    assert solution.success
    assert np.abs(moved - expected).max() < 5e-4
    if weight >= 100.0:
        assert np.abs(moved[BASE]).max() < 1e-4


@pytest.mark.parametrize("seed", range(6))
def test_no_solution_nearby_is_nearer_by_the_weights(seed: int) -> None:
    random = np.random.default_rng(seed)
    weights = random.choice([1.0, 2.0, 10.0, 100.0], 10)
    q = np.r_[random.uniform(-1, 1, 3), ARM + random.uniform(-0.3, 0.3, 7)]
    target = shifted(MOBILE, q, *random.uniform(-0.1, 0.1, 3))
    solution = bik.solve(MOBILE, target, start_q=q, joint_weights=weights)
    assert solution.success

    def error(x: NDArray[np.float64]) -> NDArray[np.float64]:
        return (MOBILE.fk(x)[:3] - target[:3]).ravel()

    best = minimize(
        lambda x: float(np.sum((weights * (x - q)) ** 2)),
        solution.q,
        jac=lambda x: 2.0 * weights**2 * (x - q),
        constraints={"type": "eq", "fun": error},
        bounds=list(zip(MOBILE.lower, MOBILE.upper, strict=True)),
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 200},
    )
    if np.abs(error(best.x)).max() < 1e-7:
        assert np.linalg.norm(weights * (solution.q - q)) <= 1.001 * np.linalg.norm(weights * (best.x - q)) + 1e-6


def test_equal_weights_give_the_bits_of_none() -> None:
    random = np.random.default_rng(3)
    for weight in (1.0, 2.0, 1e-3, 1e6):
        for robot, q in ((MOBILE, START), (PANDA, ARM), (UR5, np.array([0.3, -1.2, 1.4, -0.8, -1.1, 0.5]))):
            target = shifted(robot, q, *random.uniform(-0.1, 0.1, 3))
            plain = bik.solve(robot, target, start_q=q)
            same = bik.solve(robot, target, start_q=q, joint_weights=np.full(len(q), weight))
            assert plain.q.tobytes() == same.q.tobytes()
            assert plain.evaluations == same.evaluations
            trackers = [
                bik.Tracker(robot, q, dt=0.01),
                bik.Tracker(robot, q, dt=0.01, joint_weights=np.full(len(q), weight)),
            ]
            for _ in range(20):
                plain_step, same_step = (tracker.step(target) for tracker in trackers)
                assert plain_step.q.tobytes() == same_step.q.tobytes()
                assert plain_step.evaluations == same_step.evaluations


def test_a_factor_of_all_weights_changes_nothing() -> None:
    weights = np.r_[100.0, 30.0, 7.0, np.linspace(1.0, 5.0, 7)]
    target = shifted(MOBILE, START, 0.05, -0.02, 0.03)
    of = [
        bik.solve(MOBILE, target, start_q=START, joint_weights=factor * weights).q for factor in (1.0, 1e-6, 0.1, 1e9)
    ]
    ticks = []
    for factor in (1.0, 1e-6, 0.1, 1e9):
        tracker = bik.Tracker(MOBILE, START, dt=0.01, joint_weights=factor * weights)
        ticks.append([tracker.step(target).q for _ in range(10)][-1])
    assert max(np.abs(q - of[0]).max() for q in of) < 1e-8
    assert max(np.abs(q - ticks[0]).max() for q in ticks) < 1e-8


def test_of_the_branches_the_nearest_by_the_weights() -> None:
    random = np.random.default_rng(8)
    differ = 0
    for _ in range(40):
        start, other = UR5.random_configurations(2, seed=int(random.integers(1 << 30)))
        weights = random.choice([1.0, 10.0, 1e3], 6)
        target = UR5.fk(other)
        found = bik.solve_all(UR5, target, start_q=start, turns=True)
        if not found.complete:
            continue
        costs = np.linalg.norm(weights * (found.q - start), axis=1)
        solution = bik.solve(UR5, target, start_q=start, joint_weights=weights)
        assert np.linalg.norm(weights * (solution.q - start)) <= costs.min() + 1e-6
        differ += bool(np.abs(solution.q - bik.solve(UR5, target, start_q=start).q).max() > 1e-3)
    assert differ > 5


def test_nearest_compares_many_by_the_weights() -> None:
    random = np.random.default_rng(2)
    for _ in range(5):
        weights = random.choice([1.0, 10.0, 100.0], 7)
        target = PANDA.fk(PANDA.random_configurations(1, seed=int(random.integers(1 << 30)))[0])
        each = [
            bik.solve(PANDA, target, start_q=ARM, joint_weights=weights, prefer=prefer) for prefer in ("nearest", "any")
        ]
        assert all(solution.success for solution in each)
        nearest, first = (np.linalg.norm(weights * (solution.q - ARM)) for solution in each)
        assert nearest <= first + 1e-6


@pytest.mark.parametrize(
    "solver", [bik.LevenbergMarquardt(), bik.MultiStart(bik.LevenbergMarquardt()), bik.papers.BAS()]
)
def test_any_solver_minds_the_weights(solver: Any) -> None:
    target = MOBILE.fk(START)[:3, 3] + [0.01, 0, 0]
    solution = bik.solve(
        MOBILE, target, start_q=START, solver=solver, joint_weights=heavy_base(100.0), position_tolerance=1e-4,
        stop=bik.Stop(max_evaluations=20_000),
    )  # fmt: skip
    assert solution.success
    assert np.abs(solution.q[BASE] - START[BASE]).max() < 1e-3


def test_several_tips_mind_the_weights() -> None:
    q = np.clip(np.r_[np.zeros(2), ARM, ARM], PAIR.lower, PAIR.upper)
    targets = {tip: pose.copy() for tip, pose in zip(PAIR.tips, PAIR.fk(q), strict=True)}
    for pose in targets.values():
        pose[2, 3] += 0.01
    weights = np.r_[np.full(len(q) - 14, 100.0), np.ones(14)]
    solution = bik.solve(PAIR, targets, start_q=q, joint_weights=weights)
    plain = bik.solve(PAIR, targets, start_q=q)
    assert solution.success
    assert np.linalg.norm(weights * (solution.q - q)) <= np.linalg.norm(weights * (plain.q - q)) + 1e-9
    tracker = bik.Tracker(PAIR, q, dt=0.02, joint_weights=weights)
    assert any(tracker.step(targets).success for _ in range(50))
    assert np.abs(tracker.q - solution.q)[:2].max() < 2e-3


def test_a_batch_minds_the_weights_of_each_start() -> None:
    targets = np.array([shifted(MOBILE, START, 0.01 * i, 0, 0) for i in range(1, 4)])
    batch = bik.solve_batch(MOBILE, targets, start_q=START, joint_weights=heavy_base(100.0))
    one = bik.solve(MOBILE, targets[0], start_q=START, joint_weights=heavy_base(100.0))
    assert batch.q[0].tobytes() == one.q.tobytes()
    assert np.abs(batch.q[:, BASE] - START[BASE]).max() < 1e-3


@pytest.mark.parametrize("seed", range(4))
def test_small_steps_move_the_joints_that_cost_least(seed: int) -> None:
    random = np.random.default_rng(seed)
    weights = random.choice([1.0, 3.0, 10.0, 100.0], 10)
    q = np.r_[random.uniform(-1, 1, 3), ARM + random.uniform(-0.2, 0.2, 7)]
    tracker = bik.Tracker(MOBILE, q, dt=0.01, joint_weights=weights)
    for _ in range(10):
        before = tracker.q.copy()
        by = random.normal(size=3) * 1e-5
        step = tracker.step(shifted(MOBILE, before, *by))
        expected = cheapest(MOBILE, before, np.r_[by, np.zeros(3)], weights)
        assert step.success
        assert np.abs(step.q - before - expected).max() < 1e-2 * np.abs(expected).max() + 1e-9


@pytest.mark.parametrize("robot", ["planar", "floating"])
@pytest.mark.parametrize("weight", [100.0, 1e6])
@pytest.mark.parametrize("by", [0.01, 0.03, 0.1])
def test_a_jump_that_the_arm_can_make_leaves_the_base(robot: str, weight: float, by: float) -> None:
    base, arm = {"planar": (START[BASE], MOBILE), "floating": (np.zeros(6), FLOATING)}[robot]
    start, count = np.r_[base, ARM], len(base)
    weights = np.r_[np.full(count, weight), np.ones(7)]
    target = shifted(arm, start, -by, by, 0)
    for rate in (0.01, 0.001):
        tracker = bik.Tracker(arm, start, dt=rate, joint_weights=weights)
        assert any(tracker.step(target).success for _ in range(500))
        assert np.abs(tracker.q[:count] - base).max() < 1e-3


def test_a_jump_of_two_hands_leaves_the_torso() -> None:
    q = np.clip(np.r_[np.zeros(2), ARM, ARM], PAIR.lower, PAIR.upper)
    targets = {tip: pose.copy() for tip, pose in zip(PAIR.tips, PAIR.fk(q), strict=True)}
    for pose, sign in zip(targets.values(), (1, -1), strict=True):
        pose[:3, 3] += np.array([0.03, 0.02, 0.02]) * sign
    tracker = bik.Tracker(PAIR, q, dt=0.01, joint_weights=np.r_[100.0, 100.0, np.ones(14)])
    assert any(tracker.step(targets).success for _ in range(200))
    assert np.abs(tracker.q[:2] - q[:2]).max() < 1e-3


@pytest.mark.parametrize("acceleration", [None, 4.0])
def test_a_tray_in_both_hands_leaves_the_torso(acceleration: float | None) -> None:
    q = np.clip(np.r_[np.zeros(2), ARM, ARM], PAIR.lower, PAIR.upper)
    (left, right), (first, second) = PAIR.tips, PAIR.fk(q)
    tray = np.linalg.inv(first) @ second
    weights, limits = np.r_[100.0, 100.0, np.ones(14)], bik.Limits(velocity=1.0, acceleration=acceleration)
    moved = {}
    for name, joint_weights in {"plain": None, "weighted": weights}.items():
        tracker = bik.Tracker(PAIR, q, dt=0.01, joint_weights=joint_weights, limits=limits)
        for k in range(300):
            target = first.copy()
            target[[0, 2], 3] += 0.03 * (1 - np.cos(k / 50))
            step = tracker.step({left: target, (left, right): tray})
            assert step.errors[left, right][0] < 1e-6
            moved[name] = max(moved.get(name, 0.0), np.abs(step.q - q)[:2].max())
        assert step.errors[left][0] < 1e-3
    assert moved["weighted"] < 2e-3 < 0.02 < moved["plain"]


def test_a_heavier_base_never_moves_more() -> None:
    for limits in (None, RATED):
        moved = []
        for weight in (1.0, 2.0, 5.0, 20.0, 100.0, 1e3):
            tracker = bik.Tracker(MOBILE, START, dt=0.01, joint_weights=heavy_base(weight), limits=limits)
            steps = [tracker.step(shifted(MOBILE, START, min(0.001 * k, 0.05), 0, 0)) for k in range(200)]
            assert steps[-1].success
            moved.append(np.linalg.norm(steps[-1].q[BASE] - START[BASE]))
        assert all(more >= less - 1e-6 for more, less in pairwise(moved)), moved


@pytest.mark.parametrize("weight", [10.0, 100.0, 1e4, 1e6, 1e12])
@pytest.mark.parametrize("limits", [None, RATED])
def test_a_target_that_only_the_base_reaches_is_reached(weight: float, limits: bik.Limits | None) -> None:
    target = shifted(MOBILE, START, 2.0, 0, 0)
    ticks = []
    for weights in (None, heavy_base(weight)):
        tracker = bik.Tracker(MOBILE, START, dt=0.01, joint_weights=weights, limits=limits)
        ticks.append(next(i for i in range(1000) if tracker.step(target).success))
    assert ticks[1] <= 1.5 * ticks[0]
    assert bik.solve(MOBILE, target, start_q=START, joint_weights=heavy_base(weight)).success


def test_one_heavy_joint_among_the_joints_of_an_arm() -> None:
    target = shifted(PANDA, ARM, 0.02, 0.02, -0.02)
    for j in range(7):
        weights = np.ones(7)
        weights[j] = 1e6
        solution = bik.solve(PANDA, target, start_q=ARM, joint_weights=weights)
        plain = bik.solve(PANDA, target, start_q=ARM)
        assert solution.success
        assert abs(solution.q[j] - ARM[j]) <= abs(plain.q[j] - ARM[j]) + 1e-6


def test_a_tracker_with_goals_moves_light_joints_for_them() -> None:
    goal = bik.goals.Posture(START + np.r_[0.5, np.zeros(9)])
    moved = []
    for weight in (1.0, 30.0):
        tracker = bik.Tracker(MOBILE, START, dt=0.01, goals=goal, joint_weights=heavy_base(weight))
        for _ in range(20):
            assert tracker.step(MOBILE.fk(START)).success
        moved.append(abs(tracker.q[0] - START[0]))
    assert moved[1] < 0.1 * moved[0]


@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.parametrize("weight", [10.0, 100.0, 1e4])
@pytest.mark.parametrize(
    ("name", "arm"),
    [("panda", ARM), ("gen3", [0, 0.4, 0, 1.8, 0, 0.9, 0]), ("ur5e", [0, -1.2, 1.6, -0.4, 1.57, 0])],
)
def test_a_stretched_arm_and_its_heavy_base_do_not_chatter(name: str, arm: Any, weight: float, whole: bool) -> None:
    start = np.r_[0, 0, 0, arm]
    robot = bik.Robot.named(name).with_mobile_base(
        "planar", lower=[-3, -3, -np.pi], upper=[3, 3, np.pi], velocity=[0.8, 0.8, 1.0]
    )
    tracker = bik.Tracker(robot, start, dt=0.02, joint_weights=np.r_[np.full(3, weight), np.ones(len(arm))])
    targets = [shifted(robot, start, ahead, 0.0, 0.0) for ahead in np.linspace(0.0, 1.5, 300)]
    steps = [tracker.step(target if whole else target[:3, 3]) for target in targets]
    assert max(step.position_error for step in steps) < 1e-5
    moved = np.diff([step.q for step in steps], axis=0)
    # Turns of direction from tick to tick by more than 1e-4 rad or m.
    assert (moved[1:] * moved[:-1] < -1e-8).sum() < 15
    assert np.abs(moved[:, 0]).sum() < 1.5


def test_a_track_minds_the_weights() -> None:
    path = bik.paths.circle(MOBILE.fk(START)[:3, 3], 0.05, 2.0)
    plain = bik.track(MOBILE, path, START, dt=0.01)
    track = bik.track(MOBILE, path, START, dt=0.01, joint_weights=heavy_base(100.0))
    travel = [np.abs(np.diff(run.q[:, BASE], axis=0)).sum() for run in (track, plain)]
    assert track.success
    assert travel[0] < 0.1 * travel[1]


BAD = "must be positive and finite (a joint that must not move is locked by its limits), got"


@pytest.mark.parametrize(
    ("weights", "message"),
    [
        (np.zeros(7), f"joint_weights[0] {BAD} 0"),
        ([1, 1, -2.0, 1, 1, 1, 1], f"joint_weights[2] {BAD} -2"),
        ([1, 1, 1, 1, 1, 1, np.nan], "joint_weights must be finite, but joint 'panda_joint7' is NaN"),
        ([np.inf, 1, 1, 1, 1, 1, 1], "joint_weights must be finite, but joint 'panda_joint1' is inf"),
        (np.ones(6), "joint_weights of robot 'panda': expected 7 joints, got 6"),
        (np.ones((7, 1)), "joint_weights: expected one dimension, got shape (7, 1)"),
        (2.0, "joint_weights: expected one dimension, got shape ()"),
    ],
)
def test_wrong_weights_are_named(weights: Any, message: str) -> None:
    target = PANDA.fk(ARM)
    calls = [
        lambda: bik.solve(PANDA, target, start_q=ARM, joint_weights=weights),
        lambda: bik.solve_batch(PANDA, target[None], start_q=ARM, joint_weights=weights),
        lambda: bik.Tracker(PANDA, ARM, dt=0.01, joint_weights=weights),
        lambda: bik.track(PANDA, bik.paths.circle(target[:3, 3], 0.05, 1.0), ARM, dt=0.1, joint_weights=weights),
    ]
    for call in calls:
        with pytest.raises(Invalid) as error:
            call()
        assert str(error.value) == message


def test_weights_that_have_no_meaning_are_refused() -> None:
    weights, target, goal = np.arange(1.0, 8.0), PANDA.fk(ARM), bik.goals.Centring()
    rule = (
        "joint_weights need the library's own rule, with solver left out; WeightedPseudoInverse has weights of its own"
    )
    goals = (
        "joint_weights take no goals: the weighted distance to the start is their goal; a Posture at the start, with a "
        "weight for each joint, may stand beside other goals"
    )
    start = "joint_weights need a start to measure motions from"
    calls = [
        (lambda: bik.solve(PANDA, target, joint_weights=weights), start),
        (lambda: bik.solve_batch(PANDA, target[None], joint_weights=weights), start),
        (lambda: bik.solve(PANDA, target, start_q=ARM, goals=goal, joint_weights=weights), goals),
        (lambda: bik.Tracker(PANDA, ARM, dt=0.01, joint_weights=weights, solver=bik.WeightedPseudoInverse()), rule),
        (lambda: bik.Tracker(PANDA, ARM, dt=0.01, joint_weights=weights, solver=bik.LevenbergMarquardt()), rule),
    ]  # fmt: skip
    for call, message in calls:
        with pytest.raises(Invalid) as error:
            call()
        assert str(error.value) == message


def test_a_heavy_base_stays_within_tolerances_too() -> None:
    task = bik.tasks.Pose(tolerance=[0.002] * 3 + [0.2] * 3)
    weights = heavy_base(100.0)
    for seed in (4, 21, 42, 7, 8):
        rng = np.random.default_rng(seed)
        target = MOBILE.fk(START)
        way = rng.normal(size=3)
        target[:3, 3] += 0.1 * way / np.linalg.norm(way)

        def cost(task: bik.tasks.Task | None, target: NDArray[np.float64] = target) -> float:
            found = bik.solve(MOBILE, target, start_q=START, joint_weights=weights, task=task)
            assert found.success, found.message
            return float(np.linalg.norm(weights * (found.q - START)))

        assert cost(task) <= 1.001 * cost(None)
