"""The goal LeastTorque: lower torques in every call that takes goals, and what it refuses."""

from typing import Any

import numpy as np
import pytest
from mistakes import assert_told
from numpy.typing import NDArray
from test_dynamics import with_masses

import beetle_ik as bik

Array = NDArray[np.float64]

PANDA = bik.Robot.named("panda").with_payload(3.0, center=(0, 0, 0.05))
HOLD = bik.goals.LeastTorque()
Q = np.array([0.3, -0.5, 0.4, -2.0, 0.3, 1.5, 0.8])

MISSING = "no link has a mass: give them by robot.with_inertias({link: Inertia(link, mass, center, matrix)})"


def effort(robot: bik.Robot, q: Array, scale: Array | None = None) -> Any:
    """Sum of squared shares of the torque limits."""
    return np.sum((robot.torques(q) / (robot.torque_limit if scale is None else scale)) ** 2, axis=-1)


def arms() -> list[bik.Robot]:
    """The Panda with and without a load, hung from a wall, and arms of seven and eight joints with random links."""
    bare = bik.Robot.named("panda")
    wall = PANDA.with_base(bik.pose([0, 0, 1], rpy=[0, np.pi / 2, 0]))
    other = bik.Robot.named("iiwa14").with_limits(lower=-3.0, upper=3.0)
    return [bare, PANDA, wall, *(with_masses(other, seed) for seed in range(3))]


@pytest.mark.parametrize("robot", arms(), ids=lambda robot: robot.name)
def test_the_torque_falls_and_is_least_nearby(robot: bik.Robot) -> None:
    limited = np.isfinite(robot.torque_limit).any()
    scale = None if limited else np.full(robot.dof, 10.0)
    before, after = [], []
    for q in 0.9 * robot.random_configurations(15, seed=3):
        target = robot.fk(q)
        plain = bik.solve(robot, target, start_q=q)
        held = bik.solve(robot, target, start_q=q, goals=HOLD)
        assert plain.success
        assert held.success
        assert np.allclose(robot.fk(held.q), target, atol=1e-5)
        before.append(effort(robot, plain.q, scale))
        after.append(effort(robot, held.q, scale))
        assert after[-1] <= before[-1] * (1 + 1e-9)
        # No motion that leaves the tip in place lowers the torques, unless a limit is in the way.
        if np.all((robot.lower + 1e-3 < held.q) & (held.q < robot.upper - 1e-3)):
            along = np.linalg.svd(robot.jacobian(held.q))[2][-1]
            slope = (effort(robot, held.q + 1e-5 * along, scale) - effort(robot, held.q - 1e-5 * along, scale)) / 2e-5
            assert abs(slope) < 3e-3 * (1 + after[-1])
    assert np.median(after) < 0.95 * np.median(before)


def test_the_best_is_no_worse_than_the_nearest_optimum() -> None:
    for q in PANDA.random_configurations(10, seed=4):
        nearest = bik.solve(PANDA, PANDA.fk(q), start_q=q, goals=HOLD)
        best = bik.solve(PANDA, PANDA.fk(q), start_q=q, goals=HOLD, prefer="best")
        assert best.success
        assert effort(PANDA, best.q) <= effort(PANDA, nearest.q) * (1 + 1e-6)


def test_a_batch_solves_as_single_calls() -> None:
    qs = PANDA.random_configurations(8, seed=5)
    batch = bik.solve_batch(PANDA, PANDA.fk(qs), start_q=qs, goals=HOLD)
    for q, found in zip(qs, batch.q, strict=True):
        assert np.array_equal(found, bik.solve(PANDA, PANDA.fk(q), start_q=q, goals=HOLD).q)


def test_the_payload_and_gravity_of_the_robot_count() -> None:
    bare, target = bik.Robot.named("panda"), PANDA.fk(Q)
    # Without gravity nothing is to be held: the goal moves no joint.
    weightless = bare.with_gravity((0, 0, 0))
    assert np.allclose(
        bik.solve(weightless, target, start_q=Q, goals=HOLD).q, bik.solve(weightless, target, start_q=Q).q, atol=1e-9
    )
    aside = PANDA.with_gravity((0, 9.81, 0))
    solutions = [bik.solve(robot, target, start_q=Q, goals=HOLD).q for robot in (bare, PANDA, aside)]
    for i, robot in enumerate((bare, PANDA, aside)):
        others = [effort(robot, q) for j, q in enumerate(solutions) if j != i]
        assert effort(robot, solutions[i]) < min(others)


def test_joints_count_by_what_they_are_relative_to() -> None:
    only = np.full(7, np.inf)
    only[3] = 10.0
    held = bik.solve(PANDA, PANDA.fk(Q), start_q=Q, goals=bik.goals.LeastTorque(relative_to=only))
    all_alike = bik.solve(PANDA, PANDA.fk(Q), start_q=Q, goals=HOLD)
    assert abs(PANDA.torques(held.q)[3]) < abs(PANDA.torques(all_alike.q)[3]) < abs(PANDA.torques(Q)[3]) + 1e-9


@pytest.mark.parametrize("limits", [None, bik.Limits(acceleration=10.0)], ids=["velocity", "acceleration"])
def test_a_tracker_lowers_the_torque_on_the_way(limits: bik.Limits | None) -> None:
    target = PANDA.fk(Q)
    efforts = {}
    for goals in (None, bik.goals.LeastTorque(weight=5.0)):
        tracker = bik.Tracker(PANDA, Q, dt=0.01, limits=limits, goals=goals)
        for i in range(601):
            aside = target.copy()
            aside[1, 3] += 0.05 * np.sin(2 * np.pi * i / 600)
            step = tracker.step(aside)
        assert np.allclose(PANDA.fk(step.q), target, atol=1e-3)
        efforts[goals is None] = effort(PANDA, step.q)
    best = effort(PANDA, bik.solve(PANDA, target, start_q=Q, goals=HOLD).q)
    assert efforts[False] < 0.9 * efforts[True]
    assert efforts[False] < 1.02 * best


def test_a_track_takes_it_too() -> None:
    circle = bik.paths.circle(center=PANDA.fk(Q)[:3, 3], diameter=0.1, duration=4.0)
    efforts = [
        effort(PANDA, bik.track(PANDA, circle, dt=0.02, start_q=Q, goals=goals).q[-1])
        for goals in (None, bik.goals.LeastTorque(weight=5.0))
    ]
    assert efforts[1] < 0.9 * efforts[0]


def test_a_floating_base_never_counts() -> None:
    half = np.array([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    floating = PANDA.with_mobile_base("floating", lower=-half, upper=half)
    q = np.concatenate([np.zeros(6), Q])
    held = bik.solve(floating, floating.fk(q), start_q=q, goals=HOLD, prefer="any")
    assert held.success
    arm = slice(6, None)
    before, after = ((floating.torques(x)[arm] / PANDA.torque_limit) for x in (q, held.q))
    assert np.sum(after**2) < 0.9 * np.sum(before**2)


def test_several_tips_take_it() -> None:
    from pair_of_pandas import pair_of_pandas

    pair = with_masses(bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"]), 1)
    q = pair.random_configurations(1, seed=2)[0]
    targets = dict(zip(pair.tips, pair.fk(q), strict=True))
    scale = np.full(pair.dof, 50.0)
    goal = bik.goals.LeastTorque(relative_to=scale)
    plain, held = (bik.solve(pair, targets, start_q=q, goals=goals) for goals in (None, goal))
    assert plain.success
    assert held.success
    assert effort(pair, held.q, scale) < effort(pair, plain.q, scale)


def test_it_is_shown_and_compared_by_its_values() -> None:
    scale = [87.0, 87.0, 87.0, 87.0, 12.0, 12.0, np.inf]
    goal = bik.goals.LeastTorque(relative_to=scale, weight=2.0)
    assert repr(goal) == "goals.LeastTorque(relative_to=[87.0, 87.0, 87.0, 87.0, 12.0, 12.0, inf], weight=2.0)"
    assert repr(HOLD) == "goals.LeastTorque(weight=1.0)"
    assert HOLD.relative_to is None
    assert np.array_equal(goal.relative_to, scale)
    assert goal == bik.goals.LeastTorque(relative_to=np.array(scale), weight=2.0) != HOLD


def solve(robot: bik.Robot, **options: Any) -> None:
    bik.solve(robot, robot.fk(np.zeros(robot.dof)), goals=bik.goals.LeastTorque(**options))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: solve(bik.Robot.named("ur5e")),
            "robot 'ur5e' has no dynamics: " + MISSING,
        ),
        (
            lambda: bik.Tracker(bik.Robot.named("iiwa14"), np.zeros(7), dt=0.1, goals=HOLD),
            "robot 'iiwa14' has no dynamics: " + MISSING,
        ),
        (
            lambda: solve(PANDA, relative_to=[1.0, 2.0]),
            "relative_to of the goal LeastTorque: expected 7 (one per joint), got 2",
        ),
        (
            lambda: solve(PANDA, relative_to=[1, 2, 3, 0, 5, 6, 7]),
            "relative_to of the goal LeastTorque, entry 3, must be positive, infinite for a joint that "
            "does not count, got 0",
        ),
        (
            lambda: solve(PANDA, relative_to=[1, 2, 3, np.nan, 5, 6, 7]),
            "relative_to of the goal LeastTorque, entry 3, must be positive, infinite for a joint that "
            "does not count, got NaN",
        ),
        (
            lambda: bik.goals.LeastTorque(relative_to=[np.nan] * 7),
            "relative_to of the goal LeastTorque, entry 0, must be positive, infinite for a joint that "
            "does not count, got NaN",
        ),
        (
            lambda: solve(PANDA, relative_to=np.full(7, np.inf)),
            "relative_to of the goal LeastTorque is infinite for all joints: none would count",
        ),
        (lambda: solve(PANDA, relative_to=50.0), "relative_to: expected one dimension, got shape ()"),
        (lambda: solve(PANDA, weight=0.0), "weight of a goal must be positive and finite, got 0"),
    ],
)
def test_mistakes_are_told(call: object, message: str) -> None:
    assert_told(call, bik.InvalidInputError, message)
