"""APPS against the equations of its paper in numpy, and against wrong input."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

import beetle_ik as bik

Array = NDArray[np.float64]

# Table 1 of Yuan et al. 2016: a and alpha of the row before, d, and the range (degrees).
TABLE_1 = [
    (0.0, np.pi, -0.675, -185, 185),
    (0.35, np.pi / 2, 0.0, -95, 50),
    (1.15, 0.0, 0.0, -30, 245),
    (0.041, -np.pi / 2, -1.2, -350, 350),
    (0.0, np.pi / 2, 0.0, -125, 125),
    (0.0, -np.pi / 2, -0.215, -350, 350),
]
RATE, STEP, THRESHOLD, BUDGET = 0.2, np.pi / 180, 5e-10, 1000


def link(k: int, theta: float) -> Array:
    """Eq. (1)."""
    a, alpha, d, *_ = TABLE_1[k]
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s, 0, a], [s * ca, c * ca, -sa, -sa * d], [s * sa, c * sa, ca, ca * d], [0, 0, 0, 1.0]])


def link_derivative(k: int, theta: float) -> Array:
    """Its derivative, entry by entry."""
    _, alpha, *_ = TABLE_1[k]
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([[-s, -c, 0, 0], [c * ca, -s * ca, 0, 0], [c * sa, -s * sa, 0, 0], [0, 0, 0, 0.0]])


def tip(theta: Array) -> Array:
    """Eq. (2)."""
    product: Array = np.linalg.multi_dot([link(k, angle) for k, angle in enumerate(theta)])
    return product


def error_and_gradient(theta: Array, goal: Array) -> tuple[float, Array]:
    """Eq. (8) to (11), and (14) to (19)."""
    e = goal - tip(theta)
    gradient = np.empty(6)
    for k in range(6):
        links = [link_derivative(j, angle) if j == k else link(j, angle) for j, angle in enumerate(theta)]
        gradient[k] = -np.sum(e * np.linalg.multi_dot(links))
    return 0.5 * float(np.sum(e**2)), gradient


def wrapped(theta: Array) -> Array:
    """Eq. (12), as often as it takes."""
    theta = theta.copy()
    for k, (_, _, _, lower, upper) in enumerate(TABLE_1):
        while theta[k] < np.radians(lower):
            theta[k] += 2 * np.pi
        while theta[k] > np.radians(upper):
            theta[k] -= 2 * np.pi
    return theta


def apps(theta: Array, goal: Array) -> tuple[Array, int]:
    """The do-while loop of Figure 3: angles after the last update, and how many there were."""
    count = 0
    while True:
        error, gradient = error_and_gradient(theta, goal)
        theta = theta + np.clip(-RATE * gradient, -STEP, STEP)  # eq. (13), (20), (21)
        count += 1
        if error <= THRESHOLD or count >= BUDGET:
            return wrapped(theta), count


@pytest.fixture(scope="module")
def robot() -> bik.Robot:
    return bik.Robot.named("kr210_yuan2016")


def solve(robot: bik.Robot, goal: Array, start: Array) -> bik.Solution:
    stop = bik.Stop(max_iterations=BUDGET)
    solver = bik.papers.APPS.paper()
    return bik.solve(
        robot, goal, start_q=start, solver=solver, stop=stop, position_tolerance=1e-4, rotation_tolerance=1e-4
    )


def test_the_robot_is_that_of_table_1(robot: bik.Robot) -> None:
    np.testing.assert_array_equal(np.degrees(robot.lower).round(12), [row[3] for row in TABLE_1])
    np.testing.assert_array_equal(np.degrees(robot.upper).round(12), [row[4] for row in TABLE_1])
    for q in robot.random_configurations(10, seed=1):
        np.testing.assert_allclose(robot.fk(q), tip(q), rtol=0, atol=1e-14)


def test_other_motions_agree_to_the_last_iteration(robot: bik.Robot) -> None:
    starts = robot.random_configurations(60, seed=7)
    moves = robot.random_configurations(60, seed=8)
    converged = 0
    for start, there in zip(starts, moves, strict=True):
        q = start + 0.15 * (there - start)
        goal = tip(q)
        jacobian = robot.jacobian(q) * np.repeat([1.0, np.sqrt(2.0)], 3)[:, None]
        if np.linalg.norm(jacobian, 2) ** 2 > 1.9 / RATE or converged == 5:
            continue  # at this rate no descent comes to rest there
        expected, count = apps(start, goal)
        solution = solve(robot, goal, start)
        assert solution.iterations == count
        if count < BUDGET:
            np.testing.assert_allclose(solution.q, expected, rtol=0, atol=1e-10)
            assert solution.success
            converged += 1
    assert converged == 5


def test_a_prismatic_joint_works_and_is_never_wrapped() -> None:
    robot = bik.Robot.from_dh(
        a=[0.0, 0.4, 0.3], alpha=[0.0, 0.0, 0.0], d=[0.5, 0.0, 0.0], kinds=["prismatic", "revolute", "revolute"],
        convention="standard", lower=[0.0, -3.0, -3.0], upper=[30.0, 3.0, 3.0],
    )  # fmt: skip
    goals = robot.fk(robot.random_configurations(20, seed=2))[:, :3, 3]
    found = bik.solve_batch(robot, goals, start_q=np.tile([15.0, 0.5, 0.5], (20, 1)), solver=bik.papers.APPS())
    assert found.success.mean() >= 0.9
    assert ((robot.lower <= found.q) & (found.q <= robot.upper)).all()


def test_a_solution_outside_the_limits_is_told() -> None:
    robot = bik.Robot.planar([1.0, 1.0], lower=-0.5, upper=0.5)
    goal = bik.Robot.planar([1.0, 1.0]).fk([0.1, 1.0])[:3, 3]
    solution = bik.solve(robot, goal, start_q=[0.2, 0.4], solver=bik.papers.APPS())
    assert (solution.success, solution.status) == (False, bik.Status.OUTSIDE_LIMITS)
    assert solution.message.startswith("reached only outside the limits; inside them 0.")
    assert np.abs(solution.q).max() <= 0.5


def test_along_a_path_it_keeps_to_the_limits_of_the_tick() -> None:
    robot = bik.Robot.planar([1.0] * 5, velocity=0.3)
    circle = bik.paths.circle((3.0, 1.0, 0.0), diameter=0.8, duration=10.0)
    for solver in (bik.papers.APPS(), bik.NewtonRaphson(), bik.JacobianTranspose()):
        result = bik.track(robot, circle, dt=0.1, solver=solver, position_tolerance=1e-4)
        assert result.success, (solver, result.message)
        assert result.max_violation == 0.0


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: bik.papers.APPS(learning_rate=0.0), "learning_rate must be positive and finite, got 0"),
        (lambda: bik.papers.APPS(learning_rate=float("nan")), "learning_rate must be positive and finite, got NaN"),
        (
            lambda: bik.papers.APPS(learning_rate="fast"),  # type: ignore[arg-type]
            "learning_rate must be a number or 'auto', got 'fast'",
        ),
        (lambda: bik.papers.APPS(step_limit=-0.1), "step_limit must be positive and finite, got -0.1"),
        (lambda: bik.papers.APPS(error_threshold=0), "error_threshold must be positive and finite, got 0"),
        (lambda: bik.JacobianTranspose(step_size=-1), "step_size must be positive and finite, got -1"),
        (lambda: bik.NewtonRaphson(step_fraction=1.5), "step_fraction must be above 0 and at most 1, got 1.5"),
        (lambda: bik.NewtonRaphson(step_fraction=0), "step_fraction must be above 0 and at most 1, got 0"),
    ],
)
def test_wrong_options_are_named(make: Callable[[], object], message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as raised:
        make()
    assert str(raised.value) == message


def test_wrong_starts_and_targets_are_named(robot: bik.Robot) -> None:
    goal = robot.fk(np.zeros(6))
    with pytest.raises(bik.InvalidInputError, match=r"target is not a rigid transform: R'R differs"):
        solve(robot, goal * [[1.1], [1], [1], [1]], np.zeros(6))
    with pytest.raises(bik.InvalidInputError, match=r"start_q must be finite, but joint '.*' is inf"):
        solve(robot, goal, np.full(6, np.inf))
