"""Two arms planned out of narrow places; coal judges the motions, between the arms too."""

import numpy as np
import pytest
from coal_distance import distance_by_coal
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik

ROBOT = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
LIMITS = bik.Limits(velocity=1.5, acceleration=5.0)
MARGIN = 0.01


def grid(random: np.random.Generator) -> tuple[bik.Scene, float]:
    """A grid of bars in front of both arms, whose openings are hardly wider than an elbow; and its distance."""
    x, gap = random.uniform(0.4, 0.55), random.uniform(0.3, 0.36)
    upright = [bik.obstacles.Box(center=(x, y, 0.9), size=(0.03, 0.03, 2.0)) for y in np.arange(-3, 4) * gap]
    level = [bik.obstacles.Box(center=(x, 0, z), size=(0.03, 2.4, 0.03)) for z in 0.4 + np.arange(5) * gap]
    return bik.Scene([*upright, *level]), x


def reaching_through(scene: bik.Scene, x: float, random: np.random.Generator) -> np.ndarray:
    """A clear configuration with both hands behind the bars."""
    while True:
        beyond = x + random.uniform(0.08, 0.2, 2)
        left, right = random.uniform((0.1, 0.6), (0.6, 1.3)), random.uniform((-0.6, 0.6), (-0.1, 1.3))
        targets = {"left_tool": (beyond[0], *left), "right_tool": (beyond[1], *right)}
        start = ROBOT.random_configurations(1, seed=int(random.integers(2**31)))[0]
        solution = bik.solve(ROBOT, targets, start_q=start, obstacles=scene, margin=2 * MARGIN)
        if solution.success:
            return solution.q


@pytest.mark.parametrize("seed", range(16))
def test_both_hands_get_from_opening_to_opening(seed: int) -> None:
    random = np.random.default_rng(seed)
    scene, x = grid(random)
    ends = [reaching_through(scene, x, random) for _ in range(2)]
    plan = bik.plan_point_to_point(ROBOT, start_q=ends[0], end_q=ends[1], obstacles=scene, margin=MARGIN, limits=LIMITS)
    assert plan.success, plan.message
    motion = plan.trajectory
    np.testing.assert_allclose(motion.at([0.0, motion.duration])[0], ends, atol=1e-9)
    for t in np.linspace(0.0, motion.duration, 60):
        assert distance_by_coal(ROBOT, motion.at(t)[0], scene) > MARGIN - 1e-6


def test_a_plan_out_of_a_narrow_place_repeats_by_its_seed() -> None:
    random = np.random.default_rng(3)
    scene, x = grid(random)
    ends = [reaching_through(scene, x, random) for _ in range(2)]
    one, again, other = (
        bik.plan_point_to_point(
            ROBOT, start_q=ends[0], end_q=ends[1], obstacles=scene, margin=MARGIN, limits=LIMITS, seed=seed
        ).trajectory
        for seed in (7, 7, 8)
    )
    assert np.array_equal(one.coefficients, again.coefficients)
    assert one.coefficients.shape != other.coefficients.shape or not np.array_equal(
        one.coefficients, other.coefficients
    )
