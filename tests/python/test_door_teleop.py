"""Arms led by twists, and by the poses of the package teleop where it is installed."""

from collections import deque
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

import beetle_ik as bik
from beetle_ik.interop.teleop import TwistTracker

UR5E, PANDA = bik.Robot.named("ur5e"), bik.Robot.named("panda")
START = np.array([0.0, -1.5, 1.5, -1.5, -1.5, 0.0])
GENTLE = bik.Limits(velocity=1.0, acceleration=5.0, jerk=100.0)
DT = 0.01
REST = np.zeros(6)


def led(robot: bik.Robot, start: np.ndarray, twists: list[object], **options: object) -> np.ndarray:
    """Commands (k, n), the start first."""
    jog = TwistTracker(robot, start, dt=DT, **{"limits": GENTLE, **options})
    return np.array([start, *(jog.step(twist).q for twist in twists)])


def assert_within(q: np.ndarray, limits: bik.Limits = GENTLE) -> None:
    qd = np.diff(q, axis=0) / DT
    qdd = np.diff(qd, axis=0, prepend=0.0) / DT
    assert np.abs(qd).max() <= limits.velocity * (1 + 1e-9)
    assert np.abs(qdd).max() <= limits.acceleration * (1 + 1e-6)


@pytest.mark.parametrize("frame", ["base", "tip"])
def test_the_tip_moves_with_the_twist(frame: str) -> None:
    rotation = pytest.importorskip("scipy.spatial.transform", reason="scipy is not installed").Rotation
    twist = np.array([0.1, 0.05, -0.05, 0.1, -0.1, 0.2])
    poses = UR5E.fk(led(UR5E, START, [twist] * 200, frame=frame))
    for one, other in pairwise(poses[100:]):
        speed, turn = (
            (other[:3, 3] - one[:3, 3]) / DT,
            rotation.from_matrix(other[:3, :3] @ one[:3, :3].T).as_rotvec() / DT,
        )
        axes = np.eye(3) if frame == "base" else one[:3, :3]
        np.testing.assert_allclose(speed, axes @ twist[:3], atol=2e-3)
        np.testing.assert_allclose(turn, axes @ twist[3:], atol=2e-3)


def test_the_reference_does_not_run_away() -> None:
    out, back = [0.2, 0, 0, 0, 0, 0], [-0.2, 0, 0, 0, 0, 0]
    q = led(UR5E, START, [out] * 1500 + [back] * 100)
    assert_within(q)
    x = UR5E.fk(q)[:, 0, 3]
    poses = UR5E.fk(q)
    assert np.ptp(x[1200:1500]) < 1e-3  # stretched out
    assert x[1520] < x[1500] - 5e-3
    assert x[1600] < x[1500] - 0.05
    chord = np.linalg.norm(poses[:, :3, :3] - poses[0, :3, :3], axis=(1, 2)) / np.sqrt(8)
    assert 2 * np.arcsin(chord.max()) < 0.25  # the orientation is not given up


@pytest.mark.parametrize("twist", [REST, None], ids=["zero", "silence"])
def test_an_arm_that_is_not_led_stops_and_stays(twist: np.ndarray | None) -> None:
    q = led(UR5E, START, [[0.2, 0.1, 0, 0, 0, 0.3]] * 150 + [twist] * 100)
    assert_within(q)
    x = UR5E.fk(q)[150:, 0, 3]
    assert np.all(np.diff(x) >= -1e-9)  # no way back
    np.testing.assert_array_equal(q[-1], q[-40])
    assert x[-1] - x[0] < (0.03 if twist is not None else 0.08)


def test_a_singular_wrist_is_passed_smoothly() -> None:
    start = np.array([0, -1.2, 1.6, -0.4, 0.4, 0.3])
    q = led(UR5E, start, [[0, 0, 0, 0, 0, 0.3]] * 600)
    assert_within(q)
    assert q[0, 4] > 0.3
    assert q[-1, 4] < -0.3
    place = UR5E.fk(q)[:, :3, 3]
    assert np.linalg.norm(place - place[0], axis=1).max() < 5e-3


@pytest.mark.parametrize("seed", range(8))
def test_wild_twists_keep_all_limits(seed: int) -> None:
    rng = np.random.default_rng(seed)
    robot = (UR5E, PANDA)[seed % 2]
    limits = bik.Limits(velocity=1.0, acceleration=float(rng.choice([2.0, 5.0, 20.0])))
    twists: list[object] = []
    while len(twists) < 600:
        size = rng.choice([0.0, 0.05, 0.5, 3.0])
        twist = size * np.where(rng.random(6) < 0.5, rng.normal(size=6), 0.0)
        twists += [twist if rng.random() < 0.9 else None] * int(rng.integers(1, 120))
    start = robot.clip(robot.random_configurations(1, seed=seed)[0])
    q = led(robot, start, [*twists, *([None] * 300)], limits=limits, frame=["base", "tip"][seed % 2])
    assert_within(q, limits)
    assert np.all((robot.lower - 1e-9 <= q) & (q <= robot.upper + 1e-9))
    np.testing.assert_array_equal(q[-1], q[-2])


def test_obstacles_hold_an_arm_that_is_led_into_them() -> None:
    arm = UR5E.with_capsules(radius=0.05)
    here = UR5E.fk(START)[:3, 3]
    crate = bik.obstacles.Box(here - [0, 0, 0.3], (0.3, 0.3, 0.2))
    jog = TwistTracker(arm, START, dt=DT, limits=bik.Limits(velocity=1.0, acceleration=5.0), obstacles=[crate])
    clear = [jog.step([0, 0, -0.2, 0, 0, 0]).clearance for _ in range(400)]
    assert min(clear) >= 1e-3 - 1e-9
    assert np.linalg.norm(jog.reference[:3, 3] - arm.fk(jog.tracker.q)[:3, 3]) < 0.07


def test_a_wrong_twist_changes_nothing() -> None:
    jog = TwistTracker(UR5E, START, dt=DT, limits=GENTLE)
    jog.step([0.1, 0, 0, 0, 0, 0])
    before = jog.tracker.q, jog.tracker.time, jog.reference
    with pytest.raises(bik.InvalidInputError):
        jog.step([np.nan] * 6)
    np.testing.assert_array_equal(jog.tracker.q, before[0])
    assert jog.tracker.time == before[1]
    np.testing.assert_array_equal(jog.reference, before[2])
    assert jog.stop() >= 0.0
    jog.reset(START)
    np.testing.assert_allclose(jog.reference, UR5E.fk(START))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: TwistTracker(UR5E, START, dt=DT, frame="hand"), "frame must be 'base' or 'tip', got 'hand'"),
        (lambda: TwistTracker(UR5E, START, dt=DT, timeout=0), "timeout must be positive (s), got 0"),
        (
            lambda: TwistTracker(UR5E, START, dt=DT).step([0.1, 0, 0]),
            "twist: expected 6 numbers (m/s, rad/s), got shape (3,)",
        ),
        (lambda: TwistTracker(UR5E, START, dt=DT).step("up"), "twist must be an array of numbers, got 'up'"),
        (
            lambda: TwistTracker(UR5E, START, dt=DT).step([np.inf, 0, 0, 0, 0, 0]),
            "twist must be finite, got [inf  0.  0.  0.  0.  0.]",
        ),
    ],
)
def test_wrong_calls_are_named(call: Callable[[], object], message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        call()
    assert str(caught.value) == message


def test_a_phone_leads_the_arm_through_teleop() -> None:
    teleop = pytest.importorskip("teleop", reason="the package teleop is not installed")
    phone, inbox = teleop.Teleop(), deque[np.ndarray](maxlen=1)
    home = UR5E.fk(START)
    phone.set_pose(home)
    phone.subscribe(lambda pose, _: inbox.append(pose))
    tracker = bik.Tracker(UR5E, START, dt=DT, limits=GENTLE)
    for tick in range(400):
        if tick % 2 == 0:  # 50 messages a second, as a page of WebXR sends them: right, up, back
            shift = 0.1 * np.sin(0.01 * tick)
            message = {
                "move": True,
                "position": {"x": shift, "y": 0.0, "z": 0.0},
                "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
            }
            phone._Teleop__update(message)
        step = tracker.step(inbox.pop() if inbox else None)
    assert step.inside_limits
    moved = UR5E.fk(step.q)[:3, 3] - home[:3, 3]
    np.testing.assert_allclose(moved, [0.0, -0.1 * np.sin(0.01 * 398), 0.0], atol=2e-3)  # right is -y
