"""Ctrl-C stops long calls, and they leave the interpreter to other threads."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable

import pytest
from iiwa_circle import IIWA, START
from interrupts import interrupted, interrupted_by_another_thread

import beetle_ik as bik

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no process can send itself Ctrl-C on Windows")

# Out of reach, so that every step spends all of its passes: minutes of work.
FAR = bik.paths.circle((5.0, 5.0, 5.0), diameter=0.2, duration=3600.0)


def track_for_minutes(progress: Callable[[int, int], object] | bool = False) -> object:
    solver = bik.papers.BAS()
    return bik.track(IIWA, FAR, START, dt=0.01, solver=solver, position_tolerance=1e-12, progress=progress)


def solve_for_minutes() -> object:
    # Inside the shoulder: out of reach, but not farther than the arm is long, which would be told at once.
    return bik.solve(IIWA, [0.0, 0.0, 0.36], stop=bik.Stop(max_evaluations=10**12))


def solve_one_endless_iteration() -> object:
    solver = bik.papers.BAS(explorations=10**12)
    return bik.solve(IIWA, [5.0, 5.0, 5.0], solver=solver, stop=bik.Stop(max_evaluations=10**13))


@pytest.mark.usefixtures("ctrl_c_raises")
def test_ctrl_c_stops_a_call_that_has_begun() -> None:
    begun = threading.Event()

    def send() -> None:
        begun.wait()
        os.kill(os.getpid(), signal.SIGINT)

    sender = threading.Thread(target=send)
    sender.start()
    with pytest.raises(KeyboardInterrupt):
        track_for_minutes(progress=lambda *_: begun.set())
    sender.join()
    assert bik.solve(IIWA, [0.4, 0.3, 0.9]).success


@pytest.mark.parametrize("call", [solve_one_endless_iteration, lambda: track_for_minutes(progress=True)])
def test_a_signal_stops_what_has_no_end_of_its_own(call: Callable[[], object]) -> None:
    with pytest.raises(KeyboardInterrupt), interrupted():
        call()


def test_a_call_outlives_ctrl_c_where_the_process_ignores_it() -> None:
    """Under nohup, SIGINT is ignored: the call runs to the end of its budget."""
    sent = 0

    def objective(_: object) -> float:
        nonlocal sent
        sent += 1
        os.kill(os.getpid(), signal.SIGINT)
        return 1.0

    inherited = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        stop = bik.Stop(max_evaluations=1000)
        found = bik.minimize(objective, [0.0], [1.0], solver=bik.papers.PSO(stall_generations=None), stop=stop)
    finally:
        signal.signal(signal.SIGINT, inherited)
    assert (found.status, found.evaluations, sent) == (bik.Status.BUDGET_SPENT, 1000, 1000)


def test_what_progress_raises_stops_a_long_track() -> None:
    reports = []

    def progress(done: int, total: int) -> None:
        reports.append(done)
        if len(reports) == 3:
            raise ValueError(f"enough after {done} of {total}")

    with pytest.raises(ValueError, match=r"^enough after [0-9]+ of 360000$"):
        track_for_minutes(progress)
    assert len(reports) == 3
    assert reports[2] < 360_000


@pytest.mark.parametrize("call", [track_for_minutes, solve_for_minutes])
def test_other_threads_run_meanwhile(call: Callable[[], object]) -> None:
    with pytest.raises(KeyboardInterrupt), interrupted_by_another_thread():
        call()


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


def test_ctrl_c_while_numpy_is_imported_ends_no_process() -> None:
    program = """
import sys

import beetle_ik as bik

class Interrupted:
    def find_spec(self, name, *_):
        if name.split(".")[0] == "numpy":
            sys.meta_path.remove(self)
            raise KeyboardInterrupt

assert "numpy" not in sys.modules
sys.meta_path.insert(0, Interrupted())
for _ in range(2):
    try:
        print(bik.Robot.named("ur5e").fk([0.0] * 6).shape)
    except KeyboardInterrupt:
        print("interrupted")
"""
    made = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (made.returncode, made.stdout) == (0, "interrupted\n(4, 4)\n"), made.stderr
