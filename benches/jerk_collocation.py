"""Durations under jerk limits over those of a direct collocation.

    python benches/jerk_collocation.py [joint paths] [circles] [first]

Joint paths for `time_optimal` are sums of three sines of s, 0 <= s <= 1; `plan_along_path` gets circles of the tip of a
planar arm. The collocation seeks s(t) with a jerk that is constant on each of 400 equal intervals of time, by CasADi
and Ipopt, from two starts; the shorter result counts. It checks limits at the ends of intervals only; ours hold at
every instant.
"""

import sys
import time
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np

import beetle_ik as bik

INTERVALS = 400
ROWS = 401  # of a path given to `time_optimal`
JOINTS = (2, 6, 7)
WAVES = np.array([1.0, 2.0, 3.0])
ACCURACY = 1e-6  # m, of the tip on a circle: so that it may not round the path
IPOPT = {"print_level": 0, "sb": "yes", "max_iter": 800, "tol": 1e-6, "acceptable_tol": 1e-5}


def sines(random: np.random.Generator, joints: int) -> ca.Function:
    """Joint path q(s) = sum_k a_k sin(w_k s + p_k) for each joint."""
    shape = (len(WAVES), joints)
    amplitude = random.uniform(0.2, 1.0, shape) / np.array([[1.0], [2.0], [4.0]])
    rate = np.pi * WAVES[:, None] * random.uniform(0.7, 1.3, shape)
    phase = random.uniform(0.0, 2 * np.pi, shape)
    s = ca.SX.sym("s")
    return ca.Function("q", [s], [ca.sum1(amplitude * ca.sin(rate * s + phase)).T])


def circle(random: np.random.Generator) -> tuple[ca.Function, np.ndarray]:
    """Joint path of a planar arm with two links of 1 m on a circle, and the circle as points (k, 3)."""
    radius, turned = random.uniform(0.15, 0.4), random.uniform(0.0, 2 * np.pi)
    distance = random.uniform(0.2 + radius, 1.9 - radius)
    s = ca.SX.sym("s")
    x, y = distance + radius * ca.cos(2 * np.pi * s + turned), radius * ca.sin(2 * np.pi * s + turned)
    elbow = ca.acos((x**2 + y**2 - 2.0) / 2.0)
    shoulder = ca.atan2(y, x) - ca.atan2(ca.sin(elbow), 1.0 + ca.cos(elbow))
    points = ca.Function("p", [s], [ca.vertcat(x, y, 0.0)])
    return ca.Function("q", [s], [ca.vertcat(shoulder, elbow)]), rows_of(points, 10 * ROWS)


def rows_of(path: ca.Function, count: int) -> np.ndarray:
    """Values (count, n) of a path at equal steps of s."""
    return np.array(path.map(count)(np.linspace(0.0, 1.0, count)[None])).T


def limits_of(random: np.random.Generator) -> np.ndarray:
    """Limits of velocity, acceleration and jerk of all joints (rad, s)."""
    return np.array([random.choice(each) for each in ([1.0, 2.0], [2.0, 5.0, 10.0], [20.0, 50.0, 200.0])])


def ours(limits: np.ndarray) -> bik.Limits:
    """The same limits for all joints."""
    velocity, acceleration, jerk = limits
    return bik.Limits(velocity=velocity, acceleration=acceleration, jerk=jerk, lower=-10.0, upper=10.0)


def derivatives(path: ca.Function) -> list[ca.Function]:
    """First three derivatives of a path by s."""
    s = ca.SX.sym("s")
    value, found = path(s), []
    for order in range(1, 4):
        value = ca.jacobian(value, s)
        found.append(ca.Function(f"d{order}", [s], [value]))
    return found


def collocation(path: ca.Function, limits: np.ndarray) -> tuple[ca.Opti, Any, Any]:
    """Problem, its duration, and its states: s, s', s'' (3, INTERVALS + 1)."""
    problem = ca.Opti()
    state, jerk, duration = problem.variable(3, INTERVALS + 1), problem.variable(1, INTERVALS), problem.variable()
    problem.minimize(duration)
    problem.subject_to(duration >= 0.01)
    problem.subject_to(state[:, 0] == ca.vertcat(0, 0, 0))
    problem.subject_to(state[:, -1] == ca.vertcat(1, 0, 0))
    problem.subject_to(state[1, :] >= 0)
    step, (s, v, a) = duration / INTERVALS, [state[row, :-1] for row in range(3)]
    problem.subject_to(state[0, 1:] == s + step * v + step**2 / 2 * a + step**3 / 6 * jerk)
    problem.subject_to(state[1, 1:] == v + step * a + step**2 / 2 * jerk)
    problem.subject_to(state[2, 1:] == a + step * jerk)
    for rows in limited(path, limits, state, jerk):
        problem.subject_to(problem.bounded(-1.0, ca.vec(rows), 1.0))
    problem.solver("ipopt", {"print_time": False, "expand": True}, IPOPT)
    return problem, duration, state


def limited(path: ca.Function, limits: np.ndarray, state: Any, jerk: Any) -> list[Any]:
    """Velocities, accelerations and jerks of the joints over their limits, jerks at both ends of each interval."""
    s, v, a = [state[row, :] for row in range(3)]
    first, second, third = [each.map(INTERVALS + 1)(s) for each in derivatives(path)]

    def times(rows: Any, row: Any) -> Any:
        return rows * ca.repmat(row, rows.shape[0], 1)

    moving = times(third, v**3) + times(second, 3 * v * a)
    jerks = [moving[:, end] + times(first[:, end], jerk) for end in (slice(0, INTERVALS), slice(1, INTERVALS + 1))]
    accelerations = times(second, v**2) + times(first, a)
    return [times(first, v) / limits[0], accelerations / limits[1], *(each / limits[2] for each in jerks)]


def shortest(path: ca.Function, limits: np.ndarray, guess: float) -> float:
    """Shortest duration over starts of 1.3 and of 3 times the duration `guess`; infinite where neither converges."""
    problem, duration, state = collocation(path, limits)
    tau = np.linspace(0.0, 1.0, INTERVALS + 1)
    quintic = np.polynomial.Polynomial([0.0, 0.0, 0.0, 10.0, -15.0, 6.0])
    found = [np.inf]
    for slower in (1.3, 3.0):
        problem.set_initial(duration, slower * guess)
        for order in range(3):
            problem.set_initial(state[order, :], quintic.deriv(order)(tau) / (slower * guess) ** order)
        try:
            found.append(float(problem.solve().value(duration)))
        except RuntimeError:  # Ipopt did not converge
            continue
    return min(found)


def joint_path(seed: int) -> tuple[ca.Function, np.ndarray, Callable[[], float]]:
    """Path, limits and the duration by `time_optimal`."""
    random = np.random.default_rng(seed)
    path, limits = sines(random, JOINTS[seed % len(JOINTS)]), limits_of(random)
    rows = rows_of(path, ROWS)
    return path, limits, lambda: bik.time_optimal(rows, ours(limits), spline="not-a-knot").duration


def tip_path(seed: int) -> tuple[ca.Function, np.ndarray, Callable[[], float]]:
    """Path, limits and the duration by `plan_along_path`."""
    random = np.random.default_rng(seed)
    (path, points), limits = circle(random), limits_of(random)
    arm, start = bik.Robot.planar([1.0, 1.0]), np.array(path(0.0)).ravel()

    def duration() -> float:
        given = {"start_q": start, "limits": ours(limits), "accuracy": ACCURACY, "task": bik.tasks.Position()}
        plan = bik.plan_along_path(arm, points, **given)
        return plan.trajectory.duration if plan.success else np.nan

    return path, limits, duration


def measure(
    named: str, drawn: Callable[[int], tuple[ca.Function, np.ndarray, Callable[[], float]]], seeds: range
) -> None:
    """Prints a line for each path, then median and extremes of the ratio."""
    ratios = []
    for seed in seeds:
        path, limits, timed = drawn(seed)
        begin = time.process_time()
        duration = timed()
        taken = 1e3 * (time.process_time() - begin)
        ratios.append(duration / shortest(path, limits, duration))
        given = f"{path.size1_out(0)} joints, limits {limits}"
        print(f"{named} {seed}: {given}: {duration:.4f} s, ratio {ratios[-1]:.5f}, {taken:.1f} ms", flush=True)
    converged = [ratio for ratio in ratios if ratio > 0.0]
    print(f"{named}: {len(converged)} of {len(seeds)} converged", end="")
    print(f"; ratio: median {np.median(converged):.5f}, from {min(converged):.5f} to {max(converged):.5f}", flush=True)


if __name__ == "__main__":
    arguments = [int(argument) for argument in sys.argv[1:]]
    paths, circles, begun = arguments + [60, 20, 0][len(arguments) :]
    measure("time_optimal", joint_path, range(begun, begun + paths))
    measure("plan_along_path", tip_path, range(begun, begun + circles))
