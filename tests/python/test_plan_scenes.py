"""Plans in random scenes, judged by coal: a small count of `benches/random_scenes.py`."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beetle_ik as bik

pytest.importorskip("coal", reason="coal is not installed")
sys.path.insert(0, str(Path(__file__).parents[2] / "benches"))

from peers import random_scenes

COUNT = 50
CAUGHT = (340, 404, 1100, 1422)  # once hit by planners that certified too little


def test_what_is_called_clear_in_random_scenes_is_clear() -> None:
    outcome = random_scenes.run([*range(COUNT), *CAUGHT])
    assert outcome.wrong == []
    assert outcome.scenes == COUNT + len(CAUGHT)
    assert outcome.solved > COUNT // 2


def solved() -> tuple[random_scenes.Scene, bik.Plan]:
    scene = random_scenes.scene(8)
    plan = scene.plan()
    assert plan.success
    return scene, plan


def test_the_judge_sees_an_obstacle_on_the_way() -> None:
    scene, plan = solved()
    assert random_scenes.judge(scene, plan.trajectory) == []
    q = plan.trajectory.at(0.4 * plan.trajectory.duration)[0]
    ball = random_scenes.sphere(scene.robot.link_poses(q)[-1, :3, 3], np.random.default_rng(0))
    (wrong,) = random_scenes.judge(replace(scene, things=[*scene.things, ball]), plan.trajectory)
    assert wrong.startswith("clearance -")


def test_the_judge_sees_a_margin_missed_by_a_little() -> None:
    scene, plan = solved()
    q = plan.trajectory.at(np.linspace(0.0, plan.trajectory.duration, 1000))[0]
    least = random_scenes.least_distance(replace(scene, margin=1.0), q, random_scenes.capsule_ends(scene.robot, q))
    assert plan.clearance <= least
    (wrong,) = random_scenes.judge(replace(scene, margin=least + 1e-4), plan.trajectory)
    assert wrong.startswith("clearance ")


def test_the_judge_sees_wrong_ends_and_rates() -> None:
    scene, plan = solved()
    (wrong,) = random_scenes.judge(replace(scene, start=scene.start + 1e-6), plan.trajectory)
    assert wrong.startswith("from [")
    slower = replace(scene, robot=scene.robot.with_limits(velocity=0.1))
    (wrong,) = random_scenes.judge(slower, plan.trajectory)
    assert wrong.endswith(" of a limit")


def test_samples_are_left_out_only_where_nothing_can_be_near() -> None:
    way = np.concatenate([np.linspace(1.0, 0.0, 500), np.linspace(0.0, 0.7, 300)])
    asked: list[int] = []

    def distance(sample: int) -> float:
        asked.append(sample)
        return float(way[sample])

    moved = np.abs(np.diff(way))
    assert random_scenes.least_along(distance, moved, 0.01) == 0.0
    assert len(asked) < 60
