"""Manipulability, its gradient and the velocity ellipsoid from Python. The core tests the numbers themselves."""

import numpy as np
import pytest

import beetle_ik as bik

IIWA = bik.Robot.named("iiwa14")
Q = np.array([0.3, 0.5, -0.2, -1.1, 0.4, 0.9, 0.1])


def test_ellipsoid_lengths_are_singular_values_of_the_jacobian() -> None:
    ellipsoid = IIWA.velocity_ellipsoid(Q)
    left, lengths, _ = np.linalg.svd(IIWA.jacobian(Q)[:3])
    np.testing.assert_allclose(ellipsoid.lengths, lengths, rtol=1e-12)
    np.testing.assert_allclose(np.abs(np.sum(ellipsoid.axes[:, :3] * left.T, axis=1)), 1.0, rtol=1e-12)
    assert ellipsoid.axes.shape == (3, 6)
    assert ellipsoid.index == pytest.approx(IIWA.manipulability(Q, motion="position"), rel=1e-12)
    assert ellipsoid.condition == pytest.approx(lengths[0] / lengths[-1], rel=1e-12)
    assert 0.0 < ellipsoid.isotropy < 1.0
    assert repr(ellipsoid).startswith("<VelocityEllipsoid: lengths ")


@pytest.mark.parametrize("motion", ["pose", "position", "rotation"])
def test_the_gradient_is_that_of_finite_differences(motion: str) -> None:
    steps = 1e-6 * np.eye(7)
    after, before = (IIWA.manipulability(Q + sign * steps, motion=motion) for sign in (1, -1))
    np.testing.assert_allclose(IIWA.manipulability_gradient(Q, motion=motion), (after - before) / 2e-6, atol=1e-8)


def test_links_of_a_planar_arm() -> None:
    arm = bik.Robot.planar([0.5, 0.5, 0.5])
    q = np.array([0.2, 1.0, 0.4])
    indices = arm.link_manipulability(q)
    assert indices[0] == 0.0
    assert indices[1] == pytest.approx(np.pi * 0.25 * np.sin(1.0), rel=1e-12)
    assert indices[2] == pytest.approx(np.pi * arm.manipulability(q, motion="position"), rel=1e-12)


def test_wrong_input_is_named() -> None:
    message = "motion must be one of 'pose', 'position', 'rotation', got 'speed'"
    for call in (IIWA.manipulability, IIWA.velocity_ellipsoid, IIWA.manipulability_gradient, IIWA.link_manipulability):
        with pytest.raises(bik.InvalidInputError, match=message):
            call(Q, motion="speed")
        with pytest.raises(bik.InvalidInputError, match="joint angles of robot 'iiwa14': expected 7 joints, got 2"):
            call([0.0, 0.0])
