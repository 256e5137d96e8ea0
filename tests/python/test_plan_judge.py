"""The judge of `benches/planning.py` against the data, coal and known distances; and the page that shows its table."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from oracle import SHARED, needs_shared

import beetle_ik as bik

pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
sys.path.insert(0, str(Path(__file__).parents[2] / "benches"))

from peers import plan_report, planners
from peers.clear import ALWAYS_TOUCH, ARMS, CoalScene, MotionBenchArm
from peers.plan_report import Result
from peers.plan_worker import Answer
from peers.sphere_arm import SphereArm
from peers.sphere_judge import APART, Motion, Obstacle, SphereJudge, Verdict, dense, rates, turn

DATA = SHARED / "motionbenchmaker"
DOCS = Path(__file__).parents[2] / "docs"
ACCELERATION = 5.0


def arm_and_spheres(name: str) -> tuple[MotionBenchArm, SphereArm]:
    arm = MotionBenchArm(DATA, name)
    return arm, SphereArm(arm.urdf, arm.urdf.with_name(f"{name}.srdf"), list(arm.robot.joint_names), ALWAYS_TOUCH)


@needs_shared
@pytest.mark.parametrize("name", ARMS)
def test_the_judge_says_of_all_ends_what_the_data_say(name: str) -> None:
    _, spheres = arm_and_spheres(name)
    scenes = json.loads((DATA / f"{name}.json").read_text(encoding="utf-8"))["scenes"]
    problems = [problem for each in scenes.values() for problem in each]
    for problem in problems:
        clear = SphereJudge(spheres, problem).clearances(np.array([problem["start"], problem["goal"]])) >= 0.0
        assert clear.tolist() == [problem["start_valid"], problem["goal_valid"]], problem["index"]


@needs_shared
@pytest.mark.parametrize("name", ARMS)
def test_the_judge_and_coal_find_the_same_distances(name: str) -> None:
    arm, spheres = arm_and_spheres(name)
    assert spheres.tested_links() == {frozenset(pair) for pair in arm.robot.collision_pairs}
    q = arm.robot.random_configurations(60, seed=1)
    for problem in arm.problems()[::60]:
        coal = CoalScene(arm, problem)
        expected = [coal.clearance(each) for each in q]
        np.testing.assert_allclose(SphereJudge(spheres, problem).clearances(q), expected, rtol=0, atol=1e-9)


@needs_shared
def test_a_plan_is_kept_and_a_straight_line_is_not() -> None:
    arm, spheres = arm_and_spheres("panda")
    problem = arm.problems()[0]
    judge = SphereJudge(spheres, problem)
    plan = bik.plan_point_to_point(
        arm.robot,
        start_q=problem["start"],
        end_q=problem["goal"],
        obstacles=arm.scene(problem),
        limits=bik.Limits(acceleration=ACCELERATION),
    )
    duration = plan.trajectory.duration
    verdict = judge.judge(Motion(lambda t: plan.trajectory.at(t)[0], duration, 1e-3), ACCELERATION)
    assert plan.success
    assert verdict.kept
    assert plan.clearance <= verdict.clearance
    assert max(verdict.speed, verdict.acceleration) < 1.0 + 1e-6

    fast = judge.judge(Motion(lambda t: plan.trajectory.at(1.2 * t)[0], duration / 1.2, 1e-3), ACCELERATION)
    assert fast.kept
    assert fast.acceleration == pytest.approx(1.44 * verdict.acceleration, rel=1e-2)

    late = judge.judge(Motion(lambda t: plan.trajectory.at(t)[0], 0.99 * duration, 1e-3), ACCELERATION)
    assert late.off_ends > 1e-5
    assert not late.kept

    start, goal = np.array(problem["start"]), np.array(problem["goal"])
    line = judge.judge(Motion(lambda t: start + t[:, None] * (goal - start), 1.0, 1e-3), ACCELERATION)
    assert line.clearance < -0.01
    assert line.length == pytest.approx(float(np.linalg.norm(goal - start)))
    fine = judge.clearances(start + np.linspace(0.0, 1.0, 4_001)[:, None] * (goal - start))
    assert line.clearance == pytest.approx(fine.min(), abs=APART)


def test_distances_from_the_shapes() -> None:
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    box = Obstacle(turn, np.array([1.0, 0.0, 0.0]), np.array([0.1, 0.2, 0.3]))  # 0.2 along x, 0.1 along y
    points = np.array([[1.5, 0.0, 0.0], [1.0, 0.4, 0.7], [1.0, 0.05, 0.0], [1.0, 0.0, 0.29]])
    np.testing.assert_allclose(box.distances(points), [0.3, 0.5, -0.05, -0.01], atol=1e-15)
    cylinder = Obstacle(np.eye(3), np.zeros(3), np.array([0.3, 0.5]))
    points = np.array([[0.6, 0.8, 0.0], [0.3 + 0.3, 0.0, 0.9], [0.1, 0.0, 0.0], [0.0, 0.0, 0.45]])
    np.testing.assert_allclose(cylinder.distances(points), [0.7, 0.5, -0.2, -0.05], atol=1e-15)
    sphere = Obstacle(np.eye(3), np.ones(3), np.array([0.5]))
    np.testing.assert_allclose(sphere.distances(np.array([[1.0, 1.0, 3.0]])), [1.5])


def test_no_point_moves_farther_than_a_millimetre() -> None:
    def points(q: np.ndarray) -> np.ndarray:
        return np.stack([np.cos(q), np.sin(q), 0.0 * q], axis=2)

    q, found = dense(points, Motion(lambda t: 40.0 * np.sin(t)[:, None], 3.0, 1e-3))
    assert np.linalg.norm(np.diff(found, axis=0), axis=2).max() <= APART
    assert q[0] == 0.0
    assert q[-1] == 40.0 * np.sin(3.0)


def test_rates_are_those_of_a_parabola_and_see_a_jump_at_the_end() -> None:
    first, second = rates(Motion(lambda t: t[:, None] ** 2, 1.0, 1e-3))
    assert first == pytest.approx(2.0, rel=1e-3)
    assert second > 1000.0
    first, second = rates(Motion(lambda t: np.sin(np.pi * t - np.pi / 2)[:, None], 1.0, 1e-3))
    assert first == pytest.approx(np.pi, rel=1e-4)
    assert second == pytest.approx(np.pi**2, rel=1e-4)


def test_samples_of_others_are_joined_by_cubics() -> None:
    class Cubic(planners.Sampled):
        def __init__(self) -> None:
            time = np.array([0.0, 0.3, 1.0, 1.1])[:, None]
            self.motion = self._sampled(time[:, 0], time**3 - time, 3 * time**2 - 1)

    time = np.linspace(0.0, 1.1, 40)
    np.testing.assert_allclose(Cubic().at(time)[:, 0], time**3 - time, atol=1e-14)
    assert Cubic().motion.duration == 1.1


def test_a_prism_holds_its_cylinder() -> None:
    thing = {"position": [1.0, 2.0, 3.0], "xyzw": [0.5, 0.5, 0.5, 0.5], "radius": 0.1, "length": 0.4}
    corners = planners.prism(thing)
    cylinder = Obstacle(turn(thing["xyzw"]), np.array(thing["position"]), np.array([0.1, 0.2]))
    middles = 0.5 * (corners + np.roll(corners.reshape(2, 24, 3), 1, axis=1).reshape(48, 3))
    np.testing.assert_allclose(cylinder.distances(middles), 0.0, atol=1e-15)


def test_claims_that_are_not_kept_are_counted() -> None:
    problem = {"scene": "table", "index": 1}
    answer = Answer(claimed=True, seconds=0.002, wall=0.003, margin_0=False, duration=2.0, spacing=1e-3)
    kept = Verdict(clearance=0.001, off_ends=0.0, outside=0.0, length=3.0, speed=1.0, acceleration=1.0)
    verdicts = [
        kept,
        replace(kept, clearance=-0.002),
        replace(kept, off_ends=0.1, speed=1.5),
        replace(kept, outside=0.1),
    ]
    results = [Result("beetle-ik", "panda", problem, answer, verdict) for verdict in verdicts]
    results.append(Result("beetle-ik", "panda", problem, replace(answer, claimed=False), None))
    (line,) = plan_report.summary(results)
    row = dict(zip(plan_report.COLUMNS, line, strict=True))
    assert [row[name] for name in ("problems", "claimed", "kept", "claimed, not kept")] == ["5", "4", "1", "3"]
    assert [row["least clearance_mm"], row["limits exceeded by"], row["median_ms"]] == ["-2", "50 %", "2"]


def test_the_page_says_what_the_tables_say() -> None:
    page = (DOCS / "benchmarks_motion.md").read_text(encoding="utf-8")
    assert page == plan_report.with_section(page, plan_report.section(DOCS))


def test_nothing_was_called_clear_that_is_not() -> None:
    ours = [row for row in plan_report.table(DOCS, "planning.csv") if row["planner"].startswith("beetle-ik")]
    assert {row["claimed, not kept"] for row in ours} == {"0"}
