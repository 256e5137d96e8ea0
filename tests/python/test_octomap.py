"""Octomaps: trees encoded here, and files of the tools of OctoMap."""

import os
import re
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest

import beetle_ik as bik

BINARY, FULL = b"# Octomap OcTree binary file\n", b"# Octomap OcTree file\n"
# A tree as nested lists: None unknown, False free, True occupied, a list of eight an inner node.
Tree = bool | None | list["Tree"]


def header(first: bytes, size: int, kind: str = "OcTree", resolution: float = 0.1) -> bytes:
    return first + b"# a comment\n#\n" + f"id {kind}\nsize {size}\nres {resolution}\ndata\n".encode()


def count(tree: Tree) -> int:
    return 0 if tree is None else 1 + (sum(map(count, tree)) if isinstance(tree, list) else 0)


def binary(tree: list[Tree]) -> bytes:
    """The bits of a tree, written by recursion: the word of a node, then its inner children."""
    codes = {None: "00", False: "01", True: "10"}  # the second bit of a pair first
    bits = "".join(codes[child] if child in (None, False, True) else "11" for child in reversed(tree))
    inner = [child for child in tree if isinstance(child, list)]
    return struct.pack("<H", int(bits, 2)) + b"".join(map(binary, inner))


def full(tree: Tree, colour: bytes = b"") -> bytes:
    """The nodes of a tree with log-odds."""
    children = tree if isinstance(tree, list) else []
    mask = sum(1 << i for i, child in enumerate(children) if child is not None)
    value = -0.4 if tree is False else 0.85
    nodes = b"".join(full(child, colour) for child in children if child is not None)
    return struct.pack("<f", value) + colour + bytes([mask]) + nodes


def within(tree: Tree, levels: int) -> list[Tree]:
    """Puts a tree this many levels down, towards the voxels above the origin."""
    node: Tree = tree
    for level in range(levels):
        children: list[Tree] = [None] * 8
        children[7 if level == levels - 1 else 0] = node
        node = children
    assert isinstance(node, list)
    return node


def random_tree(rng: np.random.Generator, depth: int) -> Tree:
    kind = rng.integers(0, 5)
    if depth == 0 or kind < 3:
        return [None, False, True][kind % 3]
    return [random_tree(rng, depth - 1) for _ in range(8)]


def voxels(tree: Tree, size: int) -> np.ndarray:
    """Which voxels of a cube are occupied."""
    if not isinstance(tree, list):
        return np.full((size, size, size), tree is True)
    whole, half = np.empty((size, size, size), bool), size // 2
    for i, child in enumerate(tree):
        x, y, z = half * (i & 1), half * (i >> 1 & 1), half * (i >> 2)
        whole[x : x + half, y : y + half, z : z + half] = voxels(child, half)
    return whole


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "map.bt"


def placed(grid: bik.obstacles.Grid, size: int) -> np.ndarray:
    """The voxels of a grid in a cube from the origin."""
    whole = np.zeros((size, size, size), bool)
    low = np.round(grid.origin / grid.voxel).astype(int)
    high = low + grid.occupied.shape
    whole[low[0] : high[0], low[1] : high[1], low[2] : high[2]] = grid.occupied
    return whole


def test_trees_of_all_forms_are_read(file: Path) -> None:
    rng = np.random.default_rng(1)
    read = 0
    for _ in range(60):
        tree = random_tree(rng, 3)
        if not isinstance(tree, list) or not voxels(tree, 8).any():
            continue
        whole, colour = within(tree, 13), bytes([1, 2, 3])
        for content in (
            header(BINARY, count(whole)) + binary(whole),
            header(FULL, count(whole)) + full(whole),
            header(FULL, count(whole), "ColorOcTree") + full(whole, colour),
        ):
            file.write_bytes(content)
            (grid,) = bik.Scene.from_octomap(file)
            assert grid.voxel == 0.1
            np.testing.assert_array_equal(placed(grid, 8), voxels(tree, 8))
            read += 1
    assert read > 30


def test_turned_maps_are_placed(file: Path) -> None:
    rng = np.random.default_rng(2)
    tree = [random_tree(rng, 2) for _ in range(7)] + [True]
    whole = within(tree, 13)
    file.write_bytes(header(BINARY, count(whole)) + binary(whole))
    (grid,) = bik.Scene.from_octomap(file)
    centres = grid.origin + grid.voxel * (np.argwhere(grid.occupied) + 0.5)
    for rpy in [(0, 0, 0), (0, 0, 90), (0, 90, 0), (90, 0, 180), (180, 0, 270), (90, 90, 0)]:
        frame = bik.pose([0.3, -0.2, 1.0], rpy=np.radians(rpy))
        (turned,) = bik.Scene.from_octomap(file, frame=frame)
        expected = centres @ frame[:3, :3].T + frame[:3, 3]
        found = turned.origin + turned.voxel * (np.argwhere(turned.occupied) + 0.5)
        np.testing.assert_allclose(sorted(found.round(6).tolist()), sorted(expected.round(6).tolist()), atol=1e-9)
    with pytest.raises(bik.InvalidInputError, match=r"map\.bt: frame turns the map"):
        bik.Scene.from_octomap(file, frame=bik.pose([0, 0, 0], rpy=[0, 0, 0.3]))


def test_a_region_is_cut_out(file: Path) -> None:
    whole = within([True] * 8, 4)  # cubes of 2^11 voxels: 8 * 10^9 in each
    file.write_bytes(header(BINARY, count(whole)) + binary(whole))
    with pytest.raises(bik.InvalidInputError, match=r"region=\(corner, corner\)"):
        bik.Scene.from_octomap(file)
    (grid,) = bik.Scene.from_octomap(file, region=((0.95, 1.0, 1.0), (0.0, 0.5, -3.0)))
    np.testing.assert_allclose(grid.origin, [0, 0.5, 0], atol=1e-12)
    assert grid.occupied.shape == (10, 5, 10)
    assert grid.occupied.all()
    assert list(bik.Scene.from_octomap(file, region=((-2, -2, -2), (-1, -1, -1)))) == []
    with pytest.raises(bik.InvalidInputError, match=r"region must be two corners \(3,\) \(m\), got 1"):
        bik.Scene.from_octomap(file, region=1)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"", 'line 1: expected "# Octomap OcTree binary file" or "# Octomap OcTree file", got \'\': this is no .bt'),
        (BINARY, 'line 2: expected "data" and the nodes, and the file ends'),
        (BINARY + b"size 1\nres 0.1\ndata\n", 'the header has no line "id" (kind of tree)'),
        (BINARY + b"id OcTree\ndata\n", 'the header has no line "res" (edge of a voxel in m)'),
        (BINARY + b"id OcTree\nres x\ndata\n", "res must be a number (m), got 'x'"),
        (BINARY + b"id OcTree\nres 0\ndata\n", "the edge of a voxel must be positive and finite (m), got 0.0"),
        (BINARY + b"id OcTree\nsize x\nres 1\ndata\n", "size must be the number of nodes, got 'x'"),
        (BINARY + b"what\n", "line 2: expected id, size, res or data, got 'what'"),
        (
            header(BINARY, 1, "ColorOcTree") + b"\0\0",
            "a tree of the kind 'ColorOcTree'; those that can be read: OcTree",
        ),
        (
            header(FULL, 1, "Stamped") + b"\0",
            "a tree of the kind 'Stamped'; those that can be read: OcTree, ColorOcTree",
        ),
        (header(BINARY, 9) + b"\x02", "the nodes end early: the file is not complete"),
        (header(BINARY, 9) + b"\x02\0", "2 nodes, and the header counts 9: the data are damaged"),
        (header(BINARY, 99) + b"\x03\0" * 40, "nodes below the level of voxels: the data are damaged"),
    ],
)
def test_damaged_files_are_refused_by_name(file: Path, content: bytes, problem: str) -> None:
    file.write_bytes(content)
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.Scene.from_octomap(file)
    assert str(caught.value).startswith(f"{file}: {problem}")


def test_maps_without_occupied_voxels_are_empty(file: Path) -> None:
    for content in (header(BINARY, 0), header(BINARY, 9) + b"\x55\x55", header(FULL, 0)):
        file.write_bytes(content)
        assert list(bik.Scene.from_octomap(file)) == []


def binvox(occupied: np.ndarray) -> bytes:
    """A file of the program binvox: runs of equal voxels, y fastest, then z, then x."""
    n = len(occupied)
    flat = occupied.transpose(0, 2, 1).ravel()
    head = f"#binvox 1\ndim {n} {n} {n}\ntranslate 0 0 0\nscale {0.05 * n}\ndata\n".encode()
    return head + b"".join(bytes([int(voxel), 1]) for voxel in flat)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.98])
def test_files_of_the_octomap_tools_are_read(tmp_path: Path, share: float) -> None:
    cmeel = pytest.importorskip("cmeel")
    place = Path(cmeel.__file__).parents[1] / "cmeel.prefix"
    if not (place / "bin" / "binvox2bt").exists():
        pytest.skip("the tools of OctoMap are not installed")
    environment = {**os.environ, "LD_LIBRARY_PATH": str(place / "lib")}

    def run(tool: str, *arguments: str) -> None:
        subprocess.run(
            [place / "bin" / tool, *arguments], cwd=tmp_path, env=environment, check=True, capture_output=True
        )

    occupied = np.random.default_rng(3).random((16, 16, 16)) < share
    (tmp_path / "a.binvox").write_bytes(binvox(occupied))
    run("binvox2bt", "--mark-free", "-o", "a.bt", "a.binvox")
    run("convert_octree", "a.bt", "a.ot")
    run("bt2vrml", "a.bt")
    cubes = re.findall(r"translation (\S+) (\S+) (\S+)\s+children[^}]*size (\S+)", (tmp_path / "a.bt.wrl").read_text())
    drawn = np.zeros_like(occupied)
    for x, y, z, size in np.array(cubes, float):
        low = np.round((np.array([x, y, z]) - size / 2) / 0.05).astype(int)
        high = low + round(size / 0.05)
        drawn[low[0] : high[0], low[1] : high[1], low[2] : high[2]] = True
    for name in ("a.bt", "a.ot"):
        (grid,) = bik.Scene.from_octomap(tmp_path / name)
        assert grid.voxel == 0.05
        np.testing.assert_array_equal(placed(grid, 16), drawn)
    assert drawn.sum() == occupied.sum()
