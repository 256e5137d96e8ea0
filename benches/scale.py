"""Cost of chunks: poses a second and processor time with one and two worker processes, in memory and in a store.

Run it where nothing else runs: python benches/scale.py [--rows 500000] [--out DIR]
"""

import argparse
import csv
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from distributed import Client, LocalCluster

import beetle_ik as bik
from beetle_ik import distributed

CHUNKS = [2048, 32768]
TASKS = 1000
REPEATS = 2
COLUMNS = [
    "case",
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


def boxes() -> list[bik.obstacles.Box]:
    """Returns boxes around an arm."""
    rng = np.random.default_rng(0)
    return [bik.obstacles.Box(rng.uniform(-0.8, 0.8, 3), rng.uniform(0.05, 0.2, 3)) for _ in range(20)]


def cases(rows: int) -> Iterator[tuple[str, bik.Robot, np.ndarray, list[int], dict[str, Any]]]:
    """Yields name, robot, targets, rows of a chunk and options."""
    panda = bik.Robot.named("panda").with_capsules(radius=0.06)
    for name in ("ur5e", "panda"):
        robot = bik.Robot.named(name)
        yield name, robot, poses(robot, rows), CHUNKS, {}
    yield "panda, 20 boxes", panda, poses(panda, rows // 40), [rows // 400], {"obstacles": boxes()}


def measure(client: Client | None, workers: str, rows: int, store: Path, write: Callable[..., None]) -> None:
    """Solves batches in chunks of several lengths, in memory, into a store, and once more where it is finished."""
    for name, robot, targets, chunks, options in cases(rows):
        given = {**options, **({"threads": 1} if client is None else {})}
        solve = partial(distributed.solve_batch, client, robot, targets, **given)
        if client is None:
            whole = measured(None, len(targets), partial(bik.solve_batch, robot, targets, **given))
            write(name, workers, "one call", len(targets), *whole)
        for chunk in chunks:
            calls = {
                "memory": partial(solve, rows_per_chunk=chunk),
                "store": partial(into_new, solve, store, rows_per_chunk=chunk),
                "finished store": partial(solve, store=store, rows_per_chunk=chunk),
            }
            for what, call in calls.items():
                write(name, workers, what, chunk, *measured(client, len(targets), call))
        files = [file.stat().st_size for file in store.rglob("*") if file.is_file()]
        print(f"the store: {sum(files) / len(targets):.0f} bytes a row, {len(files)} files")


def into_new(solve: Callable[..., object], store: Path, **options: Any) -> None:
    """Solves into a store that is not there yet."""
    shutil.rmtree(store, ignore_errors=True)
    solve(store=store, **options)


def measure_tasks(client: Client, workers: str, write: Callable[..., None]) -> None:
    """Measures chunks of one target: what remains is the time of scheduler and client."""
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
    if arguments.out is not None:
        arguments.out.mkdir(parents=True, exist_ok=True)
    lines: list[list[object]] = [[*COLUMNS]]
    print(*COLUMNS, sep=", ")

    def write(*line: object) -> None:
        lines.append([f"{value:.4g}" if isinstance(value, float) else value for value in line])
        print(*lines[-1], sep=", ", flush=True)

    with tempfile.TemporaryDirectory() as folder:
        store = Path(folder) / "store"
        measure(None, "none", arguments.rows, store, write)
        for workers in (1, 2):
            cluster = LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=":0")
            with cluster, Client(cluster) as client:
                measure(client, str(workers), arguments.rows, store, write)
                measure_tasks(client, str(workers), write)
    if arguments.out is not None:
        with (arguments.out / "scale.csv").open("w", newline="") as file:
            csv.writer(file).writerows(lines)


if __name__ == "__main__":
    main()
