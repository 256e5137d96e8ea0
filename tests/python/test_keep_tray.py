"""A tray in two hands past a post: kept at every instant, and no plan is lost by a wider tolerance."""

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik

HANDS = ("left_tool", "right_tool")
PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=list(HANDS))
TRAY = bik.pose((0.0, 0.5, 0.0))
LIMITS = bik.Limits(velocity=1.5, acceleration=5.0)
FREE = np.inf


def problem(seed: int) -> tuple[np.ndarray, np.ndarray, bik.obstacles.Obstacle]:
    """Configurations at both ends of a way, and a post beside it."""
    random = np.random.default_rng(seed)
    while True:
        begin, end = (bik.pose(random.uniform([0.3, 0.05, 0.6], [0.6, 0.35, 0.9]), rpy=[np.pi, 0, 0]) for _ in range(2))
        y, height = random.uniform(-0.1, 0.1), random.uniform(0.5, 0.8)
        post = bik.obstacles.Capsule((0.75, y, 0.0), (0.75, y, height), 0.04)
        start = bik.solve(PAIR, {"left_tool": begin, HANDS: TRAY}, goals=[bik.goals.Centring()], obstacles=[post])
        there = bik.solve(PAIR, {"left_tool": end, HANDS: TRAY}, start_q=start.q, obstacles=[post])
        if start.success and there.success:
            return start.q, there.q, post


def worst(plan: bik.Plan) -> np.ndarray:
    """Largest deviation along an axis (m), and sine of the largest turn about one, at 5,000 samples."""
    poses = np.asarray(PAIR.fk(plan.trajectory.sample(plan.trajectory.duration / 5000)[1]))
    seen = np.linalg.inv(TRAY) @ np.linalg.inv(poses[:, 0]) @ poses[:, 1]
    turn = 0.5 * (seen[:, :3, :3] - np.swapaxes(seen[:, :3, :3], 1, 2))
    return np.array([np.abs(seen[:, :3, 3]).max(), np.abs(turn).max()])


@pytest.mark.parametrize("seed", range(4))
def test_no_width_of_the_tolerance_loses_the_tray(seed: int) -> None:
    start, end, post = problem(seed)
    for tolerance in (1e-6, 1e-4, 1e-3, 2e-3, 4e-3, 6e-3, 0.05):
        keep = bik.Keep({HANDS: TRAY}, bik.tasks.Pose(tolerance=[tolerance] * 6))
        plan = bik.plan_point_to_point(PAIR, start_q=start, end_q=end, keep=keep, limits=LIMITS, obstacles=[post])
        assert plan.success, f"{tolerance}: {plan.message}"
        assert (worst(plan) <= tolerance * (1 + 1e-6)).all(), tolerance


def test_narrow_and_wide_entries_of_one_task_hold_together() -> None:
    start, end, post = problem(5)
    task = bik.tasks.Pose(tolerance=[1e-5, 1e-5, 0.02, 0.1, FREE, 1e-4])
    keep = bik.Keep({HANDS: TRAY}, task)
    plan = bik.plan_point_to_point(PAIR, start_q=start, end_q=end, keep=keep, limits=LIMITS, obstacles=[post])
    assert plan.success, plan.message
    ((_, largest),) = plan.kept
    limited = np.isfinite(task.tolerance)
    assert (largest[limited] <= task.tolerance[limited]).all()
