"""Ctrl-C stops long calls, and they leave the interpreter to other threads."""

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from iiwa_circle import IIWA, START

import beetle_ik as bik

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no process can send itself Ctrl-C on Windows")

# Out of reach, so that every step spends all of its passes: minutes of work.
FAR = bik.paths.circle((5.0, 5.0, 5.0), diameter=0.2, duration=3600.0)


def track_for_minutes() -> object:
    return bik.track(IIWA, FAR, START, dt=0.01, solver=bik.papers.BAS(), position_tolerance=1e-12)


def solve_for_minutes() -> object:
    # Inside the shoulder: out of reach, but not farther than the arm is long, which would be told at once.
    return bik.solve(IIWA, [0.0, 0.0, 0.36], stop=bik.Stop(max_evaluations=10**12))


def solve_one_endless_iteration() -> object:
    solver = bik.papers.BAS(explorations=10**12)
    return bik.solve(IIWA, [5.0, 5.0, 5.0], solver=solver, stop=bik.Stop(max_evaluations=10**13))


def swarm_for_hours() -> object:
    swarm = bik.papers.CircleSwarm(population=1000, generations=10**6)
    return bik.papers.planar_posture(bik.Robot.planar([0.5] * 3), [0.5, 0.5, 0.0], swarm=swarm)


def find_solutions_without_end() -> object:
    # Each is found in a few evaluations, and there are millions.
    return bik.solve_all(IIWA, [0.5, 0.0, 0.6], limit=10**9, stop=bik.Stop(max_evaluations=10**12))


LONG_CALLS = [
    track_for_minutes,
    solve_for_minutes,
    solve_one_endless_iteration,
    swarm_for_hours,
    find_solutions_without_end,
]


@contextmanager
def interrupted(after: float) -> Iterator[list[float]]:
    """Sends SIGINT to this process from a thread; the list then holds when."""
    sent: list[float] = []

    def send() -> None:
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(after, send)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            yield sent
    finally:
        timer.cancel()  # a call that ended by itself must not have the next test interrupted


@pytest.mark.usefixtures("ctrl_c_raises")
@pytest.mark.parametrize("call", LONG_CALLS)
def test_ctrl_c_stops_a_long_call(call: Callable[[], object]) -> None:
    with interrupted(after=0.15) as sent:
        call()
    # 0.2 s is promised; a loaded machine may take longer.
    assert time.monotonic() - sent[0] < 1.0
    assert bik.solve(IIWA, [0.4, 0.3, 0.9]).success


@pytest.mark.usefixtures("ctrl_c_raises")
def test_ctrl_c_stops_a_track_with_a_progress_bar() -> None:
    with interrupted(after=0.15):
        bik.track(IIWA, FAR, START, dt=0.01, solver=bik.papers.BAS(), position_tolerance=1e-12, progress=True)


def test_a_call_outlives_ctrl_c_where_the_process_ignores_it() -> None:
    """Under nohup, SIGINT is ignored: the call runs to the end of its budget."""
    inherited = signal.signal(signal.SIGINT, signal.SIG_IGN)
    timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        found = bik.solve(IIWA, [0.0, 0.0, 0.36], stop=bik.Stop(max_evaluations=10**12, max_time=0.4))
    finally:
        timer.join()
        signal.signal(signal.SIGINT, inherited)
    assert found.status == bik.Status.TIME_UP


def test_what_progress_raises_stops_a_long_track() -> None:
    began = time.monotonic()

    def progress(done: int, total: int) -> None:
        if time.monotonic() - began > 0.1:
            raise ValueError(f"enough after {done} of {total}")

    with pytest.raises(ValueError, match=r"^enough after [0-9]+ of 360000$"):
        bik.track(IIWA, FAR, START, dt=0.01, solver=bik.papers.BAS(), position_tolerance=1e-12, progress=progress)
    assert time.monotonic() - began < 2.0


@pytest.mark.usefixtures("ctrl_c_raises")
@pytest.mark.parametrize("call", [track_for_minutes, solve_for_minutes])
def test_other_threads_run_meanwhile(call: Callable[[], object]) -> None:
    turns = 0
    stopped = threading.Event()

    def count() -> None:
        nonlocal turns
        while not stopped.is_set():
            turns += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    try:
        with interrupted(after=0.3):
            call()
    finally:
        stopped.set()
        counter.join()
    assert turns > 10  # with the interpreter held throughout it would be one or two


def test_threads_solve_at_the_same_time() -> None:
    results: dict[int, bik.Solution] = {}

    def solve(seed: int) -> None:
        results[seed] = bik.solve(IIWA, IIWA.fk([0.1 * seed] * 7), seed=seed)

    threads = [threading.Thread(target=solve, args=(seed,)) for seed in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for seed, found in results.items():
        assert found.success
        assert found.q.tolist() == bik.solve(IIWA, IIWA.fk([0.1 * seed] * 7), seed=seed).q.tolist()
