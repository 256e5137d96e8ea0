"""Several ends of a planned motion, and tasks that leave a part of them free."""

from typing import Any

import numpy as np
import pytest

import beetle_ik as bik

PANDA = bik.Robot.named("panda")
LIMITS = bik.Limits(acceleration=5.0)
READY = np.array([0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8])
TURNED = READY + np.array([[0.9], [0.3], [-1.2]]) * np.eye(7)[0]


def to(end: Any = None, **options: Any) -> bik.Plan:
    return bik.plan_point_to_point(PANDA, end=end, **({"start_q": READY, "limits": LIMITS} | options))


def test_the_quickest_of_several_ends_is_taken() -> None:
    for ends in ({"end_q": TURNED}, {"end": PANDA.fk(TURNED)}, {"end": PANDA.fk(TURNED)[:, :3, 3]}):
        plan = to(**ends)
        assert plan.success
        assert plan.chosen_end == 1
    np.testing.assert_allclose(to(end_q=TURNED).trajectory.q[-1], TURNED[1], atol=1e-12)
    assert to(end_q=TURNED[0]).chosen_end == 0
    assert to(end=[PANDA.fk(TURNED[0])]).chosen_end == 0
    assert bik.plan_along_path(PANDA, PANDA.fk(TURNED)[:2], limits=LIMITS).chosen_end is None


def test_ends_out_of_reach_are_passed_over() -> None:
    assert to(end=[[3.0, 0, 0], [0.4, 0.3, 0.5]]).chosen_end == 1
    with pytest.raises(bik.InvalidInputError, match=r"^none of the 2 ends can be reached: end\[0\]: the nearest "):
        to(end=[[3.0, 0, 0], [0.0, 3.0, 0.5]])


def test_a_task_leaves_a_part_of_the_end_free() -> None:
    pose = PANDA.fk(TURNED[0] + [0, 0, 0, 0, 0, 0, 1.5])
    plan = to(end=pose, task=bik.tasks.Pointing())
    reached = PANDA.fk(plan.trajectory.q[-1])
    np.testing.assert_allclose(reached[:3, 2:], pose[:3, 2:], atol=1e-5)
    assert plan.cost < 0.99 * to(end=pose).cost


TARGETS = "end: expected a pose (4, 4), a position (3,), or several, (k, 4, 4) or (k, 3), got shape "
CONFIGURATIONS = "end_q: expected joint positions (n,), or several, (k, n), got shape "


@pytest.mark.parametrize(
    ("ends", "message"),
    [
        ({"end": np.zeros((0, 3))}, TARGETS + "(0, 3)"),
        ({"end": np.zeros((2, 4))}, TARGETS + "(2, 4)"),
        (
            {"end": np.zeros(7)},
            "end: expected a pose (4, 4) or a position (3,), got shape (7,); joint angles go to end_q",
        ),
        ({"end": [[0.4, 0.1, 0.3], [0.4, np.nan, 0.3]]}, "end[1] must be finite, but coordinate y is NaN"),
        ({"end": [np.eye(4), np.ones((4, 4))]}, "end[1] is not a rigid transform"),
        ({"end_q": np.zeros((3, 6))}, "end_q[0] of robot 'panda': expected 7 joints, got 6"),
        ({"end_q": np.zeros((0, 7))}, CONFIGURATIONS + "(0, 7)"),
        ({"end_q": np.zeros((1, 1, 7))}, CONFIGURATIONS + "(1, 1, 7)"),
        ({"end_q": [READY, READY * np.nan]}, "end_q[1] must be finite, but joint 'panda_joint1' is NaN"),
        ({"end_q": TURNED, "end": np.eye(4)}, "both end and end_q were given: give one of them"),
        ({}, "no end was given: give end= a position or pose, or end_q="),
        (
            {"end_q": TURNED, "method": "tpbso"},
            'several ends are taken by method="minmax": method="tpbso" plans to one',
        ),
        (
            {"end": [0.4, 0.1, 0.3], "task": bik.tasks.Pointing()},
            "task Pointing needs a target pose (4, 4), got a position (3,)",
        ),
        ({"end": [0.4, 0.1, 0.3], "task": "pointing"}, "task must be one of beetle_ik.tasks, got 'pointing'"),
    ],
)
def test_a_wrong_end_is_named(ends: dict[str, Any], message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as raised:
        to(**ends)
    assert str(raised.value).startswith(message)
