"""Maps and stores of another robot, mixed or truncated: refused by name, never loaded as a wrong map."""

import itertools
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beetle_ik as bik
from beetle_ik import distributed

COARSE: dict[str, Any] = {"voxel": 0.5, "directions": 4, "rolls": 1, "region": [[-0.4, -0.4, -0.4], [0.4, 0.4, 0.4]]}
QUARTER = np.pi / 2
DH: dict[str, Any] = {
    "a": [0, 0, -0.4, -0.4, 0, 0],
    "alpha": [0, QUARTER, 0, 0, QUARTER, -QUARTER],
    "d": [0.2, 0, 0, 0.1, 0.1, 0.1],
}
LIMITS = {"lower": -2.0, "upper": 2.0}


def arm(**changes: Any) -> bik.Robot:
    return bik.Robot.from_dh(**{**DH, **LIMITS, "name": "arm", **changes})


# Robots of one name, so that nothing but their content tells them apart.
ROBOTS: dict[str, Callable[[], bik.Robot]] = {
    "plain": arm,
    "limits": lambda: arm(upper=2.0 + 1e-9),
    "one limit": lambda: arm(lower=[-2.0, -2.0, -1.0, -2.0, -2.0, -2.0]),
    "base": lambda: arm().with_base(bik.pose((0, 0, 1e-6))),
    "tool": lambda: arm().with_tool(bik.pose((0, 0, 1e-6))),
    "length": lambda: arm(d=[0.2, 0, 0, 0.1, 0.1, 0.1 + 1e-9]),
    "bodies": lambda: arm().with_capsules(radius=0.01),
    "wider bodies": lambda: arm().with_capsules(radius=0.02),
}
STORED = ("plain", "limits", "base", "bodies")
PAIRS = list(itertools.permutations(ROBOTS, 2))


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("maps")
    for name, robot in ROBOTS.items():
        bik.reachability(robot(), **COARSE).to_npz(folder / f"{name}.npz")
    return {name: folder / f"{name}.npz" for name in ROBOTS}


@pytest.fixture(scope="module")
def stores(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    pytest.importorskip("zarr", reason="stores need the extra 'distributed'")
    folder = tmp_path_factory.mktemp("stores")
    for name in STORED:
        bik.reachability(ROBOTS[name](), **COARSE, store=folder / name)
    return {name: folder / name for name in STORED}


def refused(file: Path, **options: Any) -> str:
    with pytest.raises(bik.InvalidInputError) as told:
        bik.ReachabilityMap.load(file, **options)
    assert str(file) in str(told.value)
    return str(told.value).removeprefix(f"{file}: ")


@pytest.mark.parametrize(("mapped", "asked"), PAIRS)
def test_maps_of_another_robot_are_refused(files: dict[str, Path], mapped: str, asked: str) -> None:
    differ = "the map is of another robot 'arm': joints, limits, base, tool or bodies differ"
    assert refused(files[mapped], robot=ROBOTS[asked]()) == differ
    found = bik.ReachabilityMap.load(files[mapped], robot=ROBOTS[mapped]())
    with pytest.raises(bik.InvalidInputError, match="map is of another robot 'arm'"):
        bik.best_base(ROBOTS[asked](), [np.eye(4)], region=[[0, 0, 0], [0, 0, 0]], map=found)


@pytest.mark.parametrize("array", ["robot", "grid", "bits", "seal", ("robot", "grid"), ("bits", "seal")])
@pytest.mark.parametrize(("into", "source"), [("plain", "limits"), ("limits", "base"), ("tool", "plain")])
def test_arrays_of_another_map_are_refused(
    files: dict[str, Path], tmp_path: Path, array: str | tuple[str, ...], into: str, source: str
) -> None:
    arrays, others = dict(np.load(files[into])), dict(np.load(files[source]))
    names = [array] if isinstance(array, str) else array
    changed = {name: others[name] for name in names}
    file = tmp_path / "swapped.npz"
    np.savez(file, **{**arrays, **changed})
    same = all(np.array_equal(arrays[name], others[name]) for name in names)
    if same:
        assert bik.ReachabilityMap.load(file) == bik.ReachabilityMap.load(files[into])
    else:
        assert refused(file).startswith("damaged reachability map: ")


def test_bits_of_a_map_cannot_be_changed(files: dict[str, Path], tmp_path: Path) -> None:
    arrays = dict(np.load(files["plain"]))
    file = tmp_path / "changed.npz"
    for place in range(0, arrays["bits"].size, 3):
        changed = arrays["bits"].copy()
        changed.flat[place] ^= 1
        np.savez(file, **{**arrays, "bits": changed})
        assert refused(file) == "damaged reachability map: its arrays do not belong together"
    np.savez(file, **{**arrays, "manipulability": np.zeros(arrays["bits"].shape[:3], np.float32)})
    assert refused(file) == "damaged reachability map: its arrays do not belong together"


def test_a_cut_map_file_is_refused_at_any_length(files: dict[str, Path], tmp_path: Path) -> None:
    content = files["plain"].read_bytes()
    file = tmp_path / "cut.npz"
    for length in range(0, len(content), 37):
        file.write_bytes(content[:length])
        refused(file)


def test_maps_of_an_older_format_are_refused(files: dict[str, Path], tmp_path: Path) -> None:
    arrays = dict(np.load(files["plain"]))
    file = tmp_path / "old.npz"
    np.savez(file, **{**arrays, "reachability_map": np.array(1)})
    assert refused(file) == "a map of format 1; this library reads format 2: compute it again"


def test_stores_of_another_robot_are_refused(stores: dict[str, Path]) -> None:
    for mapped, asked in itertools.permutations(stores, 2):
        robot = ROBOTS[asked]()
        assert "the map is of another robot 'arm'" in refused(stores[mapped], robot=robot)
        with pytest.raises(bik.InvalidInputError, match="holds another job: robot is"):
            bik.reachability(robot, **COARSE, store=stores[mapped])
        assert bik.ReachabilityMap.load(stores[mapped], robot=ROBOTS[mapped]()) is not None


OTHER_JOBS: dict[str, dict[str, Any]] = {
    "obstacles": {"obstacles": [bik.obstacles.Sphere((0.2, 0.0, 0.0), 0.05)]},
    "margin": {"obstacles": [], "margin": 0.01},
    "self_collision": {"self_collision": False},
    "task": {"task": bik.tasks.Position()},
    "evaluations": {"evaluations": 100},
    "voxel": {"voxel": 0.45},
    "region": {"region": [[-0.4, -0.4, -0.4], [0.4, 0.4, 0.3]]},
    "quality": {"quality": True},
}


@pytest.mark.parametrize("name", OTHER_JOBS)
def test_a_store_of_another_job_is_refused(stores: dict[str, Path], name: str) -> None:
    with pytest.raises(bik.InvalidInputError, match=f"holds another job: .*{name} is "):
        bik.reachability(ROBOTS["bodies"](), **{**COARSE, **OTHER_JOBS[name]}, store=stores["bodies"])


def parts(store: Path) -> list[str]:
    return sorted(str(file.relative_to(store)) for file in store.rglob("*") if file.is_file())


def repaired(store: Path, whole: bik.ReachabilityMap) -> None:
    """A store with a foreign part is repaired by the call that made it, or refused; it never gives another map."""
    try:
        again = bik.reachability(arm(), **COARSE, store=store)
    except bik.InvalidInputError:
        return
    assert again == bik.ReachabilityMap.load(store) == whole


def test_parts_of_another_store_never_give_another_map(stores: dict[str, Path], tmp_path: Path) -> None:
    whole = bik.ReachabilityMap.load(stores["plain"])
    refusals = 0
    for other in ("limits", "base"):
        for part in parts(stores["plain"]):
            store = tmp_path / f"{other}-{part.replace('/', '-')}"
            shutil.copytree(stores["plain"], store)
            if (
                not (stores[other] / part).exists()
                or (store / part).read_bytes() == (stores[other] / part).read_bytes()
            ):
                continue
            shutil.copy(stores[other] / part, store / part)
            refused(store)
            refusals += 1
            repaired(store, whole)
    assert refusals > 5


def test_all_chunks_of_another_store_are_refused(stores: dict[str, Path], tmp_path: Path) -> None:
    for folders in (["bits"], ["chunks"], ["bits", "chunks"], ["robot"], ["grid"], ["robot", "grid"]):
        store = tmp_path / "-".join(folders)
        shutil.copytree(stores["plain"], store)
        for folder in folders:
            shutil.copytree(stores["limits"] / folder, store / folder, dirs_exist_ok=True)
        if parts(store) and all(
            (store / part).read_bytes() == (stores["plain"] / part).read_bytes() for part in parts(store)
        ):
            continue
        assert refused(store).startswith("damaged store: ")
        repaired(store, bik.ReachabilityMap.load(stores["plain"]))


def test_chunks_at_each_others_place_are_refused(stores: dict[str, Path], tmp_path: Path) -> None:
    store = tmp_path / "store"
    shutil.copytree(stores["plain"], store)
    numbered = sorted((store / "bits").glob("c.*"))
    hashes = sorted((store / "chunks").glob("c.*"))
    assert len(numbered) == len(hashes) > 1
    for files in (numbered, hashes):
        first, last = files[0].read_bytes(), files[-1].read_bytes()
        files[0].write_bytes(last)
        files[-1].write_bytes(first)
    assert refused(store).startswith("damaged store: chunk ")
    repaired(store, bik.ReachabilityMap.load(stores["plain"]))


def test_a_cut_or_missing_file_of_a_store_is_refused(stores: dict[str, Path], tmp_path: Path) -> None:
    whole = bik.ReachabilityMap.load(stores["plain"])
    for i, part in enumerate(parts(stores["plain"])):
        for keep in (None, 0, 1, 0.5):
            store = tmp_path / f"{i}-{keep}"
            shutil.copytree(stores["plain"], store)
            content = (store / part).read_bytes()
            if keep is None:
                (store / part).unlink()
            else:
                (store / part).write_bytes(content[: int(keep * len(content)) if keep < 1 else 1])
            refused(store)
            repaired(store, whole)


def test_arrays_of_another_size_are_refused(stores: dict[str, Path], tmp_path: Path) -> None:
    for name, place in itertools.product(("bits", "chunks"), range(2)):
        store = tmp_path / f"{name}{place}"
        shutil.copytree(stores["plain"], store)
        described = json.loads((store / name / "zarr.json").read_text())
        described["shape"][place] += 1
        (store / name / "zarr.json").write_text(json.dumps(described))
        refused(store)


def test_a_store_says_what_it_is_of(stores: dict[str, Path], tmp_path: Path) -> None:
    store = tmp_path / "store"
    shutil.copytree(stores["plain"], store)
    described = json.loads((store / "zarr.json").read_text())
    described["attributes"]["beetle_ik"]["margin"] = 0.5
    (store / "zarr.json").write_text(json.dumps(described))
    assert refused(store).startswith("damaged store: chunk 0 of ")
    described["attributes"]["beetle_ik"]["format"] = 1
    (store / "zarr.json").write_text(json.dumps(described))
    assert refused(store) == "a store of format 1; this library reads 2: compute it again"


def test_a_batch_goes_on_without_chunks_of_others(tmp_path: Path) -> None:
    pytest.importorskip("zarr", reason="stores need the extra 'distributed'")
    targets = arm().fk(arm().random_configurations(12, seed=1))[:, :3, 3]
    made = {
        name: distributed.solve_batch(None, ROBOTS[name](), targets, store=tmp_path / name, rows_per_chunk=4)
        for name in ("plain", "limits")
    }
    expected = np.array(made["plain"].q[:])
    shutil.copytree(tmp_path / "limits" / "q", tmp_path / "plain" / "q", dirs_exist_ok=True)
    shutil.copytree(tmp_path / "limits" / "chunks", tmp_path / "plain" / "chunks", dirs_exist_ok=True)
    again = distributed.solve_batch(None, arm(), targets, store=tmp_path / "plain", rows_per_chunk=4)
    np.testing.assert_array_equal(again.q[:], expected)
