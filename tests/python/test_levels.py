"""Levels of several tips: lower ones are met first, higher ones as far as these allow."""

from __future__ import annotations

import pickle
import re

import numpy as np
import pytest
from trees_of_tips import Array, Level, humanoid, nested, residual, two_arms

import beetle_ik as bik
from beetle_ik.tasks import Orientation, Pointing, Pose, Position

PAIR, BODY = two_arms(), humanoid()
GIVEN_UP = bik.Status.LEVEL_GIVEN_UP


def far(robot: bik.Robot, seed: int, by: float) -> dict[str, Array]:
    """Returns a target for each tip, each of a configuration of its own and moved by about `by` (m)."""
    random = np.random.default_rng(seed)
    targets = {}
    for i, tip in enumerate(robot.tips):
        pose = robot.fk(robot.random_configurations(1, seed=100 * seed + i)[0])[i].copy()
        # Half of the targets are of round numbers.
        pose[:3, 3] += random.choice([0.0, 0.5, -0.5], 3) if seed % 2 else random.normal(0.0, by, 3)
        targets[tip] = pose
    return targets


def inside(robot: bik.Robot, q: Array) -> bool:
    return bool(((robot.lower <= q) & (q <= robot.upper)).all())


def level(robot: bik.Robot, targets: dict[str, Array], *parts: tuple[str, str]) -> Level:
    return Level(robot, tuple((tip, targets[tip], part) for tip, part in parts))


def check(levels: list[Level], q: Array, starts: list[Array]) -> None:
    """Checks that each level is as near as scipy finds, unless a lower one is nearer."""
    assert inside(levels[0].robot, q)
    mine, best = [one.error(q) for one in levels], nested(levels, [q, *starts])
    for k, (own, other) in enumerate(zip(mine, best, strict=True)):
        if own < other - 1e-5:
            return
        assert own <= other + (1e-3 if k else 1e-6), (mine, best)


@pytest.mark.parametrize("seed", range(8))
def test_each_level_is_as_near_as_scipy_finds(seed: int) -> None:
    targets = far(PAIR, seed, 0.4)
    found = bik.solve(PAIR, targets, task={"right": Pose(level=1)})
    levels = [level(PAIR, targets, ("left", "pose")), level(PAIR, targets, ("right", "pose"))]
    check(levels, found.q, list(PAIR.random_configurations(4, seed=seed)))


@pytest.mark.parametrize("seed", range(3))
def test_feet_then_hands_then_gaze(seed: int) -> None:
    targets = far(BODY, seed, 0.15)
    targets["left_foot"] = BODY.fk(BODY.random_configurations(1, seed=seed)[0])[0]
    found = bik.solve(BODY, targets, task={"hand": Position(level=5), "head": Orientation(level=7)})
    parts = [("left_foot", "pose"), ("hand", "position"), ("head", "orientation")]
    assert found.errors["left_foot"][0] < 1e-6
    check([level(BODY, targets, part) for part in parts], found.q, list(BODY.random_configurations(2, seed=seed)))


@pytest.mark.parametrize("seed", range(8))
def test_a_higher_level_never_worsens_a_lower_one(seed: int) -> None:
    targets = far(PAIR, seed, 0.5)
    alone = bik.solve(PAIR, {"left": targets["left"]})
    both = bik.solve(PAIR, targets, task={"right": Pose(level=1)})
    lowest = level(PAIR, targets, ("left", "pose"))
    assert lowest.error(both.q) <= lowest.error(alone.q) + 1e-6, (alone.message, both.message)


def test_equal_levels_are_as_without_levels() -> None:
    for seed in range(6):
        targets = far(PAIR, seed, 0.3)
        plain = bik.solve(PAIR, targets)
        for level in (0, 3):
            same = bik.solve(PAIR, targets, task=Pose(level=level))
            np.testing.assert_array_equal(same.q, plain.q)
            assert (same.status, same.evaluations) == (plain.status, plain.evaluations)


def test_targets_that_can_all_be_met_are() -> None:
    for seed in range(10):
        frames = PAIR.fk(PAIR.random_configurations(1, seed=seed)[0])
        targets = dict(zip(PAIR.tips, frames, strict=True))
        found = bik.solve(PAIR, targets, task={"left": Pose(level=2)})
        assert found.status == bik.Status.SOLVED, found.message


def test_gaps_between_levels_and_the_order_of_tips_do_not_matter() -> None:
    targets = far(BODY, 3, 0.3)
    close = {"left_foot": Pose(), "hand": Pose(level=1), "head": Orientation(level=2)}
    wide = {"left_foot": Pose(), "hand": Pose(level=5), "head": Orientation(level=70)}
    one, other = (bik.solve(BODY, targets, task=task) for task in (close, wide))
    np.testing.assert_array_equal(one.q, other.q)
    turned = dict(reversed(targets.items()))
    again = bik.solve(BODY, turned, task=close)
    for tip in BODY.tips:
        assert again.errors[tip] == pytest.approx(one.errors[tip], abs=1e-3, nan_ok=True)


def test_two_tips_of_one_level_share_the_error() -> None:
    targets = far(BODY, 2, 0.6)
    order = {"left_foot": Pose(), "hand": Position(level=1), "head": Position(level=1)}
    together = bik.solve(BODY, targets, task=order)
    assert together.errors["left_foot"][0] < 1e-6
    check(
        [level(BODY, targets, ("left_foot", "pose")), level(BODY, targets, ("hand", "position"), ("head", "position"))],
        together.q,
        list(BODY.random_configurations(2, seed=1)),
    )


def test_the_message_says_each_level_by_tip() -> None:
    targets = {"left": PAIR.fk(np.zeros(16))[0].copy(), "right": bik.pose([5.0, 0.0, 1.0])}
    targets["left"][:3, 3] -= [0.0, 0.0, 0.3]
    found = bik.solve(PAIR, targets, task={"right": Position(level=4)})
    assert found.status == GIVEN_UP
    assert not found.success
    number = r"[0-9.e-]+"
    assert re.match(
        rf"level 0 met: 'left' to {number} m and {number} rad; "
        rf"level 4 not met, the nearest found is 'right' {number} m away",
        found.message,
    )
    assert found.message.endswith(
        ": move the targets of the higher levels, "
        "or give them a tolerance, a lower level or a task that leaves more free"
    )


def test_a_lowest_level_out_of_reach_is_named_and_nearest() -> None:
    targets = {"left": bik.pose([3.0, 0.0, 1.0]), "right": bik.pose([-3.0, 0.0, 1.0])}
    found = bik.solve(PAIR, targets, task={"left": Position(), "right": Position(level=1)})
    alone = bik.solve(PAIR, {"left": targets["left"]}, task={"left": Position()})
    assert found.status == alone.status != GIVEN_UP
    assert "level 0 not met, the nearest found is 'left' " in found.message
    assert "as near as possible" not in found.message
    assert found.errors["left"][0] <= alone.errors["left"][0] + 1e-6


def test_two_tips_that_fight_for_one_joint() -> None:
    # One joint turns both tips: the lower level decides alone, and what it leaves free is the other's.
    urdf = (
        "<robot name='fork'><link name='base'/><link name='hub'/><link name='a'/><link name='b'/>"
        "<joint name='turn' type='revolute'><parent link='base'/><child link='hub'/>"
        "<axis xyz='0 0 1'/><limit lower='-1' upper='2' velocity='1'/></joint>"
        "<joint name='slide' type='prismatic'><parent link='hub'/><child link='a'/>"
        "<origin xyz='1 0 0'/><axis xyz='0 0 1'/>"
        "<limit lower='0' upper='0.5' velocity='1'/></joint>"
        "<joint name='lift' type='prismatic'><parent link='hub'/><child link='b'/>"
        "<origin xyz='0 1 0'/><axis xyz='0 0 1'/>"
        "<limit lower='0' upper='0.5' velocity='1'/></joint></robot>"
    )
    fork = bik.Robot.from_urdf(urdf, tip=["a", "b"])
    targets = {"a": np.array([0.0, 1.0, 0.2]), "b": np.array([0.0, 1.0, 0.5])}
    first = bik.solve(fork, targets, task={"a": Position(), "b": Position(level=1)})
    np.testing.assert_allclose(first.q, [np.pi / 2, 0.2, 0.5], atol=1e-9)
    second = bik.solve(fork, targets, task={"a": Position(level=1), "b": Position()})
    np.testing.assert_allclose(second.q, [0.0, 0.2, 0.5], atol=1e-9)
    assert first.status == second.status == GIVEN_UP
    free = bik.solve(fork, targets, task={"a": Position(weights=[0, 0, 1]), "b": Position(level=1)})
    np.testing.assert_allclose(free.q, [0.0, 0.2, 0.5], atol=1e-6)
    assert free.status == bik.Status.SOLVED
    # The lowest level is met exactly at a limit, and stays there.
    targets["a"] = np.array([np.cos(2.0), np.sin(2.0), 0.5])
    held = bik.solve(fork, targets, task={"a": Position(), "b": Position(level=1)})
    np.testing.assert_allclose(held.q, [2.0, 0.5, 0.5], atol=1e-9)
    # Beyond the limit, the lowest level rests at it.
    targets["a"] = np.array([np.cos(2.5), np.sin(2.5), 0.5])
    beyond = bik.solve(fork, targets, task={"a": Position(), "b": Position(level=1)})
    np.testing.assert_allclose(beyond.q, [2.0, 0.5, 0.5], atol=1e-9)


def test_a_pair_of_tips_has_a_level_too() -> None:
    q = PAIR.random_configurations(1, seed=8)[0]
    left, right = PAIR.fk(q)
    tray = np.linalg.inv(left) @ right
    away = left.copy()
    away[:3, 3] += [2.0, 0.0, 0.0]
    tray_first = bik.solve(PAIR, {"left": away, ("left", "right"): tray}, task={"left": Pose(level=1)})
    assert tray_first.status == GIVEN_UP
    assert max(tray_first.errors["left", "right"]) < 1e-6
    hand_first = bik.solve(
        PAIR, {"left": left, ("left", "right"): np.linalg.inv(left) @ away}, task={("left", "right"): Pose(level=1)}
    )
    assert max(hand_first.errors["left"]) < 1e-6
    assert hand_first.errors["left", "right"][0] > 0.1


def test_a_floating_base_follows_the_lower_level() -> None:
    turn = [np.pi] * 3
    floating = PAIR.with_mobile_base("floating", lower=[-1.0] * 3 + [-t for t in turn], upper=[1.0] * 3 + turn)
    for seed in range(3):
        left = floating.fk(floating.random_configurations(1, seed=seed)[0])[0]
        targets = {"left": left, "right": left @ bik.pose([2.5, 0.0, 0.0])}
        found = bik.solve(floating, targets, task={"right": Pose(level=1)})
        assert max(found.errors["left"]) < 1e-6
        levels = [level(floating, targets, (tip, "pose")) for tip in ("left", "right")]
        check(levels, found.q, list(floating.random_configurations(2, seed=seed)))


def test_an_order_inside_a_pose_of_several_tips_counts() -> None:
    targets = {"left": PAIR.fk(np.zeros(16))[0], "right": bik.pose([0.0, -0.3, 2.0], rpy=[1.0, 0.5, 0.0])}
    found = bik.solve(PAIR, targets, task={"right": Pose(first="position", level=1)})
    assert max(found.errors["left"]) < 1e-6
    both = bik.solve(PAIR, targets, task={"right": Pose(level=1)})
    assert found.errors["right"][0] <= both.errors["right"][0] + 1e-9


def test_what_is_within_a_tolerance_counts_as_met() -> None:
    targets = {"left": PAIR.fk(np.zeros(16))[0].copy(), "right": bik.pose([0.3, -0.3, 1.5])}
    # 5 cm beyond the longest reach.
    targets["left"][2, 3] += 0.45
    missed = bik.solve(PAIR, targets, task={"left": Position(), "right": Position(level=1)})
    wide = {"left": Position(tolerance=[0.06] * 3), "right": Position(level=1)}
    met = bik.solve(PAIR, targets, task=wide)
    assert missed.errors["left"][0] > 0.04
    assert missed.status != GIVEN_UP
    assert np.abs(PAIR.fk(met.q)[0][:3, 3] - targets["left"][:3, 3]).max() <= 0.06
    assert met.status in (GIVEN_UP, bik.Status.SOLVED)


def test_a_batch_is_as_single_solves() -> None:
    targets = [far(PAIR, seed, 0.4) for seed in range(4)]
    rows = {tip: np.array([target[tip] for target in targets]) for tip in PAIR.tips}
    order = {"right": Pose(level=1)}
    batch = bik.solve_batch(PAIR, rows, task=order, threads=2)
    for i, target in enumerate(targets):
        one = bik.solve(PAIR, target, task=order)
        assert batch.status[i] == one.status
        for tip in PAIR.tips:
            assert batch.errors[tip][0][i] == pytest.approx(one.errors[tip][0], abs=1e-3)


def test_a_plan_ends_where_the_lower_level_is_met() -> None:
    start = PAIR.random_configurations(1, seed=1)[0]
    end = {"left": PAIR.fk(PAIR.random_configurations(1, seed=2)[0])[0], "right": np.array([0.0, -3.0, 1.0])}
    limits = bik.Limits(velocity=1.5, acceleration=5.0)
    order = {"left": Pose(), "right": Position(level=1)}
    plan = bik.plan_point_to_point(PAIR, start_q=start, end=end, task=order, limits=limits)
    last = PAIR.fk(plan.trajectory.q[-1])
    assert np.abs(residual(last[0], end["left"])).max() < 1e-6
    with pytest.raises(bik.InvalidInputError, match="cannot be reached"):
        bik.plan_point_to_point(PAIR, start_q=start, end=end, task={"right": Position()}, limits=limits)


@pytest.mark.parametrize("limits", [bik.Limits(velocity=1.0), bik.Limits(velocity=1.0, acceleration=4.0)])
def test_the_lower_level_is_tracked_while_the_higher_leaves_reach(limits: bik.Limits) -> None:
    q = np.tile([0.2, 0.0], 8) + np.linspace(0.1, 0.8, 16)
    q[0] = 0.2
    left, right = PAIR.fk(q)
    dt = 0.01
    tracker = bik.Tracker(PAIR, q, dt=dt, limits=limits, task={"right": Pose(level=1)})
    before, speed = q, np.zeros(16)
    statuses = set()
    for tick in range(700):
        # Out of reach to the side, and back.
        away = right.copy()
        away[1, 3] -= 1.5 * np.sin(np.pi * min(tick * dt, 4.0) / 4.0)
        step = tracker.step({"left": left, "right": away})
        statuses.add(step.status)
        velocity = (step.q - before) / dt
        assert np.abs(velocity).max() <= 1.0 + 1e-9
        if limits.acceleration is not None and tick > 0:
            assert np.abs(velocity - speed).max() / dt <= 4.0 + 1e-6
        assert step.errors["left"][0] < (1e-6 if limits.acceleration is None else 2e-2), tick
        before, speed = step.q, velocity
    assert GIVEN_UP in statuses
    assert step.status == bik.Status.SOLVED
    assert max(step.errors["left"]) < 1e-6


def test_a_step_says_the_levels() -> None:
    q = np.linspace(0.1, 0.8, 16)
    q[0] = 0.2
    left, right = PAIR.fk(q)
    right = right.copy()
    right[1, 3] -= 3.0
    tracker = bik.Tracker(PAIR, q, dt=0.01, limits=bik.Limits(velocity=3.0), task={"right": Pose(level=1)})
    for _ in range(300):
        step = tracker.step({"left": left, "right": right})
    assert step.status == GIVEN_UP
    assert step.message.startswith("the lowest level met and a higher one given up, ")
    assert "(level 0 met: 'left' to " in step.message
    assert "; level 1 not met, the nearest found is 'right' " in step.message
    assert pickle.loads(pickle.dumps(step)).message == step.message


def test_a_track_gives_up_the_higher_level() -> None:
    q = np.linspace(0.1, 0.8, 16)
    q[0] = 0.2
    left, right = PAIR.fk(q)
    path = bik.paths.circle(center=left[:3, 3], diameter=0.05, duration=2.0).with_orientation(left[:3, :3])
    beyond = right.copy()
    beyond[1, 3] -= 3.0
    result = bik.track(
        PAIR,
        {"left": path, "right": beyond},
        dt=0.02,
        start_q=q,
        task={"right": Pose(level=1)},
        limits=bik.Limits(velocity=3.0),
    )
    assert result.errors["left"][0][1:].max() < 1e-6
    assert result.status == GIVEN_UP
    assert result.message.startswith("the lowest level met from t = ")


def test_tasks_carry_their_level() -> None:
    for kind in (Pose, Position, Orientation, Pointing):
        task = kind(level=2)
        assert task.level == 2
        assert kind().level == 0
        assert repr(task).endswith("level=2)")
        assert pickle.loads(pickle.dumps(task)) == task
        assert task != kind()
        with pytest.raises(bik.InvalidInputError, match=r"^level must be zero or more, got -1$"):
            kind(level=-1)
        with pytest.raises(bik.InvalidInputError, match="level"):
            kind(level=0.5)


def test_calls_that_cannot_order_levels_refuse_them() -> None:
    targets = dict(zip(PAIR.tips, PAIR.fk(np.zeros(16)), strict=True))
    message = (
        "all solutions meet all targets, so levels from 0 to 1 have no effect: "
        "give all tasks one level, or solve for one configuration, which meets them in their order"
    )
    with pytest.raises(bik.InvalidInputError, match=f"^{re.escape(message)}$"):
        bik.solve_all(PAIR, targets, task={"left": Pose(level=1)})
    assert bik.solve_all(PAIR, targets, task=Pose(level=1), limit=1).success
    message = "what is kept comes before all targets, at every instant: leave out the level of its task, 1"
    with pytest.raises(bik.InvalidInputError, match=f"^{re.escape(message)}$"):
        bik.Keep(targets["left"], Pose(level=1, tolerance=[0.1] * 6))
