"""Distances of bodies from obstacles and from each other against coal, an independent collision library."""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import beetle_ik as bik

pytest.importorskip("coal")
sys.path.insert(0, str(Path(__file__).parents[2] / "benches"))

import coal
import random_pairs

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


def hull(c: np.ndarray, s: np.ndarray, turn: np.ndarray) -> tuple[bik.obstacles.Obstacle, object]:
    corners = np.random.default_rng(int(1e6 * s[0])).uniform(-0.4, 0.4, (12, 3))
    points = coal.StdVec_Vec3s()
    points.extend(corners)
    return bik.obstacles.ConvexMesh(corners @ turn.T + c), coal.Convex.convexHull(points, False, "Qt")


SOLIDS = [box, cylinder, ellipsoid, hull]


def random_place(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return rng.uniform(-0.8, 0.8, 3), rng.uniform(0.05, 0.5, 3), rotation(rng)


def apart(one: object, place: object, other: object, other_place: object) -> float:
    return float(coal.distance(one, place, other, other_place, REQUEST, coal.DistanceResult()))


def agrees(found: float, exact: float) -> bool:
    """Whether the bodies are apart; the distance is compared, or the fact that they overlap."""
    if exact <= 0:
        assert found <= 1e-6
        return False
    assert exact - 1e-6 < found < exact + 1e-6
    return True


@pytest.mark.parametrize("own", SOLIDS)
@pytest.mark.parametrize("make", [sphere, capsule, *SOLIDS, mesh])
def test_bodies_of_any_shape_are_as_far_as_coal_says(
    own: Callable[..., tuple[bik.obstacles.Obstacle, object]],
    make: Callable[..., tuple[bik.obstacles.Obstacle, object]],
) -> None:
    rng = np.random.default_rng(2)
    compared = 0
    for _ in range(60):
        (center, size, turn), (there, extent, twist) = random_place(rng), random_place(rng)
        body, model = own(center - PLACE, size, turn)
        obstacle, shape = make(there, extent, twist)
        found = bik.obstacles.clearance(ARM.with_attached(LINK, body), [0.0], [obstacle])
        at = coal.Transform3s(np.eye(3) if make is sphere else twist, there)
        exact = apart(model, coal.Transform3s(turn, center), shape, at)
        compared += agrees(found, exact)
    assert compared > 20


@pytest.mark.parametrize("own", SOLIDS)
def test_points_near_bodies_go_where_coal_finds_them_near(
    own: Callable[..., tuple[bik.obstacles.Obstacle, object]],
) -> None:
    rng = np.random.default_rng(5)
    counts = np.zeros(2, int)
    for _ in range(20):
        center, size, turn = random_place(rng)
        body, model = own(center - PLACE, size, turn)
        radius, padding = rng.choice([0.001, 0.01]), rng.choice([0.0, 0.02, 0.1])
        points = center + rng.uniform(-0.5, 0.5, (200, 3))
        cloud = bik.obstacles.PointCloud(points, radius)
        left = cloud.without_robot(ARM.with_attached(LINK, body), [0.0], padding=padding)
        ball, place = coal.Sphere(radius), coal.Transform3s(turn, center)
        exact = np.array([apart(ball, coal.Transform3s(np.eye(3), p), model, place) for p in points])
        kept = (points[:, None] == left.points[None]).all(axis=2).any(axis=1)
        clearly = np.abs(exact - padding) > 1e-6
        np.testing.assert_array_equal(kept[clearly], exact[clearly] > padding)
        counts += [left.removed, len(left.points)]
    assert counts.min() > 200


@pytest.mark.parametrize("other", [capsule, *SOLIDS])
@pytest.mark.parametrize("own", SOLIDS)
def test_bodies_of_two_links_are_as_far_apart_as_coal_says(
    own: Callable[..., tuple[bik.obstacles.Obstacle, object]],
    other: Callable[..., tuple[bik.obstacles.Obstacle, object]],
) -> None:
    rng = np.random.default_rng(3)
    compared = 0
    for _ in range(40):
        (center, size, turn), (there, extent, twist) = random_place(rng), random_place(rng)
        body, model = own(center - PLACE, size, turn)
        fixed, shape = other(there, extent, twist)
        robot = ARM.with_attached(LINK, body, name="moving").with_attached(ARM.link_names[0], fixed, name="still")
        found = bik.obstacles.clearance(robot.with_collision_pairs([("moving", "still")]), [0.0])
        exact = apart(model, coal.Transform3s(turn, center), shape, coal.Transform3s(twist, there))
        compared += agrees(found, exact)
    assert compared > 12


def test_no_distance_of_random_pairs_is_above_that_of_coal() -> None:
    """A small count of `benches/random_pairs.py`."""
    outcomes = random_pairs.run(pairs=36 * random_pairs.POSES, seed=4)
    assert len(outcomes) == 36
    assert sum(outcome.overlapping for outcome in outcomes.values()) > 100
    for kinds, outcome in outcomes.items():
        assert outcome.above < random_pairs.EXACT, kinds
        assert outcome.below < 1e-6, kinds
        assert outcome.disagreeing == 0, kinds


def test_a_body_that_is_too_small_is_noticed() -> None:
    rng, outcome = np.random.default_rng(5), random_pairs.Outcome()
    shape, model, center, turn = random_pairs.box(rng, 0.1, 0.15)
    smaller = bik.obstacles.Box(shape.center, shape.size - 1e-4, shape.rotation)  # type: ignore[attr-defined]
    random_pairs.compare((smaller, model, center, turn), random_pairs.sphere(rng, 0.6, 0.4), rng, outcome)
    assert outcome.above > 2e-5


def test_thin_hulls_keep_all_their_corners() -> None:
    rng = np.random.default_rng(6)
    for _ in range(200):
        corners = rng.uniform(-1, 1, (12, 3)) * (1.0, 1.0, 10.0 ** rng.uniform(-5, -1))
        turn, place = rotation(rng), rng.uniform(1.0, 3.0, 3)
        points = coal.StdVec_Vec3s()
        points.extend(corners @ turn.T + place)
        body = bik.obstacles.Sphere(-PLACE, 0.1)
        found = bik.obstacles.clearance(
            ARM.with_attached(LINK, body).with_collision_pairs([]),
            [0.0],
            [bik.obstacles.ConvexMesh(corners @ turn.T + place)],
        )
        exact = apart(
            coal.Sphere(0.1),
            coal.Transform3s.Identity(),
            coal.Convex.convexHull(points, False, "Qt"),
            coal.Transform3s.Identity(),
        )
        assert exact - 1e-6 < found < exact + 1e-6


def test_a_box_is_as_far_from_a_cloud_as_from_its_nearest_ball() -> None:
    rng = np.random.default_rng(7)
    for _ in range(200):
        size, radius, points = rng.uniform(0.01, 1.0, 3), rng.uniform(0.2, 0.6), rng.uniform(-3, 3, (30, 3))
        body = bik.obstacles.Box(-PLACE, size)
        robot = ARM.with_attached(LINK, body).with_collision_pairs([])
        found = bik.obstacles.clearance(robot, [0.0], [bik.obstacles.PointCloud(points, radius)])
        exact = np.linalg.norm(np.maximum(np.abs(points) - size / 2, 0.0), axis=1).min() - radius
        assert found == pytest.approx(exact, abs=1e-6) or max(found, exact) <= 0.0
