"""Maps in chunks: the bits of one call, stores that continue and load, and equal bytes from two workers."""

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mistakes import Invalid, assert_told
from test_distributed import contents, written
from typer.testing import CliRunner

import beetle_ik as bik
from beetle_ik import distributed
from beetle_ik.cli.app import app

UR5 = bik.Robot.named("ur5e").with_capsules(radius=0.05)
BOX = bik.obstacles.Box((0.4, 0.0, 0.3), size=(0.2, 0.2, 0.2))
COARSE = {"voxel": 0.25, "directions": 6, "rolls": 2}
CASES = {"layers": COARSE, "blocks": {**COARSE, "obstacles": [BOX], "quality": True}}


@pytest.fixture
def store(tmp_path: Path) -> Path:
    pytest.importorskip("zarr", reason="stores need the extra 'distributed'")
    return tmp_path / "map.zarr"


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    dask = pytest.importorskip("distributed", reason="workers need the extra 'distributed'")
    workers = dask.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0")
    with workers as cluster, dask.Client(cluster) as client:
        yield client


@pytest.mark.parametrize("case", CASES)
def test_a_store_holds_the_map(store: Path, case: str) -> None:
    found = bik.reachability(UR5, **CASES[case])
    assert bik.reachability(UR5, **CASES[case], store=store) == found
    assert bik.ReachabilityMap.load(store, robot=UR5) == found


@pytest.mark.parametrize("case", CASES)
@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL does not exist on Windows")
def test_two_workers_write_the_bytes_of_one_process(client: Any, store: Path, tmp_path: Path, case: str) -> None:
    bik.reachability(UR5, **CASES[case], store=tmp_path / "here")
    killed = []

    def kill_one(_done: int, _total: int) -> None:
        if not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    distributed.reachability(client, UR5, **CASES[case], store=store, progress=kill_one)
    assert killed
    assert contents(store) == contents(tmp_path / "here")


def test_workers_give_a_map_without_a_store(client: Any) -> None:
    assert distributed.reachability(client, UR5, **COARSE) == bik.reachability(UR5, **COARSE)


def test_an_interrupted_map_goes_on(store: Path, tmp_path: Path) -> None:
    bik.reachability(UR5, **COARSE, store=tmp_path / "whole")
    told_of: list[tuple[int, int]] = []

    def progress(done: int, total: int) -> None:
        told_of.append((done, total))
        if len(told_of) == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        bik.reachability(UR5, **COARSE, store=store, progress=progress)
    x, y, z = bik.ReachabilityMap.load(tmp_path / "whole").shape
    assert told_of == [(x * y, x * y * z), (2 * x * y, x * y * z)]
    message = f"{store}: 2 of {z} chunks are done: the call that began the store goes on"
    assert_told(lambda: bik.ReachabilityMap.load(store), Invalid, message)
    finished = written(store)
    bik.reachability(UR5, **COARSE, store=store)
    assert {file: time for file, time in written(store).items() if file in finished} == finished
    assert contents(store) == contents(tmp_path / "whole")


def test_a_store_of_another_map_is_refused(store: Path) -> None:
    bik.reachability(UR5, **COARSE, store=store)
    difference = "directions is 6 there and 7 here"
    message = f"store: '{store}' holds another job: {difference}: give another folder"
    assert_told(lambda: bik.reachability(UR5, **{**COARSE, "directions": 7}, store=store), Invalid, message)
    panda = bik.Robot.named("panda")
    message = f"{store}: the map is of robot 'ur5e', not of 'panda'"
    assert_told(lambda: bik.ReachabilityMap.load(store, robot=panda), Invalid, message)


def test_a_store_of_a_batch_is_no_map(store: Path) -> None:
    distributed.solve_batch(None, UR5, np.zeros((1, 3)), store=store)
    assert_told(lambda: bik.ReachabilityMap.load(store), Invalid, f"{store}: not a store of reachability")


def test_a_damaged_store_is_not_loaded(store: Path) -> None:
    found = bik.reachability(UR5, **COARSE, store=store)
    chunk = store / "bits" / "c.0.0.1.0"
    content = bytearray(chunk.read_bytes())
    content[0] ^= 1
    chunk.write_bytes(content)
    with pytest.raises(Invalid, match=r"map.zarr: damaged store: .*; the call that made it repairs it$"):
        bik.ReachabilityMap.load(store)
    assert bik.reachability(UR5, **COARSE, store=store) == found
    assert bik.ReachabilityMap.load(store) == found


def test_the_command_line_computes_into_a_store(store: Path) -> None:
    command = ["reach", "ur5e", "--voxel", "0.25", "--directions", "6", "--rolls", "2", "--store", str(store)]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.output
    arm = bik.Robot.named("ur5e")
    assert bik.ReachabilityMap.load(store, robot=arm) == bik.reachability(arm, **COARSE)
