"""The door for LeRobot: its calls, in degrees, and streams of poses. Only its signatures need LeRobot itself."""

import ast
import copy
import importlib.util
import inspect
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hobby_arm import HOBBY_ARM, MOTORS

import beetle_ik as bik
from beetle_ik.interop.lerobot import PoseTracker, RobotKinematics

ARM = bik.Robot.from_urdf(HOBBY_ARM, tip="gripper_frame_link")
HOME = np.array([0.0, -30.0, 40.0, 30.0, 0.0, 55.0])
FAR = bik.pose([2.0, 0.5, 0.5])


def hobby() -> RobotKinematics:
    return RobotKinematics(HOBBY_ARM, joint_names=MOTORS)


def draw(rng: np.random.Generator, count: int) -> np.ndarray:
    """Joint positions (count, 6) in degrees: reals, round numbers, zeros and values at the limits."""
    lower, upper = np.rad2deg(ARM.lower), np.rad2deg(ARM.upper)
    q = rng.uniform(lower, upper, (count, 5))
    q = np.where(rng.random(q.shape) < 0.25, np.clip(15.0 * np.round(q / 15.0), lower, upper), q)
    q = np.where(rng.random(q.shape) < 0.1, rng.choice([lower, upper]), q)
    return np.column_stack((q, rng.uniform(0.0, 100.0, count)))


def turned(target: np.ndarray, *rotvec: float) -> np.ndarray:
    pose = target.copy()
    pose[:3, :3] = bik.pose([0, 0, 0], rotvec=rotvec)[:3, :3] @ target[:3, :3]
    return pose


def angle(one: np.ndarray, other: np.ndarray) -> float:
    scipy = pytest.importorskip("scipy.spatial.transform", reason="scipy is not installed")
    return float(scipy.Rotation.from_matrix(one[:3, :3].T @ other[:3, :3]).magnitude())


def hand_stream(count: int, dt: float) -> list[np.ndarray]:
    """Poses of a hand that swings and turns, all of whose places the arm reaches."""
    start, t = hobby().forward_kinematics(HOME), dt * np.arange(count)
    swing = np.column_stack((0.05 * np.sin(0.9 * t), 0.12 * np.sin(0.7 * t), 0.06 * np.sin(1.3 * t)))
    turn = np.column_stack((0.3 * np.sin(0.5 * t), 0.2 * np.sin(0.8 * t), 0.2 * np.sin(0.6 * t)))
    poses = [turned(start, *rotvec) for rotvec in turn]
    for pose, shift in zip(poses, swing, strict=True):
        pose[:3, 3] += shift
    return poses


def test_forward_kinematics_is_that_of_the_arm_in_degrees() -> None:
    for q in draw(np.random.default_rng(1), 50):
        np.testing.assert_allclose(hobby().forward_kinematics(q), ARM.fk(np.deg2rad(q[:5])), rtol=0, atol=1e-15)


def test_names_may_come_in_any_order() -> None:
    shuffled = [MOTORS[i] for i in (5, 3, 0, 4, 1, 2)]
    kinematics = RobotKinematics(HOBBY_ARM, joint_names=shuffled)
    q = draw(np.random.default_rng(2), 1)[0]
    mixed = np.array([q[MOTORS.index(name)] for name in shuffled])
    target = hobby().forward_kinematics(q)
    np.testing.assert_array_equal(kinematics.forward_kinematics(mixed), target)
    found = kinematics.inverse_kinematics(np.zeros(6), target)
    np.testing.assert_allclose(kinematics.forward_kinematics(found), target, rtol=0, atol=2e-6)
    limits = kinematics.tracker(mixed, dt=0.02, velocity=[40, 10, 50, 20, 30]).tracker.limits
    np.testing.assert_allclose(np.rad2deg(limits.velocity), [10, 20, 30, 40, 50])


def test_without_names_the_arm_comes_first() -> None:
    assert RobotKinematics(HOBBY_ARM).joint_names == MOTORS


def test_every_pose_of_the_arm_is_reached_from_anywhere() -> None:
    kinematics = hobby()
    starts = draw(np.random.default_rng(3), 300)
    for start, goal in zip(starts, starts[::-1], strict=True):
        target = kinematics.forward_kinematics(goal)
        found = kinematics.inverse_kinematics(start, target)
        assert kinematics.result.success, kinematics.result.message
        np.testing.assert_allclose(kinematics.forward_kinematics(found), target, rtol=0, atol=3e-6)
        assert np.all((np.rad2deg(ARM.lower) <= found[:5] + 1e-9) & (found[:5] <= np.rad2deg(ARM.upper) + 1e-9))


def test_the_gripper_and_what_follows_pass_through() -> None:
    current = np.array([*HOME[:5], 61.5, 7.0, np.nan])
    target = hobby().forward_kinematics([10, -20, 30, 20, 5, 0])
    np.testing.assert_array_equal(hobby().inverse_kinematics(current, target)[5:], current[5:])
    assert hobby().inverse_kinematics(current.astype(np.float32), target).dtype == np.float64


def test_the_place_is_met_where_the_turn_cannot_be() -> None:
    kinematics, rng = hobby(), np.random.default_rng(4)
    for q in draw(rng, 100):
        target = turned(kinematics.forward_kinematics(q), *rng.normal(scale=0.15, size=3))
        found = kinematics.inverse_kinematics(q, target)
        assert np.linalg.norm(kinematics.forward_kinematics(found)[:3, 3] - target[:3, 3]) < 1e-6
        assert kinematics.result.status in (bik.Status.ROTATION_GIVEN_UP, bik.Status.SOLVED)


@pytest.mark.parametrize("weights", [(1.0, 1.0), (1.0, 0.5), (0.2, 1.0)])
def test_weights_between_are_those_of_a_least_sum(weights: tuple[float, float]) -> None:
    optimize = pytest.importorskip("scipy.optimize", reason="scipy is not installed")
    rotation = pytest.importorskip("scipy.spatial.transform", reason="scipy is not installed").Rotation
    kinematics, q = hobby(), np.array([10.0, -20.0, 30.0, 25.0, 5.0, 0.0])
    target = turned(kinematics.forward_kinematics(q), 0.1, 0.05, 0.2)

    def errors(radians: np.ndarray) -> np.ndarray:
        here = ARM.fk(radians)
        turn = rotation.from_matrix(here[:3, :3].T @ target[:3, :3]).as_rotvec()
        return np.sqrt(np.repeat(weights, 3)) * np.concatenate((here[:3, 3] - target[:3, 3], turn))

    least = optimize.least_squares(errors, np.deg2rad(q[:5]), bounds=(ARM.lower, ARM.upper), xtol=1e-14, ftol=1e-14)
    found = kinematics.inverse_kinematics(q, target, *weights)
    assert np.sum(errors(np.deg2rad(found[:5])) ** 2) <= 2.0 * least.cost + 1e-9


def test_a_weight_of_zero_leaves_its_part_free() -> None:
    kinematics, target = hobby(), turned(hobby().forward_kinematics(HOME), 0.3, 0.2, 0.1)
    found = kinematics.inverse_kinematics(HOME, target, 0.0, 1.0)
    assert angle(kinematics.forward_kinematics(found), target) < 1e-6
    kinematics.inverse_kinematics(HOME, target, orientation_weight=0.0)
    assert kinematics.result.success
    assert np.isnan(kinematics.result.rotation_error)
    kinematics.inverse_kinematics(HOME, target, 0.01, 1.0)
    assert kinematics.result.status == bik.Status.POSITION_GIVEN_UP


def test_out_of_reach_the_nearest_is_returned_and_said() -> None:
    kinematics = hobby()
    nearest = np.linalg.norm(ARM.fk(bik.solve(ARM, FAR[:3, 3]).q)[:3, 3] - FAR[:3, 3])
    found = kinematics.inverse_kinematics(HOME, FAR)
    assert np.linalg.norm(kinematics.forward_kinematics(found)[:3, 3] - FAR[:3, 3]) < nearest + 2e-3
    assert not kinematics.result.success
    assert kinematics.result.message.startswith("out of reach, the nearest found is 1.")


def test_a_reading_outside_the_limits_is_led_inside() -> None:
    current = np.array([140.0, -130.0, 0.0, 0.0, 0.0, 0.0])
    found = hobby().inverse_kinematics(current, hobby().forward_kinematics(HOME))
    np.testing.assert_allclose(found[:5], HOME[:5], atol=1e-4)


def test_a_stream_of_calls_makes_no_jump() -> None:
    kinematics, q = hobby(), HOME
    for target in hand_stream(500, 0.02):
        found = kinematics.inverse_kinematics(q, target)
        assert np.abs(found - q).max() < 3.0
        assert np.linalg.norm(kinematics.forward_kinematics(found)[:3, 3] - target[:3, 3]) < 1e-6
        q = found


# --- the tracker --------------------------------------------------------------------------------


def assert_within(commands: np.ndarray, dt: float, velocity: float, acceleration: float) -> None:
    speeds = np.diff(commands[:, :5], axis=0, prepend=commands[:1, :5]) / dt
    assert np.abs(speeds).max() <= velocity * (1 + 1e-9)
    assert np.abs(np.diff(speeds, axis=0, prepend=0.0)).max() / dt <= acceleration * (1 + 1e-6)


@pytest.mark.parametrize("rate", [30, 50, 100])
@pytest.mark.parametrize("seed", range(3))
def test_a_broken_stream_keeps_all_limits(rate: int, seed: int) -> None:
    rng, dt = np.random.default_rng(seed), 1.0 / rate
    tracker = hobby().tracker(HOME, dt=dt, velocity=90, acceleration=300)
    commands = [HOME]
    for pose in hand_stream(8 * rate, dt):
        draw = rng.random()  # a lost pose, one far away, or the right one
        target = None if draw < 0.3 else FAR if draw < 0.32 else pose
        commands.append(tracker.step(target, gripper(commands)))
    tracker.stop()
    commands += [tracker.step(None) for _ in range(2 * rate)]
    assert_within(np.array(commands), dt, 90, 300)
    np.testing.assert_array_equal(commands[-1], commands[-2])
    assert np.all(np.array(commands)[:, 5] == HOME[5])


def gripper(commands: list[np.ndarray]) -> np.ndarray:
    return np.array([0, 0, 0, 0, 0, commands[-1][5]])


def test_a_tracker_follows_the_place_without_lag() -> None:
    kinematics, dt = hobby(), 0.02
    tracker = kinematics.tracker(HOME, dt=dt)
    far = []
    for pose in hand_stream(500, dt):
        place = kinematics.forward_kinematics(tracker.step(pose))[:3, 3]
        far.append(np.linalg.norm(place - pose[:3, 3]))
    assert max(far[50:]) < 2e-3
    assert tracker.time == pytest.approx(10.0)


def test_a_refused_pose_leaves_the_tracker_unchanged() -> None:
    tracker, target = hobby().tracker(HOME, dt=0.02), hand_stream(10, 0.02)[-1]
    tracker.step(target, [*HOME[:5], 12.0])
    with pytest.raises(bik.InvalidInputError):
        tracker.step(np.full((4, 4), np.nan))
    assert tracker.time == pytest.approx(0.02)
    assert tracker.step(None)[5] == 12.0
    tracker.reset(HOME)
    assert tracker.time == 0.0
    np.testing.assert_allclose(tracker.step(None), HOME)


# --- what is refused ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: RobotKinematics(HOBBY_ARM, "gripper_frame"),
            bik.UnknownNameError,
            "robot 'hobby' has no link 'gripper_frame' (did you mean 'gripper_frame_link'?); its links: base, "
            "shoulder, upper, fore, wrist, hand, jaw, gripper_frame_link",
        ),
        (
            lambda: RobotKinematics(HOBBY_ARM, joint_names=[*MOTORS, "wrist_yaw"]),
            bik.UnknownNameError,
            "joint_names: no joint 'wrist_yaw' in the robot; joints: shoulder_pan, shoulder_lift, elbow_flex, "
            "wrist_flex, wrist_roll, gripper",
        ),
        (
            lambda: RobotKinematics(HOBBY_ARM, joint_names=MOTORS[:4]),
            bik.InvalidInputError,
            "joint_names: joint 'wrist_roll' is missing, and moves the frame 'gripper_frame_link'",
        ),
        (
            lambda: RobotKinematics(HOBBY_ARM, joint_names=[*MOTORS, "gripper"]),
            bik.InvalidInputError,
            "joint_names: 'gripper' is there twice",
        ),
        (
            lambda: hobby().forward_kinematics(HOME[:5]),
            bik.InvalidInputError,
            "joint_pos_deg: expected at least 6 entries, one per joint name, got shape (5,)",
        ),
        (
            lambda: hobby().forward_kinematics("home"),
            bik.InvalidInputError,
            "joint_pos_deg must be an array of numbers, got 'home'",
        ),
        (
            lambda: hobby().inverse_kinematics([0, np.nan, 0, 0, 0, 0], FAR),
            bik.InvalidInputError,
            "current_joint_pos: joint 'shoulder_lift' must be finite, got nan",
        ),
        (
            lambda: hobby().inverse_kinematics(HOME, FAR, -1.0),
            bik.InvalidInputError,
            "position_weight must be a number, zero or more, got -1.0",
        ),
        (
            lambda: hobby().inverse_kinematics(HOME, FAR, 0, 0),
            bik.InvalidInputError,
            "position_weight and orientation_weight are both 0: nothing is left to reach",
        ),
        (
            lambda: hobby().tracker(HOME, dt=0.02, velocity=[1, 2]),
            bik.InvalidInputError,
            "velocity: expected a number or 5, one per joint that moves the frame, got shape (2,)",
        ),
    ],
)
def test_wrong_calls_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    with pytest.raises(error) as caught:
        call()
    assert str(caught.value) == message


def test_the_calls_are_those_of_lerobot() -> None:
    found = importlib.util.find_spec("lerobot")
    if found is None or not found.submodule_search_locations:
        pytest.skip("lerobot is not installed")
    # Read, not imported: that would load torch.
    text = (Path(found.submodule_search_locations[0]) / "model" / "kinematics.py").read_text(encoding="utf-8")
    theirs = next(
        node for node in ast.parse(text).body if isinstance(node, ast.ClassDef) and node.name == "RobotKinematics"
    )
    calls = [node for node in theirs.body if isinstance(node, ast.FunctionDef)]
    assert {call.name for call in calls} == {"__init__", "forward_kinematics", "inverse_kinematics"}
    for call in calls:
        ours = inspect.signature(getattr(RobotKinematics, call.name)).parameters
        assert list(ours) == [argument.arg for argument in call.args.args]
        defaults = [value.default for value in ours.values() if value.default is not inspect.Parameter.empty]
        assert defaults == [ast.literal_eval(value) for value in call.args.defaults]


def test_the_tracker_is_made_by_the_kinematics() -> None:
    assert isinstance(hobby().tracker(HOME, dt=0.02), PoseTracker)


# --- entries ------------------------------------------------------------------------------------


def test_entries_of_any_kind_are_read_alike() -> None:
    kinematics, target = hobby(), hobby().forward_kinematics([10, -20, 30, 20, 5, 0])
    expected = kinematics.inverse_kinematics(HOME, target)
    spaced = np.repeat(HOME, 2)[::2]
    for given in (HOME.tolist(), HOME.astype(np.float32), HOME.astype(int), spaced):
        np.testing.assert_array_equal(kinematics.inverse_kinematics(given, target), expected)
    np.testing.assert_array_equal(HOME, [0.0, -30.0, 40.0, 30.0, 0.0, 55.0])
    expected[0] = 1.0  # the caller's own


def test_a_copy_of_the_kinematics_is_independent_of_the_first() -> None:
    first = hobby()
    entries = copy.deepcopy(first._entries)
    np.testing.assert_array_equal(entries.q("q", HOME), first._entries.q("q", HOME))


@pytest.mark.parametrize("target", [np.eye(3), [0.2, 0.0, 0.1], np.full((4, 4), np.nan), 2.0 * np.eye(4)])
def test_what_is_no_pose_is_refused(target: object) -> None:
    with pytest.raises(bik.InvalidInputError, match="target"):
        hobby().inverse_kinematics(HOME, target)
