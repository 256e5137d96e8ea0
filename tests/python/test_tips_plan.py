"""Two arms on a torso planned among boxes: coal judges the motions, between the arms too."""

import numpy as np
import pytest
from coal_distance import distance_by_coal
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik

ROBOT = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
LIMITS = bik.Limits(velocity=1.5, acceleration=5.0)
MARGIN = 0.01


def on_a_table(seed: int) -> bik.Scene:
    """A table with four boxes standing on it, where both hands work."""
    rng = np.random.default_rng(seed)
    places, sizes = rng.uniform((0.4, -0.6), (0.8, 0.6), (4, 2)), rng.uniform(0.05, 0.15, (4, 2))
    boxes = [
        bik.obstacles.Box(center=(*place, 0.65), size=(*size, 0.25)) for place, size in zip(places, sizes, strict=True)
    ]
    return bik.Scene([bik.obstacles.Box(center=(0.6, 0, 0.5), size=(0.5, 1.4, 0.05)), *boxes])


def clear_configurations(scene: bik.Scene, seed: int) -> np.ndarray:
    qs = ROBOT.random_configurations(3000, seed=seed)
    return qs[bik.obstacles.clearance(ROBOT, qs, scene) > 2 * MARGIN]


@pytest.mark.parametrize("seed", range(12))
def test_both_arms_keep_clear_of_boxes_and_of_each_other(seed: int) -> None:
    scene = on_a_table(seed)
    start, end, *_ = clear_configurations(scene, seed)
    options = {"obstacles": scene, "margin": MARGIN, "self_collision": True, "limits": LIMITS}
    plan = bik.plan_point_to_point(
        ROBOT, start_q=start, end=dict(zip(ROBOT.tips, ROBOT.fk(end), strict=True)), **options
    )
    assert plan.success, plan.message
    motion = plan.trajectory
    np.testing.assert_allclose(ROBOT.fk(motion.at(motion.duration)[0]), ROBOT.fk(end), atol=1e-5)
    for t in np.linspace(0.0, motion.duration, 60):
        assert distance_by_coal(ROBOT, motion.at(t)[0], scene) > MARGIN - 1e-6
