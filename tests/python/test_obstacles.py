"""Obstacles, link capsules and plans among them."""

from pathlib import Path

import numpy as np
import pytest

import beetle_ik as bik

PANDA = bik.Robot.named("panda").with_capsules(radius=0.06)
CENTRE = (PANDA.lower + PANDA.upper) / 2
CRATE = bik.obstacles.Box(center=(0.5, 0, 0.2), size=(0.2, 0.6, 0.4))
LIMITS = bik.Limits(acceleration=10.0)
BEHIND = PANDA.fk([0.124, 0.768, -0.323, -0.972, 0.047, 1.456, 2.818])


def test_a_plan_around_a_crate_keeps_clear_and_within_limits() -> None:
    plan = bik.plan_point_to_point(PANDA, start_q=CENTRE, end=BEHIND, obstacles=[CRATE], limits=LIMITS)
    assert plan.success, plan.message
    _, q, qd, qdd = plan.trajectory.sample(0.001)
    distances = bik.obstacles.clearance(PANDA, q, [CRATE])
    assert 0.001 <= plan.clearance <= distances.min() + 1e-9
    assert (np.abs(qd) <= PANDA.velocity_limit).all()
    assert (np.abs(qdd) <= 10.0).all()
    assert np.allclose(PANDA.fk(q[-1]), BEHIND, atol=3e-6)


def test_a_larger_margin_is_kept_too() -> None:
    plan = bik.plan_point_to_point(PANDA, start_q=CENTRE, end=BEHIND, obstacles=[CRATE], margin=0.03, limits=LIMITS)
    assert plan.success
    assert plan.clearance >= 0.03
    assert plan.obstacles == (CRATE,)


def test_an_end_inside_an_obstacle_is_told_by_name() -> None:
    plan = bik.plan_point_to_point(PANDA, start_q=CENTRE, end=[0.5, 0.0, 0.2], obstacles=[CRATE], limits=LIMITS)
    assert not plan.success
    assert plan.violations[-1].what.startswith("distance of link '")
    assert plan.violations[-1].what.endswith("' from obstacle 0 (Box)")
    assert plan.violations[-1].bound == 0.001
    assert plan.clearance < 0


def test_a_start_in_collision_names_link_obstacle_and_depth() -> None:
    arm = bik.Robot.planar([1.0, 1.0], velocity=1.0).with_capsules(radius=0.01)
    ball = bik.obstacles.Sphere([1.0, 0.0, 0.0], 0.25)
    depth = r"^start_q: link 'link_1' is 0\.2600 m inside obstacle 0 \(Sphere\); free_start=True moves out first$"
    with pytest.raises(bik.InvalidInputError, match=depth):
        bik.plan_point_to_point(arm, start_q=[0, 0], end_q=[1, 0], obstacles=[ball])


def test_clearance_of_one_and_of_many() -> None:
    arm = bik.Robot.planar([1.0, 1.0]).with_capsules(radius=0.1)
    ball = bik.obstacles.Sphere([0.0, 2.0, 0.0], 0.5)
    assert bik.obstacles.clearance(arm, [0, 0], [ball]) == pytest.approx(1.4, abs=1e-8)
    many = bik.obstacles.clearance(arm, [[0, 0], [np.pi / 2, 0]], [ball])
    assert many == pytest.approx([1.4, -0.6], abs=1e-8)
    assert bik.obstacles.clearance(arm, [0, 0]) == np.inf


def test_capsules_are_seen_from_their_links() -> None:
    arm = bik.Robot.planar([1.0, 0.5]).with_capsules([("link_2", [0, 0, 0], [0.5, 0, 0], 0.2)])
    [(link, a, b, radius)] = arm.capsules
    assert (link, a.tolist(), b.tolist(), radius) == ("link_2", [0, 0, 0], [0.5, 0, 0], 0.2)
    ball = bik.obstacles.Sphere([2.0, 0.0, 0.0], 0.1)
    assert bik.obstacles.clearance(arm, [0, 0], [ball]) == pytest.approx(0.2, abs=1e-8)


def ball_at(x: float, y: float, z: float) -> bik.Robot:
    """Returns an arm that carries one ball of 0.1 m at that place, when its joints are at zero."""
    arm = bik.Robot.planar([1.0])
    x, y, z = np.array([x, y, z]) - arm.link_poses([0.0])[-1, :3, 3]
    return arm.with_capsules([(arm.link_names[-1], [x, y, z], [x, y, z], 0.1)])


BOX = bik.obstacles.Box([0, 0, 0], [1, 1, 1])
OCCUPIED = np.zeros((3, 3, 3), dtype=bool)
OCCUPIED[0, 0, 0] = OCCUPIED[2, 2, 2] = True
KINDS = {
    "Cylinder": (bik.obstacles.Cylinder([0, 0, 0], [2, 0, 0], 0.5, 1.0), (2, 0.5, 0), 1.4, (1, 0, 0)),
    "HalfSpace": (bik.obstacles.HalfSpace([0, 2, 0], 0.5), (3, 1.0, -4), 0.4, (0, 1, 0)),
    "Mesh": (bik.obstacles.Mesh(BOX.triangles.reshape(-1, 3), np.arange(36).reshape(12, 3)), (0, 0, 2), 1.4, (0, 0, 1)),
    "PointCloud": (bik.obstacles.PointCloud([[0, 0, 0], [5, 0, 0]], 0.05), (6, 0, 0), 0.85, (1, 0, 0)),
    "Grid": (bik.obstacles.Grid([0, 0, 0], 0.1, OCCUPIED), (0.25, 0.25, 0.6), 0.2, (0, 0, 1)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_of_obstacle_has_distance_place_and_normal(kind: str) -> None:
    obstacle, place, distance, normal = KINDS[kind]
    arm = ball_at(*place)
    found = bik.obstacles.nearest(arm, [0.0], [obstacle])
    assert found is not None
    assert (found.body, found.other) == (arm.link_names[-1], f"obstacle 0 ({kind})")
    assert found.distance == bik.obstacles.clearance(arm, [0.0], [obstacle])
    assert distance - 1e-9 <= found.distance <= distance
    assert found.normal == pytest.approx(normal, abs=1e-9)
    assert found.point == pytest.approx(np.array(place) - 0.1 * found.normal, abs=1e-9)
    # The joint turns about z at the origin.
    assert found.gradient == pytest.approx([np.cross([0, 0, 1], found.point) @ found.normal], abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_a_plan_keeps_clear_of_each_kind_of_obstacle(kind: str) -> None:
    obstacle = {
        "Cylinder": bik.obstacles.Cylinder([0.5, 0, 0.2], [0, 1, 0], 0.15, 0.6),
        "HalfSpace": bik.obstacles.HalfSpace([0, 0, 1], -0.1),
        "Mesh": bik.obstacles.Mesh(CRATE.triangles.reshape(-1, 3), np.arange(36).reshape(12, 3)),
        "PointCloud": bik.obstacles.PointCloud(
            np.random.default_rng(1).uniform(-1, 1, (300, 3)) * 0.1 + [0.5, 0, 0.2], 0.02
        ),
        "Grid": bik.obstacles.Grid([0.4, -0.3, 0.0], 0.1, np.ones((2, 6, 4), dtype=bool)),
    }[kind]
    plan = bik.plan_point_to_point(PANDA, start_q=CENTRE, end=BEHIND, obstacles=[obstacle], limits=LIMITS)
    assert plan.success, plan.message
    _, q, *_ = plan.trajectory.sample(0.005)
    assert 0.001 <= plan.clearance <= bik.obstacles.clearance(PANDA, q, [obstacle]).min() + 1e-9


def test_nothing_is_nearest_where_nothing_can_touch() -> None:
    arm = bik.Robot.planar([1.0, 1.0]).with_capsules(radius=0.1)
    assert bik.obstacles.nearest(arm, [0, 0]) is None


def test_a_closed_mesh_has_an_inside_and_an_open_one_has_none() -> None:
    corners, faces = BOX.triangles.reshape(-1, 3), np.arange(36).reshape(12, 3)
    closed, open_ = bik.obstacles.Mesh(corners, faces), bik.obstacles.Mesh(corners, faces[:-1])
    assert (closed.closed, open_.closed) == (True, False)
    arm = ball_at(0.3, 0.0, 0.0)
    assert bik.obstacles.clearance(arm, [0.0], [closed]) == pytest.approx(-0.3, abs=1e-9)
    assert bik.obstacles.clearance(arm, [0.0], [open_]) == pytest.approx(0.1, abs=1e-9)


def test_an_arm_inside_a_two_sided_mesh_is_in_collision(tmp_path: Path) -> None:
    corners, faces = BOX.triangles.reshape(-1, 3), np.arange(36).reshape(12, 3)
    turned, arm = faces[:, ::-1], ball_at(0.3, 0.0, 0.0)
    # Two-sided, inside out, partly turned, some triangles twice.
    for given in (
        np.vstack([faces, turned]),
        turned,
        np.vstack([faces[:5], turned[5:]]),
        np.vstack([faces, faces[:3]]),
    ):
        bik.Scene([bik.obstacles.Mesh(corners, given)]).save(tmp_path / "scene.json")
        read = bik.Scene.load(tmp_path / "scene.json")
        assert read[0].closed
        assert bik.obstacles.clearance(arm, [0.0], read) == pytest.approx(-0.3, abs=1e-9)
        assert bik.solve(arm, arm.fk([0.0]), obstacles=read).status == bik.Status.IN_COLLISION


def test_layers_without_a_certain_inside_are_said_to_be_open() -> None:
    # Both sides of a square, halved along other diagonals: all edges cancel, and nothing is inside.
    corners = [[2, 0, 0], [2, 1, 0], [2, 1, 1], [2, 0, 1]]
    sheet = bik.obstacles.Mesh(corners, [[0, 1, 2], [0, 2, 3], [3, 1, 0], [3, 2, 1]])
    assert not sheet.closed
    found = bik.solve(PANDA, PANDA.fk([0.1] * 7), obstacles=[sheet], self_collision=False)
    assert found.success
    assert found.message.endswith("; the mesh of obstacle 0 is open, so that its inside is unknown")


@pytest.mark.parametrize("size", [1e-12, 1e3, 1e40, 1e60, 1e100, 1e155, 1e300])
def test_what_holds_an_arm_is_never_clear_of_it(size: float) -> None:
    cube = size * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    triangles = bik.obstacles.Box((0, 0, 0), (2, 2, 2)).triangles.reshape(-1, 3)
    arm, middle = ball_at(0.0, 0.0, 0.0), np.array([-0.6, 0.3, 0.7]) * size
    for shape in (
        bik.obstacles.Sphere(middle, 1.1 * size),
        bik.obstacles.Box(0.4 * middle, (2 * size, 2 * size, 2 * size)),
        bik.obstacles.Capsule(-middle, middle, size),
        bik.obstacles.Cylinder(0.4 * middle, (0, 0, 1), size, 2 * size),
        bik.obstacles.Mesh(size * triangles, np.arange(36).reshape(12, 3)),
        bik.obstacles.PointCloud(cube, 2 * size),
        bik.obstacles.Grid(-size * np.ones(3), size, np.ones((2, 2, 2), bool)),
        bik.obstacles.HalfSpace(middle, size),
    ):
        assert bik.obstacles.clearance(arm, [0.0], [shape]) < 0.0
        found = bik.solve(arm, arm.fk([0.0]), obstacles=[shape])
        assert found.status == bik.Status.IN_COLLISION
        assert ("perhaps (its numbers are too large to tell) inside" in found.message) == (found.clearance == -np.inf)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: PANDA.with_capsules(), "with_capsules: give either radius= or a list of (link, a, b, radius)"),
        (lambda: PANDA.with_capsules([1]), "capsule 0 must be (link, a, b, radius), got 1"),
        (lambda: PANDA.with_capsules(radius=-1.0), "radius must be zero or more and finite, got -1"),
        (lambda: bik.obstacles.Sphere([0, 0], 1), "center: expected shape (3,), got (2,)"),
        (lambda: bik.obstacles.Sphere([0, 0, np.nan], 1), "center must be finite, but coordinate z is NaN"),
        (
            lambda: bik.obstacles.Box([0, 0, 0], [1, 0, 1]),
            "size of the box along y must be positive and finite, got 0",
        ),
        (
            lambda: bik.obstacles.ConvexMesh([[0, 0, 0], [1, 0, 0]]),
            "a convex mesh needs at least 4 points that do not lie in a plane, got 2",
        ),
        (
            lambda: bik.obstacles.ConvexMesh(1e-90 * np.eye(4, 3)),
            "a convex mesh must measure 1e-75 to 1e75 m, got 1e-90",
        ),
        (
            lambda: bik.obstacles.Cylinder([0, 0, 0], [0, 0, 0], 0.1, 1),
            "length of the axis of the cylinder must be positive and finite, got 0",
        ),
        (
            lambda: bik.obstacles.HalfSpace([0, 0, 1], np.inf),
            "offset of the half-space must be finite, but it is inf",
        ),
        (lambda: bik.obstacles.Mesh([[0, 0, 0]], []), "faces: expected shape (t, 3), got (0,)"),
        (
            lambda: bik.obstacles.Mesh([[0, 0, 0]], np.empty((0, 3))),
            "a mesh needs at least one triangle, got none",
        ),
        (
            lambda: bik.obstacles.Mesh([[0, 0, 0]], [[0, 1, 0]]),
            "face 0 of the mesh names vertex 1, but it has 1 (from 0)",
        ),
        (
            lambda: bik.obstacles.Mesh([[0, 0, 0]], [[0, -1, 0]]),
            "face 0: expected indices of vertices, from 0, got -1",
        ),
        (
            lambda: bik.obstacles.PointCloud([[0, 0, 0], [0, np.nan, 1], [np.inf, 0, 0]], 0.1),
            "points of the point cloud: 2 of 3 are not finite, the first is point 1, [0, NaN, 1]: leave out what was "
            "not measured: points[np.isfinite(points).all(axis=1)]",
        ),
        (
            lambda: bik.obstacles.Grid([0, 0, 0], 0.1, [[1, 0]]),
            "occupied must be a boolean array (nx, ny, nz), got an array of int64",
        ),
        (
            lambda: bik.plan_point_to_point(PANDA, start_q=CENTRE, end_q=CENTRE, obstacles=[3]),
            "obstacle 0 must be made by bik.obstacles, such as Sphere or Box, got 3",
        ),
        (
            lambda: bik.plan_point_to_point(PANDA, start_q=CENTRE, end_q=CENTRE, obstacles=CRATE),
            f"obstacles must be a list, got a single one: [{CRATE!r}]",
        ),
        (
            lambda: bik.plan_point_to_point(PANDA, start_q=CENTRE, end_q=CENTRE, margin=-1.0),
            "margin must be zero or more and finite, got -1",
        ),
    ],
)
def test_mistakes_are_named(call: object, message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        call()  # type: ignore[operator]
    assert str(caught.value) == message


def test_a_link_that_does_not_exist_is_named() -> None:
    with pytest.raises(bik.UnknownNameError, match="has no link 'hand'"):
        PANDA.with_capsules([("hand", [0, 0, 0], [0, 0, 1], 0.1)])


def test_obstacles_and_capsules_are_drawn() -> None:
    plt = pytest.importorskip("matplotlib.pyplot")
    figure = bik.plot.robot(PANDA, CENTRE, obstacles=[CRATE, bik.obstacles.Sphere([0, 0.5, 0.5], 0.1)])
    assert len(figure.axes[0].collections) == 2 + 1 + len(PANDA.capsules)
    plt.close(figure)


@pytest.mark.parametrize("seed", [2, 3, 5, 9, 11])
def test_no_objective_finds_a_better_motion_for_another(seed: int) -> None:
    rng = np.random.default_rng(seed)
    arm = bik.Robot.named("ur5").with_capsules(radius=0.05)
    limits = bik.Limits(velocity=2.0, acceleration=5.0)
    start, end = ([0.4, y, 0.35] + 0.1 * rng.uniform(-1, 1, 3) for y in (-0.35, 0.35))
    ball = bik.obstacles.Sphere((0.45, 0.0, 0.3), radius=0.08 + 0.1 * rng.random())

    def facing_down(position: np.ndarray) -> np.ndarray:
        pose = np.diag([1.0, -1.0, -1.0, 1.0])
        pose[:3, 3] = position
        return pose

    def costs(motion: bik.Trajectory) -> dict[str, float]:
        q, _, _ = motion.at(np.linspace(0.0, motion.duration, 4001))
        tips = np.linalg.norm(np.diff(arm.fk(q)[:, :3, 3], axis=0), axis=1)
        return {"time": motion.duration, "joint_travel": np.abs(np.diff(q, axis=0)).sum(), "tip_travel": tips.sum()}

    found = {
        objective: bik.plan_point_to_point(
            arm, facing_down(start), facing_down(end), limits=limits, obstacles=[ball], objective=objective, seed=seed
        )
        for objective in ("time", "joint_travel", "tip_travel")
    }
    measured = {objective: costs(plan.trajectory) for objective, plan in found.items()}
    for objective in found:
        assert found[objective].success
        assert measured[objective][objective] <= 1.001 * min(cost[objective] for cost in measured.values())
