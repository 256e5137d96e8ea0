"""Long runs and rough treatment: memory, threads, full disks, killed writers, forks, sub-interpreters.

Each trial runs in a process of its own, says what it measured, and raises `AssertionError` if its promise is broken.
"""

from __future__ import annotations

import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import beetle_ik as bik

MEGABYTE = 2**20
KNOTS = 2000  # of the motions that are written while the writer is killed


@dataclass(frozen=True)
class Trial:
    """What is tried. `short` and `long` are amounts, in `unit`."""

    promise: str
    unit: str
    short: int
    long: int
    run: Callable[[int], str]


def memory() -> float:
    """Memory of this process that is resident (MB)."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * resource.getpagesize() / MEGABYTE


def tracker(seconds: int) -> str:
    """Steps a tracker at 1 kHz."""
    robot = bik.Robot.named("panda").with_capsules(radius=0.05)
    start = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
    limits = bik.Limits(velocity=1.5, acceleration=5.0, jerk=50.0)
    wall = [bik.obstacles.Box((0.6, 0.4, 0.4), (0.05, 0.3, 0.5))]
    arm, center = bik.Tracker(robot, start, dt=1e-3, limits=limits, obstacles=wall), robot.fk(start)
    ticks, late, after_warming = np.full(seconds * 1000, np.nan), 0, 0.0  # all of its memory is taken at once
    due = time.perf_counter()
    for i in range(len(ticks)):
        target = center.copy()
        target[:3, 3] += 0.1 * np.array([np.sin(1e-3 * i), np.cos(7e-4 * i), 0.0])
        began = time.perf_counter()
        step = arm.step(target if i % 3 else None)
        ticks[i] = time.perf_counter() - began
        assert step.clearance >= 1e-3, f"tick {i} is nearer than the margin: {step.clearance}"
        if i == min(2000, len(ticks) // 2):
            after_warming = memory()
        due += 1e-3
        late += time.perf_counter() > due
        while time.perf_counter() < due:
            time.sleep(1e-4)
    growth = memory() - after_warming
    assert growth < 8.0, f"memory grows by {growth:.1f} MB"
    spent = f"median {1e6 * np.median(ticks):.0f} us, slowest {1e3 * ticks.max():.2f} ms, {late} late"
    return f"{len(ticks)} ticks, {spent}, memory +{growth:.1f} MB"


def threads(rounds: int) -> str:
    """Sixteen threads share a robot and a scene; each must get the bits that one thread gets alone."""
    robot = bik.Robot.named("panda").with_capsules(radius=0.05)
    scene = bik.Scene([bik.obstacles.Sphere((0.5, 0.2, 0.5), 0.1)])
    q = robot.random_configurations(64, seed=1)
    poses, start = robot.fk(q), np.clip(np.zeros(7), robot.lower, robot.upper)

    def work(number: int) -> list[bytes]:
        target = poses[number]
        found = bik.solve(robot, target, obstacles=scene, seed=number)
        steps = bik.Tracker(robot, start, dt=0.01)
        batch = bik.solve_batch(robot, poses[number : number + 8], threads=2, seed=number)
        every = bik.solve_all(robot, target)
        clear = bik.obstacles.clearance(robot, q, scene)
        return [part.tobytes() for part in (found.q, steps.step(target).q, batch.q, every.q, clear, robot.jacobian(q))]

    alone = [work(number) for number in range(16)]
    wrong: list[int] = []

    def again(number: int) -> None:
        wrong.extend(number for _ in range(rounds) if work(number) != alone[number])

    crowd = [threading.Thread(target=again, args=(number,)) for number in range(16)]
    for one in crowd:
        one.start()
    for one in crowd:
        one.join()
    assert not wrong, f"threads {sorted(set(wrong))} got other bits"
    return f"16 threads, {16 * rounds} rounds of six calls, all with the same bits; memory {memory():.0f} MB"


def rows(count: int) -> str:
    """Solves a batch of so many rows, a hundred thousand at a time, within 1 GB of memory."""
    robot, chunk, solved, after_first = bik.Robot.named("panda"), min(100_000, count), 0, 0.0
    for first in range(0, count, chunk):
        targets = robot.fk(robot.random_configurations(chunk, seed=first))
        solved += int(bik.solve_batch(robot, targets).success.sum())
        after_first = after_first or memory()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    assert peak < 1024, f"the peak is {peak:.0f} MB"
    assert memory() - after_first < 100, f"memory grows from {after_first:.0f} to {memory():.0f} MB"
    growth = memory() - after_first
    return f"{count} rows, {solved} solved, peak {peak:.0f} MB, memory +{growth:.0f} MB after the first chunk"


def motion(level: float) -> bik.Trajectory:
    """A motion of many knots, all joints at `level`: files of it are long."""
    time = np.arange(float(KNOTS))
    return bik.Trajectory.from_samples(time, np.full((KNOTS, 3), level), qd=np.zeros((KNOTS, 3)))


def scene(level: float) -> bik.Scene:
    """A scene of many spheres, all at `level`."""
    return bik.Scene([bik.obstacles.Sphere((level, 0.0, 0.0), 0.1)] * (KNOTS // 2))


# What writes a file, and what reads the level from it again.
WRITERS: dict[str, tuple[Callable[[Path, float], object], Callable[[Path], float]]] = {
    "motion.csv": (
        lambda file, level: motion(level).to_csv(file),
        lambda file: bik.Trajectory.from_csv(file).q[-1, -1],
    ),
    "motion.npz": (
        lambda file, level: motion(level).to_npz(file),
        lambda file: bik.Trajectory.from_npz(file).q[-1, -1],
    ),
    "scene.json": (lambda file, level: scene(level).save(file), lambda file: bik.Scene.load(file)[-1].center[0]),
    "motion.yaml": (
        lambda file, level: bik.interop.to_ros_yaml(motion(level), file),
        lambda file: _level_of_yaml(file),
    ),
}


def _level_of_yaml(file: Path) -> float:
    lines = file.read_text(encoding="utf-8").splitlines()
    points = [line for line in lines if "positions" in line]
    assert len(points) == KNOTS, f"{len(points)} of {KNOTS} points"
    return float(points[-1].rstrip("]").split(",")[-1])


def killed_writers(kills: int) -> str:
    """Kills writers at any moment, by SIGTERM and by SIGKILL: the file is then the old one or the new one."""
    left = 0
    for number in range(kills):
        name = list(WRITERS)[number % len(WRITERS)]
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / name
            WRITERS[name][0](file, 0.0)
            child = os.fork()
            if child == 0:
                for level in range(1, 1_000_000):
                    WRITERS[name][0](file, float(level))
            time.sleep(random.Random(number).uniform(0.0, 0.05))
            os.kill(child, signal.SIGKILL if number // len(WRITERS) % 2 else signal.SIGTERM)
            os.waitpid(child, 0)
            level = WRITERS[name][1](file)
            assert level == int(level) >= 0, f"{name} holds {level}"
            left += len(list(Path(folder).iterdir())) - 1
    return f"{kills} writers killed, every file whole; {left} hidden unfinished files beside them"


def full_disk(rounds: int) -> str:
    """Writes files that do not fit: an error, the old file, and nothing beside it."""
    refused = 0
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    for number in range(rounds):
        for name, (write, read) in WRITERS.items():
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / name
                write(file, 1.0)
                room = int(file.stat().st_size * random.Random(number).random())
                resource.setrlimit(resource.RLIMIT_FSIZE, (room, resource.RLIM_INFINITY))
                try:
                    write(file, 2.0)
                except OSError:
                    refused += 1
                finally:
                    resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
                assert read(file) == 1.0, f"{name} is not the old file"
                assert os.listdir(folder) == [name], f"{name} leaves {os.listdir(folder)}"  # noqa: PTH208
    assert refused == rounds * len(WRITERS), f"{refused} of {rounds * len(WRITERS)} writers complained"
    return f"{refused} files did not fit: each an error, the old file kept, nothing left behind"


def read_only_folder(rounds: int) -> str:
    """Writes into folders that may not be written, and reads robots with a cache that may not be."""
    refused = 0
    for _ in range(rounds):
        for place in _unwritable():
            for name, (write, _read) in WRITERS.items():
                try:
                    write(place / name, 1.0)
                except OSError as error:
                    refused += str(place) in str(error)
    assert refused == rounds * len(_unwritable()) * len(WRITERS), f"only {refused} writers named the folder"
    return f"{refused} writers refused by name"


def _unwritable() -> list[Path]:
    """Folders in which nobody creates files, not even root."""
    return [Path("/proc/self/fdinfo"), Path("/sys/kernel")]


def forks(count: int) -> str:
    """Forks in the middle of a batch; the child solves a batch of its own."""
    robot = bik.Robot.named("panda")
    targets = robot.fk(robot.random_configurations(3000, seed=2))
    right = bik.solve_batch(robot, targets, threads=2)
    for number in range(count):
        found: list[bik.BatchSolution] = []
        busy = threading.Thread(target=lambda into=found: into.append(bik.solve_batch(robot, targets, threads=2)))
        busy.start()
        time.sleep(random.Random(number).uniform(0.0, 0.02))
        child = os.fork()
        if child == 0:
            signal.alarm(120)
            same = bik.solve_batch(robot, targets[:50], threads=2).q.tobytes() == right.q[:50].tobytes()
            os._exit(0 if same else 1)
        _, status = os.waitpid(child, 0)
        busy.join()
        assert status == 0, f"the child of fork {number} ended with {status}"
        assert found[0].q.tobytes() == right.q.tobytes(), f"the batch of the parent differs after fork {number}"
    return f"{count} forks in the middle of a batch; every child and every parent had the same bits"


def subinterpreters(count: int) -> str:
    """Imports the library in sub-interpreters: it works, or refuses by an ImportError."""
    program = (
        "try:\n    import _interpreters as many\nexcept ImportError:\n    import _xxsubinterpreters as many\n"
        "import beetle_ik\n"
        f"for _ in range({count}):\n    one = many.create()\n"
        "    many.run_string(one, '''try:\n    import beetle_ik\n    print('works')\n"
        "except ImportError as error:\n    print('refuses:', error)''')\n"
        "    many.destroy(one)\n"
        "import beetle_ik as bik\nassert bik.solve(bik.Robot.named('panda'), (0.4, 0.1, 0.5)).success\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=300, check=False)
    told = set(done.stdout.splitlines())
    assert done.returncode == 0, f"ended with {done.returncode}: {done.stderr[-300:]}"
    assert len(told) == 1, f"answers differ: {told}"
    return f"{count} sub-interpreters, each {told.pop()}"


TRIALS = {
    "tracker": Trial("A tracker runs at 1 kHz without growing", "s", 3, 3600, tracker),
    "threads": Trial("Threads share robots and scenes, and get the same bits", "rounds", 3, 2000, threads),
    "rows": Trial("Batches of any length fit into memory by chunks", "rows", 20_000, 10_000_000, rows),
    "killed_writers": Trial("A file is whole or absent when its writer is killed", "kills", 16, 4000, killed_writers),
    "full_disk": Trial("A file that does not fit is an error, and the old one stays", "rounds", 3, 500, full_disk),
    "read_only": Trial("A folder that cannot be written is an error that names it", "rounds", 2, 50, read_only_folder),
    "forks": Trial("A fork in the middle of a batch leaves child and parent able to work", "forks", 2, 300, forks),
    "subinterpreters": Trial("A sub-interpreter works or refuses", "interpreters", 2, 20, subinterpreters),
}


def soak(names: list[str], *, amount: int | None, long: bool) -> int:
    """Runs trials, each in a process of its own; prints a row each, and returns how many failed."""
    failed = 0
    for name in names:
        trial = TRIALS[name]
        much = amount or (trial.long if long else trial.short)
        code = f"from campaign.soak import TRIALS; print(TRIALS[{name!r}].run({much}))"
        began = time.monotonic()
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        lines = (done.stdout if done.returncode == 0 else done.stderr).strip().splitlines()
        told = lines[-1] if lines else f"ended with code {done.returncode}"
        failed += done.returncode != 0
        verdict = "kept" if done.returncode == 0 else "BROKEN"
        cells = trial.promise, f"`{name}` {much:,} {trial.unit}", verdict, told, f"{time.monotonic() - began:.0f} s"
        print(f"| {' | '.join(cells)} |", flush=True)
    return failed
