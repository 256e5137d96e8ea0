"""`self_motion`: curves of configurations that keep the tip at a target."""

import pickle

import numpy as np
import pytest

import beetle_ik as bik

PANDA = bik.Robot.named("panda")
Q = np.array([0.3, 0.2, -0.4, -1.7, 0.2, 1.9, 0.5])
POSE = PANDA.fk(Q)


def test_every_configuration_keeps_the_pose_within_limits_and_spacing() -> None:
    curves = bik.self_motion(PANDA, POSE, start_q=Q, spacing=0.1)
    for curve in curves:
        np.testing.assert_allclose(PANDA.fk(curve.q), np.broadcast_to(POSE, (len(curve), 4, 4)), rtol=0, atol=1e-8)
        assert ((PANDA.lower <= curve.q) & (curve.q <= PANDA.upper)).all()
        assert (np.linalg.norm(np.diff(curve.q, axis=0), axis=1) <= 0.1).all()
        assert curve.length == pytest.approx(np.linalg.norm(np.diff(curve.q, axis=0), axis=1).sum())
    # The nearest curve comes first and passes the start.
    assert np.linalg.norm(curves[0].q - Q, axis=1).min() <= 0.1


def test_the_finest_spacing_keeps_the_pose_too() -> None:
    curves = bik.self_motion(PANDA, POSE, spacing=1e-3)
    assert sum(map(len, curves)) > 10_000
    for curve in curves:
        np.testing.assert_allclose(PANDA.fk(curve.q), np.broadcast_to(POSE, (len(curve), 4, 4)), rtol=0, atol=1e-8)
        assert (np.linalg.norm(np.diff(curve.q, axis=0), axis=1) <= 1e-3).all()


def test_limits_cut_curves_at_the_joint_they_name() -> None:
    cut = [curve for curve in bik.self_motion(PANDA, POSE) if not curve.closed]
    assert cut
    for curve in cut:
        for q, name in ((curve.q[0], curve.lower_cut), (curve.q[-1], curve.upper_cut)):
            j = PANDA.joint_names.index(name)
            assert min(q[j] - PANDA.lower[j], PANDA.upper[j] - q[j]) < 1e-6
        assert repr(curve).startswith(f"<SelfMotion: {len(curve)} configurations, from a limit of")


def test_without_limits_curves_are_closed() -> None:
    wide = bik.Limits(lower=-np.inf, upper=np.inf)
    for curve in bik.self_motion(PANDA, POSE, limits=wide, spacing=0.1):
        assert curve.closed
        assert (curve.lower_cut, curve.upper_cut) == (None, None)
        gap = (curve.q[0] - curve.q[-1] + np.pi) % (2 * np.pi) - np.pi
        assert np.linalg.norm(gap) <= 0.1


def test_the_arm_angle_proves_that_no_curve_is_missing() -> None:
    iiwa = bik.Robot.named("iiwa14")
    curves = bik.self_motion(iiwa, iiwa.fk(np.array([0.1, 0.6, -0.3, -1.2, 0.4, 0.9, -0.2])))
    assert curves
    assert all(curve.complete for curve in curves)
    assert not any(curve.complete for curve in bik.self_motion(PANDA, POSE))


def test_four_joints_and_a_position() -> None:
    table = {"a": [0.0, 0.3, 0.3, 0.2], "alpha": [np.pi / 2, 0.0, 0.0, 0.0], "d": [0.2, 0.0, 0.0, 0.0]}
    arm = bik.Robot.from_dh(**table, convention="standard")
    q = np.array([0.4, 0.7, -0.9, 0.6])
    position = arm.fk(q)[:3, 3]
    curves = bik.self_motion(arm, position, start_q=q)
    np.testing.assert_allclose(arm.fk(curves[0].q)[:, :3, 3], np.broadcast_to(position, (len(curves[0]), 3)), atol=1e-8)
    assert np.linalg.norm(curves[0].q - q, axis=1).min() <= 0.05


def test_a_target_out_of_reach_has_no_curve() -> None:
    assert bik.self_motion(PANDA, bik.pose([2.0, 0.0, 0.5])) == []


def test_curves_are_pickled() -> None:
    curve = bik.self_motion(PANDA, POSE)[0]
    copy = pickle.loads(pickle.dumps(curve))
    np.testing.assert_array_equal(copy.q, curve.q)
    assert (copy.closed, copy.lower_cut, copy.upper_cut, repr(copy)) == (
        curve.closed,
        curve.lower_cut,
        curve.upper_cut,
        repr(curve),
    )


def test_arms_without_one_joint_more_are_refused() -> None:
    says = r"^self_motion needs one joint more than the target: robot 'ur10' has 6 joints, and this target takes 6$"
    with pytest.raises(bik.InvalidInputError, match=says):
        bik.self_motion(bik.Robot.named("ur10"), POSE)
    with pytest.raises(bik.InvalidInputError, match=r"^spacing must be from 0.001 to 0.5, got 2$"):
        bik.self_motion(PANDA, POSE, spacing=2.0)


def test_curves_of_random_arms_have_no_gaps_where_limits_cut_them() -> None:
    rng = np.random.default_rng(1)
    cut = 0
    for _ in range(5):
        a, d, alpha = rng.uniform(-0.4, 0.4, 7), rng.uniform(-0.4, 0.4, 7), rng.uniform(-2.0, 2.0, 7)
        lower, upper = -rng.uniform(1, 6, 7), rng.uniform(1, 6, 7)
        arm = bik.Robot.from_dh(a=a, alpha=alpha, d=d, lower=lower, upper=upper)
        for curve in bik.self_motion(arm, arm.fk(rng.uniform(lower, upper)), spacing=0.2):
            steps = np.linalg.norm(np.diff(curve.q, axis=0), axis=1)
            assert steps.max(initial=0.0) <= 0.2
            cut += (curve.lower_cut is not None) + (curve.upper_cut is not None)
    assert cut > 20


def nearest_to(curves: list[bik.SelfMotion], q: np.ndarray) -> float:
    """Distance of q from the curves, whole turns aside."""
    return min(float(np.linalg.norm((curve.q - q + np.pi) % (2 * np.pi) - np.pi, axis=1).min()) for curve in curves)


@pytest.mark.parametrize("joint", [1, 3, 5])
def test_curves_of_singular_poses_are_not_called_complete(joint: int) -> None:
    iiwa = bik.Robot.named("iiwa14")
    rng = np.random.default_rng(joint)
    for _ in range(5):
        q = rng.uniform(0.9 * iiwa.lower, 0.9 * iiwa.upper)
        q[joint] = 0.0
        curves = bik.self_motion(iiwa, iiwa.fk(q))
        assert curves
        assert not any(curve.complete for curve in curves)
        # The start reaches the pose: a curve passes it.
        assert nearest_to(bik.self_motion(iiwa, iiwa.fk(q), start_q=q), q) <= 0.06


def test_a_pose_that_is_solved_has_a_curve() -> None:
    gen3 = bik.Robot.named("gen3")
    q = np.array([2.332157592, 0.647266749, -0.871976777, -0.039234226, 4.693339491, -0.693481864, -0.678897468])
    assert bik.solve(gen3, gen3.fk(q)).success
    assert bik.self_motion(gen3, gen3.fk(q))
    assert nearest_to(bik.self_motion(gen3, gen3.fk(q), start_q=q), q) <= 0.06
