"""The centre of mass as a task beside those of several tips, with Pinocchio as judge of where it is."""

from functools import cache
from typing import Any

import numpy as np
import pytest
from dynamics_oracle import DynamicsOracle
from mistakes import assert_told
from numpy.typing import NDArray
from pair_of_pandas import pair_of_pandas
from test_dynamics import with_masses

import beetle_ik as bik
from beetle_ik.tasks import Orientation, Pointing, Pose, Position

Array = NDArray[np.float64]

BARE = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
PAIR = with_masses(BARE, 1)
CENTER = "center_of_mass"
LEVEL = Position(weights=(1, 1, 0))  # horizontal alone
GIVEN_UP = bik.Status.LEVEL_GIVEN_UP


def draw(count: int, seed: int) -> Array:
    """Configurations in the middle half of the ranges."""
    return 0.5 * PAIR.random_configurations(count, seed=seed) + 0.25 * (PAIR.lower + PAIR.upper)


def hands(q: Array) -> dict[Any, Array]:
    return dict(zip(PAIR.tips, PAIR.fk(q), strict=True))


@cache
def oracle() -> DynamicsOracle:
    """Pinocchio with the masses of PAIR."""
    found = DynamicsOracle(pair_of_pandas(), PAIR)
    pin, model = found.pin, found.model
    model.inertias[0] = pin.Inertia.Zero()
    for frame in model.frames:
        known = {inertia.link: inertia for inertia in PAIR.inertias}.get(frame.name)
        if known is not None and frame.type == pin.BODY:
            body = pin.Inertia(known.mass, known.center, known.matrix)
            model.inertias[frame.parentJoint] = model.inertias[frame.parentJoint] + frame.placement.act(body)
    found.data = model.createData()
    return found


def jacobians(q: Array) -> tuple[Array, Array]:
    """Jacobians of both hands (12, n) and of the centre of mass (3, n), by Pinocchio."""
    judge = oracle()
    pin, model, data = judge.pin, judge.model, judge.data
    full = judge._configuration(q)
    pin.computeJointJacobians(model, data, full)
    pin.updateFramePlacements(model, data)
    frames = [model.getFrameId(tip, pin.BODY) for tip in PAIR.tips]
    tips = [pin.getFrameJacobian(model, data, frame, pin.LOCAL_WORLD_ALIGNED) for frame in frames]
    center = pin.jacobianCenterOfMass(model, data, full)
    # Masses on the base count in the centre and are no part of the tree of Pinocchio.
    share = sum(body.mass for body in list(model.inertias)[1:]) / sum(body.mass for body in model.inertias)
    return np.vstack(tips) @ judge.followed, share * np.asarray(center @ judge.followed)


@pytest.mark.parametrize("seed", range(5))
def test_the_centre_is_where_it_was_asked_to_be(seed: int) -> None:
    q, other = draw(2, seed)
    target = {**hands(q), CENTER: PAIR.center_of_mass(q)}
    found = bik.solve(PAIR, target, task={CENTER: LEVEL}, start_q=0.8 * q + 0.2 * other)
    assert found.success, found.message
    assert found.errors[CENTER][0] < 1e-6
    assert np.isnan(found.errors[CENTER][1])
    center = oracle().center_of_mass(found.q)
    np.testing.assert_allclose(center[:2], target[CENTER][:2], atol=1e-6)
    np.testing.assert_allclose(PAIR.fk(found.q), PAIR.fk(q), atol=1e-5)


def test_the_whole_centre_with_one_hand() -> None:
    for q, other in zip(draw(5, 7), draw(5, 8), strict=True):
        target = {"left_tool": hands(q)["left_tool"], CENTER: PAIR.center_of_mass(0.7 * q + 0.3 * other)}
        found = bik.solve(PAIR, target)
        assert found.success, found.message
        np.testing.assert_allclose(oracle().center_of_mass(found.q), target[CENTER], atol=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_a_higher_level_is_as_near_as_the_hands_allow(seed: int) -> None:
    q = draw(1, seed)[0]
    target = {**hands(q), CENTER: PAIR.center_of_mass(q) + np.array([1.0, -0.5, 0.0])}
    found = bik.solve(PAIR, target, task={CENTER: Position(level=1)}, start_q=q)
    assert found.status is GIVEN_UP
    assert max(found.errors[tip][0] for tip in PAIR.tips) < 1e-6
    assert "level 1 not met, the nearest found is the centre of mass" in found.message
    # No motion of the free joints that leaves the hands lowers the error.
    free = (PAIR.lower + 1e-6 < found.q) & (found.q < PAIR.upper - 1e-6)
    of_hands, of_center = (jacobian[:, free] for jacobian in jacobians(found.q))
    slope = of_center.T @ (oracle().center_of_mass(found.q) - target[CENTER])
    kept = slope - np.linalg.pinv(of_hands, rcond=1e-6) @ (of_hands @ slope)
    assert np.linalg.norm(kept) < 2e-3 * np.linalg.norm(slope)


def test_a_hand_gives_way_to_the_centre_of_a_lower_level() -> None:
    q = draw(1, 3)[0]
    beyond = hands(q)["right_tool"].copy()
    beyond[:3, 3] += (0.0, -2.0, 0.0)
    target = {"right_tool": beyond, CENTER: PAIR.center_of_mass(q)}
    found = bik.solve(PAIR, target, task={CENTER: LEVEL, "right_tool": Position(level=1)}, start_q=q)
    assert found.status is GIVEN_UP
    np.testing.assert_allclose(oracle().center_of_mass(found.q)[:2], target[CENTER][:2], atol=1e-6)


def test_within_a_tolerance_the_centre_is_met() -> None:
    q = draw(1, 5)[0]
    target = {**hands(q), CENTER: PAIR.center_of_mass(q) + np.array([0.02, 0.0, 5.0])}
    found = bik.solve(PAIR, target, task={CENTER: Position(tolerance=(0.03, 0.03, np.inf))}, start_q=q)
    assert found.success
    assert abs(oracle().center_of_mass(found.q) - target[CENTER])[:2].max() <= 0.03 + 1e-9


def test_a_batch_and_all_solutions_meet_it() -> None:
    qs = draw(4, 11)
    targets = {**{tip: PAIR.fk(qs)[:, i] for i, tip in enumerate(PAIR.tips)}, CENTER: PAIR.center_of_mass(qs)}
    batch = bik.solve_batch(PAIR, targets, start_q=qs + 0.02, task={CENTER: LEVEL})
    assert batch.success.all()
    assert batch.errors[CENTER][0].max() < 1e-6
    found = bik.solve_all(PAIR, {**hands(qs[0]), CENTER: PAIR.center_of_mass(qs[0])}, task={CENTER: LEVEL}, limit=4)
    assert len(found.q)
    for q in found.q:
        np.testing.assert_allclose(oracle().center_of_mass(q)[:2], PAIR.center_of_mass(qs[0])[:2], atol=1e-6)


@pytest.mark.parametrize("limits", [None, bik.Limits(acceleration=15.0)], ids=["velocity", "acceleration"])
def test_a_tracker_keeps_the_centre_while_a_hand_reaches_out(limits: bik.Limits | None) -> None:
    floating = PAIR.with_mobile_base("floating", lower=[-1] * 6, upper=[1] * 6, velocity=[1] * 6, acceleration=[10] * 6)
    q = np.concatenate([np.zeros(6), draw(1, 13)[0]])
    foot, hand = floating.fk(q)
    center = floating.center_of_mass(q)
    tasks = {CENTER: LEVEL, "right_tool": Position(level=1)}
    tracker = bik.Tracker(floating, q, dt=0.01, task=tasks, limits=limits)
    for i in range(301):
        way = 0.1 * (1 - np.cos(i * np.pi / 150))
        reach = hand[:3, 3] + [way, 0.0, 0.0]
        step = tracker.step({"left_tool": foot, CENTER: center, "right_tool": reach})
        assert np.abs(floating.center_of_mass(step.q) - center)[:2].max() < (2e-5 if limits is None else 2e-3)
        assert step.errors["left_tool"][0] < (2e-5 if limits is None else 2e-3)
    assert step.success


def test_a_track_takes_a_path_of_the_centre() -> None:
    q = draw(1, 17)[0]
    begin = PAIR.center_of_mass(q)
    times = np.linspace(0.0, 2.0, 41)
    places = begin + np.stack([0.02 * np.sin(np.pi * times) ** 2, 0 * times, 0 * times], axis=1)
    path = bik.paths.from_samples(times, places)
    result = bik.track(
        PAIR, {CENTER: path, "left_tool": hands(q)["left_tool"]}, dt=0.02, start_q=q, task={CENTER: LEVEL}
    )
    assert result.success
    assert result.errors[CENTER][0].max() < 1e-4


def test_a_plan_ends_with_the_centre_there() -> None:
    q, other = draw(2, 19)
    end = {**hands(other), CENTER: PAIR.center_of_mass(other)}
    plan = bik.plan_point_to_point(PAIR, start_q=q, end=end, task={CENTER: LEVEL}, limits=bik.Limits(acceleration=5.0))
    assert plan.success, plan.message
    np.testing.assert_allclose(oracle().center_of_mass(plan.trajectory.q[-1])[:2], end[CENTER][:2], atol=1e-5)


def test_a_payload_counts() -> None:
    q, other = draw(2, 23)
    loaded = PAIR.with_payload(4.0, link="left_tool")
    target = {**hands(q), CENTER: loaded.center_of_mass(q)}
    assert np.linalg.norm(PAIR.center_of_mass(q) - target[CENTER]) > 0.01
    found = bik.solve(loaded, target, task={CENTER: LEVEL}, start_q=0.8 * q + 0.2 * other)
    assert found.success, found.message
    np.testing.assert_allclose(loaded.center_of_mass(found.q)[:2], target[CENTER][:2], atol=1e-6)


def test_a_tip_of_this_name_is_a_tip() -> None:
    named = pair_of_pandas().replace('"left_tool"', f'"{CENTER}"')
    robot = bik.Robot.from_urdf(named, tip=[CENTER, "right_tool"])
    q = robot.random_configurations(1, seed=1)[0]
    found = bik.solve(robot, {CENTER: robot.fk(q)[0]})
    assert found.success
    np.testing.assert_allclose(robot.fk(found.q)[0], robot.fk(q)[0], atol=1e-5)


def solve(robot: bik.Robot, target: Any = (0.0, 0.0, 1.0), task: Any = None) -> None:
    bik.solve(robot, {CENTER: target}, task=None if task is None else {CENTER: task})


ALONE = "the centre of mass takes task Position without a tool, got "


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: solve(bik.Robot.named("panda")),
            "the centre of mass is a task beside those of several tips; robot 'panda' has one",
        ),
        (
            lambda: bik.Tracker(bik.Robot.named("panda"), np.zeros(7), dt=0.1, task={CENTER: LEVEL}),
            "the centre of mass is a task beside those of several tips; robot 'panda' has one",
        ),
        (
            lambda: solve(BARE),
            "robot 'pair_of_pandas' has no dynamics: no link has a mass: give them by robot.with_inertias({link: "
            "Inertia(link, mass, center, matrix)})",
        ),
        (lambda: solve(PAIR, np.eye(4)), "the centre of mass has no orientation: its target is a position"),
        (lambda: solve(PAIR, task=Pose()), ALONE + "Pose"),
        (lambda: solve(PAIR, task=Orientation()), ALONE + "Orientation"),
        (lambda: solve(PAIR, task=Pointing()), ALONE + "Pointing"),
        (lambda: solve(PAIR, task=Position(tool=bik.pose((0, 0, 0.1)))), ALONE + "a tool"),
        (lambda: solve(PAIR, (0.0, np.nan, 0.0)), "target must be finite, but coordinate y is NaN"),
        (
            lambda: bik.plan_point_to_point(
                PAIR, start_q=draw(1, 0)[0], end_q=draw(1, 1)[0], keep=bik.Keep({CENTER: (0, 0, 1)}, task=Position())
            ),
            "a tip or a pair of tips is kept along the way, not the centre of mass",
        ),
    ],
)
def test_mistakes_are_told(call: object, message: str) -> None:
    assert_told(call, bik.InvalidInputError, message)


def test_a_centre_in_millimetres_is_doubted() -> None:
    with pytest.warns(bik.UnitsWarning, match="target: z is 1300 m"):
        solve(PAIR, (0.0, 0.0, 1300.0))
