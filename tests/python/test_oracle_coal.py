"""Distances of capsules from obstacles against coal, an independent collision library."""

from collections.abc import Callable

import numpy as np
import pytest

import beetle_ik as bik

coal = pytest.importorskip("coal")

ARM = bik.Robot.planar([1.0])
LINK, PLACE = ARM.link_names[-1], ARM.link_poses([0.0])[-1, :3, 3]
PAIRS = 400
REQUEST = coal.DistanceRequest()
REQUEST.gjk_tolerance = 1e-9  # the default gives errors above 1e-6


def rotation(rng: np.random.Generator) -> np.ndarray:
    q, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    return q * np.sign(np.linalg.det(q))


def sphere(c: np.ndarray, s: np.ndarray, _: np.ndarray) -> tuple[bik.obstacles.Obstacle, object]:
    return bik.obstacles.Sphere(c, s[0]), coal.Sphere(s[0])


def capsule(c: np.ndarray, s: np.ndarray, turn: np.ndarray) -> tuple[bik.obstacles.Obstacle, object]:
    half = turn[:, 2] * s[1] / 2
    return bik.obstacles.Capsule(c - half, c + half, s[0]), coal.Capsule(s[0], s[1])


def box(c: np.ndarray, s: np.ndarray, turn: np.ndarray) -> tuple[bik.obstacles.Obstacle, object]:
    return bik.obstacles.Box(c, s, turn), coal.Box(*s)


def cylinder(c: np.ndarray, s: np.ndarray, turn: np.ndarray) -> tuple[bik.obstacles.Obstacle, object]:
    return bik.obstacles.Cylinder(c, turn[:, 2], s[0], s[1]), coal.Cylinder(s[0], s[1])


def ellipsoid(c: np.ndarray, s: np.ndarray, turn: np.ndarray) -> tuple[bik.obstacles.Obstacle, object]:
    return bik.obstacles.Ellipsoid(c, s, turn), coal.Ellipsoid(*s)


def mesh(c: np.ndarray, s: np.ndarray, turn: np.ndarray) -> tuple[bik.obstacles.Obstacle, object]:
    rng = np.random.default_rng(int(1e6 * s[0]))
    corners, faces = rng.uniform(-0.5, 0.5, (30, 3)), np.arange(30).reshape(10, 3)
    model = coal.BVHModelOBBRSS()
    model.beginModel(10, 30)
    for a, b, d in corners[faces]:
        model.addTriangle(a, b, d)
    model.endModel()
    return bik.obstacles.Mesh(corners @ turn.T + c, faces), model


def carried(rng: np.random.Generator) -> tuple[bik.Robot, object, object, float]:
    """Returns an arm with one capsule or sphere, the same for coal, its place and its radius."""
    a = rng.uniform(-1, 1, 3)
    b = a if rng.random() < 0.3 else rng.uniform(-1, 1, 3)
    radius, length = float(rng.uniform(0.01, 0.2)), float(np.linalg.norm(b - a))
    arm = ARM.with_capsules([(LINK, a - PLACE, b - PLACE, radius)])
    if length == 0.0:
        return arm, coal.Sphere(radius), coal.Transform3s(np.eye(3), a), radius
    z = (b - a) / length
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    turn = np.column_stack((x, np.cross(z, x), z))
    return arm, coal.Capsule(radius, length), coal.Transform3s(turn, (a + b) / 2), radius


@pytest.mark.parametrize("make", [sphere, capsule, box, cylinder, ellipsoid, mesh])
def test_distances_are_those_of_coal(make: Callable[..., tuple[bik.obstacles.Obstacle, object]]) -> None:
    rng = np.random.default_rng(1)
    compared = 0
    for _ in range(PAIRS):
        arm, body, place, radius = carried(rng)
        center, size, turn = rng.uniform(-1, 1, 3), rng.uniform(0.02, 0.5, 3), rotation(rng)
        obstacle, shape = make(center, size, turn)
        found = bik.obstacles.clearance(arm, [0.0], [obstacle])
        if found <= -0.9 * radius:
            continue  # the axis meets the obstacle: depth is measured in another way
        result = coal.DistanceResult()  # a used one may keep an earlier answer
        at = coal.Transform3s(np.eye(3) if make is sphere else turn, center)
        exact = coal.distance(body, place, shape, at, REQUEST, result)
        if make is mesh and exact <= 0:
            continue  # surfaces without thickness have no depth
        compared += 1
        assert exact - 1e-6 < found < exact + 1e-6
    assert compared > PAIRS / 3
