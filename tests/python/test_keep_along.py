"""What holds along a path of the tip: `plan_along_path(keep=)`, judged by samples of the timed motion."""

import numpy as np
import pytest

import beetle_ik as bik

ARM = bik.Robot.named("panda")
LIMITS = bik.Limits(velocity=1.5, acceleration=5.0)
CIRCLE = bik.paths.circle([0.45, 0.0, 0.35], 0.3, 10.0)
ANYWHERE = bik.tasks.Position()
SAMPLES = 5000


def sampled(plan: bik.Plan) -> np.ndarray:
    """Poses of the tip (m, 4, 4) along the motion."""
    return ARM.fk(plan.trajectory.sample(plan.trajectory.duration / SAMPLES)[1])


def tilts(plan: bik.Plan) -> np.ndarray:
    """Angles (m,) between the axis of the flange and down (rad), by their sines and cosines."""
    axis = sampled(plan)[:, :3, 2]
    return np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), -axis[:, 2])


def upright_along(path: object, tilt: float, **options: object) -> bik.Plan:
    keep = bik.upright(ARM, tilt=tilt)
    return bik.plan_along_path(ARM, path, task=ANYWHERE, keep=keep, limits=LIMITS, **options)


@pytest.mark.parametrize("tilt", [1.0, 0.1, 1e-6])
def test_a_free_orientation_stays_upright(tilt: float) -> None:
    free = bik.plan_along_path(ARM, CIRCLE, task=ANYWHERE, limits=LIMITS)
    assert tilts(free).max() > 0.5
    plan = upright_along(CIRCLE, tilt)
    assert plan.success, plan.message
    assert tilts(plan).max() <= tilt * (1 + 1e-6)
    ((_, largest),) = plan.kept
    assert tilts(plan).max() * (1 - 1e-6) <= largest[3] <= tilt


def test_the_tip_still_follows_its_path_among_obstacles() -> None:
    arm = ARM.with_capsules(radius=0.05)
    ball = bik.obstacles.Sphere((0.45, 0.0, 0.75), 0.1)
    keep = bik.upright(arm, tilt=0.2)
    plan = bik.plan_along_path(arm, CIRCLE, task=ANYWHERE, keep=keep, limits=LIMITS, obstacles=[ball])
    assert plan.success, plan.message
    assert tilts(plan).max() <= 0.2
    assert plan.clearance >= 0.001
    distance = np.linalg.norm(sampled(plan)[:, :3, 3] - [0.45, 0.0, 0.35], axis=1)
    assert np.abs(distance - 0.15).max() < 1e-3


def test_poses_that_break_it_are_named() -> None:
    across = np.linspace(-0.3, 0.3, 12)
    poses = np.array([bik.pose([0.45, y, 0.4], rpy=[np.pi, 0.5 * y, 0]) for y in across])
    assert bik.plan_along_path(ARM, poses, keep=bik.upright(ARM, tilt=0.2), limits=LIMITS).success
    with pytest.raises(bik.InvalidInputError, match=r"what is to be kept holds at none of \d+ configurations .* tilt"):
        bik.plan_along_path(ARM, poses, keep=bik.upright(ARM, tilt=0.1), limits=LIMITS)


def test_a_start_that_breaks_it_is_refused() -> None:
    start = bik.solve(ARM, [0.6, 0.0, 0.35]).q
    tilt = float(np.arccos(-ARM.fk(start)[2, 2]))
    said = f"start_q: what is to be kept on the way does not hold there: tilt {tilt:.4g} rad of at most 0.1000"
    with pytest.raises(bik.InvalidInputError) as told:
        upright_along(CIRCLE, 0.1, start_q=start)
    assert str(told.value) == said


def test_a_method_that_keeps_nothing_is_refused() -> None:
    arm = bik.Robot.planar([1.0, 1.0, 1.0])
    star = bik.paths.pentagram((1.0, 1.0, 0.0), 5.0, radius=0.5)
    keep = bik.Keep([0, 0, 0], bik.tasks.Position(tolerance=[9, 9, 9]))
    with pytest.raises(bik.InvalidInputError) as told:
        bik.plan_along_path(arm, star, keep=keep, method="tpbso")
    assert str(told.value) == 'what is to be kept along a path needs method="timed"'


def test_a_region_holds_along_a_path_or_the_plan_fails() -> None:
    start = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])
    pose = ARM.fk(start)
    free, half = [np.inf] * 3, np.array([0.2, 0.03, 0.2])
    box = [pose[:3, 3] - half, pose[:3, 3] + half]
    keep = bik.Keep(pose[:3, 3], bik.tasks.Position(tolerance=free, region=box))
    for way, holds in ((0.02, True), (0.1, False)):
        poses = np.tile(pose, (15, 1, 1))
        poses[:, 1, 3] += np.linspace(0.0, way, 15)
        plan = bik.plan_along_path(ARM, poses, start_q=start, keep=keep, limits=LIMITS)
        assert plan.success is holds, plan.message
        if not holds:
            assert "no plan keeps everything" in plan.message
            assert "distance above y" in plan.message
