"""Plans along a path among obstacles from Python; their distances by coal, an independent library."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest
from coal_distance import distance_by_coal
from typer.testing import CliRunner

import beetle_ik as bik
from beetle_ik.cli.app import app

ARM = bik.Robot.named("panda").with_capsules(radius=0.05)
UR5 = bik.Robot.named("ur5e").with_capsules(radius=0.05)
LIMITS = bik.Limits(velocity=2.0, acceleration=5.0)
Q = np.array([0.1, 0.2, 0.1, -2.2, 0.1, 2.4, 0.8])


def bent(arm: bik.Robot, q: np.ndarray, along: np.ndarray, rise: np.ndarray) -> np.ndarray:
    """Poses on a bent path that begins at `q`."""
    s = np.linspace(0.0, 1.0, 30)[:, None]
    poses = np.repeat(arm.fk(q)[None], len(s), axis=0)
    poses[:, :3, 3] += s * along + s * (1 - s) * rise
    return poses


PATH = bent(ARM, Q, np.array([0.0, 0.4, 0.0]), np.array([0.0, 0.0, 0.2]))


def ball_at_elbow() -> bik.obstacles.Sphere:
    """An obstacle that the elbow runs into where nothing is avoided."""
    free = bik.plan_along_path(ARM, PATH, limits=LIMITS)
    q = free.trajectory.at(free.trajectory.duration / 2)[0]
    return bik.obstacles.Sphere(ARM.link_poses(q)[4][:3, 3], 0.05)


def instants(plan: bik.Plan, count: int) -> np.ndarray:
    return np.array([plan.trajectory.at(t)[0] for t in np.linspace(0.0, plan.trajectory.duration, count)])


@pytest.mark.parametrize("arm", [ARM, UR5], ids=["panda", "ur5e"])
def test_plans_are_clear_by_the_distances_of_coal(arm: bik.Robot) -> None:
    rng = np.random.default_rng(3)
    clear = 0
    for q in arm.random_configurations(6, seed=5):
        path = bent(arm, q, *rng.uniform(-0.15, 0.15, (2, 3)))
        centers = path[rng.integers(30, size=2), :3, 3] * rng.uniform(0.3, 0.9, (2, 1)) + rng.uniform(-0.1, 0.1, (2, 3))
        scene = bik.Scene([bik.obstacles.Box(center, rng.uniform(0.03, 0.12, 3)) for center in centers])
        try:
            plan = bik.plan_along_path(arm, path, limits=LIMITS, obstacles=scene, margin=0.003)
        except bik.InvalidInputError:
            continue  # the path leaves the reach
        least = min(distance_by_coal(arm, q, scene) for q in instants(plan, 60))
        assert plan.success == (plan.clearance >= 0.003)
        assert least >= plan.clearance - 1e-6
        clear += plan.success
    assert clear > 0


def test_a_plan_keeps_its_distance_when_pickled_and_retimed() -> None:
    ball = ball_at_elbow()
    plan = bik.plan_along_path(ARM, PATH, limits=LIMITS, obstacles=[ball], margin=0.003)
    assert plan.success, plan.message
    assert plan.obstacles == (ball,)
    assert plan.nearest is not None
    assert plan.nearest.distance == pytest.approx(plan.clearance, rel=0.02, abs=1e-4)
    copy = pickle.loads(pickle.dumps(plan))
    assert copy.nearest == plan.nearest
    assert copy.message == plan.message
    slower = copy.retime(bik.Limits(velocity=1.0, acceleration=2.0, jerk=20.0))
    assert bik.obstacles.clearance(ARM, instants(slower, 2000), [ball]).min() >= 0.003


def test_without_obstacles_nothing_is_checked() -> None:
    plan = bik.plan_along_path(ARM, PATH, limits=LIMITS)
    assert np.isnan(plan.clearance)
    assert plan.nearest is None
    bare = bik.Robot.named("panda")
    assert bik.plan_along_path(bare, PATH, limits=LIMITS).trajectory == plan.trajectory
    alone = bik.plan_along_path(ARM, PATH, limits=LIMITS, self_collision=True)
    assert alone.success
    assert alone.clearance > 0.001


def test_an_open_mesh_is_said_to_be_open() -> None:
    sheet = bik.obstacles.Mesh([[2, 0, 0], [2, 1, 0], [2, 0, 1]], [[0, 1, 2]])
    plan = bik.plan_along_path(ARM, PATH, limits=LIMITS, obstacles=[sheet], self_collision=False)
    assert plan.success
    assert "m clear of all surfaces; the mesh of obstacle 0 is open, so that its inside is unknown" in plan.message


def test_shapes_that_are_not_finite_are_refused() -> None:
    with pytest.raises(bik.InvalidInputError, match="center must be finite, but coordinate x is NaN"):
        bik.plan_along_path(ARM, PATH, limits=LIMITS, obstacles=[bik.obstacles.Sphere([np.nan, 0, 0], 0.1)])


@pytest.mark.parametrize("margin", [-1.0, np.nan, np.inf])
def test_a_margin_must_be_finite_and_not_negative(margin: float) -> None:
    with pytest.raises(bik.InvalidInputError, match="margin must be zero or more and finite"):
        bik.plan_along_path(ARM, PATH, limits=LIMITS, obstacles=[], margin=margin)


def test_an_obstacle_around_the_arm_is_named() -> None:
    around = bik.obstacles.Box((0.0, 0.0, 0.5), (4.0, 4.0, 4.0))
    plan = bik.plan_along_path(ARM, PATH, limits=LIMITS, obstacles=[around])
    assert plan.status == bik.Status.IN_COLLISION
    assert plan.message.startswith("no clear plan for point 0 of the path: link '")
    assert " m inside obstacle 0 (Box)" in plan.message


def test_between_two_ends_links_are_checked_where_asked_for() -> None:
    ends = {"start_q": Q, "end_q": Q * [-1, 1, 1, 1, 1, 1, 1]}
    checked = bik.plan_point_to_point(ARM, **ends, limits=LIMITS)
    assert checked.clearance > 0
    assert checked.nearest is not None
    assert checked.nearest.other.startswith("link '")
    unchecked = bik.plan_point_to_point(ARM, **ends, limits=LIMITS, self_collision=False)
    assert np.isnan(unchecked.clearance)
    assert unchecked.nearest is None
    bare = bik.Robot.named("panda")
    with pytest.raises(bik.InvalidInputError, match="robot 'panda' has no capsules"):
        bik.plan_point_to_point(bare, **ends, limits=LIMITS, self_collision=True)


def test_a_plan_of_the_command_line_keeps_clear_of_a_scene(tmp_path: Path) -> None:
    scene = tmp_path / "scene.json"
    bik.Scene([bik.obstacles.Box((0.0, -0.6, 0.3), (0.1, 0.1, 0.1))]).save(scene)
    arguments = ["plan", "along-path", "panda", "--curve", "circle", "--acceleration-limit", "5", "--json"]
    around = ["--scene", str(scene), "--margin", "0.02", "--link-radius", "0.05"]
    done = CliRunner().invoke(app, [*arguments, *around])
    answer = json.loads(done.stdout)
    assert answer["success"], done.output
    assert answer["clearance"] >= 0.02
    assert json.loads(CliRunner().invoke(app, arguments).stdout)["clearance"] is None
