"""Loads of the motors in the viewer: shares of the torque limits at rest, while playing and while dragging."""

import re
from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray
from viewer_turns import until

import beetle_ik as bik
from beetle_ik.viewing.arm import Arm
from beetle_ik.viewing.loads import loads_in_html

Array = NDArray[np.float64]

PANDA = bik.Robot.named("panda").with_payload(3.0).with_capsules(radius=0.06)
START = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])


@pytest.fixture
def viewer() -> Iterator[bik.Viewer]:
    with bik.view(PANDA, START, port=0) as viewer:
        yield viewer


def shown(arm: Arm) -> tuple[str, Array]:
    """The line of text, and the share of each bar."""
    page = loads_in_html(arm)
    assert page is not None
    text = re.sub(r"<[^>]*>", "", re.findall(r"data-beetle-ik='load'>(.*?)</span>", page)[0])
    return text, np.array([float(share) for share in re.findall(r"share='([\d.]+)'", page)])


def shares(q: Array, *rates: Array) -> Array:
    return np.asarray(np.abs(PANDA.torques(q, *rates)) / PANDA.torque_limit)


def test_an_arm_at_rest_shows_what_holds_it_up() -> None:
    text, bars = shown(Arm(PANDA, START, []))
    right = shares(START)
    np.testing.assert_allclose(bars, right, atol=6e-4)
    most = int(np.argmax(right))
    assert text == f"motor load up to {100 * right[most]:.0f} %, {PANDA.joint_names[most]}"


def test_a_motion_shows_what_moves_the_arm_too() -> None:
    arm = Arm(PANDA, START, [])
    rates = np.full(7, 1.0), np.full(7, 8.0)
    arm.put(START, *rates)
    np.testing.assert_allclose(shown(arm)[1], shares(START, *rates), atol=6e-4)
    arm.put(START)
    np.testing.assert_allclose(shown(arm)[1], shares(START), atol=6e-4)


def test_a_motor_beyond_its_limit_is_named() -> None:
    arm = Arm(PANDA, START, [])
    still, fast = np.zeros(7), np.zeros(7)
    fast[4] = 1000.0
    arm.put(START, still, fast)
    text, bars = shown(arm)
    over = np.flatnonzero(shares(START, still, fast) > 1.0)
    assert 4 in over
    assert text.startswith("beyond its motor: ")
    assert [name in text for name in PANDA.joint_names] == [j in over for j in range(7)]
    assert bars[4] > 1.0


def test_a_dragged_arm_shows_the_torques_of_its_motion() -> None:
    arm = Arm(PANDA, START, [])
    arm.aim(PANDA.tips[0], bik.pose([0.0, 0.0, -0.15]) @ PANDA.fk(START))
    before, seen = np.zeros(7), []
    while arm.advance():
        assert arm.outcome is not None
        velocity = arm.outcome.qd
        np.testing.assert_allclose(shown(arm)[1], shares(arm.q, velocity, 60 * (velocity - before)), atol=6e-4)
        before = velocity
        seen.append(np.abs(shares(arm.q, *arm.rates) - shares(arm.q)).max())
    assert max(seen) > 0.01
    assert arm.rates == ()
    np.testing.assert_allclose(shown(arm)[1], shares(arm.q), atol=6e-4)


def test_a_drag_after_a_motion_begins_at_rest() -> None:
    arm = Arm(PANDA, START, [])
    arm.put(START, np.full(7, 2.0), np.zeros(7))
    arm.aim(PANDA.tips[0], bik.pose([0.0, 0.0, -0.15]) @ PANDA.fk(START))
    arm.advance()
    velocity, acceleration = arm.rates
    np.testing.assert_allclose(acceleration, 60 * velocity, atol=1e-9)
    assert np.abs(acceleration).max() <= 20.0 + 1e-6


def test_playback_shows_the_torques_of_the_motion(viewer: bik.Viewer) -> None:
    limits = bik.Limits(acceleration=5.0)
    there = START + np.array([0.7, 0.4, 0, 0.3, 0, 0, 0])
    plan = bik.plan_point_to_point(PANDA, start_q=START, end_q=there, limits=limits)
    viewer.show(plan)
    parts = viewer._parts
    until(lambda: parts.playback._time > 0.2)
    with viewer._turns.between():
        parts.playback._jump(0.4)
        found = shown(viewer._arm)[1]
    np.testing.assert_allclose(found, np.abs(plan.torques(0.4)) / PANDA.torque_limit, atol=6e-4)


def test_the_page_has_the_bars(viewer: bik.Viewer) -> None:
    until(lambda: "motor load up to" in str(viewer._parts.report._text.content))


def test_a_robot_without_masses_shows_none() -> None:
    robot = bik.Robot.named("ur5e")
    assert loads_in_html(Arm(robot, np.zeros(6), [])) is None


def test_without_torque_limits_the_largest_torque_is_told() -> None:
    links = bik.Robot.named("ur5e").link_names[1:]
    bodies = [bik.Inertia(link, 2.0, center=(0, 0, 0), matrix=0.01 * np.eye(3)) for link in links]
    robot = bik.Robot.named("ur5e").with_inertias(bodies)
    q = np.full(6, 0.3)
    torques = np.abs(robot.torques(q))
    page = loads_in_html(Arm(robot, q, []))
    assert np.isinf(robot.torque_limit).all()
    assert page == (
        f"<span data-beetle-ik='load'>largest torque {torques.max():.1f} N m, "
        f"{robot.joint_names[int(np.argmax(torques))]}</span>"
    )
