"""Solutions among obstacles from Python; their distances by coal, an independent library."""

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coal_distance import distance_by_coal
from typer.testing import CliRunner

import beetle_ik as bik
from beetle_ik.cli.app import app

ARM = bik.Robot.named("panda").with_capsules(radius=0.06)
UR5 = bik.Robot.named("ur5e").with_capsules(radius=0.05)
Q = np.array([0.2, 0.5, -0.2, -1.9, 0.1, 2.4, 0.9])
TABLE = bik.obstacles.Box((0.5, 0.0, 0.0), (0.8, 1.6, 0.05))
POST = bik.obstacles.Cylinder((0.3, -0.3, 0.4), (0, 0, 1), 0.05, 0.8)
SCENE = bik.Scene([TABLE, POST])


def poses(arm: bik.Robot, count: int, seed: int) -> np.ndarray:
    return arm.fk(arm.random_configurations(count, seed=seed))


def boxes(rng: np.random.Generator) -> bik.Scene:
    angle, radius = rng.uniform(-3, 3, 6), rng.uniform(0.3, 0.7, 6)
    centers = np.column_stack((radius * np.cos(angle), radius * np.sin(angle), rng.uniform(0.1, 0.9, 6)))
    return bik.Scene([bik.obstacles.Box(center, rng.uniform(0.05, 0.2, 3)) for center in centers])


@pytest.mark.parametrize("arm", [ARM, UR5], ids=["panda", "ur5e"])
def test_solutions_are_clear_by_the_distances_of_coal(arm: bik.Robot) -> None:
    rng = np.random.default_rng(5)
    clear = 0
    for target in poses(arm, 60, seed=5):
        scene = boxes(rng)
        solution = bik.solve(arm, target, obstacles=scene, margin=0.01)
        distance = distance_by_coal(arm, solution.q, scene)
        if solution.success:
            assert distance >= 0.01 - 1e-9
            assert distance == pytest.approx(solution.clearance, abs=1e-6)
            clear += 1
        else:
            assert solution.status == bik.Status.IN_COLLISION
            assert distance < 0.01
    assert clear > 15


def test_the_margin_is_one_millimetre_unless_given() -> None:
    tip = UR5.fk([0.3, -1.2, 1.4, -0.9, -1.5, 0.2])
    floor = [bik.obstacles.HalfSpace((0, 0, 1), -5.0)]
    free = bik.solve(UR5, tip, obstacles=floor, self_collision=False)
    assert free.success
    lowest = free.clearance
    for gap, margin, solved in ((5e-4, None, False), (5e-4, 0.0, True), (2e-3, None, True), (2e-3, 3e-3, False)):
        near = [bik.obstacles.HalfSpace((0, 0, 1), -5.0 + lowest - gap)]
        found = bik.solve_all(UR5, tip, start_q=free.q, limit=1, obstacles=near, margin=margin, self_collision=False)
        assert (found.success and found[0].clearance == pytest.approx(gap, abs=1e-8)) == solved, (gap, margin)


def test_what_is_nearest_is_told() -> None:
    solution = bik.solve(ARM, ARM.fk(Q), obstacles=SCENE, margin=0.02)
    assert solution.success
    assert solution.nearest == bik.obstacles.nearest(ARM, solution.q, SCENE)
    assert solution.clearance == bik.obstacles.clearance(ARM, solution.q, SCENE) >= 0.02
    assert solution.message.endswith("m clear of everything")
    again = pickle.loads(pickle.dumps(solution))
    assert (again.clearance, again.nearest, again.message) == (solution.clearance, solution.nearest, solution.message)


def test_what_is_nearest_is_told_where_the_target_is_out_of_reach() -> None:
    solution = bik.solve(UR5, bik.pose([3.0, 0.2, 0.4]), obstacles=SCENE, margin=0.02)
    assert solution.status is bik.Status.OUT_OF_REACH
    assert solution.nearest == bik.obstacles.nearest(UR5, solution.q, SCENE)
    assert np.isfinite(solution.clearance)


def test_nothing_is_checked_unless_asked_for() -> None:
    target = ARM.fk(Q)
    plain = bik.solve(ARM, target)
    assert np.isnan(plain.clearance)
    assert plain.nearest is None
    unchecked = bik.solve(ARM, target, self_collision=False)
    np.testing.assert_array_equal(plain.q, unchecked.q)
    for checked in (bik.solve(ARM, target, obstacles=[]), bik.solve(ARM, target, self_collision=True)):
        assert checked.clearance >= 1e-3


def test_a_batch_has_the_clearance_of_each_item() -> None:
    targets = poses(ARM, 20, seed=6)
    batch = bik.solve_batch(ARM, targets, obstacles=SCENE, margin=0.02)
    assert (batch.clearance[batch.success] >= 0.02).all()
    assert set(batch.status[~batch.success]) <= {bik.Status.IN_COLLISION}
    assert batch[0].q.tolist() == bik.solve(ARM, targets[0], obstacles=SCENE, margin=0.02).q.tolist()
    np.testing.assert_array_equal([one.clearance for one in batch], batch.clearance)
    assert np.isnan(bik.solve_batch(ARM, targets).clearance).all()


def test_all_solutions_are_clear() -> None:
    found = bik.solve_all(ARM, ARM.fk(Q), obstacles=SCENE, margin=0.02, redundancy=32)
    assert len(found) > 5
    assert (bik.obstacles.clearance(ARM, found.q, SCENE) >= 0.02).all()
    assert all(one.clearance >= 0.02 and one.nearest is not None for one in found)


def test_a_wall_within_the_hand_is_said_to_be_there_whatever_the_arm_does() -> None:
    target = ARM.fk(Q)
    inside = bik.obstacles.Sphere(target[:3, 3], 0.05)
    for found in (
        bik.solve(ARM, target, obstacles=[TABLE, inside]),
        bik.solve_all(ARM, target, obstacles=[TABLE, inside]).miss,
    ):
        assert found is not None
        assert found.status == bik.Status.IN_COLLISION
        assert "inside obstacle 1 (Sphere) whatever the arm does: the hand itself is in the way" in found.message
        assert found.clearance < 0


def floor(*touch: str) -> bik.obstacles.HalfSpace:
    return bik.obstacles.HalfSpace((0, 0, 1), 0.0, touch=touch)


def test_an_arm_stands_on_a_floor_that_its_foot_may_touch() -> None:
    """Every call takes the floor; distances to it are those of a scene without the link that stands on it."""
    tip, allowed = ARM.fk(Q), [floor("link_1"), POST]
    refused = bik.solve(ARM, tip, obstacles=[floor()])
    assert refused.status == bik.Status.IN_COLLISION
    assert (
        "link 'link_1' is 0.06000 m inside obstacle 0 (HalfSpace) whatever the arm does; if the robot stands there, "
        "put 'link_1' into the obstacle's touch: " in refused.message
    )
    others = ARM.with_capsules([body for body in ARM.capsules if body[0] != "link_1"])
    for solution in (
        bik.solve(ARM, tip, obstacles=allowed),
        bik.solve_all(ARM, tip, obstacles=allowed)[0],
        bik.solve_batch(ARM, tip[None], obstacles=allowed)[0],
        bik.solve(ARM, tip, obstacles=allowed, goals=bik.goals.Clearance()),
    ):
        assert solution.success
        over_floor = bik.obstacles.clearance(others, solution.q, [floor()])
        beside_post = bik.obstacles.clearance(ARM, solution.q, [POST])
        assert solution.clearance == pytest.approx(min(over_floor, beside_post), abs=1e-9)
        assert solution.clearance >= 1e-3
    plan = bik.plan_point_to_point(ARM, start_q=Q, end_q=Q + 0.1, obstacles=allowed)
    assert plan.success
    assert plan.clearance >= 1e-3
    with pytest.raises(bik.InvalidInputError, match=r"start_q: link 'link_1' is .* into the obstacle's touch$"):
        bik.plan_point_to_point(ARM, start_q=Q, end_q=Q + 0.1, obstacles=[floor()])


def test_a_moved_body_meets_the_floor_that_another_may_touch() -> None:
    down = np.array([0.0, 1.7, 0.0, -0.3, 0.0, 1.8, 0.0])  # the hand below z = 0
    found = bik.obstacles.nearest(ARM, down, [floor("link_1")])
    assert found is not None
    assert (found.body, found.distance < 0) == ("link_7", True)
    assert bik.obstacles.clearance(ARM, down, [floor("link_1", "link_7")]) > found.distance
    carrying = ARM.with_attached("flange", bik.obstacles.Sphere((0, 0, 0.1), 0.04), name="ball")
    assert bik.obstacles.nearest(carrying, down, [floor("link_1", "link_7")]).body == "ball"  # type: ignore[union-attr]


def test_a_link_that_an_obstacle_names_must_have_a_body() -> None:
    bodies = "links with bodies: link_1, link_3, link_4, link_5, link_6, link_7"
    for link, problem in (
        ("link_2", "link 'link_2' of robot 'panda' has no body"),
        ("panda_link0", "robot 'panda' has no link 'panda_link0'"),
    ):
        with pytest.raises(bik.InvalidInputError) as caught:
            bik.solve(ARM, ARM.fk(Q), obstacles=[POST, floor(link)])
        assert str(caught.value) == f"touch of obstacle 1 (HalfSpace): {problem}; {bodies}"


def test_a_goal_of_clearance_is_a_value() -> None:
    goal = bik.goals.Clearance(weight=2.0, up_to=0.3)
    assert repr(goal) == "goals.Clearance(weight=2.0, up_to=0.3)"
    assert (goal.weight, goal.up_to) == (2.0, 0.3)
    assert pickle.loads(pickle.dumps(goal)) == goal != bik.goals.Clearance(up_to=0.3)
    ball = bik.obstacles.Sphere((0.22, 0.38, 0.6), 0.05)  # beside the elbow
    plain, away = (bik.solve(ARM, ARM.fk(Q), obstacles=[ball], self_collision=False, goals=g) for g in ((), goal))
    assert away.clearance > plain.clearance + 0.1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"obstacles": [], "margin": -1.0}, "margin must be zero or more and finite, got -1"),
        ({"obstacles": [], "margin": np.nan}, "margin must be zero or more and finite, got NaN"),
        ({"margin": 0.1}, "margin= needs obstacles= (a list, which may be empty) or self_collision=True"),
        ({"obstacles": TABLE}, "obstacles must be a list, got a single one: ["),
        ({"obstacles": [1]}, "obstacle 0 must be made by bik.obstacles, such as Sphere or Box, got 1"),
        (
            {"goals": bik.goals.Clearance()},
            "the goal Clearance is for calls with obstacles= (a list, which may be empty)",
        ),
    ],
)
def test_wrong_surroundings_are_refused(arguments: dict[str, Any], message: str) -> None:
    for call in (bik.solve, bik.solve_all, bik.solve_batch):
        if call is bik.solve_all and "goals" in arguments:
            continue
        target = ARM.fk(Q) if call is not bik.solve_batch else ARM.fk(Q)[None]
        with pytest.raises(bik.InvalidInputError) as caught:
            call(ARM, target, **arguments)
        assert str(caught.value).startswith(message)


def test_a_robot_without_bodies_is_told_how_to_get_them() -> None:
    with pytest.raises(bik.BeetleIkError, match=r'collision="fit", or give it capsules with with_capsules'):
        bik.solve(bik.Robot.named("panda"), ARM.fk(Q), obstacles=[])


def test_a_tracker_has_no_goal_of_clearance() -> None:
    with pytest.raises(bik.BeetleIkError, match="the goal Clearance is for calls with obstacles="):
        bik.Tracker(ARM, Q, dt=0.01, goals=bik.goals.Clearance())


@pytest.mark.parametrize("solver", [bik.papers.PSO(), bik.DifferentialEvolution(), bik.papers.BAS(variant="greedy")])
def test_solvers_of_values_take_obstacles_as_a_penalty(solver: Any) -> None:
    rng = np.random.default_rng(9)
    found = avoided = 0
    for target in poses(ARM, 20, seed=9)[:, :3, 3]:
        scene = boxes(rng)
        options: dict[str, Any] = {"solver": solver, "position_tolerance": 5e-3, "seed": 1}
        solution = bik.solve(ARM, target, obstacles=scene, margin=0.01, **options)
        is_clear = bik.obstacles.clearance(ARM, solution.q, scene) >= 0.01
        assert solution.success == (is_clear and solution.position_error <= 5e-3)
        found += solution.success
        free = bik.solve(ARM, target, **options)
        avoided += solution.success and bik.obstacles.clearance(ARM, free.q, scene) < 0.01
    assert found > 10
    assert avoided > 0


def test_the_command_line_solves_in_a_scene(tmp_path: Path) -> None:
    SCENE.save(tmp_path / "scene.json")
    options = ["--scene", str(tmp_path / "scene.json"), "--margin", "0.02", "--link-radius", "0.06", "--json"]
    done = CliRunner().invoke(app, ["solve", "panda", "--position", "0.4,0.1,0.5", *options])
    assert done.exit_code == 0, done.output
    answer = json.loads(done.stdout)
    assert answer["clearance"] >= 0.02
    assert bik.obstacles.clearance(ARM, answer["q"], SCENE) == pytest.approx(answer["clearance"])
    below = CliRunner().invoke(app, ["solve", "panda", "--position", "0.4,0.1,0.0", *options])
    assert below.exit_code == 1
    assert json.loads(below.stdout)["status"] == "IN_COLLISION"


def test_a_straight_wrist_is_turned_clear() -> None:
    link_poses, rng, tried = UR5.all_link_poses, np.random.default_rng(0), 0
    for _ in range(40):
        q = rng.uniform(-3, 3, 6)
        q[4] = 0.0
        pose = UR5.fk(q)
        places = [link_poses(one)[link, :3, 3] for one in bik.solve_all(UR5, pose).q for link in (2, 3, 4)]
        balls = [bik.obstacles.Sphere(place, 0.06) for place in places]
        balls = [ball for ball in balls if bik.obstacles.clearance(UR5, q, [ball]) > 0.01]
        if not balls or bik.obstacles.clearance(UR5, q, balls) < 0.002:
            continue
        # q is clear, though every member of the family that the closed form returns may be blocked.
        tried += 1
        assert bik.solve(UR5, pose, obstacles=balls).success
        assert len(bik.solve_all(UR5, pose, obstacles=balls)) > 0
    assert tried > 20
