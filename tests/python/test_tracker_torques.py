"""Torque limits of `Tracker` and `track`, judged by Pinocchio at every tick of commands and stops."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from test_torque_limits import ARM, MOTORS, ROBOT

import beetle_ik as bik

pin = pytest.importorskip("pinocchio")
api: Any = bik  # wrong calls on purpose
Array = NDArray[np.float64]

HOME = np.array([0.3, -0.6, 1.2, 0.1, 0.2])
PANDA = bik.Robot.named("panda")
READY = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])
RATED = [15, 7.5, 10, 12.5, 15, 20, 20]


def limits(torque: Any, **others: Any) -> bik.Limits:
    return bik.Limits(**({"velocity": 3.0, "acceleration": 25.0, "lower": -2.0, "upper": 2.0} | others), torque=torque)


def model(mass: float) -> Any:
    """The arm with this mass 5 cm beyond its tip."""
    arm = pin.buildModelFromXML(ARM)
    arm.appendBodyToJoint(
        arm.njoints - 1, pin.Inertia(mass, np.array([0.0, 0.0, 0.05]), np.zeros((3, 3))), pin.SE3.Identity()
    )
    return arm


def beyond(commands: list[Array], dt: float, mass: float, motors: Array) -> float:
    """How far torques exceed their limits at most (N m, N)."""
    arm = model(mass)
    data, q = arm.createData(), np.array(commands)
    qd = np.diff(q, axis=0) / dt
    qdd = np.diff(qd, axis=0) / dt
    rows = zip(q[2:], qd[1:], qdd, strict=True)
    torques = np.array([pin.rnea(arm, data, *row) for row in rows])
    return float((np.abs(torques) - motors).max())


def target(rng: np.random.Generator) -> Array:
    """A pose near the start, or anywhere; round values as often as others."""
    q = rng.choice([HOME + rng.uniform(-0.5, 0.5, 5), rng.uniform(-1.5, 1.5, 5), rng.choice([-1.0, 0, 0.5, 1], 5)])
    q[3] = np.clip(q[3], 0, 0.3)
    return ROBOT.fk(q)


def grasping(jerk: float | None) -> tuple[bik.Tracker, bik.Robot]:
    """A tracker whose arm has grasped 3 kg where it cannot hold them."""
    at = np.array([0.0, 0.7, 0.0, -1.2, 0.0, 1.8, 0.8])
    within = {"acceleration": RATED, "torque": 0.7 * PANDA.torque_limit}
    tracker = bik.Tracker(PANDA, at, dt=0.004, limits=bik.Limits(**within, **({} if jerk is None else {"jerk": jerk})))
    for _ in range(10):
        tracker.step(PANDA.fk(at))
    tracker.robot = PANDA.with_payload(3.0, center=(0, 0, 0.05))
    return tracker, tracker.robot


@pytest.mark.parametrize("wait", [0, 1000])
@pytest.mark.parametrize("jerk", [None, 500.0])
def test_an_arm_that_has_grasped_too_much_leaves_and_follows_its_target(jerk: float | None, wait: int) -> None:
    tracker, loaded = grasping(jerk)
    here, back = loaded.fk(tracker.q), loaded.fk([0.0, -0.5, 0.0, -2.2, 0.0, 1.8, 0.8])
    before = tracker.step(here)
    assert "joint 'panda_joint2' needs 65.37 N m to hold the arm, its limit is 60.90 N m" in before.message
    for _ in range(wait):  # at the edge of what it can hold, where the target draws it
        tracker.step(here)
    steps = [tracker.step(back) for _ in range(2500)]
    assert steps[-1].status is bik.Status.SOLVED, steps[-1].message


def stopped(tracker: bik.Tracker) -> list[Array]:
    """The commands of a stop, until after its end."""
    ticks = round(tracker.stop() / tracker.dt)
    return [tracker.step(None).q for _ in range(ticks + 2)]


@pytest.mark.parametrize("jerk", [None, 800.0])
@pytest.mark.parametrize("dt", [0.002, 0.01])
def test_commands_and_stops_keep_torques_at_ticks(dt: float, jerk: float | None) -> None:
    rng, worst = np.random.default_rng(7), -np.inf
    for mass in (0.0, 0.3, 0.5, float(rng.uniform(0, 0.5))):
        robot = ROBOT.with_payload(mass, center=(0, 0, 0.05))
        motors = rng.choice([0.7, 1.0]) * MOTORS
        tracker = bik.Tracker(robot, HOME, dt=dt, limits=limits(motors, jerk=jerk))
        commands = [HOME, HOME]
        for _ in range(6):
            aim = target(rng)
            commands += [tracker.step(aim).q for _ in range(rng.integers(20, 80))]
            commands += [tracker.step(None).q for _ in range(rng.choice([0, 0, 5]))]
            if rng.random() < 0.4:
                commands += stopped(tracker)
        commands += stopped(tracker)
        assert np.ptp(commands[-2:], axis=0).max() == 0
        excess = beyond(commands, dt, mass, motors)
        assert excess <= 1e-9
        worst = max(worst, excess)
    assert worst > -2.0


@pytest.mark.parametrize(("dt", "allowed"), [(0.002, 1.1e-3), (0.01, 1e-2)])
def test_between_ticks_torques_are_as_near_to_their_limits_as_told(dt: float, allowed: float) -> None:
    rng, worst = np.random.default_rng(11), -np.inf
    for mass in (0.0, 1.5, 3.0):
        robot = PANDA.with_payload(mass, center=(0, 0, 0.05))
        motors = 0.7 * PANDA.torque_limit
        tracker = bik.Tracker(robot, READY, dt=dt, limits=bik.Limits(acceleration=RATED, torque=motors))
        commands = [READY] * 3
        for _ in range(6):
            aim = robot.fk(np.clip(READY + rng.uniform(-1, 1, 7), robot.lower + 0.05, robot.upper - 0.05))
            commands += [tracker.step(aim).q for _ in range(round(0.15 / dt))]
        commands += stopped(tracker)
        before, here, there, after = (np.array(commands[i : len(commands) - 3 + i]) for i in range(4))
        for s in np.linspace(0, 1, 6):
            r = 1 - s
            weights = (r**3, 3 * s**3 - 6 * s**2 + 4, 3 * r**3 - 6 * r**2 + 4, s**3)
            rates = (-(r**2), 3 * s**2 - 4 * s, 4 * r - 3 * r**2, s**2)
            changes = (r, 3 * s - 2, 3 * r - 2, s)
            rows = (before, here, there, after)
            q, qd, qdd = (
                sum(weight * row for weight, row in zip(each, rows, strict=True)) / scale
                for each, scale in ((weights, 6), (rates, 2 * dt), (changes, dt**2))
            )
            worst = max(worst, float((np.abs(robot.torques(q, qd, qdd)) / motors).max()) - 1)
    assert -0.05 < worst <= allowed


def test_a_payload_changes_in_the_hand() -> None:
    tracker = bik.Tracker(ROBOT, HOME, dt=0.004, limits=limits(MOTORS))
    assert tracker.robot == ROBOT
    rng = np.random.default_rng(3)
    masses = [0.3, 0.0, 0.4, 0.2, 0.5]
    for mass in masses:
        aim = target(rng)
        for _ in range(15):
            tracker.step(aim)
        carrying = ROBOT.with_payload(mass, center=(0, 0, 0.05))
        tracker.robot = carrying
        assert tracker.robot == carrying
        steps = [tracker.step(aim) for _ in range(200)]
        settled = next(i for i, step in enumerate(steps) if step.status != bik.Status.HELD_BY_TORQUE)
        commands = [step.q for step in steps[settled:]]
        assert beyond(commands, 0.004, mass, MOTORS) <= 1e-9


def test_too_much_in_the_hand_is_said_and_slows_the_arm() -> None:
    tracker = bik.Tracker(
        PANDA, READY, dt=0.004, limits=bik.Limits(acceleration=RATED, torque=0.6 * PANDA.torque_limit)
    )
    aim = PANDA.fk([0.4, 0.3, 0, -1.5, 0, 1.8, 0.8])
    for _ in range(30):
        tracker.step(aim)
    tracker.robot = PANDA.with_payload(20.0)
    steps = [tracker.step(aim) for _ in range(300)]
    assert {step.status for step in steps} == {bik.Status.HELD_BY_TORQUE}
    assert np.abs(steps[-1].qd).max() < 1e-3
    assert "joint 'panda_joint" in steps[-1].message
    assert "to hold the arm, its limit is" in steps[-1].message
    tracker.robot = PANDA
    assert [tracker.step(aim) for _ in range(500)][-1].success


def test_the_arm_stops_before_what_a_joint_cannot_hold() -> None:
    robot = PANDA.with_payload(3.0)
    motors = PANDA.torque_limit.copy()
    motors[1] = 1.2 * abs(robot.torques(READY)[1])
    tracker = bik.Tracker(robot, READY, dt=0.004, limits=bik.Limits(acceleration=RATED, torque=motors))
    steps = [tracker.step(robot.fk([0.3, 0.9, 0, -0.9, 0, 1.8, 0.8])) for _ in range(1500)]
    assert all(step.status == bik.Status.HELD_BY_TORQUE for step in steps[-200:])
    holding = np.abs(robot.torques(np.array([step.q for step in steps])))
    assert (holding <= motors).all()
    assert holding[-1, 1] > 0.9 * motors[1]
    assert "joint 'panda_joint2' would need" in steps[-1].message


def test_stop_takes_longer_with_a_payload() -> None:
    times = []
    for mass in (0.0, 3.0):
        robot = PANDA.with_payload(mass)
        weak = bik.Limits(acceleration=RATED, torque=0.6 * PANDA.torque_limit)
        tracker = bik.Tracker(robot, READY, dt=0.002, limits=weak)
        for _ in range(120):
            step = tracker.step(PANDA.fk([1.5, 0.2, 0, -1.4, 0, 1.8, 0.8]))
        times.append(tracker.stop() / np.abs(step.qd).max())
    assert times[1] > times[0] * 1.02


def test_dry_friction_at_rest_holds_no_arm_back() -> None:
    rubbing = ARM.replace('<axis xyz="0 1 0"/>', '<axis xyz="0 1 0"/><dynamics damping="1" friction="5"/>')
    robot = bik.Robot.from_urdf(rubbing)
    hold = np.abs(robot.torques(HOME))
    motors = np.maximum(hold + 2.0, 10.0)  # less than dry friction beyond what holds the arm
    tracker = bik.Tracker(robot, HOME, dt=0.004, limits=limits(motors))
    commands = [HOME, HOME]
    for aim in (robot.fk(HOME - [0, 0, 0.4, 0, 0]), robot.fk(HOME)):
        commands += [tracker.step(aim).q for _ in range(150)]
    qd = np.diff(commands, axis=0) / 0.004
    torques = robot.torques(np.array(commands[2:]), qd[1:], np.diff(qd, axis=0) / 0.004)
    assert (np.abs(torques) <= motors + 1e-9).all()


def test_wrong_calls_are_refused_by_name() -> None:
    rated = bik.Limits(acceleration=RATED, torque=PANDA.torque_limit)
    with pytest.raises(
        bik.UnsupportedLimit, match=r"^Tracker cannot honour torque limits: joint 'panda_joint1' may change"
    ):
        bik.Tracker(PANDA, READY, dt=0.01, limits=bik.Limits(torque=50.0))
    with pytest.raises(bik.InvalidInputError, match="robot 'ur5e' has no dynamics: no link has a mass"):
        bik.Tracker(bik.Robot.named("ur5e"), np.ones(6), dt=0.01, limits=bik.Limits(acceleration=5.0, torque=50.0))
    with pytest.raises(
        bik.InfeasibleError, match=r"^infeasible: at start_q joint 'panda_joint4' needs .* N m to hold the arm, its"
    ):
        bik.Tracker(PANDA, READY, dt=0.01, limits=bik.Limits(acceleration=RATED, torque=1.0))
    tracker = bik.Tracker(PANDA, READY, dt=0.01, limits=rated)
    for other in (bik.Robot.named("ur5e"), PANDA.with_capsules(radius=0.05), PANDA.with_tool(bik.pose([0, 0, 0.1]))):
        with pytest.raises(bik.InvalidInputError, match="differs from robot 'panda' in more than masses, payloads and"):
            tracker.robot = other
    for other in (None, "panda", 3):
        with pytest.raises(
            bik.CallError, match=r"^robot must be a Robot, such as tracker.robot.with_payload\(2\), got"
        ):
            api.Tracker.robot.__set__(tracker, other)
    with pytest.raises(bik.InvalidInputError, match="mass"):
        tracker.robot = PANDA.with_payload(-1.0)
    assert tracker.robot == PANDA
    path = bik.paths.from_samples([0.0, 1.0], np.tile(PANDA.fk(READY)[:3, 3], (2, 1)))
    with pytest.raises(bik.InvalidInputError, match=r"ease.* does not keep torque limits"):
        bik.track(PANDA, path, READY, dt=0.01, limits=rated, ease=True)
