"""What chunks cost: poses a second and processor time with one and two worker processes, in memory and in a store.

Run it where nothing else runs: python benches/scale.py [--rows 500000] [--out DIR]
"""

import argparse
import csv
import shutil
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
CHUNKS = [2048, 8192, 32768]
TASKS = 1000
REPEATS = 3
COLUMNS = [
    "robot",
    "workers",
    "results in",
    "rows per chunk",
    "rows a second",
    "us of workers a row",
    "us of client a row",
]


def poses(robot: bik.Robot, rows: int) -> np.ndarray:
    """Returns poses that the robot reaches."""
    return np.asarray(robot.fk(robot.random_configurations(rows, seed=1)))


def measured(client: Client | None, rows: int, call: Callable[[], object]) -> list[float]:
    """Returns rows a second, and processor time of the workers and of this process, with the scheduler (us a row)."""

    def of_workers() -> float:
        return 0.0 if client is None else sum(client.run(time.process_time).values())

    results = []
    for _ in range(REPEATS):
        began, workers, here = time.perf_counter(), of_workers(), time.process_time()
        call()
        here, spent = time.process_time() - here, time.perf_counter() - began
        results.append([rows / spent, 1e6 * (of_workers() - workers) / rows, 1e6 * here / rows])
    return [max(column) if i == 0 else min(column) for i, column in enumerate(zip(*results, strict=True))]


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
        write(
            name, workers, "one call", rows, *measured(None, rows, partial(bik.solve_batch, robot, targets, threads=1))
        )
    for chunk in CHUNKS:
        write(name, workers, "memory", chunk, *measured(client, rows, partial(run, chunk, None)))
        write(name, workers, "store", chunk, *measured(client, rows, partial(run, chunk, store)))
        write(name, workers, "finished store", chunk, *measured(client, rows, partial(run, chunk, store, anew=False)))
    files = [file.stat().st_size for file in store.rglob("*") if file.is_file()]
    print(f"the store of {rows} rows: {sum(files) / rows:.0f} bytes a row, {len(files)} files")


def measure_tasks(client: Client, workers: str, write: Callable[..., None]) -> None:
    """Chunks of one target: what remains is the time of scheduler and client."""
    robot = bik.Robot.named("ur5e")
    targets = poses(robot, TASKS)
    solve = partial(distributed.solve_batch, client, robot, targets, rows_per_chunk=1)
    write("ur5e", workers, "memory", 1, *measured(client, TASKS, solve))


def main() -> None:
    """Measures, prints, and writes scale.csv if asked to."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=500_000)
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    lines: list[list[object]] = [[*COLUMNS]]
    print(*COLUMNS, sep=", ")

    def write(*line: object) -> None:
        lines.append([f"{value:.4g}" if isinstance(value, float) else value for value in line])
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


if __name__ == "__main__":
    main()
