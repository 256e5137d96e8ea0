"""Batches: equal to single solves on any number of threads and in forks; interruptions; wrong rows."""

import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager
from typing import Any

import numpy as np
import pytest
from interrupts import interrupted, interrupted_by_another_thread
from mistakes import Case, Invalid, assert_told, told

import beetle_ik as bik

PANDA = bik.Robot.named("panda")
COLUMNS = ["q", "success", "status", "position_error", "rotation_error", "iterations", "restarts", "evaluations"]


def poses(robot: bik.Robot, m: int) -> np.ndarray:
    return robot.fk(robot.random_configurations(m, seed=7))


def columns(batch: bik.BatchSolution) -> dict[str, bytes]:
    return {name: getattr(batch, name).tobytes() for name in COLUMNS}


TARGETS = poses(PANDA, 300)
# Row 1 holds NaN, row 2 is no rotation.
WRONG = np.array(TARGETS[:4])
WRONG[1, 0, 3] = np.nan
WRONG[2, :3, :3] *= 1.1
HIGH = np.zeros((4, 7))
HIGH[3] = [0, 0, 0, -1, 0, np.nan, 0]
HIGH[:3] = [0, 0, 0, -1, 0, 1, 0]


@pytest.mark.parametrize("threads", [2, 3, None])
def test_any_number_of_threads_gives_the_same_bits(threads: int | None) -> None:
    assert columns(bik.solve_batch(PANDA, TARGETS, threads=threads)) == columns(
        bik.solve_batch(PANDA, TARGETS, threads=1)
    )


@pytest.mark.parametrize("m", [1, 2, 50])
def test_items_do_not_depend_on_later_ones(m: int) -> None:
    np.testing.assert_array_equal(bik.solve_batch(PANDA, TARGETS[:m]).q, bik.solve_batch(PANDA, TARGETS).q[:m])


@pytest.mark.parametrize("seed", [0, 1, 2**64 - 1])
def test_item_0_is_what_solve_finds(seed: int) -> None:
    batch, alone = bik.solve_batch(PANDA, TARGETS[:3], seed=seed), bik.solve(PANDA, TARGETS[0], seed=seed)
    for name in COLUMNS:
        np.testing.assert_array_equal(getattr(batch[0], name), getattr(alone, name))
        np.testing.assert_array_equal(getattr(batch, name)[0], getattr(alone, name))


def test_columns_say_what_the_poses_say() -> None:
    batch = bik.solve_batch(PANDA, TARGETS)
    assert batch.q.shape == (300, 7)
    assert batch.success.all()
    assert np.all((PANDA.lower <= batch.q) & (batch.q <= PANDA.upper))
    distances = np.linalg.norm(PANDA.fk(batch.q)[:, :3, 3] - TARGETS[:, :3, 3], axis=1)
    np.testing.assert_allclose(batch.position_error, distances, rtol=0, atol=1e-15)
    assert np.all((batch.position_error <= 1e-6) & (batch.rotation_error <= 1e-6))
    types = {name: getattr(batch, name).dtype.name for name in COLUMNS}
    assert types == dict.fromkeys(COLUMNS, "float64") | {
        "success": "bool",
        "status": "uint8",
        "iterations": "int64",
        "restarts": "int64",
        "evaluations": "int64",
    }
    assert not any(getattr(batch, name).flags.writeable for name in COLUMNS)
    assert (batch.message, repr(batch)) == ("all 300 solved", "<BatchSolution: all 300 solved>")
    assert batch.elapsed > 0.0
    np.testing.assert_array_equal(batch.limits.upper, PANDA.upper)


def test_arrays_are_made_once() -> None:
    batch = bik.solve_batch(PANDA, TARGETS[:2])
    assert batch.q is batch.q


def test_items_are_solutions() -> None:
    batch = bik.solve_batch(PANDA, TARGETS[:3], limits=bik.Limits(velocity=1.5))
    assert len(batch) == 3
    assert [type(item) for item in batch] == [bik.Solution] * 3
    np.testing.assert_array_equal([item.q for item in batch], batch.q)
    np.testing.assert_array_equal(batch[-3].q, batch.q[0])
    assert (batch[2].status, batch[2].evaluations) == (bik.Status.SOLVED, batch.evaluations[2])
    assert batch[1].elapsed > 0.0
    assert batch[1].limits.velocity == 1.5
    for index in (3, -4, sys.maxsize, -sys.maxsize):
        with pytest.raises(IndexError, match=f"^index {index} is outside a batch of 3$"):
            batch[index]


def test_results_of_several_are_iterable_for_type_checkers_too() -> None:
    for several in (bik.solve_batch(PANDA, TARGETS[:3]), bik.solve_all(bik.Robot.named("ur5e"), [0.4, 0.2, 0.3])):
        assert isinstance(several, Iterable)
        one_by_one = iter(several)
        np.testing.assert_array_equal(next(one_by_one).q, several[0].q)
        assert len(list(one_by_one)) == len(several) - 1


@pytest.mark.parametrize(
    "index",
    [slice(1, 4), slice(None, None, -2), slice(7, 9), [0, -1], np.array([2, 2]), [True, False, True, False, True], []],
    ids=str,
)
def test_several_items_are_a_batch(index: Any) -> None:
    batch = bik.solve_batch(PANDA, TARGETS[:5])
    some = batch[index]
    assert type(some) is bik.BatchSolution
    for name in COLUMNS:
        np.testing.assert_array_equal(getattr(some, name), getattr(batch, name)[index], err_msg=name)
    assert [item.message for item in some] == [batch[int(i)].message for i in np.arange(5)[index]]
    assert some.limits == batch.limits
    assert some.elapsed == pytest.approx(sum(item.elapsed for item in some))


@pytest.mark.parametrize("index", [None, ..., (0, 1), 1.0, "q", [True], [9], np.zeros((2, 2), dtype=int)], ids=repr)
def test_an_invalid_index_is_refused(index: Any) -> None:
    batch = bik.solve_batch(PANDA, TARGETS[:3])
    if index is ...:
        assert len(batch[index]) == 3
    else:
        with pytest.raises(IndexError):
            batch[index]


def test_positions_leave_the_orientation_free() -> None:
    batch = bik.solve_batch(PANDA, [[0.4, 0.1, 0.5], [9, 9, 9]], stop=bik.Stop(max_evaluations=400))
    assert batch.success.tolist() == [True, False]
    assert np.isnan(batch.rotation_error).all()
    assert batch.status[1] == bik.Status.OUT_OF_REACH
    assert batch.evaluations[1] <= 400
    assert batch.message == ("1 of 2 solved; 1 OUT_OF_REACH: move or turn the target into reach, or move the base")


def test_starts_are_one_for_each_or_one_for_all() -> None:
    starts = PANDA.random_configurations(300, seed=7)
    each = bik.solve_batch(PANDA, TARGETS, start_q=starts)
    np.testing.assert_array_equal(each.q, starts)
    assert np.all(each.evaluations == 1)
    common = bik.solve_batch(PANDA, TARGETS[:20], start_q=starts[4])
    alone = [bik.solve(PANDA, target, start_q=starts[4]).evaluations for target in TARGETS[:1]]
    assert common.evaluations[0] == alone[0]
    assert common.evaluations[4] == 1


@pytest.mark.parametrize("targets", [[], np.empty((0, 3)), np.empty((0, 4, 4))])
@pytest.mark.parametrize("threads", [1, 2])
def test_no_targets_give_no_solutions(targets: object, threads: int) -> None:
    batch = bik.solve_batch(PANDA, targets, threads=threads)
    assert batch.message == "no targets"
    assert (len(batch), batch.q.shape, batch.success.shape, list(batch)) == (0, (0, 7), (0,), [])


def test_any_layout_of_memory_is_read() -> None:
    expected = bik.solve_batch(PANDA, TARGETS[::2])
    for targets in (np.asfortranarray(TARGETS[::2]), TARGETS[::2].tolist(), TARGETS[::2].copy()):
        np.testing.assert_array_equal(bik.solve_batch(PANDA, targets).q, expected.q)


@pytest.mark.parametrize("threads", [1, 2])
def test_wrong_rows_are_skipped_on_demand(threads: int) -> None:
    batch = bik.solve_batch(PANDA, WRONG, start_q=HIGH, on_invalid="skip", threads=threads)
    assert batch.status.tolist() == [0, 8, 8, 8]
    assert batch.success.tolist() == [True, False, False, False]
    assert np.isnan(batch.q[1:]).all()
    assert np.isnan(batch.position_error[1:]).all()
    np.testing.assert_array_equal(batch.q[0], bik.solve_batch(PANDA, TARGETS[:1], start_q=HIGH[:1]).q[0])
    assert batch.message == '1 of 4 solved; 3 INVALID: use on_invalid="raise" to see what is wrong'
    assert batch[1].status is bik.Status.INVALID
    assert batch[1].message == 'not solved: use on_invalid="raise" to see what is wrong'


MISTAKES: list[Case] = [
    (lambda: bik.solve_batch(PANDA, WRONG), Invalid, "row 1: target must be finite, but entry (0, 3) is NaN"),
    (
        lambda: bik.solve_batch(PANDA, WRONG[2:]),
        Invalid,
        "row 0: target is not a rigid transform: R'R differs from the identity by 2.100e-1; "
        "the nearest rotation is U V' of its singular value decomposition U S V'",
    ),
    (
        lambda: bik.solve_batch(PANDA, TARGETS[:4], start_q=HIGH),
        Invalid,
        "row 3: start_q must be finite, but joint 'panda_joint6' is NaN",
    ),
    (
        lambda: bik.solve_batch(PANDA, TARGETS[:4], start_q=HIGH[3], on_invalid="skip"),
        Invalid,
        "start_q must be finite, but joint 'panda_joint6' is NaN",
    ),
    (
        lambda: bik.solve_batch(PANDA, [[0, 0, 0], [0, np.inf, 0]]),
        Invalid,
        "row 1: target must be finite, but coordinate y is inf",
    ),
    (
        lambda: bik.solve_batch(PANDA, TARGETS[0]),
        Invalid,
        "targets: expected poses (m, 4, 4) or positions (m, 3), got shape (4, 4)",
    ),
    (
        lambda: bik.solve_batch(PANDA, [0.4, 0.1, 0.5]),
        Invalid,
        "targets: expected poses (m, 4, 4) or positions (m, 3), got shape (3,)",
    ),
    (lambda: bik.solve_batch(PANDA, None), Invalid, "targets must be an array of numbers, got None"),
    (
        lambda: bik.solve_batch(PANDA, TARGETS[:4], start_q=HIGH[:, :6]),
        Invalid,
        "start_q of robot 'panda': expected shape (7,) or (m, 7), got (4, 6)",
    ),
    (
        lambda: bik.solve_batch(PANDA, TARGETS[:4], start_q=HIGH[:3]),
        Invalid,
        "starts: expected 28 numbers, 4 rows (one per target) of 7 joints, got 21",
    ),
    (
        lambda: bik.solve_batch(PANDA, TARGETS[:4], start_q=HIGH[0, :6]),
        Invalid,
        "start_q of robot 'panda': expected 7 joints, got 6",
    ),
    (lambda: bik.solve_batch(PANDA, TARGETS, threads=0), Invalid, "threads must be from 1 to 1024, got 0"),
    (lambda: bik.solve_batch(PANDA, TARGETS, threads=-1), Invalid, "threads must be zero or more, got -1"),
    (lambda: bik.solve_batch(PANDA, TARGETS, threads=2000), Invalid, "threads must be from 1 to 1024, got 2000"),
    (
        lambda: bik.solve_batch(PANDA, TARGETS, on_invalid="ignore"),
        Invalid,
        "on_invalid must be one of 'raise', 'skip', got 'ignore'",
    ),
    (
        lambda: bik.solve_batch(PANDA, TARGETS, progress=3),
        Invalid,
        "progress must be True, False or a callable of (done, total), got 3",
    ),
    (
        lambda: bik.solve_batch(PANDA, TARGETS, position_tolerance=0),
        Invalid,
        "position_tolerance must be positive, got 0",
    ),
    (lambda: bik.solve_batch(PANDA, [], seed=-1), Invalid, "seed must be zero or more, got -1"),
]


@told(MISTAKES)
def test_mistakes_are_told(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


@pytest.mark.parametrize("threads", [1, 2])
def test_progress_is_told_to_the_end(threads: int) -> None:
    told_in: set[int] = set()
    told_of: list[tuple[int, int]] = []

    def progress(done: int, total: int) -> None:
        told_in.add(threading.get_ident())
        told_of.append((done, total))

    bik.solve_batch(PANDA, TARGETS, threads=threads, progress=progress)
    assert told_of[-1] == (300, 300)
    assert told_of == sorted(told_of)
    assert told_in == {threading.get_ident()}


def test_a_progress_bar_and_none_give_the_same() -> None:
    expected = columns(bik.solve_batch(PANDA, TARGETS[:9]))
    assert columns(bik.solve_batch(PANDA, TARGETS[:9], progress=True)) == expected
    assert columns(bik.solve_batch(PANDA, TARGETS[:9], progress=False)) == expected


@pytest.mark.parametrize("threads", [1, 2])
def test_what_progress_raises_stops_a_batch(threads: int) -> None:
    told = 0

    def progress(done: int, total: int) -> None:
        nonlocal told
        told += 1
        raise ValueError(f"enough after {done} of {total}")

    # Far out of reach: minutes of work.
    targets = np.full((100_000, 3), 9.0)
    with pytest.raises(ValueError, match=r"^enough after [0-9]{1,5} of 100000$"):
        bik.solve_batch(PANDA, targets, threads=threads, progress=progress)
    assert told == 1


@pytest.mark.skipif(sys.platform == "win32", reason="no timer sends signals on Windows")
@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("budget", [10**4, 10**12], ids=["many short searches", "endless searches"])
@pytest.mark.parametrize("how", [interrupted, interrupted_by_another_thread])
def test_a_batch_is_interrupted_while_other_threads_run(
    threads: int, budget: int, how: Callable[[], AbstractContextManager[None]]
) -> None:
    targets = np.full((100_000, 3), 9.0)
    with pytest.raises(KeyboardInterrupt), how():
        bik.solve_batch(PANDA, targets, threads=threads, stop=bik.Stop(max_evaluations=budget))
    assert bik.solve_batch(PANDA, TARGETS, threads=threads).success.all()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this platform")
def test_a_forked_child_solves_after_its_parent_did() -> None:
    expected = columns(bik.solve_batch(PANDA, TARGETS, threads=2))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of threads in the parent: they are what is tested
        child = os.fork()
    if child == 0:
        signal.alarm(200)  # a child that waits for its parent's threads is killed
        same = all(columns(bik.solve_batch(PANDA, TARGETS, threads=threads)) == expected for threads in (2, 2, 3))
        os._exit(0 if same else 1)
    _, status = os.waitpid(child, 0)
    assert os.waitstatus_to_exitcode(status) == 0
    assert columns(bik.solve_batch(PANDA, TARGETS, threads=2)) == expected


def test_batches_run_at_the_same_time() -> None:
    found: dict[int, dict[str, bytes]] = {}

    def solve(threads: int) -> None:
        found[threads] = columns(bik.solve_batch(PANDA, TARGETS, threads=threads))

    callers = [threading.Thread(target=solve, args=(threads,)) for threads in (1, 2, 3, 4)]
    for caller in callers:
        caller.start()
    for caller in callers:
        caller.join()
    assert found == dict.fromkeys((1, 2, 3, 4), found[1])
