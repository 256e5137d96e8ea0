"""Octomaps: files of OctoMap, and the data of octomap messages.

A file is a header in text, then the nodes of an octree, each before its children, from the root, a cube of 2^16 voxels
with its middle at the origin:

    # Octomap OcTree binary file       (".bt"; ".ot": "# Octomap OcTree file")
    id OcTree
    size 3                             number of nodes
    res 0.05                           edge of a voxel (m)
    data

Binary (".bt"), an inner node is 16 bits, the lowest first: two for each child, 00 unknown, 10 free, 01 occupied, 11 an
inner node, which follows. Full (".ot"), a node is the log-odds of its occupancy (float32), its colour (3 bytes,
ColorOcTree only), and a bit for each child. Child number x + 2 y + 4 z is in the upper half along the axes that count.
Source: OctoMap 1.10, `OcTreeNode`, `OccupancyOcTreeBase::readBinaryNode`.

The tree becomes a `Grid`. This reader needs no other package, and takes the data of messages too.
"""

import os
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import obstacles
from .._core import InvalidInputError, Obstacle
from ..files.whole import content_of
from .frames import rigid

_DEPTH = 16  # levels below the root
_MOST_VOXELS = 2**28  # of a grid, a byte each
_KINDS = ("OcTree", "ColorOcTree")
_FIRST_LINES = {"# Octomap OcTree binary file": True, "# Octomap OcTree file": False}

Leaves = NDArray[np.int64]  # (k, 4): lowest voxel along x, y, z, from the lowest of the root, and voxels along an edge


class _Tree(NamedTuple):
    """A tree as it is stored."""

    binary: bool
    kind: str
    resolution: float
    data: bytes
    size: int | None  # number of nodes, if known


def read_octomap(
    file: str | os.PathLike[str], frame: ArrayLike | None, region: tuple[ArrayLike, ArrayLike] | None
) -> list[Obstacle]:
    """Reads the occupied voxels of a file as a list of one grid, or of none.

    Raises:
        InvalidInputError: not such a file; the message names it.
    """
    content, where = content_of(file), os.fspath(file)
    place, corners = np.eye(4) if frame is None else rigid(frame), _corners(region)
    return _grid(where, _tree(where, content), place, corners)


def octomap_message(where: str, message: Any, at: NDArray[np.float64]) -> list[Obstacle]:
    """Reads the occupied voxels of an `octomap_msgs/Octomap` as a mapping; `at` is the pose (4, 4) of its frame.

    Raises:
        InvalidInputError: not such a message; the message of the error begins with `where`.
    """
    try:
        data = bytes(int(number) % 256 for number in message["data"])
        tree = _Tree(bool(message["binary"]), str(message["id"]), float(message["resolution"]), data, None)
    except (LookupError, TypeError, ValueError) as error:
        cut = ": `ros2 topic echo --full-length` writes all of it" if "'...'" in repr(message)[-100_000:] else ""
        raise InvalidInputError(
            f"{where}: expected the fields binary, id, resolution and data (bytes), got {error!r:.60}{cut}"
        ) from error
    return _grid(where, tree, at, None)


def _tree(where: str, content: bytes) -> _Tree:
    """Splits a file into its header and the data of its nodes."""
    first, _, rest = content.partition(b"\n")
    line = first.decode("latin-1").strip()
    binary = _FIRST_LINES.get(line)
    if binary is None:
        known = " or ".join(f'"{known}"' for known in _FIRST_LINES)
        raise InvalidInputError(f"{where}: line 1: expected {known}, got {line!r:.60}: this is no .bt or .ot file")
    header: dict[str, str] = {}
    number = 1
    while True:
        number += 1
        if not rest:
            raise InvalidInputError(f'{where}: line {number}: expected "data" and the nodes, and the file ends')
        first, _, rest = rest.partition(b"\n")
        line = first.decode("latin-1").strip()
        if line == "data":
            break
        key, _, value = line.partition(" ")
        if line and not line.startswith("#"):
            if key not in ("id", "size", "res"):
                raise InvalidInputError(f"{where}: line {number}: expected id, size, res or data, got {line!r:.60}")
            header[key] = value.strip()
    for key, meaning in (("id", "kind of tree"), ("res", "edge of a voxel in m")):
        if key not in header:
            raise InvalidInputError(f'{where}: the header has no line "{key}" ({meaning})')
    try:
        resolution = float(header["res"])
    except ValueError:
        raise InvalidInputError(f"{where}: res must be a number (m), got {header['res']!r:.60}") from None
    size = header.get("size", "")
    if size and not (size.isascii() and size.isdigit() and len(size) < 16):
        raise InvalidInputError(f"{where}: size must be the number of nodes, got {size!r:.60}")
    nodes = int(size) if size else None
    return _Tree(binary, header["id"], resolution, b"" if nodes == 0 else rest, nodes)


def _leaves(where: str, tree: _Tree) -> Leaves:
    """Returns the occupied leaves."""
    if tree.kind not in _KINDS or (tree.binary and tree.kind != "OcTree"):
        known = "OcTree" if tree.binary else ", ".join(_KINDS)
        raise InvalidInputError(f"{where}: a tree of the kind {tree.kind!r:.60}; those that can be read: {known}")
    if not tree.data:
        return np.empty((0, 4), np.int64)
    try:
        if tree.binary:
            cubes, nodes = _binary_leaves(tree.data)
        else:
            cubes, nodes = _full_leaves(tree.data, 4 + 3 * (tree.kind == "ColorOcTree"))
    except IndexError:
        raise InvalidInputError(f"{where}: the nodes end early: the file is not complete") from None
    except _TooDeepError:
        raise InvalidInputError(f"{where}: nodes below the level of voxels: the data are damaged") from None
    if tree.size is not None and nodes != tree.size:
        raise InvalidInputError(f"{where}: {nodes} nodes, and the header counts {tree.size}: the data are damaged")
    return np.array(cubes, np.int64).reshape(-1, 4)


class _TooDeepError(Exception):
    """A node below the level of voxels."""


_Cube = tuple[int, int, int, int]  # lowest voxel along x, y, z, and voxels along an edge


def _children(cube: _Cube) -> list[tuple[int, _Cube]]:
    """Returns the number and the cube of each child, the last first, so that the first is on top of a stack."""
    x, y, z, size = cube
    half = size // 2
    if half == 0:
        raise _TooDeepError
    return [(i, (x + half * (i & 1), y + half * (i >> 1 & 1), z + half * (i >> 2), half)) for i in range(7, -1, -1)]


def _binary_leaves(data: bytes) -> tuple[list[_Cube], int]:
    """Returns the occupied leaves of a binary tree, and the number of its nodes."""
    at, nodes, leaves = 0, 1, []
    stack = [(0, 0, 0, 2**_DEPTH)]
    while stack:
        states = data[at] | data[at + 1] << 8
        at += 2
        for child, cube in _children(stack.pop()):
            state = states >> 2 * child & 3
            nodes += state != 0
            if state == 2:  # 01 with the lowest bit first
                leaves.append(cube)
            elif state == 3:
                stack.append(cube)
    return leaves, nodes


def _full_leaves(data: bytes, value_size: int) -> tuple[list[_Cube], int]:
    """Returns the occupied leaves of a full tree, and the number of its nodes."""
    at, nodes, leaves = 0, 0, []
    stack = [(0, 0, 0, 2**_DEPTH)]
    while stack:
        cube, children = stack.pop(), data[at + value_size]
        if children:
            stack += [inner for child, inner in _children(cube) if children >> child & 1]
        elif data[at + 3] < 128 or data[at : at + 4] == b"\0\0\0\x80":  # log-odds of at least 0: no sign, or -0
            leaves.append(cube)
        at += value_size + 1
        nodes += 1
    return leaves, nodes


def _grid(where: str, tree: _Tree, place: NDArray[np.float64], corners: NDArray[np.float64] | None) -> list[Obstacle]:
    """Returns the occupied voxels as a grid."""
    resolution = tree.resolution
    if not 0.0 < resolution < np.inf:
        raise InvalidInputError(f"{where}: the edge of a voxel must be positive and finite (m), got {resolution}")
    axes = _axes(where, place)
    leaves = _leaves(where, tree)
    low, high = leaves[:, :3], leaves[:, :3] + leaves[:, 3:]
    if corners is not None:
        with np.errstate(over="ignore"):
            bounds = np.clip(corners / resolution + 2 ** (_DEPTH - 1), 0, 2**_DEPTH)
        low, high = np.maximum(low, np.floor(bounds[0])), np.minimum(high, np.ceil(bounds[1]))
    meets = (low < high).all(axis=1)
    low, high = low[meets].astype(np.int64), high[meets].astype(np.int64)
    if len(low) == 0:
        return []
    first, last = low.min(axis=0), high.max(axis=0)
    counts = last - first
    if int(np.prod(counts.astype(float))) > _MOST_VOXELS:
        size = " x ".join(f"{edge:.4g}" for edge in counts * resolution)
        raise InvalidInputError(
            f"{where}: a map of {size} m has too many voxels of {resolution} m for a grid: "
            "give the part around the robot as region=(corner, corner)"
        )
    occupied = np.zeros(counts, bool)
    for (x, y, z), (to_x, to_y, to_z) in zip(low - first, high - first, strict=True):
        occupied[x:to_x, y:to_y, z:to_z] = True
    corner = (first - 2 ** (_DEPTH - 1)) * resolution
    return [_turned(corner, resolution, occupied, axes, place[:3, 3])]


def _turned(
    corner: NDArray[np.float64],
    resolution: float,
    occupied: NDArray[np.bool_],
    axes: NDArray[np.float64],
    origin: NDArray[np.float64],
) -> Obstacle:
    """Returns a grid turned by a matrix of zeros and ones, and moved."""
    order = [int(np.flatnonzero(row)[0]) for row in axes]  # axis of the map along each axis of the base
    signs = [axes[k, order[k]] for k in range(3)]
    turned = occupied.transpose(order)
    turned = turned[tuple(slice(None, None, 1 if sign > 0 else -1) for sign in signs)]
    far = corner + resolution * np.array(occupied.shape)
    lowest = np.minimum(axes @ corner, axes @ far)
    return obstacles.Grid(lowest + origin, resolution, np.ascontiguousarray(turned))


def _axes(where: str, place: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the rotation of a pose, made of zeros and ones."""
    axes: NDArray[np.float64] = np.round(place[:3, :3])
    if np.abs(axes - place[:3, :3]).max() > 1e-6:
        raise InvalidInputError(
            f"{where}: frame turns the map, and the voxels of a Grid lie along the axes of the base: "
            "put the robot into the frame of the map by robot.with_base(np.linalg.inv(frame))"
        )
    return axes


def _corners(region: tuple[ArrayLike, ArrayLike] | None) -> NDArray[np.float64] | None:
    if region is None:
        return None
    try:
        corners = np.array(region, dtype=float)
    except (TypeError, ValueError):
        corners = np.empty(0)
    if corners.shape != (2, 3) or not np.isfinite(corners).all():
        raise InvalidInputError(f"region must be two corners (3,) (m), got {region!r:.60}")
    return np.sort(corners, axis=0)
