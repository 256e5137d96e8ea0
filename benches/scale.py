"""What chunks cost: poses a second with one and two worker processes, and the time of a store and of its check.

Run it where nothing else runs: python benches/scale.py [--rows 400000] [--out DIR]
"""

import argparse
import csv
import shutil
import statistics
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from distributed import Client, LocalCluster

import beetle_ik as bik
from beetle_ik import distributed

ROBOTS = ["ur5e", "panda"]
CHUNKS = [1024, 4096, 16384, 65536]
TASKS = 1000


def seconds(call: Callable[[], object], repeats: int = 3) -> float:
    """Returns the median time of a call."""
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        call()
        times.append(time.perf_counter() - began)
    return statistics.median(times)


def poses(robot: bik.Robot, rows: int) -> np.ndarray:
    """Returns poses that the robot reaches."""
    return np.asarray(robot.fk(robot.random_configurations(rows, seed=1)))


def size(folder: Path) -> int:
    """Returns the size of all files (bytes)."""
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())


def measure(client: Client | None, workers: str, name: str, rows: int, store: Path, write: Callable[..., None]) -> None:
    """Solves a batch in chunks of several lengths, in memory, into a store, and once more where it is finished."""
    robot = bik.Robot.named(name)
    targets = poses(robot, rows)
    threads = {"threads": 1} if client is None else {}

    def run(chunk: int, folder: Path | None, *, anew: bool = True) -> None:
        if anew:
            shutil.rmtree(store, ignore_errors=True)
        distributed.solve_batch(client, robot, targets, store=folder, rows_per_chunk=chunk, **threads)

    if client is None:
        write(name, workers, "one call", rows, rows / seconds(lambda: bik.solve_batch(robot, targets, threads=1)))
    for chunk in CHUNKS:
        write(name, workers, "memory", chunk, rows / seconds(partial(run, chunk, None)))
        write(name, workers, "store", chunk, rows / seconds(partial(run, chunk, store)), size(store) / rows)
        write(name, workers, "finished store", chunk, rows / seconds(partial(run, chunk, store, anew=False)))


def main() -> None:
    """Measures, prints, and writes scale.csv if asked to."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=400_000)
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    lines: list[list[object]] = [["robot", "workers", "results in", "rows per chunk", "rows a second", "bytes a row"]]

    def write(*line: object) -> None:
        lines.append([f"{value:.0f}" if isinstance(value, float) else value for value in line])
        print(*lines[-1], sep=", ", flush=True)

    with tempfile.TemporaryDirectory() as folder:
        store = Path(folder) / "store"
        for name in ROBOTS:
            measure(None, "none", name, arguments.rows, store, write)
        for workers in (1, 2):
            cluster = LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=":0")
            with cluster, Client(cluster) as client:
                for name in ROBOTS:
                    measure(client, str(workers), name, arguments.rows, store, write)
                measure_tasks(client, str(workers), write)
    if arguments.out is not None:
        with (arguments.out / "scale.csv").open("w", newline="") as file:
            csv.writer(file).writerows(lines)


def measure_tasks(client: Client, workers: str, write: Callable[..., None]) -> None:
    """Chunks of one target: what remains is the time of scheduler and client."""
    robot = bik.Robot.named("ur5e")
    targets = poses(robot, TASKS)
    spent = seconds(lambda: distributed.solve_batch(client, robot, targets, rows_per_chunk=1))
    write("ur5e", workers, "memory", 1, TASKS / spent)


if __name__ == "__main__":
    main()
