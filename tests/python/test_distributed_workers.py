"""Batches on two worker processes: the bytes of one process, even if a worker, client or scheduler is killed."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_distributed import PANDA, POSITIONS, columns, contents, in_chunks, written

import beetle_ik as bik
from beetle_ik import distributed

dask = pytest.importorskip("distributed", reason="workers need the extra 'distributed'")
pytest.importorskip("zarr", reason="stores need the extra 'distributed'")
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL does not exist on Windows")


def cluster_of(workers: int) -> Any:
    return dask.LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=":0")


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    with cluster_of(2) as cluster:
        yield cluster


@pytest.fixture
def client(cluster: Any) -> Iterator[Any]:
    with dask.Client(cluster) as client:
        client.wait_for_workers(2)
        yield client


def on(client: Any, store: Path | None, **options: Any) -> distributed.BatchArrays:
    return distributed.solve_batch(client, PANDA, POSITIONS, store=store, rows_per_chunk=8, seed=4, **options)


# Each chunk takes long enough to be killed in: the target above cannot be reached, and the search goes on.
SLOW = {"stop": bik.Stop(max_evaluations=40_000, max_iterations=10**9)}
OUT_OF_REACH = np.full((12, 3), [0.0, 0.0, 0.1])


def slow_batch(client: Any, store: Path, **options: Any) -> distributed.BatchArrays:
    return distributed.solve_batch(client, PANDA, OUT_OF_REACH, store=store, rows_per_chunk=1, **SLOW, **options)


def test_two_workers_write_the_bytes_of_one_process(client: Any, tmp_path: Path) -> None:
    in_chunks(tmp_path / "here")
    stored = on(client, tmp_path / "there")
    assert contents(tmp_path / "there") == contents(tmp_path / "here")
    assert columns(on(client, None)) == columns(stored) == columns(bik.solve_batch(PANDA, POSITIONS, seed=4))


def test_a_worker_reads_its_rows_of_a_zarr_array(client: Any, tmp_path: Path) -> None:
    import zarr

    targets = zarr.create_array(tmp_path / "targets", shape=POSITIONS.shape, chunks=(8, 3), dtype="f8")
    targets[:] = POSITIONS
    found = distributed.solve_batch(client, PANDA, targets, rows_per_chunk=8, seed=4)
    assert columns(found) == columns(bik.solve_batch(PANDA, POSITIONS, seed=4))


def test_what_a_worker_does_not_see_is_named(client: Any, tmp_path: Path) -> None:
    import zarr

    targets = zarr.create_array(tmp_path / "targets", shape=POSITIONS.shape, chunks=(8, 3), dtype="f8")
    shared = "on a file system that all workers share, under the same path"

    def hide(_done: int, _total: int) -> None:
        if not (tmp_path / "hidden").exists():
            (tmp_path / "targets").rename(tmp_path / "hidden")

    with pytest.raises(FileNotFoundError, match=rf"no array of zarr here: it must be {shared}: 'file://.*/targets'"):
        distributed.solve_batch(client, PANDA, targets, rows_per_chunk=1, on_invalid="skip", progress=hide)


def test_a_killed_worker_changes_nothing(client: Any, tmp_path: Path) -> None:
    slow_batch(None, tmp_path / "here")
    killed = []

    def kill_one(_done: int, _total: int) -> None:
        if not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    slow_batch(client, tmp_path / "there", progress=kill_one)
    assert killed
    assert contents(tmp_path / "there") == contents(tmp_path / "here")


def test_a_killed_client_goes_on_where_it_was(cluster: Any, client: Any, tmp_path: Path) -> None:
    program = (
        "import sys, distributed as dask, numpy as np\n"
        "sys.path.insert(0, sys.argv[1])\n"
        "from test_distributed_workers import slow_batch\n"
        "from pathlib import Path\n"
        "def tell(done, total):\n"
        "    if done == 3:\n"
        "        print('three', flush=True)\n"
        "        sys.stdin.read()\n"
        "with dask.Client(sys.argv[2]) as client: slow_batch(client, Path(sys.argv[3]), progress=tell)\n"
    )
    store = tmp_path / "there"
    command = [sys.executable, "-c", program, str(Path(__file__).parent), cluster.scheduler_address, str(store)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"three\n"
        other.kill()
    finished = {file: time for file, time in written(store).items() if file.startswith("chunks")}
    assert 3 <= len(finished) < 12
    slow_batch(client, store)
    assert {file: time for file, time in written(store).items() if file in finished} == finished
    slow_batch(None, tmp_path / "here")
    assert contents(store) == contents(tmp_path / "here")


def test_a_lost_scheduler_is_told_and_a_new_one_goes_on(client: Any, tmp_path: Path) -> None:
    slow_batch(client, tmp_path / "here")
    store = tmp_path / "there"
    with cluster_of(1) as short_lived, dask.Client(short_lived) as other:
        with pytest.raises(bik.BeetleIkError) as caught:
            slow_batch(other, store, progress=lambda *_: short_lived.close())
        lost = "the connection to the scheduler is lost after 1 of 12 chunks"
        assert str(caught.value) == f"{lost}: the same call with a new client goes on"
    slow_batch(client, store)
    assert contents(store) == contents(tmp_path / "here")


def test_a_worker_of_another_version_is_refused(client: Any) -> None:
    worker = next(iter(client.scheduler_info()["workers"]))

    def pretend(name: str, value: str) -> None:
        from beetle_ik.chunked import chunks

        setattr(chunks, name, value)

    client.run(pretend, "__version__", "9.9.9", workers=[worker])
    with pytest.raises(bik.BeetleIkError) as caught:
        on(client, None)
    difference = f"worker {worker} has beetle-ik 9.9.9, the client {bik.__version__}"
    assert str(caught.value) == f"{difference}: install one version everywhere"
    client.run(pretend, "__version__", bik.__version__, workers=[worker])

    client.run(pretend, "_instructions", "abacus", workers=[worker])
    with pytest.raises(bik.BeetleIkError) as caught:
        on(client, None)
    difference = f"worker {worker} computes with abacus instructions, the client with {bik._core._instructions}"
    advice = "the last bits of results would differ; any_instruction_set=True allows it"
    assert str(caught.value) == f"{difference}: {advice}"
    assert columns(on(client, None, any_instruction_set=True)) == columns(in_chunks(None))
    client.run(pretend, "_instructions", bik._core._instructions, workers=[worker])


def test_an_invalid_row_is_named_from_the_first_one(client: Any) -> None:
    targets = [*POSITIONS[:9], [np.inf, 0, 0]]
    with pytest.raises(bik.InvalidInputError, match=r"^row 9: target must be finite, but coordinate x is inf$"):
        distributed.solve_batch(client, PANDA, targets, rows_per_chunk=4)


def test_an_error_of_writing_names_the_store(client: Any, tmp_path: Path) -> None:
    def limit(size: int) -> None:
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))

    client.run(limit, 300)
    with pytest.raises(OSError, match=r"chunk \d of 7 cannot be written; the finished chunks are kept"):
        on(client, tmp_path / "there")
    client.run(limit, -1)
    on(client, tmp_path / "there")
    in_chunks(tmp_path / "here")
    assert contents(tmp_path / "there") == contents(tmp_path / "here")


def test_wrong_clients_are_refused(client: Any) -> None:
    with pytest.raises(bik.InvalidInputError, match=r"^client must be a distributed.Client, .*, got 'tcp://cluster'$"):
        distributed.solve_batch("tcp://cluster", PANDA, POSITIONS)
    with pytest.raises(bik.InvalidInputError, match=r"^threads must be None with a client, .*, got 2$"):
        on(client, None, threads=2)
