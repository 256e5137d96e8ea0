"""Motions of a human's points for a robot of other measures."""

from collections.abc import Callable

import numpy as np
import pytest
from four_fingers import FINGERS, FOUR_FINGERS, TIPS

import beetle_ik as bik
from beetle_ik.interop.retarget import Retargeter

HAND = bik.Robot.from_urdf(FOUR_FINGERS, tip=TIPS)
POINTS = dict(zip(FINGERS, TIPS, strict=True))
BENT = np.tile([0.0, 0.4, 0.5, 0.4], 4)
LIMITS = bik.Limits(lower=np.tile([-0.5, 0.0, 0.05, 0.05], 4), velocity=8.0, acceleration=100.0)
DT = 1e-3
TURN = bik.pose([0.3, -0.2, 0.1], rotvec=[0.4, -1.0, 0.7])


def hand(**options: object) -> Retargeter:
    return Retargeter(HAND, BENT, POINTS, dt=DT, **{"limits": LIMITS, **options})


def places(q: np.ndarray) -> np.ndarray:
    return HAND.fk(q)[..., :3, 3]


def human(q: np.ndarray, scale: float = 1.25, turn: np.ndarray = TURN) -> dict[str, np.ndarray]:
    """Points of a human whose hand is the robot's, larger and in another frame."""
    points = scale * places(q) @ turn[:3, :3].T + turn[:3, 3]
    return dict(zip(FINGERS, np.moveaxis(points, -2, 0), strict=True))


def grasp(t: float) -> np.ndarray:
    """Fingers that close and spread, in turn."""
    return BENT + 0.35 * np.sin(2.0 * t + np.repeat(np.arange(4), 4) * 0.6) * np.tile([0.4, 1.0, 0.6, 0.5], 4)


def test_scale_and_frame_are_found_again() -> None:
    led = hand()
    assert led.fit(human(BENT), BENT) < 1e-12
    assert led.scale == pytest.approx(1 / 1.25)
    np.testing.assert_allclose(led.transform[:3, :3], TURN[:3, :3].T, atol=1e-12)
    for name, tip in POINTS.items():
        np.testing.assert_allclose(led.offsets[name], 0.0, atol=1e-12)
        np.testing.assert_allclose(led.targets(human(BENT))[tip], places(BENT)[TIPS.index(tip)], atol=1e-12)


def test_offsets_meet_the_posture_of_the_fit() -> None:
    led, rng = hand(), np.random.default_rng(1)
    other = {name: point + rng.normal(scale=0.01, size=3) for name, point in human(BENT).items()}
    assert led.fit(other, BENT, offsets=False) > 1e-3
    assert led.fit(other, BENT) < 1e-12
    for name, tip in POINTS.items():
        np.testing.assert_allclose(led.targets(other)[tip], places(BENT)[TIPS.index(tip)], atol=1e-12)
        assert np.linalg.norm(led.offsets[name]) > 1e-4


def test_several_postures_are_fitted_by_least_squares() -> None:
    optimize = pytest.importorskip("scipy.optimize", reason="scipy is not installed")
    led, rng = hand(), np.random.default_rng(2)
    q = np.array([grasp(t) for t in np.linspace(0, 3, 7)])
    noisy = {name: points + rng.normal(scale=3e-3, size=points.shape) for name, points in human(q).items()}
    rms = led.fit(noisy, q, offsets=False)
    theirs, ours = np.stack(list(noisy.values()), axis=1).reshape(-1, 3), places(q).reshape(-1, 3)

    def apart(x: np.ndarray) -> np.ndarray:
        return (ours - (x[0] * theirs @ bik.pose([0, 0, 0], rotvec=x[1:4])[:3, :3].T + x[4:])).ravel()

    begin = np.array([0.8, -0.4, 1.0, -0.7, 0.0, 0.0, 0.0])
    best = optimize.least_squares(apart, begin, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    assert led.scale == pytest.approx(best.x[0], rel=1e-6)
    assert rms == pytest.approx(np.sqrt(2 * best.cost / len(ours)), rel=1e-6)


def test_given_scale_and_rotation_are_kept() -> None:
    led = hand()
    led.fit(human(BENT), BENT, scale=0.7, rotation=TURN[:3, :3].T)
    assert led.scale == 0.7
    np.testing.assert_allclose(led.transform[:3, :3], TURN[:3, :3].T, atol=1e-12)
    np.testing.assert_allclose(led.targets(human(BENT))["thumb_tip"], places(BENT)[3], atol=1e-12)


def test_a_motion_of_the_human_is_followed_at_1_khz() -> None:
    led = hand()
    led.fit(human(BENT), BENT)
    q, errors = [BENT], []
    for k in range(1500):
        step = led.step(human(grasp(DT * k)))
        q.append(step.q)
        errors.append(step.position_error)
    assert max(errors[300:]) < 1e-4
    qd = np.diff(q, axis=0) / DT
    assert np.abs(qd).max() <= 8.0 * (1 + 1e-9)
    assert np.abs(np.diff(qd, axis=0)).max() / DT <= 100.0 * (1 + 1e-6)


def test_a_hand_that_moves_about_is_taken_in_its_own_frame() -> None:
    led = hand()
    led.fit(human(BENT), BENT)
    wrist = bik.pose([1.0, 2.0, 3.0], rotvec=[0.1, 0.2, 0.3])
    moved = {name: wrist[:3, :3] @ point + wrist[:3, 3] for name, point in human(grasp(0.3)).items()}
    for tip, target in led.targets(moved, frame=wrist).items():
        np.testing.assert_allclose(target, places(grasp(0.3))[TIPS.index(tip)], atol=1e-12)


def test_hidden_points_leave_their_tips_free() -> None:
    led = hand()
    led.fit(human(BENT), BENT)
    seen = human(grasp(0.4))
    seen["ring"] = np.full(3, np.nan)
    del seen["middle"]
    assert sorted(led.targets(seen)) == ["index_tip", "thumb_tip"]
    for _ in range(600):
        step = led.step(seen)
    assert sorted(step.errors) == ["index_tip", "thumb_tip"]
    assert step.success
    for _ in range(300):
        step = led.step(None)
    assert np.abs(step.qd).max() < 1e-6


def contested(**options: object) -> dict[str, float]:
    """Errors by point after two hands on one waist have been drawn forward, farther than both reach."""
    links = [("waist", "base", "chest", "0 0 0", "0 0 1"), ("left", "chest", "l", "0 0.4 0", "0 0 1")]
    links += [("right", "chest", "r", "0 -0.4 0", "0 0 1")]
    text = "".join(
        f"<link name='{child}'/><joint name='{name}' type='revolute'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='{xyz}'/><axis xyz='{axis}'/><limit lower='-1.5' upper='1.5' velocity='5'/></joint>"
        for name, parent, child, xyz, axis in links
    )
    ends = "".join(
        f"<link name='{side}_hand'/><joint name='{side}_end' type='fixed'><parent link='{side}'/>"
        f"<child link='{side}_hand'/><origin xyz='0.3 0 0'/></joint>"
        for side in "lr"
    )
    robot = bik.Robot.from_urdf(
        f"<robot name='torso'><link name='base'/>{text}{ends}</robot>", tip=["l_hand", "r_hand"]
    )
    led = Retargeter(robot, np.zeros(3), {"left": "l_hand", "right": "r_hand"}, dt=0.01, **options)
    for _ in range(400):
        step = led.step({"left": [0.9, 0.4, 0.0], "right": [0.9, -0.4, 0.0]})
    return {name: step.errors[f"{name[0]}_hand"][0] for name in ("left", "right")}


def test_weights_say_which_point_gives_way() -> None:
    even = contested()
    left, right = contested(weights={"left": 100.0}), contested(weights={"right": 100.0})
    assert left["left"] < even["left"] - 1e-3
    assert right["right"] < even["right"] - 1e-3
    assert left["right"] > even["right"]


def test_levels_come_before_weights() -> None:
    first = contested(levels={"right": 1})
    second = contested(levels={"left": 1}, weights={"left": 100.0})
    assert first["left"] < contested(weights={"left": 100.0})["left"] + 1e-6
    assert second["right"] < contested(weights={"right": 100.0})["right"] + 1e-6


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: Retargeter(HAND, BENT, {}, dt=DT),
            bik.InvalidInputError,
            "points: at least one is needed, got none",
        ),
        (
            lambda: Retargeter(HAND, BENT, {"index": "finger"}, dt=DT),
            bik.UnknownNameError,
            "points: no tip 'finger'; tips: index_tip, middle_tip, ring_tip, thumb_tip",
        ),
        (
            lambda: Retargeter(HAND, BENT, {"a": "thumb_tip", "b": "thumb_tip"}, dt=DT),
            bik.InvalidInputError,
            "points: two points lead the tip 'thumb_tip'",
        ),
        (
            lambda: hand(weights={"little": 1.0}),
            bik.UnknownNameError,
            "weights: no point 'little' is led; points: index, middle, ring, thumb",
        ),
        (
            lambda: hand(weights={"ring": 0.0}),
            bik.InvalidInputError,
            "weights: the weight of 'ring' must be positive, got 0",
        ),
        (
            lambda: hand().fit({"index": [0, 0, 0]}, BENT),
            bik.InvalidInputError,
            "human: points are missing: middle, ring, thumb",
        ),
        (
            lambda: hand().fit({name: np.zeros((2, 3)) for name in FINGERS}, BENT),
            bik.InvalidInputError,
            "human: expected (3,) or (1, 3) for each point, as many as configurations, got shape (2, 3)",
        ),
        (
            lambda: hand().fit({name: [0.1 * i, 0, 0] for i, name in enumerate(FINGERS)}, BENT),
            bik.InvalidInputError,
            "human: the points are on a line, from which no rotation can be found: give rotation=",
        ),
        (
            lambda: hand().fit(dict.fromkeys(FINGERS, (0.1, 0, 0)), BENT, rotation=np.eye(3)),
            bik.InvalidInputError,
            "human: all points are one, from which no scale can be found: give scale=",
        ),
        (
            lambda: hand().fit(human(BENT), BENT, scale=0.0),
            bik.InvalidInputError,
            "scale must be positive, got 0.0",
        ),
        (
            lambda: hand().fit(human(BENT), BENT, rotation=-TURN[:3, :3].T @ np.diag([1, -1, 1])),
            bik.InvalidInputError,
            "human: the points do not resemble those of the robot: give scale= and rotation=",
        ),
        (
            lambda: hand().fit(dict.fromkeys(FINGERS, (np.nan, 0, 0)), BENT),
            bik.InvalidInputError,
            "human: positions must be finite",
        ),
        (
            lambda: hand().step({"little": [0, 0, 0]}),
            bik.UnknownNameError,
            "no point 'little' is led; points: index, middle, ring, thumb",
        ),
        (
            lambda: hand().step({"ring": [0, 0]}),
            bik.InvalidInputError,
            "human: expected (3,) for point 'ring', got shape (2,)",
        ),
    ],
)
def test_wrong_calls_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    with pytest.raises(error) as caught:
        call()
    assert str(caught.value) == message
