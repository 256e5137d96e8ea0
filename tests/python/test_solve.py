"""Inverse kinematics from Python."""

import numpy as np
import pytest
from oracle import SHARED, Oracle, needs_shared

import beetle_ik as bik

SOLVERS = [
    bik.LevenbergMarquardt(),
    bik.LevenbergMarquardt(initial_damping=1e-2),
    bik.papers.BAS(variant="star"),
    bik.papers.BAS(variant="chain"),
    bik.papers.BAS(variant="greedy"),
    bik.MultiStart(bik.LevenbergMarquardt()),
    bik.MultiStart(bik.papers.BAS(variant="greedy"), max_starts=50),
]


def rotation_between(a: np.ndarray, b: np.ndarray) -> float:
    """Geodesic angle; from the sine, since the cosine loses half the digits near zero."""
    return 2.0 * float(np.arcsin(np.linalg.norm(a[:3, :3] - b[:3, :3]) / (2.0 * np.sqrt(2.0))))


@pytest.mark.parametrize("name", ["iiwa14", "panda", "ur5e", "kr210", "gen3"])
def test_poses_are_reached(name: str) -> None:
    robot = bik.Robot.named(name)
    for seed, target in enumerate(robot.fk(robot.random_configurations(25, seed=11))):
        found = bik.solve(robot, target, seed=seed)
        assert found.success, found.message
        pose = robot.fk(found.q)
        assert np.linalg.norm(pose[:3, 3] - target[:3, 3]) <= 1e-6
        assert rotation_between(pose, target) <= 1e-6
        assert np.all((robot.lower <= found.q) & (found.q <= robot.upper))


@needs_shared
@pytest.mark.parametrize("name", ["iiwa14", "panda", "ur5", "atlas"])
def test_poses_are_reached_by_pinocchios_word(name: str) -> None:
    base, tip = {
        "iiwa14": ("base_link", "tool0"),
        "panda": ("panda_link0", "panda_link8"),
        "ur5": ("base_link", "tool0"),
        "atlas": ("utorso", "r_hand"),
    }[name]
    file = SHARED / "robots" / f"{name}.urdf"
    oracle, robot = Oracle(file.read_text(), base, tip), bik.Robot.from_urdf(file, base=base, tip=tip)
    with np.load(SHARED / "targets" / f"{name}.npz") as stored:
        targets, starts = stored["pose"][:20], stored["q_start"][:20]
    for target, start in zip(targets, starts, strict=True):
        found = bik.solve(robot, target, start_q=start)
        assert found.success, found.message
        pose, _ = oracle.fk_and_jacobian(robot.joint_names, found.q)
        assert np.linalg.norm(pose[:3, 3] - target[:3, 3]) <= 1e-6
        assert rotation_between(pose, target) <= 1e-6


@pytest.mark.parametrize("solver", SOLVERS, ids=repr)
def test_every_solver_reaches_a_position(solver: object) -> None:
    robot = bik.Robot.named("iiwa14")
    target = np.array([0.4, 0.3, 0.9])
    start = [0.6449, 0.2037, 0.1969, -0.7714, 0.2028, 0.7179, 0.1]
    found = bik.solve(robot, target, start_q=start, solver=solver, position_tolerance=1e-5)
    assert found.success, found.message
    assert np.linalg.norm(robot.fk(found.q)[:3, 3] - target) <= 1e-5


def test_a_result_says_what_happened() -> None:
    robot = bik.Robot.named("iiwa14")
    target = robot.fk([0.1] * 7)
    found = bik.solve(robot, target)
    assert found.status is bik.Status.SOLVED
    assert (found.q.shape, found.q.flags.writeable) == ((7,), False)
    pose = robot.fk(found.q)
    assert found.position_error == pytest.approx(np.linalg.norm(pose[:3, 3] - target[:3, 3]), abs=1e-15)
    assert found.rotation_error == pytest.approx(rotation_between(pose, target), abs=1e-12)
    assert found.message == f"solved to {found.position_error:.3e} m and {found.rotation_error:.3e} rad".replace(
        "e-0", "e-"
    )
    # By the closed form; a named solver searches.
    assert (found.evaluations >= 1, found.iterations, found.restarts) == (True, 0, 0)
    searched = bik.solve(robot, target, solver=bik.MultiStart(bik.LevenbergMarquardt()))
    assert searched.success
    assert searched.evaluations >= searched.iterations >= 1
    assert searched.restarts >= 0
    assert found.elapsed > 0.0
    np.testing.assert_array_equal(found.limits.upper, robot.upper)
    assert repr(found) == f"<Solution SOLVED: {found.message}>"
    assert (f"{found.status}", f"{found.status:>15}") == ("Status.SOLVED", "  Status.SOLVED")


def test_a_status_is_true_where_it_is_success() -> None:
    robot = bik.Robot.planar([1.0, 1.0])
    assert bik.solve(robot, [1.0, 0.5, 0.0]).status
    assert not bik.solve(robot, [3.0, 0.0, 0.0]).status
    assert [status for status in bik.Status if status] == [bik.Status.SOLVED]


def test_a_position_leaves_the_orientation_free() -> None:
    found = bik.solve(bik.Robot.named("panda"), [0.4, 0.1, 0.5])
    assert found.success
    assert np.isnan(found.rotation_error)
    assert "rad" not in found.message


def test_a_start_that_is_a_solution_is_kept() -> None:
    robot = bik.Robot.named("ur5e")
    start = robot.random_configurations(1)[0]
    found = bik.solve(robot, robot.fk(start), start_q=start)
    np.testing.assert_array_equal(found.q, start)
    assert (found.evaluations, found.iterations, found.restarts) == (1, 0, 0)


def test_out_of_reach_is_a_status_with_the_nearest_point() -> None:
    robot = bik.Robot.planar([1.0, 1.0])
    found = bik.solve(robot, [3.0, 0.0, 0.0])
    assert not found.success
    assert found.status is bik.Status.OUT_OF_REACH
    assert found.position_error == pytest.approx(1.0, abs=1e-6)
    assert "(out of reach by at least 1.000 m" in found.message


@pytest.mark.parametrize(("name", "height"), [("iiwa14", 0.36), ("panda", 0.4)])
def test_a_pose_that_no_elbow_allows_is_proven_out_of_reach(name: str, height: float) -> None:
    robot = bik.Robot.named(name)
    inside = robot.fk(np.clip(np.full(7, 0.3), robot.lower, robot.upper)).copy()
    inside[:3, 3] = [0.0, 0.0, height]
    found = bik.solve(robot, inside)
    assert found.status is bik.Status.OUT_OF_REACH
    assert "no configuration inside the limits has this pose" in found.message
    assert found.evaluations < 200
    assert bik.solve(robot, inside, position_tolerance=0.5, rotation_tolerance=1.0).success


def test_seeds_repeat_and_differ() -> None:
    robot = bik.Robot.named("panda")
    target = robot.fk(robot.random_configurations(1, seed=5)[0])
    first, again = (bik.solve(robot, target, seed=1).q for _ in range(2))
    np.testing.assert_array_equal(first, again)
    # Only a search that draws depends on its seed: the default begins at stored configurations.
    beetles = [bik.solve(robot, target[:3, 3], solver=bik.papers.BAS(), seed=seed).q for seed in (1, 1, 2)]
    np.testing.assert_array_equal(beetles[0], beetles[1])
    assert not np.array_equal(beetles[0], beetles[2])
    assert bik.solve(robot, target, seed=2**64 - 1).success


@pytest.mark.parametrize("budget", [1, 2, 3, 10, 100])
@pytest.mark.parametrize("solver", SOLVERS, ids=repr)
def test_an_evaluation_budget_is_kept_exactly(solver: object, budget: int) -> None:
    robot = bik.Robot.named("iiwa14")
    stop = bik.Stop(max_evaluations=budget)
    found = bik.solve(robot, [9.0, 0.0, 0.0], start_q=[0.1] * 7, solver=solver, stop=stop)
    assert not found.success
    assert found.evaluations <= budget
    if found.status is bik.Status.BUDGET_SPENT:
        assert found.evaluations == budget


def test_other_budgets_end_a_search() -> None:
    robot = bik.Robot.named("iiwa14")
    unreachable = np.array([0.0, 0.0, 0.36])  # inside the shoulder
    few = bik.solve(robot, unreachable, solver=bik.papers.BAS(), stop=bik.Stop(max_iterations=3))
    assert (few.status, few.iterations) == (bik.Status.BUDGET_SPENT, 3)
    stop = bik.Stop(max_time=0.05, max_evaluations=10**12)
    timed = bik.solve(robot, unreachable, stop=stop)
    assert timed.status is bik.Status.TIME_UP
    assert timed.message.endswith("raise max_time")
    assert timed.elapsed >= 0.05


def test_limits_of_the_call_replace_the_robots() -> None:
    robot = bik.Robot.named("iiwa14")
    target = robot.fk([0.5] * 7)[:3, 3]
    narrow = bik.Limits(lower=-0.6, upper=0.6)
    found = bik.solve(robot, target, limits=narrow)
    assert found.success
    assert np.all(np.abs(found.q) <= 0.6)
    assert (found.limits.lower, found.limits.upper) == (-0.6, 0.6)
    np.testing.assert_array_equal(found.limits.velocity, robot.velocity_limit)


def test_infinite_limits_are_switched_off() -> None:
    robot = bik.Robot.planar([1.0, 1.0], lower=-0.1, upper=0.1)
    target = [0.0, 1.5, 0.0]
    assert not bik.solve(robot, target).success
    assert bik.solve(robot, target, limits=bik.Limits(lower=-np.inf, upper=np.inf)).success


def test_locked_joints_stay() -> None:
    robot = bik.Robot.named("iiwa14")
    lower, upper = robot.lower.copy(), robot.upper.copy()
    lower[2] = upper[2] = 0.25
    found = bik.solve(robot, [0.4, 0.3, 0.9], limits=bik.Limits(lower=lower, upper=upper))
    assert found.success
    assert found.q[2] == 0.25


def test_tolerances_are_the_users() -> None:
    robot = bik.Robot.named("panda")
    target = robot.fk(robot.random_configurations(1, seed=9)[0])
    solver = bik.MultiStart(bik.LevenbergMarquardt())
    loose = bik.solve(robot, target, solver=solver, position_tolerance=1e-2, rotation_tolerance=1e-1)
    searched = bik.solve(robot, target, solver=solver, position_tolerance=1e-12, rotation_tolerance=1e-12)
    assert loose.evaluations < searched.evaluations
    tight = bik.solve(robot, target, position_tolerance=1e-12, rotation_tolerance=1e-12)
    assert tight.success
    assert max(tight.position_error, tight.rotation_error) <= 1e-12


def test_tool_and_base_are_solved_for() -> None:
    plain = bik.Robot.named("ur5e")
    robot = plain.with_tool(bik.pose([0, 0, 0.2], rpy=[0.1, 0, 0])).with_base(bik.pose([1, 1, 0], rpy=[0, 0, 2]))
    target = robot.fk(plain.random_configurations(1, seed=3)[0])
    found = bik.solve(robot, target)
    assert found.success
    np.testing.assert_allclose(robot.fk(found.q), target, rtol=0, atol=1e-5)


def test_every_status_is_explained() -> None:
    for status in bik.Status:
        assert status.__doc__ in bik.Status.__doc__
        assert f"- `{status.name}`: " in bik.Status.__doc__
        assert status.__doc__.endswith(".")


@pytest.mark.parametrize("size", [1e12, 1e15, 1.7e308])
def test_limits_beyond_a_million_turns_count_as_none(size: float) -> None:
    robot = bik.Robot.named("iiwa14")
    wide = robot.with_limits(lower=-size, upper=size)
    for q in robot.random_configurations(20, seed=1):
        assert bik.solve(wide, robot.fk(q)).success
    assert np.abs(wide.random_configurations(100, seed=1)).max() <= np.pi
