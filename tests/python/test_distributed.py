"""Batches in chunks: the bits of one call, and stores that continue, refuse other jobs and keep finished chunks."""

import errno
import os
import shutil
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from mistakes import Case, Invalid, assert_told, told
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik
from beetle_ik import distributed
from beetle_ik.chunked.store import Layout, Store

PANDA, UR5 = bik.Robot.named("panda"), bik.Robot.named("ur5e")
POSES = PANDA.fk(PANDA.random_configurations(50, seed=3))
# Positions have no closed form: searched for, from random starts.
POSITIONS = np.vstack([POSES[:, :3, 3], [[0.0, 0.0, 5.0]]])
COLUMNS = [
    "q",
    "success",
    "status",
    "position_error",
    "rotation_error",
    "clearance",
    "iterations",
    "restarts",
    "evaluations",
]
PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])


@pytest.fixture
def store(tmp_path: Path) -> Path:
    pytest.importorskip("zarr", reason="stores need the extra 'distributed'")
    return tmp_path / "batch.zarr"


def columns(batch: bik.BatchSolution | distributed.BatchArrays) -> dict[str, bytes]:
    return {name: np.asarray(getattr(batch, name)[:]).tobytes() for name in COLUMNS}


def contents(folder: Path) -> dict[str, bytes]:
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()}


def written(folder: Path) -> dict[str, int]:
    """When each whole chunk was written; a worker may be writing another, whose file then goes by a passing name."""
    whole = [file for file in folder.rglob("c.*") if file.suffix != ".partial"]
    return {str(file.relative_to(folder)): file.stat().st_mtime_ns for file in whole}


def in_chunks(store: Path | None, **options: object) -> distributed.BatchArrays:
    return distributed.solve_batch(
        None, PANDA, POSITIONS, **{"store": store, "rows_per_chunk": 8, "seed": 4, **options}
    )


def after_chunks(count: int, exception: BaseException) -> Callable[[int, int], None]:
    """Progress that raises when so many chunks are done."""

    def progress(done: int, _total: int) -> None:
        if done == 8 * count:
            raise exception

    return progress


@pytest.mark.parametrize("rows_per_chunk", [1, 7, 50, 1000])
@pytest.mark.parametrize("targets", [POSES, POSITIONS], ids=["closed form", "search"])
def test_chunks_have_the_bits_of_one_batch(targets: np.ndarray, rows_per_chunk: int) -> None:
    whole = bik.solve_batch(PANDA, targets, seed=4)
    chunked = distributed.solve_batch(None, PANDA, targets, rows_per_chunk=rows_per_chunk, seed=4)
    assert columns(chunked) == columns(whole)
    assert chunked.message == whole.message
    assert len(chunked) == len(whole)


def test_a_part_of_a_batch_has_the_bits_of_the_whole() -> None:
    whole = bik.solve_batch(PANDA, POSITIONS, seed=4)
    part = bik.solve_batch(PANDA, POSITIONS[20:], first_row=20, seed=4)
    assert columns(part) == columns(whole[20:])


@pytest.mark.parametrize(
    "starts", [PANDA.clip(np.zeros(7)), PANDA.random_configurations(51, seed=1)], ids=["one", "each"]
)
def test_starts_go_with_their_targets(starts: np.ndarray) -> None:
    options = {"start_q": starts, "prefer": "nearest"}
    assert columns(in_chunks(None, **options)) == columns(bik.solve_batch(PANDA, POSITIONS, seed=4, **options))


def test_several_tips_have_errors_each(store: Path) -> None:
    poses = PAIR.fk(PAIR.random_configurations(6, seed=0))
    targets = {tip: poses[:, i] for i, tip in enumerate(PAIR.tips)}
    whole = bik.solve_batch(PAIR, targets)
    chunked = distributed.solve_batch(None, PAIR, targets, rows_per_chunk=4, store=store)
    assert columns(chunked) == columns(whole)
    assert list(chunked.errors) == list(whole.errors)
    for tip, errors in whole.errors.items():
        np.testing.assert_array_equal([part[:] for part in chunked.errors[tip]], errors)


def test_a_store_holds_what_memory_does(store: Path) -> None:
    stored = in_chunks(store)
    assert columns(stored) == columns(in_chunks(None))
    assert repr(stored) == f"<BatchArrays in {str(store)!r}: {stored.message}>"


def test_targets_are_read_from_a_zarr_array(store: Path) -> None:
    import zarr

    targets = zarr.create_array(store / "targets", shape=POSITIONS.shape, chunks=(8, 3), dtype="f8")
    targets[:] = POSITIONS
    assert columns(in_chunks(store / "results")) == columns(
        distributed.solve_batch(None, PANDA, targets, rows_per_chunk=8, seed=4)
    )


def test_a_store_that_a_worker_does_not_see_is_named(store: Path) -> None:
    with pytest.raises(FileNotFoundError) as caught:
        Store(store, Layout({}, (1,), (1,)))
    what = "no store here: the folder must be on a file system that all workers share, under the same path"
    assert (caught.value.strerror, caught.value.filename) == (what, str(store))


def test_no_targets_give_no_chunks(store: Path) -> None:
    for folder in (None, store):
        none = distributed.solve_batch(None, PANDA, np.zeros((0, 3)), store=folder)
        assert (len(none), none.q.shape, none.message) == (0, (0, 7), "no targets")


def test_a_finished_store_is_as_large_as_its_targets(store: Path) -> None:
    stored = distributed.solve_batch(None, PANDA, POSITIONS, store=store, seed=4)
    assert stored.q.chunks == (51, 7)


def test_progress_counts_targets() -> None:
    told_of: list[tuple[int, int]] = []
    in_chunks(None, progress=lambda done, total: told_of.append((done, total)))
    assert told_of == [(min(8 * i, 51), 51) for i in range(1, 8)]


@pytest.mark.parametrize("exception", [KeyboardInterrupt(), ValueError("enough")], ids=["Ctrl-C", "an error"])
def test_an_interrupted_store_goes_on(store: Path, exception: BaseException, tmp_path: Path) -> None:
    in_chunks(tmp_path / "whole")
    with pytest.raises(type(exception)):
        in_chunks(store, progress=after_chunks(3, exception))
    finished = written(store)
    assert len(finished) == 3 * (len(COLUMNS) + 1)
    in_chunks(store)
    assert {file: time for file, time in written(store).items() if file in finished} == finished
    assert contents(store) == contents(tmp_path / "whole")


def cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-20])


def flip(file: Path) -> None:
    content = bytearray(file.read_bytes())
    content[3] ^= 1
    file.write_bytes(content)


def take_that_of_another_chunk(file: Path) -> None:
    shutil.copy(file.with_name("c.5.0"), file)


@pytest.mark.parametrize("damage", [cut, flip, take_that_of_another_chunk, Path.unlink])
def test_a_half_written_chunk_is_computed_again(store: Path, damage: Callable[[Path], None]) -> None:
    in_chunks(store)
    whole, times = contents(store), written(store)
    damage(store / "q" / "c.2.0")
    in_chunks(store)
    assert contents(store) == whole
    changed = {file for file, time in written(store).items() if time != times[file]}
    assert {file.split(".")[1] for file in changed} == {"2"}


def test_files_of_killed_writers_are_removed(store: Path) -> None:
    in_chunks(store)
    whole = contents(store)
    (store / "q" / "c.3.1f2e.partial").write_bytes(b"half")
    in_chunks(store)
    assert contents(store) == whole


def test_a_store_killed_as_it_was_made_goes_on(store: Path) -> None:
    in_chunks(store)
    whole = contents(store)
    for killed_after in range(3):
        shutil.rmtree(store)
        store.mkdir()
        (store / "zarr.1f2e.partial").write_bytes(b"half")
        if killed_after > 0:
            (store / "zarr.json").write_bytes(whole["zarr.json"])
        if killed_after > 1:
            (store / "q").mkdir()
            (store / "q" / "zarr.json").write_bytes(whole["q/zarr.json"])
        in_chunks(store)
        assert contents(store) == whole


DIFFERENT: dict[str, tuple[dict[str, object], str]] = {
    "seed": ({"seed": 5}, "seed is 4 there and 5 here"),
    "tolerance": ({"position_tolerance": 1e-3}, "position_tolerance is 1e-06 there and 0.001 here"),
    "chunk": ({"rows_per_chunk": 9}, "rows_per_chunk is 8 there and 9 here"),
    "instructions": (
        {"any_instruction_set": True},
        f"instructions is '{bik._core._instructions}' there and 'any' here",
    ),
}


@pytest.mark.parametrize("name", DIFFERENT)
def test_a_store_of_another_job_is_refused(store: Path, name: str) -> None:
    in_chunks(store)
    whole = contents(store)
    options, difference = DIFFERENT[name]
    message = f"store: '{store}' holds another job: {difference}: give another folder"
    assert_told(lambda: in_chunks(store, **options), Invalid, message)
    assert contents(store) == whole


def test_a_store_of_another_robot_is_refused(store: Path) -> None:
    in_chunks(store)
    moved = PANDA.with_base(bik.pose((0, 0, 1)))
    for robot, name in ((UR5, "ur5e"), (moved, "panda")):
        difference = rf"robot is 'Robot panda [0-9a-f]+' there and 'Robot {name} [0-9a-f]+' here"
        with pytest.raises(Invalid, match=rf"holds another job: {difference}: give another folder$"):
            distributed.solve_batch(None, robot, POSITIONS, store=store, rows_per_chunk=8, seed=4)


def test_a_store_of_other_targets_is_refused(store: Path) -> None:
    in_chunks(store)
    whole = contents(store)
    targets = POSITIONS.copy()
    targets[20] += 0.001
    message = (
        f"store: rows 16 to 23 of the store '{store}' were computed from other targets or starts: give another folder"
    )
    assert_told(
        lambda: distributed.solve_batch(None, PANDA, targets, store=store, rows_per_chunk=8, seed=4), Invalid, message
    )
    assert contents(store) == whole


def test_a_store_of_another_version_is_refused(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    in_chunks(store)
    monkeypatch.setattr("beetle_ik.chunked.chunks.__version__", "9.9.9")
    difference = f"version is '{bik.__version__}' there and '9.9.9' here"
    message = f"store: '{store}' holds another job: {difference}: give another folder"
    assert_told(lambda: in_chunks(store), Invalid, message)


def test_a_folder_of_other_files_is_refused(store: Path) -> None:
    store.mkdir()
    (store / "thesis.txt").write_text("mine")
    message = f"store: folder '{store}' holds other files: thesis.txt: give another folder"
    assert_told(lambda: in_chunks(store), Invalid, message)
    assert contents(store) == {"thesis.txt": b"mine"}


@pytest.mark.parametrize(
    "text", ["{", "{}", '{"zarr_format": 3, "node_type": "group", "attributes": {"beetle_ik": 1}}']
)
def test_a_group_that_is_no_store_is_refused(store: Path, text: str) -> None:
    store.mkdir()
    (store / "zarr.json").write_text(text)
    message = f"store: folder '{store}' is not a store of beetle-ik: give another folder"
    assert_told(lambda: in_chunks(store), Invalid, message)
    assert contents(store) == {"zarr.json": text.encode()}


@pytest.mark.skipif(sys.platform == "win32", reason="Windows words these errors differently")
def test_a_folder_that_cannot_be_made_is_told(store: Path) -> None:
    store.write_text("a file")
    message = f"store: folder '{store}' cannot be written: File exists"
    assert_told(lambda: in_chunks(store), Invalid, message)
    message = f"store: folder '{store / 'inside'}' cannot be written: Not a directory"
    assert_told(lambda: in_chunks(store / "inside"), Invalid, message)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everywhere")
def test_a_read_only_folder_is_told(store: Path) -> None:
    store.mkdir(mode=0o500)
    message = f"store: folder '{store}' cannot be written: Permission denied"
    assert_told(lambda: in_chunks(store), Invalid, message)


@contextmanager
def files_of_at_most(size: int) -> Iterator[None]:
    """A disk that takes no larger files; a write beyond fails as on a full disk."""
    import resource

    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of file sizes on Windows")
def test_a_full_disk_is_told_and_nothing_lost(store: Path, tmp_path: Path) -> None:
    in_chunks(tmp_path / "whole", rows_per_chunk=20)
    with pytest.raises(ValueError, match="enough"):
        in_chunks(store, rows_per_chunk=20, progress=lambda *_: (_ for _ in ()).throw(ValueError("enough")))
    first = contents(store)
    with pytest.raises(OSError, match="chunk 1 of 3") as caught, files_of_at_most(1000):
        in_chunks(store, rows_per_chunk=20)
    advice = "the finished chunks are kept, and the same call goes on from them"
    what = f"{os.strerror(errno.EFBIG)}: chunk 1 of 3 cannot be written; {advice}"
    assert (caught.value.errno, caught.value.strerror, caught.value.filename) == (errno.EFBIG, what, str(store))
    assert contents(store) == first
    in_chunks(store, rows_per_chunk=20)
    assert contents(store) == contents(tmp_path / "whole")


@pytest.mark.parametrize(("module", "options"), [("zarr", {"store": "s"}), ("distributed", {"client": object()})])
def test_a_missing_extra_is_named(
    module: str, options: dict[str, object], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, module, None)
    needs = "store= needs zarr" if module == "zarr" else "client= needs dask"
    message = f"{needs}: pip install 'beetle-ik[distributed]'"
    assert_told(
        lambda: distributed.solve_batch(**{"client": None, "robot": PANDA, "targets": POSES, **options}),
        bik.BeetleIkError,
        message,
    )


MISTAKES: list[Case] = [
    (
        lambda: in_chunks("s3://bucket/s"),
        Invalid,
        "store must be a folder on a file system, got 's3://bucket/s': mount it",
    ),
    (lambda: in_chunks(3), Invalid, "store must be the path of a folder, got 3"),
    (
        lambda: in_chunks(None, rows_per_chunk=0),
        Invalid,
        "rows_per_chunk must be a whole number from 1 to 2^31 - 1, got 0",
    ),
    (lambda: in_chunks(None, any_instruction_set=1), Invalid, "any_instruction_set must be a bool, got 1"),
    (
        lambda: in_chunks(None, progress=3),
        Invalid,
        "progress must be True, False or a callable of (done, total), got 3",
    ),
    (lambda: in_chunks(None, start_q=np.zeros((3, 7))), Invalid, "start_q: expected 51 rows, one per target, got 3"),
    (lambda: in_chunks(None, threads=0), Invalid, "threads must be from 1 to 1024, got 0"),
    (lambda: in_chunks(None, position_tolerance=0), Invalid, "position_tolerance must be positive, got 0"),
    (
        lambda: distributed.solve_batch(None, PANDA, [0.4, 0.1, 0.5]),
        Invalid,
        "targets: expected poses (m, 4, 4) or positions (m, 3), got shape (3,)",
    ),
    (lambda: distributed.solve_batch(None, PANDA, None), Invalid, "targets must be an array of numbers, got None"),
    (
        lambda: distributed.solve_batch(None, PANDA, [*POSITIONS[:9], [np.inf, 0, 0]], rows_per_chunk=4),
        Invalid,
        "row 9: target must be finite, but coordinate x is inf",
    ),
    (
        lambda: distributed.solve_batch(None, PAIR, {"left_tool": POSITIONS, "right_tool": POSITIONS[:9]}),
        Invalid,
        "targets: expected 51 rows as for the first tip, got 9",
    ),
    (
        lambda: bik.solve_batch(PANDA, POSITIONS, first_row=2**63),
        Invalid,
        "first_row must be below 2^63, got 9223372036854776000",
    ),
]


@told(MISTAKES)
def test_mistakes_are_told(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)
