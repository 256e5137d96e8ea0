"""Straight lines at both ends of a planned motion, starts in contact, and carried parts."""

import copy
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from mistakes import Case, Invalid, told

import beetle_ik as bik

LIMITS = bik.Limits(acceleration=5.0)
READY = np.array([0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8])
TURN = np.eye(7)[0]
# Two fingers on each side of the tip, which grip a part.
FINGERS = [("link_7", (0.0, y, 0.15), (0.0, y, 0.31), 0.01) for y in (-0.03, 0.03)]
PANDA = bik.Robot.named("panda")
ARM = PANDA.with_capsules([*PANDA.with_capsules(radius=0.05).capsules, *FINGERS]).with_tool(bik.pose((0, 0, 0.2)))
PART = bik.obstacles.Box((0.5, 0.2, 0.1), (0.05, 0.05, 0.2))
TABLE = bik.obstacles.HalfSpace((0, 0, 1), -0.05, touch=["link_1"])
THINGS = [PART, TABLE]
GRASPS = [bik.pose((0.5, 0.2, 0.19), rpy=(np.pi, 0.0, yaw)) for yaw in (0.0, np.pi / 2)]
CLOSE = bik.StraightLine(0.1, touch={0: ["link_7"]})


def to(robot: bik.Robot = ARM, **options: Any) -> bik.Plan:
    return bik.plan_point_to_point(robot, **({"start_q": READY, "limits": LIMITS, "obstacles": THINGS} | options))


def tips(plan: bik.Plan, since: float, until: float) -> np.ndarray:
    q, _, _ = plan.trajectory.at(np.linspace(since, until, 400))
    return ARM.fk(q)


def off_line(poses: np.ndarray, direction: np.ndarray) -> float:
    """Largest distance of the tips from the line through the first one."""
    moved = poses[:, :3, 3] - poses[0, :3, 3]
    return float(np.linalg.norm(moved - np.outer(moved @ direction, direction), axis=1).max())


def rests(plan: bik.Plan) -> np.ndarray:
    """The times at which the arm is at rest."""
    _, qd, _ = plan.trajectory.at(plan.trajectory.time)
    return plan.trajectory.time[np.abs(qd).max(axis=1) < 1e-9]


def test_the_last_piece_is_a_straight_line_of_the_tip() -> None:
    plan = to(end=GRASPS, approach=CLOSE)
    assert plan.success, plan.message
    assert plan.chosen_end is not None
    grasp = GRASPS[plan.chosen_end]
    *_, before, end = rests(plan)
    assert end == plan.trajectory.duration
    line = tips(plan, before, end)
    np.testing.assert_allclose(line[-1], grasp, atol=3e-6)
    np.testing.assert_allclose(line[0][:3, 3], grasp[:3, 3] - 0.1 * grasp[:3, 2], atol=3e-6)
    assert off_line(line, grasp[:3, 2]) < 1.1e-4
    np.testing.assert_allclose(line[:, :3, :3], np.broadcast_to(grasp[:3, :3], (400, 3, 3)), atol=2e-4)


def test_only_the_line_may_touch() -> None:
    plan = to(end=GRASPS, approach=CLOSE, margin=0.005)
    before = rests(plan)[-2]
    times = np.linspace(0.0, plan.trajectory.duration, 2000)
    q, _, _ = plan.trajectory.at(times)
    clearance = bik.obstacles.clearance(ARM, q, THINGS)
    assert clearance[times <= before].min() >= 0.005
    assert clearance[-1] < 0.005
    allowed = [bik.obstacles.Box((0.5, 0.2, 0.1), (0.05, 0.05, 0.2), touch=["link_7"]), TABLE]
    assert bik.obstacles.clearance(ARM, q, allowed).min() >= 0.005
    assert plan.clearance >= 0.005
    assert f", {plan.clearance:.4g} m clear of everything; what its straight ends may touch is left" in plan.message


def test_a_retreat_lifts_the_part() -> None:
    held = to(end=GRASPS, approach=CLOSE).trajectory.q[-1]
    part = bik.obstacles.Box((0.0, 0.0, 0.05), (0.05, 0.05, 0.1))
    loaded = ARM.with_attached("link_7", part, touch=["link_6", "link_7"], name="part")
    up = bik.StraightLine(0.15, direction=(0, 0, 1), frame="base", touch=["part", "link_7"])
    plan = to(loaded, start_q=held, end_q=READY, retreat=up, obstacles=[TABLE])
    assert plan.success, plan.message
    line = tips(plan, 0.0, rests(plan)[1])
    np.testing.assert_allclose(line[-1][:3, 3] - line[0][:3, 3], (0, 0, 0.15), atol=5e-6)
    assert off_line(line, np.array([0.0, 0.0, 1.0])) < 1.1e-4
    both = to(start_q=held, end=(0.4, -0.3, 0.4), retreat=CLOSE, approach=0.05)
    assert both.success, both.message
    away = tips(both, 0.0, rests(both)[1])
    np.testing.assert_allclose(away[-1][:3, 3], away[0][:3, 3] - 0.1 * away[0][:3, 2], atol=5e-6)


def test_a_thing_in_the_hand_is_kept_clear() -> None:
    shelf = [bik.obstacles.Box((0.45, 0.0, 0.75), (0.5, 0.8, 0.02)), TABLE]
    start, end = READY - 0.7 * TURN, READY + 0.7 * TURN
    bare = to(PANDA.with_capsules(radius=0.05), start_q=start, end_q=end, obstacles=shelf)
    assert bare.success
    rod = bik.obstacles.Capsule((0.0, 0.0, 0.05), (0.0, 0.0, 0.3), 0.02)
    holding = PANDA.with_capsules(radius=0.05).with_attached("flange", rod, touch=["link_7"], name="rod")
    wall = [*shelf, bik.obstacles.Box((0.65, 0.0, 0.2), (0.3, 0.02, 0.25))]
    q, _, _ = bare.trajectory.at(np.linspace(0, bare.trajectory.duration, 500))
    assert bik.obstacles.clearance(holding, q, wall).min() < 0.0, "the rod would hit the wall"
    plan = to(holding, start_q=start, end_q=end, obstacles=wall)
    assert plan.success, plan.message
    q, _, _ = plan.trajectory.at(np.linspace(0, plan.trajectory.duration, 2000))
    assert bik.obstacles.clearance(holding, q, wall).min() >= 1e-3


DEEP = bik.obstacles.Sphere(PANDA.fk(READY)[:3, 3] + [0.0, 0.0, -0.07], 0.05)
BARE = PANDA.with_capsules(radius=0.05)


def test_a_start_in_contact_moves_out_first() -> None:
    end = READY + 0.9 * TURN
    begun = bik.obstacles.clearance(BARE, READY, [DEEP])
    assert begun < 0.0
    with pytest.raises(bik.InvalidInputError, match=r"^start_q: link '.*; free_start=True moves out first$"):
        to(BARE, end_q=end, obstacles=[DEEP])
    plan = to(BARE, end_q=end, obstacles=[DEEP], free_start=True)
    assert plan.success, plan.message
    assert plan.freed is not None
    clearance, until = plan.freed
    assert clearance == pytest.approx(begun, abs=1e-6)
    assert f"; it begins with a clearance of {clearance:.5f} m and keeps the margin after {until:.4f} s" in plan.message
    times = np.linspace(0.0, plan.trajectory.duration, 3000)
    distances = bik.obstacles.clearance(BARE, plan.trajectory.at(times)[0], [DEEP])
    assert distances.min() >= begun - 1e-4
    assert distances[times >= until].min() >= 1e-3
    assert plan.clearance == pytest.approx(distances.min(), abs=2e-4)
    assert plan.violations == []
    slower = plan.retime(bik.Limits(acceleration=1.0))
    assert slower.freed is not None
    factor = slower.trajectory.duration / plan.trajectory.duration
    np.testing.assert_allclose(slower.freed, (clearance, until * factor))
    assert to(BARE, end_q=end, obstacles=[TABLE], free_start=True).freed is None


def test_a_batch_takes_pieces() -> None:
    problems: list[dict[str, Any]] = [
        {"start_q": READY, "end": GRASPS, "approach": CLOSE},
        {"start_q": READY, "end": GRASPS[0]},
    ]
    batch = bik.plan_batch(ARM, problems, limits=LIMITS, obstacles=THINGS, approach=CLOSE, threads=2)
    for plan, problem in zip(batch, problems, strict=True):
        alone = to(**({"approach": CLOSE} | problem))
        assert plan is not None
        np.testing.assert_array_equal(plan.trajectory.coefficients, alone.trajectory.coefficients)


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))])
@pytest.mark.parametrize(
    "line",
    [
        bik.StraightLine(0.1),
        bik.StraightLine(0.2, direction=(1, 0, -1), frame="base", touch=["link_7"]),
        CLOSE,
    ],
)
def test_lines_come_back(line: bik.StraightLine, again: Callable[[bik.StraightLine], bik.StraightLine]) -> None:
    other = again(line)
    assert other == line
    assert hash(other) == hash(line)
    assert eval(repr(line), {"StraightLine": bik.StraightLine}) == line


TOUCH = "touch must be a list of link names, or a dict from the index of an obstacle to such a list, got "
WRONG: list[Case] = [
    (lambda: bik.StraightLine(0.0), Invalid, "distance of StraightLine must be positive and finite, got 0"),
    (lambda: bik.StraightLine(np.nan), Invalid, "distance of StraightLine must be positive and finite, got NaN"),
    (
        lambda: bik.StraightLine(0.1, direction=(0, 0, 0)),
        Invalid,
        "the length of direction of StraightLine must be positive, got 0",
    ),
    (
        lambda: bik.StraightLine(0.1, direction=(0, np.nan, 0)),
        Invalid,
        "direction of StraightLine must be finite, but entry 1 is NaN",
    ),
    (lambda: bik.StraightLine(0.1, direction=(0, 1)), Invalid, "direction: expected shape (3,), got (2,)"),
    (
        lambda: bik.StraightLine(0.1, frame="world"),  # type: ignore[arg-type]
        Invalid,
        "frame must be one of 'tip', 'base', got 'world'",
    ),
    (lambda: bik.StraightLine(0.1, touch="hand"), Invalid, TOUCH + "'hand'"),
    (lambda: bik.StraightLine(0.1, touch={"part": ["hand"]}), Invalid, TOUCH + "{'part': ['hand']}"),  # type: ignore[dict-item]
    (lambda: to(end=GRASPS, approach=-0.1), Invalid, "distance of approach must be positive and finite, got -0.1"),
    (
        lambda: to(end=GRASPS, retreat="far"),
        Invalid,
        "retreat must be a length (m) or a StraightLine, got 'far'",
    ),
    (
        lambda: to(end=GRASPS, approach=bik.StraightLine(0.1, touch={2: ["link_7"]})),
        Invalid,
        "obstacle in touch of approach must be the index of one of the 2 obstacles, got 2",
    ),
    (
        lambda: to(end=GRASPS, approach=0.1, method="tpbso"),
        Invalid,
        'approach, retreat and free_start are kept by method="minmax": method="tpbso" has no such pieces',
    ),
    (
        lambda: to(end=GRASPS, start_qd=np.zeros(7), retreat=0.1),
        Invalid,
        "start_qd cannot be kept by a motion that begins with retreat or free_start, from rest",
    ),
    (
        lambda: to(end=GRASPS[0], approach=0.1),
        Invalid,
        "end cannot be reached: link 'link_7' is 0.005000 m inside obstacle 0 (Box) whatever the arm does",
    ),
    (
        lambda: to(end=GRASPS[0], approach=bik.StraightLine(0.01, touch={0: ["link_7"]})),
        Invalid,
        "end cannot be reached: no straight approach of 0.01000 m: at its other end link 'link_7' is",
    ),
    (
        lambda: to(end=GRASPS[0], approach=bik.StraightLine(2.0, touch={0: ["link_7"]})),
        Invalid,
        "end cannot be reached: no straight approach of 2.000 m: ",
    ),
]  # fmt: skip


@told(WRONG)
def test_mistakes_are_told(call: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as caught:
        call()
    assert type(caught.value) is error
    assert str(caught.value).startswith(message), str(caught.value)
