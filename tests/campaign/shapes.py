"""Obstacles as plain data, for the library and for coal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import coal
import numpy as np

import beetle_ik as bik

from . import arms

Shape = dict[str, Any]
Placed = tuple[Any, coal.Transform3s]

CONVEX = ("sphere", "box", "capsule", "cylinder", "ellipsoid", "hull")
KINDS = (*CONVEX, "box_mesh", "soup", "cloud", "grid")
SQUARES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))  # of a box
SOUP = ((0, 1, 2), (3, 5, 6), (4, 1, 7))  # triangles of three corners of a hull each
OCCUPIED = np.array([[[True, False], [False, True]], [[False, False], [True, True]]])
REQUEST = coal.DistanceRequest()
REQUEST.gjk_tolerance = 1e-9  # the default gives errors above 1e-6


def shape(random: np.random.Generator, center: Any, extent: float, hard: bool, kinds: Sequence[str] = KINDS) -> Shape:
    """Draws a shape about a place; a hard one is thin, tiny, huge, or not turned."""
    size = extent * random.uniform(0.1, 1.0, 3)
    if hard and random.random() < 0.6:
        size[random.integers(3)] *= 10.0 ** random.uniform(-4, 1)
    rpy = (0.0, 0.0, 0.0) if hard and random.random() < 0.3 else arms.triple(random.uniform(-3, 3, 3))
    kind = str(random.choice(kinds))
    drawn = {
        "kind": kind,
        "center": arms.triple(center),
        "rpy": rpy,
        "size": arms.triple(np.maximum(size, 1e-4)),
    }
    return drawn | ({"faces": disordered(random)} if kind == "box_mesh" else {})


def disordered(random: np.random.Generator) -> list[tuple[int, int, int]]:
    """Draws the triangles of a box as files have them: turned, in both orientations, partly turned, some twice."""
    squares = [np.roll(square, random.integers(2)) for square in SQUARES]
    faces = [triangle for a, b, c, d in squares for triangle in ((a, b, c), (a, c, d))]
    turned = [(a, c, b) for a, b, c in faces]
    mixed = [pair[random.integers(2)] for pair in zip(faces, turned, strict=True)]
    some = turned[: random.integers(12)]
    drawn = [faces, turned, faces + turned, mixed, mixed + faces, faces + some][random.integers(6)]
    return [tuple(int(i) for i in np.roll(drawn[k], random.integers(3))) for k in random.permutation(len(drawn))]


def rotation(given: Shape) -> np.ndarray:
    """The axes of a shape (3, 3)."""
    roll, pitch, yaw = (np.array([angle]) for angle in given["rpy"])
    x, y, z = np.eye(3)
    return (arms.turn(z, yaw) @ arms.turn(y, pitch) @ arms.turn(x, roll))[0]


def corners(given: Shape) -> np.ndarray:
    """Corners of a hull in its own frame (8, 3): those of a box, two of them moved."""
    signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    signs[0] *= 1.7
    signs[7] *= 0.6
    return signs * given["size"]


def written(given: Shape, power: int = 0) -> str:
    """The expression that makes the obstacle, magnified by 2**power."""
    given = given | {key: arms.triple(2.0**power * np.array(given[key])) for key in ("center", "size")}
    center, (x, y, z), turn = given["center"], given["size"], rotation(given)
    match given["kind"]:
        case "sphere":
            return f"bik.obstacles.Sphere({center}, {x})"
        case "box":
            return f"bik.obstacles.Box({center}, {(x, y, z)}, {turn.tolist()})"
        case "capsule":
            half = 0.5 * y * turn[:, 2]
            return f"bik.obstacles.Capsule({(center - half).tolist()}, {(center + half).tolist()}, {x})"
        case "cylinder":
            return f"bik.obstacles.Cylinder({center}, {turn[:, 2].tolist()}, {x}, {y})"
        case "ellipsoid":
            return f"bik.obstacles.Ellipsoid({center}, {(x, y, z)}, {turn.tolist()})"
        case "box_mesh":
            at = (
                0.5 * np.array([[i >> k & 1 or -1 for k in range(3)] for i in range(8)]) * (x, y, z)
            ) @ turn.T + center
            return f"bik.obstacles.Mesh({at.tolist()}, {given['faces']})"
        case "soup":
            return f"bik.obstacles.Mesh({(corners(given) @ turn.T + center).tolist()}, {SOUP})"
        case "cloud":
            return f"bik.obstacles.PointCloud({(corners(given) @ turn.T + center).tolist()}, {0.2 * x})"
        case "grid":
            return f"bik.obstacles.Grid({center}, {x}, {OCCUPIED.tolist()})"
        case _:
            return f"bik.obstacles.ConvexMesh({(corners(given) @ turn.T + center).tolist()})"


def pieces(given: Shape) -> list[Placed]:
    """What the shape is made of, for coal."""
    turn, center, x = rotation(given), np.array(given["center"]), given["size"][0]
    match given["kind"]:
        case "cloud":
            places = corners(given) @ turn.T + center
            return [(coal.Sphere(0.2 * x), coal.Transform3s(np.eye(3), place)) for place in places]
        case "grid":
            places = center + x * (np.argwhere(OCCUPIED) + 0.5)
            return [(coal.Box(x, x, x), coal.Transform3s(np.eye(3), place)) for place in places]
        case _:
            return [(_single(given), coal.Transform3s(turn, center))]


def _single(given: Shape) -> Any:
    """A shape of one piece, in its own frame."""
    x, y, z = given["size"]
    match given["kind"]:
        case "sphere":
            return coal.Sphere(x)
        case "box" | "box_mesh":
            return coal.Box(x, y, z)
        case "capsule":
            return coal.Capsule(x, y)
        case "cylinder":
            return coal.Cylinder(x, y)
        case "ellipsoid":
            return coal.Ellipsoid(x, y, z)
        case "soup":
            model = coal.BVHModelOBBRSS()
            model.beginModel(len(SOUP), 3 * len(SOUP))
            for face in SOUP:
                model.addTriangle(*corners(given)[list(face)])
            model.endModel()
            return model
        case _:
            points = coal.StdVec_Vec3s()
            points.extend(corners(given))
            return coal.Convex.convexHull(points, False, "Qt")


def apart(one: Placed, other: Placed) -> float:
    """The distance of two shapes by coal."""
    return float(coal.distance(*one, *other, REQUEST, coal.DistanceResult()))


def bodies(robot: bik.Robot, q: np.ndarray) -> list[tuple[str, Placed]]:
    """The capsules of a robot at a configuration, by the links that carry them."""
    place = dict(zip(robot.all_link_names, robot.all_link_poses(q), strict=True))
    found = []
    for link, a, b, radius in robot.capsules:
        first, last = (place[link][:3, :3] @ end + place[link][:3, 3] for end in (a, b))
        length = float(np.linalg.norm(last - first))
        if length == 0.0:
            found.append((link, (coal.Sphere(radius), coal.Transform3s(np.eye(3), first))))
            continue
        z = (last - first) / length
        x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
        x /= np.linalg.norm(x)
        turn = np.column_stack((x, np.cross(z, x), z))
        found.append((link, (coal.Capsule(radius, length), coal.Transform3s(turn, 0.5 * (first + last)))))
    return found


def clearance(robot: bik.Robot, q: np.ndarray, scene: list[Placed]) -> float:
    """The smallest distance of the links from a scene, and of the pairs that can touch, by coal."""
    links, pairs = bodies(robot, q), {frozenset(pair) for pair in robot.collision_pairs}
    own = (apart(a, b) for i, (m, a) in enumerate(links) for n, b in links[:i] if {m, n} in pairs)
    return min([np.inf, *(apart(body, thing) for _, body in links for thing in scene), *own])
