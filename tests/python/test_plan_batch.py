"""Batches of plans: equal to single plans on any number of threads; interruptions; wrong problems."""

import copy
import gc
import pickle
import signal
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from mistakes import Case, Invalid, assert_told, told

import beetle_ik as bik

PANDA = bik.Robot.named("panda").with_capsules(radius=0.05)
LIMITS = bik.Limits(acceleration=5.0)
READY = np.array([0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8])
BALL = bik.obstacles.Sphere((0.55, 0.2, 0.5), 0.1)
SCENE = bik.Scene([BALL])
COMMON: dict[str, Any] = {"limits": LIMITS, "obstacles": SCENE}
PROBLEMS: list[dict[str, Any]] = [
    *({"start_q": READY, "end": (0.45, y, 0.4)} for y in (-0.4, -0.1, 0.1, 0.4)),
    {"start": (0.4, -0.4, 0.5), "end": [(0.4, 0.4, 0.5), (0.4, 0.0, 0.7)], "seed": 5, "margin": 0.02},
    {"start_q": READY, "start_qd": 0.1 * np.ones(7), "end": (0.4, 0.4, 0.5), "obstacles": None},
    {"start_q": READY, "end": (4.0, 0.0, 0.5)},
    {"start_q": READY, "end_q": READY - 0.2, "objective": "joint_travel", "self_collision": False},
]
OUT_OF_REACH = 6


def planned(**options: Any) -> bik.BatchPlan:
    return bik.plan_batch(PANDA, PROBLEMS, **(COMMON | options))


@pytest.mark.parametrize("threads", [1, 2, None])
def test_each_item_is_what_a_single_plan_is(threads: int | None) -> None:
    batch = planned(threads=threads)
    assert len(batch) == len(PROBLEMS)
    for i, (plan, problem) in enumerate(zip(batch, PROBLEMS, strict=True)):
        if i == OUT_OF_REACH:
            with pytest.raises(bik.InvalidInputError) as caught:
                bik.plan_point_to_point(PANDA, **(COMMON | problem))
            assert str(caught.value) == str(batch.errors[i])
            assert plan is None
            continue
        alone = bik.plan_point_to_point(PANDA, **(COMMON | problem))
        assert plan is not None
        assert plan is batch.plans[i]
        np.testing.assert_array_equal(plan.trajectory.coefficients, alone.trajectory.coefficients)
        np.testing.assert_array_equal(plan.trajectory.time, alone.trajectory.time)
        assert (plan.status, plan.evaluations, plan.chosen_end) == (alone.status, alone.evaluations, alone.chosen_end)
        assert plan.obstacles == alone.obstacles
        assert batch.cost[i] == alone.cost
        assert batch.errors[i] is None


def test_columns_and_parts() -> None:
    batch = planned()
    others = [i for i in range(len(PROBLEMS)) if i != OUT_OF_REACH]
    assert batch.success.tolist() == [i != OUT_OF_REACH for i in range(len(PROBLEMS))]
    assert batch.status[OUT_OF_REACH] == bik.Status.OUT_OF_REACH
    assert np.isnan(batch.cost[OUT_OF_REACH])
    assert isinstance(batch.errors[OUT_OF_REACH], bik.InvalidInputError)
    reason = "end cannot be reached: the nearest configuration found stays 3.146 m away"
    assert batch.message == f"7 of 8 planned; problem {OUT_OF_REACH}: {reason}"
    assert repr(batch) == f"<BatchPlan: {batch.message}>"
    done = batch[batch.success]
    assert isinstance(done, bik.BatchPlan)
    assert done.message == "all 7 planned"
    assert done.plans == tuple(batch[i] for i in others)
    assert done.elapsed == pytest.approx(sum(plan.elapsed for plan in done if plan))
    assert batch.elapsed > 0
    assert bik.plan_batch(PANDA, []).message == "no problems"
    with pytest.raises(IndexError, match="index 8 is outside a batch of 8"):
        batch[8]


def with_problem(**problem: Any) -> list[dict[str, Any]]:
    return [PROBLEMS[0], problem]


OPTIONS = (
    "start_slack, end_turns, approach, retreat, free_start, task, keep, limits, method, objective, obstacles, margin, "
    "self_collision, stop, seed"
)
NAMES = f"start, end, start_q, end_q, start_qd, {OPTIONS}"
WRONG: list[Case] = [
    (
        lambda: bik.plan_batch(PANDA, with_problem(start_q=READY, goal=READY)),
        Invalid,
        f"problems[1]: 'goal' is no argument of a problem; its arguments: {NAMES}",
    ),
    (
        lambda: bik.plan_batch(PANDA, with_problem(start_q=READY)),
        Invalid,
        "problems[1]: no end was given: give end= a position or pose, or end_q=",
    ),
    (
        lambda: bik.plan_batch(PANDA, with_problem(start_q=READY, end_q=READY * np.nan)),
        Invalid,
        "problems[1]: end_q must be finite, but joint 'panda_joint1' is NaN",
    ),
    (
        lambda: bik.plan_batch(PANDA, with_problem(start_q=READY, end_q=READY, margin="wide")),
        bik.CallError,
        "problems[1]: margin must be a number, got 'wide'",
    ),
    (
        lambda: bik.plan_batch(PANDA, [READY[:2]]),  # type: ignore[list-item]
        Invalid,
        "problems[0]: expected a dict of arguments of plan_point_to_point, got array([0. , 0.3])",
    ),
    (
        lambda: bik.plan_batch(PANDA, 3),  # type: ignore[arg-type]
        Invalid,
        "problems must be a sequence of dicts of arguments of plan_point_to_point",
    ),
    (lambda: planned(threads=0), Invalid, "threads must be from 1 to 1024, got 0"),
    (lambda: planned(seed=-1), Invalid, "seed must be zero or more, got -1"),
]


@told(WRONG)
def test_a_wrong_problem_is_named(call: Any, error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


@pytest.mark.parametrize("threads", [1, 2])
def test_progress_counts_problems(threads: int) -> None:
    seen: list[tuple[int, int]] = []
    planned(threads=threads, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (len(PROBLEMS), len(PROBLEMS))
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)


@pytest.mark.skipif(sys.platform == "win32", reason="no timer sends signals on Windows")
@pytest.mark.parametrize("threads", [1, 2])
def test_ctrl_c_ends_a_batch(threads: int) -> None:
    def raised(*_: object) -> None:
        raise KeyboardInterrupt

    earlier = signal.signal(signal.SIGALRM, raised)
    gc.collect()
    gc.disable()  # a signal that arrives in a callback of the collector is lost
    signal.setitimer(signal.ITIMER_REAL, 0.1)
    try:
        with pytest.raises(KeyboardInterrupt):
            bik.plan_batch(PANDA, PROBLEMS * 1000, threads=threads, **COMMON)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, earlier)
        gc.enable()


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda batch: pickle.loads(pickle.dumps(batch))])
def test_a_batch_comes_back(again: Callable[[bik.BatchPlan], bik.BatchPlan]) -> None:
    batch = planned()[4:]
    other = again(batch)
    assert (repr(other), other.elapsed) == (repr(batch), batch.elapsed)
    for name in ("success", "status", "cost"):
        np.testing.assert_array_equal(getattr(other, name), getattr(batch, name))
    assert [repr(error) for error in other.errors] == [repr(error) for error in batch.errors]
    for one, same in zip(batch, other, strict=True):
        assert repr(one) == repr(same)
    with pytest.raises(bik.InvalidInputError, match="its columns differ in length"):
        bik.BatchPlan._restore((None,), (), [0], 0.0)  # type: ignore[attr-defined]
