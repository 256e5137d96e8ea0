"""Nothing is called clear that was not tested: obstacles, surfaces, and two arms."""

import re

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik

PANDA = bik.Robot.named("panda").with_capsules(radius=0.05)
LINKS = sorted({link for link, *_ in PANDA.capsules})
READY = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
ALL_TOUCH = (
    "obstacle 0 (Sphere) may be touched by every link with a body, so that nothing would be tested against it: leave "
    "out the links of its touch that must stay clear, or the obstacle"
)


def ball(*touch: str) -> bik.obstacles.Sphere:
    return bik.obstacles.Sphere(PANDA.fk(READY)[:3, 3], 0.3, touch=list(touch))


CALLS = {
    "solve": lambda **o: bik.solve(PANDA, PANDA.fk(READY), **o),
    "solve_all": lambda **o: bik.solve_all(PANDA, PANDA.fk(READY), **o),
    "solve_batch": lambda **o: bik.solve_batch(PANDA, PANDA.fk(READY)[None], **o),
    "plan_point_to_point": lambda **o: bik.plan_point_to_point(PANDA, start_q=READY, end_q=READY + 0.1, **o),
    "plan_along_path": lambda **o: bik.plan_along_path(PANDA, path(), limits=bik.Limits(acceleration=5.0), **o),
    "track": lambda **o: bik.track(PANDA, path(), dt=0.01, start_q=READY, **o),
    "Tracker": lambda **o: bik.Tracker(PANDA, READY, dt=0.01, **o),
    "clearance": lambda obstacles, **o: bik.obstacles.clearance(PANDA, READY, obstacles, **o),
}


def path() -> bik.Path:
    return bik.paths.polyline([PANDA.fk(READY)[:3, 3], PANDA.fk(READY)[:3, 3] + [0, 0, 0.05]], 1.0)


@pytest.mark.parametrize("name", CALLS)
def test_an_obstacle_that_all_links_may_touch_is_refused(name: str) -> None:
    for options in ({},) if name == "clearance" else ({}, {"self_collision": False}):
        with pytest.raises(bik.InvalidInputError) as told:
            CALLS[name](obstacles=[ball(*LINKS)], **options)
        assert str(told.value).removeprefix("row 0: ") == ALL_TOUCH


def test_one_link_that_must_stay_clear_is_enough_to_test() -> None:
    for left_out in LINKS:
        touch = [link for link in LINKS if link != left_out]
        found = bik.obstacles.clearance(PANDA.with_collision_pairs([]), READY, [ball(*touch)])
        alone = PANDA.with_capsules([capsule for capsule in PANDA.capsules if capsule[0] == left_out])
        assert found == bik.obstacles.clearance(alone, READY, [ball()])


def test_an_attached_part_makes_a_touched_obstacle_testable() -> None:
    part = bik.obstacles.Sphere((0, 0, 0.1), 0.02)
    carrying = PANDA.with_attached("link_7", part, touch=["link_7"])
    with pytest.raises(bik.InvalidInputError, match="may be touched by every link"):
        bik.solve(carrying, PANDA.fk(READY), obstacles=[ball(*LINKS, "attached")])
    assert bik.solve(carrying, PANDA.fk(READY), obstacles=[ball(*LINKS)]).status.name == "IN_COLLISION"


def test_an_open_surface_is_not_called_everything() -> None:
    corners = np.array([[-2.0, -2, -1], [2, -2, -1], [2, 2, -1], [-2, 2, -1]])
    sheet = bik.obstacles.Mesh(corners, [[0, 1, 2], [0, 2, 3]])
    for result in (
        bik.solve(PANDA, PANDA.fk(READY), obstacles=[sheet]),
        bik.plan_point_to_point(PANDA, start_q=READY, end_q=READY + 0.1, obstacles=[sheet]),
    ):
        assert "everything" not in result.message
        assert re.search(
            r"m clear of all surfaces; the mesh of obstacle 0 is open, so that its inside is unknown", result.message
        )


PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])


def crossed(seed: int) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Draws a configuration at which the arms are inside each other, and its targets."""
    for q in PAIR.random_configurations(400, seed=seed):
        if bik.obstacles.clearance(PAIR, q, []) < -0.02:
            return q, dict(zip(PAIR.tips, PAIR.fk(q), strict=True))
    raise AssertionError("no configuration found")


def test_two_arms_stay_apart_without_being_asked() -> None:
    for seed in range(3):
        q, targets = crossed(seed)
        assert bik.solve(PAIR, targets, start_q=q, self_collision=False).success
        found = bik.solve(PAIR, targets, start_q=q)
        if found.success:
            assert bik.obstacles.clearance(PAIR, found.q, []) >= 0.001
        else:
            assert found.status.name in ("IN_COLLISION", "BUDGET_SPENT")
        assert np.isnan(bik.solve(PAIR, targets, self_collision=False).clearance)


@pytest.mark.parametrize(
    "limits", [bik.Limits(), bik.Limits(acceleration=5.0), bik.Limits(acceleration=5.0, jerk=80.0)]
)
def test_a_tracker_keeps_two_arms_apart_without_being_asked(limits: bik.Limits) -> None:
    start = next(q for q in PAIR.random_configurations(50, seed=9) if bik.obstacles.clearance(PAIR, q, []) > 0.05)
    least = {}
    for choice in (None, False):
        tracker = bik.Tracker(PAIR, start, dt=0.01, limits=limits, self_collision=choice)
        least[choice] = np.inf
        for seed in range(4):
            _, targets = crossed(seed)
            for _ in range(150):
                step = tracker.step(targets)
                least[choice] = min(least[choice], bik.obstacles.clearance(PAIR, step.q, []))
    assert least[None] >= 0.001 - 1e-9
    assert least[False] < 0


def test_one_arm_is_checked_only_where_asked() -> None:
    arm = bik.Robot.from_urdf(pair_of_pandas(), tip="left_tool")
    q = arm.random_configurations(1, seed=0)[0]
    assert np.isnan(bik.solve(arm, arm.fk(q)).clearance)
    assert np.isnan(bik.Tracker(arm, q, dt=0.01).step(arm.fk(q)).clearance)


def test_two_arms_with_unread_shapes_are_not_checked() -> None:
    mesh = '<collision><geometry><mesh filename="none.stl"/></geometry></collision>'
    text = pair_of_pandas().replace('<link name="left_tool"/>', f'<link name="left_tool">{mesh}</link>')
    arms = bik.Robot.from_urdf(text, tip=["left_tool", "right_tool"])
    q = arms.random_configurations(1, seed=0)[0]
    assert np.isnan(bik.solve(arms, dict(zip(arms.tips, arms.fk(q), strict=True))).clearance)
