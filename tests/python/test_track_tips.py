"""Tracking with several tips: a tray in both hands, targets by name, results, and refused arguments."""

import pickle
from collections.abc import Callable

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik

TIPS = ["left_tool", "right_tool"]
HANDS = ("left_tool", "right_tool")
PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=TIPS)
LEFT = bik.Robot.from_urdf(pair_of_pandas(), tip="left_tool")
DOWN = np.diag([1.0, -1.0, -1.0])
TRAY = bik.pose((0.0, 0.5, 0.0))
SLOW = 0.4


def circle(center: tuple[float, float, float], diameter: float) -> bik.Path:
    path = bik.paths.circle(center=center, diameter=diameter, duration=10.0, a=(1, 0, 0), b=(0, 1, 0))
    return path.with_orientation(DOWN)


NEAR = circle((0.5, 0.25, 0.8), 0.2)
BEYOND = circle((0.75, 0.25, 0.9), 0.6)
START = bik.solve(PAIR, {"left_tool": NEAR.pose(0.0), HANDS: TRAY}, goals=bik.goals.Centring())
POST = bik.obstacles.Sphere(center=(0.55, 0.52, 0.8), radius=0.1)


def tray_error(q: np.ndarray) -> tuple[float, float]:
    """The largest errors of the pose of the right tool as seen from the left one, by forward kinematics alone."""
    left, right = PAIR.fk(q).swapaxes(0, 1)
    away = np.linalg.inv(TRAY) @ np.linalg.inv(left) @ right
    angle = np.arcsin(
        np.clip(np.linalg.norm(away[:, :3, :3] - away[:, :3, :3].swapaxes(1, 2), axis=(1, 2)) / 8**0.5, 0, 1)
    )
    return float(np.linalg.norm(away[:, :3, 3], axis=1).max()), float(angle.max())


TRAYS: dict[str, tuple[bik.Path, dict[str, object]]] = {
    "within reach": (NEAR, {}),
    "beyond reach": (BEYOND, {}),
    "slow joints": (NEAR, {"limits": bik.Limits(velocity=0.08)}),
    "one slow arm": (NEAR, {"limits": bik.Limits(velocity=[2.0] * 9 + [0.05] * 7)}),
    "acceleration": (NEAR, {"limits": bik.Limits(velocity=1.0, acceleration=2.0)}),
    "acceleration, beyond reach": (BEYOND, {"limits": bik.Limits(velocity=1.0, acceleration=2.0)}),
    "acceleration, one slow arm": (NEAR, {"limits": bik.Limits(velocity=[2.0] * 9 + [0.05] * 7, acceleration=1.0)}),
    "jerk": (NEAR, {"limits": bik.Limits(velocity=1.0, acceleration=2.0, jerk=20.0)}),
    "obstacle": (NEAR, {"obstacles": [POST]}),
    "obstacle and acceleration": (NEAR, {"obstacles": [POST], "limits": bik.Limits(velocity=1.0, acceleration=2.0)}),
}


@pytest.mark.parametrize("name", TRAYS)
def test_a_tray_stays_in_both_hands_whatever_else_gives_way(name: str) -> None:
    path, arguments = TRAYS[name]
    result = bik.track(PAIR, {"left_tool": path, HANDS: TRAY}, START.q, dt=0.02, **arguments)  # type: ignore[arg-type]
    # Where the path begins elsewhere, the hands go there with the tray.
    position, angle = tray_error(np.asarray(result.q))
    assert max(position, angle) < 1e-6, f"{position} {angle}, {result.message}"
    assert result.errors[HANDS][0].max() == pytest.approx(position, abs=1e-12)
    assert result.max_violation == 0.0
    if "obstacles" in arguments:
        assert result.clearance.min() >= 1e-3 - 1e-12
    if name == "within reach":
        assert (result.success, result.status) == (True, bik.Status.SOLVED), result.message
    if name == "beyond reach":
        assert result.position_error.max() > 0.01


def test_slow_joints_lag_and_come_back() -> None:
    """Both arms stop at the end of the path, with the tray, where the slow arm can get to in time."""
    limits = bik.Limits(velocity=0.3, acceleration=1.0)
    tracker = bik.Tracker(PAIR, START.q, dt=0.02, limits=limits)
    target = {"left_tool": NEAR.pose(5.0), HANDS: TRAY}
    places = []
    for _ in range(300):
        step = tracker.step(target)
        places.append(step.q)
    assert step.success, step.message
    assert max(tray_error(np.array(places))) < 1e-6


def test_stopping_keeps_the_tray_too() -> None:
    tracker = bik.Tracker(PAIR, START.q, dt=0.01, limits=bik.Limits(velocity=1.0, acceleration=2.0), timeout=0.1)
    places = []
    for i in range(150):
        step = tracker.step({"left_tool": NEAR.pose(0.01 * i), HANDS: TRAY} if i < 60 else None)
        places.append(step.q)
    assert max(tray_error(np.array(places))) < 1e-6
    assert np.abs(step.qd).max() < 1e-5
    assert np.abs(np.diff(places, axis=0)[40]).max() > 1e-4, "the arms were moving"
    assert tracker.stop() < 1e-6


def test_each_tip_follows_its_own_path() -> None:
    left, right = NEAR, circle((0.5, -0.25, 0.8), 0.15)
    result = bik.track(PAIR, {"left_tool": left, "right_tool": right}, dt=0.05)
    assert result.success, result.message
    assert list(result.errors) == TIPS
    poses = PAIR.fk(np.asarray(result.q))
    for i, (tip, path) in enumerate({"left_tool": left, "right_tool": right}.items()):
        times = np.asarray(result.time)
        np.testing.assert_allclose(result.positions[tip], poses[:, i, :3, 3], rtol=0, atol=1e-12)
        np.testing.assert_allclose(result.references[tip], path.position(times), rtol=0, atol=1e-12)
        position, rotation = result.errors[tip]
        away = np.linalg.norm(result.positions[tip] - result.references[tip], axis=1)
        np.testing.assert_allclose(position, away, rtol=0, atol=1e-12)
        assert rotation.max() <= 1e-6
    np.testing.assert_array_equal(result.position, result.positions["left_tool"])
    np.testing.assert_array_equal(
        result.position_error, np.maximum(result.errors["left_tool"][0], result.errors["right_tool"][0])
    )


def test_tips_left_out_are_free_and_may_come_and_go() -> None:
    tracker = bik.Tracker(PAIR, START.q, dt=0.05, task={"right_tool": bik.tasks.Position()})
    assert tracker.step({"left_tool": NEAR.pose(0.05)}).success
    right = PAIR.fk(START.q)[1]
    turned = right @ bik.pose((0.0, 0.0, 0.0), rpy=(0.3, 0.0, 0.0))
    step = tracker.step({"left_tool": NEAR.pose(0.1), "right_tool": turned})
    assert list(step.errors) == TIPS
    assert np.isnan(step.errors["right_tool"][1]), "its task is a position"
    assert tracker.step(None).errors.keys() == step.errors.keys()


def test_goals_act_beside_the_targets() -> None:
    def centred(q: np.ndarray) -> float:
        middle = 0.5 * (PAIR.lower + PAIR.upper)
        return float((((q - middle) / (PAIR.upper - PAIR.lower)) ** 2).sum())

    plain, led = (
        bik.track(PAIR, {"left_tool": NEAR}, START.q, dt=0.05, goals=goals)
        for goals in (None, bik.goals.Centring(weight=5.0))
    )
    assert plain.success
    assert led.success
    assert centred(led.q[-1]) < centred(plain.q[-1])


def test_one_tip_in_a_dict_is_the_same_as_plain() -> None:
    plain = bik.track(LEFT, NEAR, dt=0.05, task=bik.tasks.Position(), position_tolerance=1e-5)
    named = bik.track(
        LEFT,
        {"left_tool": NEAR},
        dt=0.05,
        task={"left_tool": bik.tasks.Position()},
        position_tolerance={"left_tool": 1e-5},
    )
    np.testing.assert_array_equal(plain.q, named.q)
    assert list(plain.errors) == list(named.errors) == ["left_tool"]
    np.testing.assert_array_equal(plain.errors["left_tool"][0], plain.position_error)
    np.testing.assert_array_equal(plain.positions["left_tool"], plain.position)
    one, other = (
        bik.Tracker(LEFT, plain.q[0], dt=0.05, task=task)
        for task in (bik.tasks.Position(), {"left_tool": bik.tasks.Position()})
    )
    steps = one.step(NEAR.pose(0.05)), other.step({"left_tool": NEAR.pose(0.05)})
    np.testing.assert_array_equal(steps[0].q, steps[1].q)
    assert steps[0].errors == {"left_tool": (steps[0].position_error, pytest.approx(np.nan, nan_ok=True))}


def test_one_tip_in_a_dict_plans_as_a_plain_end() -> None:
    q = LEFT.random_configurations(2, seed=1)
    end = LEFT.fk(q[1])
    limits = bik.Limits(velocity=1.0, acceleration=2.0)
    plain = bik.plan_point_to_point(LEFT, start_q=q[0], end=end, limits=limits, self_collision=False)
    named = bik.plan_point_to_point(LEFT, start_q=q[0], end={"left_tool": end}, limits=limits, self_collision=False)
    several = bik.plan_point_to_point(LEFT, start_q=q[0], end=[{"left_tool": end}], limits=limits, self_collision=False)
    assert plain.trajectory == named.trajectory == several.trajectory


def test_batches_of_plans_take_dicts() -> None:
    first, second = PAIR.random_configurations(2, seed=11)
    limits = bik.Limits(velocity=1.0, acceleration=2.0)
    end = dict(zip(TIPS, PAIR.fk(second), strict=True))
    problems = [{"start_q": first, "end": end}, {"start_q": first, "end": {"right_tool": PAIR.fk(second)[1]}}]
    batch = bik.plan_batch(PAIR, problems, limits=limits, self_collision=False, threads=2)
    assert batch.success.all(), batch.message
    for plan, problem in zip(batch, problems, strict=True):
        alone = bik.plan_point_to_point(PAIR, limits=limits, self_collision=False, **problem)  # type: ignore[arg-type]
        assert plan.trajectory == alone.trajectory
    with pytest.raises(bik.UnknownNameError, match=r"problems\[0\]: .* no tip 'left_tol'"):
        bik.plan_batch(PAIR, [{"start_q": first, "end": {"left_tol": np.eye(4)}}], limits=limits)


def test_results_are_pickled_with_their_tips_and_drawn() -> None:
    result = bik.track(PAIR, {"left_tool": NEAR, HANDS: TRAY}, START.q, dt=0.2)
    again = pickle.loads(pickle.dumps(result))
    for key in ("left_tool", HANDS):
        np.testing.assert_array_equal(again.errors[key], result.errors[key])
        np.testing.assert_array_equal(again.positions[key], result.positions[key])
    step = bik.Tracker(PAIR, START.q, dt=0.2).step({"left_tool": NEAR.pose(0.1), HANDS: TRAY})
    assert pickle.loads(pickle.dumps(step)).errors == step.errors
    labels = {line.get_label() for axes in result.plot().axes for line in axes.lines}
    assert {"left_tool", "target of left_tool", "right_tool seen from left_tool"} <= labels


REFUSED: dict[str, tuple[Callable[[], object], str]] = {
    "a path of one tip": (
        lambda: bik.track(PAIR, NEAR, dt=0.1),
        r"^path: robot 'pair_of_pandas' has several tips, .*: give a dict, such as \{'left_tool': path\}",
    ),
    "durations": (
        lambda: bik.track(
            PAIR,
            {"left_tool": NEAR, "right_tool": bik.paths.circle(duration=3.0, center=(0.5, -0.2, 0.8), diameter=0.1)},
            dt=0.1,
        ),
        r"^path: the paths have one time, got durations of 10 s and 3 s",
    ),
    "no path": (
        lambda: bik.track(PAIR, {"left_tool": np.eye(4)}, dt=0.1),
        r"^path: all targets are constant: give a Path for one tip at least",
    ),
    "no path at all": (
        lambda: bik.track(PAIR, {"left_tool": "circle"}, dt=0.1),
        r"^path of 'left_tool': expected a Path, or",
    ),
    "an empty dict": (lambda: bik.track(PAIR, {}, dt=0.1), r"^path: the dict is empty"),
    "ease": (lambda: bik.track(PAIR, {"left_tool": NEAR}, dt=0.1, ease=True), r"ease=True is for one tip"),
    "a region": (
        lambda: bik.track(PAIR, {"left_tool": NEAR}, dt=0.1, task=bik.tasks.Pose(region=([-9, -9, -9], [9, 9, 9]))),
        r"a tracked region is for one tip",
    ),
    "a task without a target": (
        lambda: bik.track(PAIR, {"left_tool": NEAR}, dt=0.1, task={"right_tool": bik.tasks.Position()}),
        r"^task names 'right_tool', which has no target",
    ),
    "a plain target": (
        lambda: bik.Tracker(PAIR, START.q, dt=0.1).step(np.eye(4)),
        r"^target: robot 'pair_of_pandas' has several",
    ),
    "an empty target": (lambda: bik.Tracker(PAIR, START.q, dt=0.1).step({}), r"^target: the dict is empty"),
    "not a number": (
        lambda: bik.Tracker(PAIR, START.q, dt=0.1).step({"left_tool": np.full(3, np.nan)}),
        r"target.* coordinate x",
    ),
    "a velocity": (
        lambda: bik.Tracker(PAIR, START.q, dt=0.1).step({"left_tool": np.eye(4)}, velocity=(0, 0, 0)),
        r"^velocity is for the target of one tip",
    ),
    "a stamp": (
        lambda: bik.Tracker(PAIR, START.q, dt=0.1).step({"left_tool": np.eye(4)}, stamp=0.0),
        r"a stamp is used by the library's own rule under acceleration or jerk limits",
    ),
    "a contradiction": (
        lambda: bik.Tracker(PAIR, START.q, dt=0.1).step({"left_tool": np.eye(4), "right_tool": np.eye(4), HANDS: TRAY}),
        r"the targets of 'left_tool' and 'right_tool' contradict that of",
    ),
    "the same pair twice": (
        lambda: bik.Tracker(PAIR, START.q, dt=0.1).step({HANDS: TRAY, HANDS[::-1]: TRAY}),
        r"the pair of tips .* has two targets",
    ),
    "a tip seen from itself": (
        lambda: bik.Tracker(PAIR, START.q, dt=0.1).step({("left_tool", "left_tool"): TRAY}),
        r"cannot be seen from itself",
    ),
    "a dict for self_motion": (
        lambda: bik.self_motion(PAIR, {"left_tool": NEAR.pose(0.0)}),  # type: ignore[arg-type]
        r"^self_motion takes robots with one tip; this one has left_tool and right_tool",
    ),
    "a dict for plan_along_path": (
        lambda: bik.plan_along_path(PAIR, {"left_tool": NEAR}),  # type: ignore[arg-type]
        r"^plan_along_path takes robots with one tip; this one has left_tool and right_tool",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_combined_is_refused(name: str) -> None:
    call, message = REFUSED[name]
    with pytest.raises(bik.InvalidInputError, match=message):
        call()


def test_wrong_targets_leave_the_tracker_as_it_was() -> None:
    tracker = bik.Tracker(PAIR, START.q, dt=0.1)
    tracker.step({"left_tool": NEAR.pose(0.1), HANDS: TRAY})
    q, time = tracker.q, tracker.time
    for wrong in ({"left_tol": np.eye(4)}, {"left_tool": np.full((4, 4), np.inf)}, {}, {1: np.eye(4)}, np.eye(4)):
        with pytest.raises((bik.InvalidInputError, bik.UnknownNameError)):
            tracker.step(wrong)  # type: ignore[arg-type]
    np.testing.assert_array_equal(tracker.q, q)
    assert tracker.time == time


def test_a_refused_step_is_as_if_it_had_not_been() -> None:
    def follow(refused: dict[object, object] | None, stamp: float | None = None) -> np.ndarray:
        tip_limits = bik.Limits(acceleration=5.0, tip_speed=0.3)
        tracker = bik.Tracker(PAIR, START.q, dt=0.02, limits=tip_limits)
        for k in range(20):
            tracker.step({"left_tool": NEAR.pose(0.02 * k)})
        if refused is not None:
            with pytest.raises(bik.InvalidInputError):
                tracker.step(refused, stamp=stamp)  # type: ignore[arg-type]
        return np.array([tracker.step(None).q for _ in range(20)])

    expected = follow(None)
    np.testing.assert_array_equal(follow({HANDS: TRAY}), expected)
    np.testing.assert_array_equal(follow({"right_tool": NEAR.pose(0.4)}, stamp=9.0), expected)
