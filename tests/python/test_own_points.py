"""The robot in its own depth cloud: points that are taken out, and messages that say so."""

import copy
import pickle
from collections.abc import Callable

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik

PANDA = bik.Robot.named("panda").with_capsules(radius=0.06)
PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
Q = np.array([-0.7, 0.6, 0.0, -1.9, 0.0, 2.4, 0.8])
LIMITS = bik.Limits(velocity=1.5, acceleration=5.0)
OWN_POINTS = "the robot's own points may be in the cloud, and PointCloud.without_robot(robot, q) takes them out"
OWN_VOXELS = "the robot's own voxels may be in the grid, and Grid.without_robot(robot, q) takes them out"


def axes(robot: bik.Robot, q: np.ndarray) -> list[tuple[np.ndarray, np.ndarray, float]]:
    """Both ends and the radius of each capsule, in the frame of the base."""
    frames = dict(zip(robot.all_link_names, robot.all_link_poses(q), strict=True))
    place = lambda link, end: frames[link][:3, :3] @ end + frames[link][:3, 3]  # noqa: E731
    return [(place(link, a), place(link, b), radius) for link, a, b, radius in robot.capsules]


def distances(robot: bik.Robot, q: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Distances of points from the capsules of a robot, by numpy."""
    least = np.full(len(points), np.inf)
    for a, b, radius in axes(robot, q):
        along = b - a
        t = np.clip((points - a) @ along / max(along @ along, 1e-300), 0.0, 1.0)
        least = np.minimum(least, np.linalg.norm(points - a - t[:, None] * along, axis=1) - radius)
    return least


def seen_points(robot: bik.Robot, q: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Points around a robot: anywhere, at round coordinates, on its surfaces, and on their axes."""
    around = rng.uniform(-1.2, 1.2, (300, 3))
    own = []
    for a, b, radius in axes(robot, q):
        normal = rng.normal(size=(20, 3))
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        middle = a + rng.choice([0.0, 0.5, 1.0], (20, 1)) * (b - a)
        own.append(middle + normal * (radius + rng.choice([-radius, 0.0, 0.02, 0.1], (20, 1))))
    return np.vstack([around, np.round(around, 1), *own])


def mobile() -> bik.Robot:
    return PANDA.with_mobile_base("planar", lower=[-1, -1, -3], upper=[1, 1, 3])


def carrying() -> bik.Robot:
    return PANDA.with_attached("flange", bik.obstacles.Capsule((0, 0, 0.1), (0, 0.2, 0.1), 0.05), name="part")


@pytest.mark.parametrize(
    "robot", [PANDA, mobile(), carrying(), PAIR], ids=["one arm", "a mobile base", "a part in the hand", "two arms"]
)
def test_the_points_near_the_bodies_go(robot: bik.Robot) -> None:
    rng = np.random.default_rng(1)
    counts = np.zeros(2, int)
    for q in robot.random_configurations(10, seed=3):
        radius, padding = rng.choice([0.0, 0.01, 0.05]), rng.choice([0.0, 0.02, 0.1])
        points = seen_points(robot, q, rng)
        left = bik.obstacles.PointCloud(points, radius).without_robot(robot, q, padding=padding)
        away = distances(robot, q, points) - radius
        stays = away > padding
        clearly = np.abs(away - padding) > 1e-9
        kept = (points[:, None] == left.points[None]).all(axis=2).any(axis=1)
        np.testing.assert_array_equal(kept[clearly], stays[clearly])
        assert left.removed == len(points) - len(left.points)
        counts += [left.removed, len(left.points)]
    assert counts.min() > 500


def test_each_point_goes_by_its_clearance() -> None:
    rng = np.random.default_rng(2)
    box = bik.obstacles.Box((0, 0, 0.1), (0.1, 0.3, 0.05))
    robot = PANDA.with_attached("flange", box, name="part").with_collision_pairs([])
    points = np.round(robot.fk(Q)[:3, 3] + rng.uniform(-0.3, 0.3, (400, 3)), 2)
    left = bik.obstacles.PointCloud(points, 0.01).without_robot(robot, Q, padding=0.02)
    each = [bik.obstacles.clearance(robot, Q, [bik.obstacles.PointCloud([point], 0.01)]) for point in points]
    np.testing.assert_array_equal(left.points, points[np.array(each) > 0.02])
    assert 20 < left.removed < 380
    assert bik.obstacles.clearance(robot, Q, [left]) > 0.02


def test_voxels_go_by_their_clearance() -> None:
    robot = PANDA.with_collision_pairs([])
    occupied = np.random.default_rng(3).random((16, 16, 12)) < 0.4
    grid = bik.obstacles.Grid((-0.8, -0.8, 0.0), 0.1, occupied, touch=["link_1"])
    left = grid.without_robot(robot, Q)
    for index in np.argwhere(occupied):
        cube = bik.obstacles.Box(grid.origin + 0.1 * (index + 0.5), (0.1, 0.1, 0.1))
        assert left.occupied[tuple(index)] == (bik.obstacles.clearance(robot, Q, [cube]) > 0.02)
    assert left.removed == occupied.sum() - left.occupied.sum() > 20
    assert left.touch == ("link_1",)


def test_clouds_of_any_layout_are_taken() -> None:
    points = seen_points(PANDA, Q, np.random.default_rng(4)).astype(np.float32)
    plain = bik.obstacles.PointCloud(points.astype(float), 0.01, touch=["link_2"]).without_robot(PANDA, Q)
    wide = np.zeros((len(points), 8), np.float32)
    wide[:, 2:5] = points
    for given in (points, wide[:, 2:5], np.asfortranarray(points), points.tolist()):
        assert bik.obstacles.PointCloud(given, 0.01, touch=["link_2"]).without_robot(PANDA, Q) == plain
    assert plain.touch == ("link_2",)


def test_a_cloud_may_be_empty() -> None:
    nothing = bik.obstacles.PointCloud(np.empty((0, 3)), 0.01)
    alone = bik.obstacles.PointCloud(PANDA.all_link_poses(Q)[:, :3, 3], 0.01).without_robot(PANDA, Q)
    free = bik.obstacles.Grid((0, 0, 0), 0.1, np.zeros((2, 2, 2), bool))
    assert alone == nothing
    assert (alone.removed, nothing.removed) == (len(PANDA.all_link_names), 0)
    for empty in (nothing, alone, free):
        assert empty.without_robot(PANDA, Q).removed == 0
        assert len(empty.triangles) == 0
        assert bik.obstacles.clearance(PANDA.with_collision_pairs([]), Q, [empty]) == np.inf
        assert bik.obstacles.nearest(PANDA.with_collision_pairs([]), Q, [empty]) is None
        assert bik.plan_point_to_point(PANDA, start_q=Q, end_q=Q + 0.1, limits=LIMITS, obstacles=[empty]).success
        for copied in (copy.deepcopy(empty), pickle.loads(pickle.dumps(empty))):
            assert copied == empty


def test_a_robot_without_bodies_is_refused_with_a_remedy() -> None:
    cloud = bik.obstacles.PointCloud([(0, 0, 0)], 0.01)
    with pytest.raises(bik.InvalidInputError) as caught:
        cloud.without_robot(bik.Robot.named("panda"), Q)
    assert 'collision="fit"' in str(caught.value)
    assert "with_capsules" in str(caught.value)


def at_the_arm(kind: str) -> bik.obstacles.Obstacle:
    """What a sensor measured of the arm at Q, and a little more."""
    links = PANDA.all_link_poses(Q)[2:, :3, 3]
    if kind == "cloud":
        return bik.obstacles.PointCloud(np.vstack([links, [[0.5, 0.0, -0.3]]]), 0.01)
    occupied = np.zeros((20, 20, 20), bool)
    occupied[tuple(np.floor((links - (-1.0, -1.0, -0.5)) / 0.1).astype(int).T)] = True
    return bik.obstacles.Grid((-1.0, -1.0, -0.5), 0.1, occupied)


def message(call: Callable[[], object]) -> str:
    try:
        return str(call().message)  # type: ignore[attr-defined]
    except bik.BeetleIkError as error:
        return str(error)


@pytest.mark.parametrize(("kind", "remedy"), [("cloud", OWN_POINTS), ("grid", OWN_VOXELS)])
def test_calls_that_begin_in_a_cloud_name_the_remedy(kind: str, remedy: str) -> None:
    seen, end = [at_the_arm(kind)], Q * [-1, 1, 1, 1, 1, 1, 1]
    line = bik.paths.polyline([PANDA.fk(Q)[:3, 3], PANDA.fk(Q)[:3, 3] + 0.01], duration=1.0)
    plan = {"start_q": Q, "end_q": end, "limits": LIMITS, "obstacles": seen}
    calls: dict[str, Callable[[], object]] = {
        "plan": lambda: bik.plan_point_to_point(PANDA, **plan),
        "plan, free_start": lambda: bik.plan_point_to_point(PANDA, **plan, free_start=True),
        "solve": lambda: bik.solve(PANDA, PANDA.fk(Q), start_q=Q, obstacles=seen),
        "solve, end": lambda: bik.solve(PANDA, PANDA.fk(Q), start_q=Q, obstacles=seen, prefer="nearest"),
        "solve_batch": lambda: bik.solve_batch(PANDA, PANDA.fk(Q)[None], start_q=Q, obstacles=seen),
        "solve_all": lambda: bik.solve_all(PANDA, PANDA.fk(Q), start_q=Q, obstacles=seen),
        "along a path": lambda: bik.plan_along_path(PANDA, line, start_q=Q, limits=LIMITS, obstacles=seen),
        "track": lambda: bik.track(PANDA, line, Q, dt=0.1, obstacles=seen),
        "tracker": lambda: bik.Tracker(PANDA, Q, dt=0.1, obstacles=seen).step(PANDA.fk(Q)),
    }
    for name, call in calls.items():
        said = message(call)
        assert remedy in said, f"{name}: {said}"
        assert "move the target" not in said, f"{name}: {said}"


def test_a_cloud_at_the_end_alone_may_be_real() -> None:
    seen = [bik.obstacles.PointCloud(PANDA.all_link_poses(Q)[6:, :3, 3], 0.01)]
    away = Q * [-1, 1, 1, 1, 1, 1, 1]
    assert bik.obstacles.clearance(PANDA, away, seen) > 0.0
    said = message(lambda: bik.plan_point_to_point(PANDA, start_q=away, end_q=Q, limits=LIMITS, obstacles=seen))
    assert said.startswith("end_q: link 'link_")
    assert "without_robot" not in said
    either = bik.solve(
        PANDA, PANDA.fk(Q), start_q=away, obstacles=[bik.obstacles.PointCloud([PANDA.fk(Q)[:3, 3]], 0.05)]
    )
    assert f"{OWN_POINTS}; if there are none, choose another target" in either.message
    boxed = bik.solve(PANDA, PANDA.fk(Q), start_q=Q, obstacles=[bik.obstacles.Sphere(PANDA.fk(Q)[:3, 3], 0.05)])
    assert "without_robot" not in boxed.message
