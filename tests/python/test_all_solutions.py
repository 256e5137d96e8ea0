"""`solve_all` in closed form, as seen from Python."""

import pickle

import numpy as np
import pytest

import beetle_ik as bik

UR = bik.Robot.named("ur10")
Q = np.array([0.4, -1.2, 1.1, -1.3, 0.9, 0.2])
POSE = UR.fk(Q)


@pytest.mark.parametrize(
    ("robot", "closed_form"),
    [
        (UR, "axes 2 to 4 parallel; at most 8 solutions"),
        (bik.Robot.named("kr210"), "spherical wrist; at most 8 solutions"),
        (
            bik.Robot.named("panda"),
            "spherical shoulder; at most 8 solutions for each value of joint 'panda_joint7'",
        ),
        (bik.Robot.planar([0.5, 0.4, 0.2]), "planar; at most 2 solutions"),
        (bik.Robot.planar([1.0] * 8), "none: 8 joints; closed forms are for 3 to 7"),
        (bik.Robot.planar([1.0] * 6), "none: the tip moves in 3 of 6 directions"),
    ],
)
def test_the_closed_form_is_told(robot: bik.Robot, closed_form: str) -> None:
    assert robot.closed_form == closed_form


def test_the_set_is_complete_and_exact() -> None:
    found = bik.solve_all(UR, POSE, start_q=Q)
    assert (len(found), found.complete, found.singular) == (8, True, False)
    assert found.message == "8 distinct solutions, no others inside the limits"
    np.testing.assert_allclose(UR.fk(found.q), np.broadcast_to(POSE, (8, 4, 4)), rtol=0, atol=1e-10)
    np.testing.assert_allclose(found[0].q, Q, atol=1e-9)


def test_whole_turns_on_request() -> None:
    found = bik.solve_all(UR, POSE, start_q=Q, turns=True)
    assert found.complete
    assert len(found) > 100
    assert len(np.unique(found.q.round(6), axis=0)) == len(found)
    assert ((UR.lower <= found.q) & (found.q <= UR.upper)).all()
    np.testing.assert_allclose(UR.fk(found.q), np.broadcast_to(POSE, (len(found), 4, 4)), rtol=0, atol=1e-9)
    nearest = bik.solve_all(UR, POSE, start_q=Q, turns=True, limit=5)
    assert not nearest.complete
    np.testing.assert_array_equal(nearest.q, found.q[:5])


def test_too_many_turns_are_refused() -> None:
    wide = bik.Limits(lower=-60.0, upper=60.0)
    with pytest.raises(bik.InvalidInputError, match=r"^turns=True makes \d+ configurations; at most 10000 are allowed"):
        bik.solve_all(UR, POSE, start_q=Q, turns=True, limits=wide)


def test_what_is_left_out_is_not_called_complete() -> None:
    assert not bik.solve_all(UR, POSE, limit=3).complete
    assert not bik.solve_all(UR, POSE, separation=3.0).complete
    assert not bik.solve_all(UR, POSE, solver=bik.MultiStart(bik.NewtonRaphson())).complete
    assert not bik.solve_all(UR, POSE[:3, 3], limit=3).complete


def test_a_singular_pose_is_reported() -> None:
    q = np.array([0.4, -1.2, 1.1, -1.3, 0.0, 0.2])
    found = bik.solve_all(UR, UR.fk(q), start_q=q)
    assert found.singular
    assert found.message.endswith("; the pose is singular: a family counts as one solution")


def test_out_of_reach_is_proven() -> None:
    pose = bik.pose([1.2, 0.0, 0.1], rpy=[0.0, -1.5, 0.0])
    found = bik.solve_all(UR, pose)
    assert (len(found), found.status, found.complete) == (0, bik.Status.OUT_OF_REACH, True)
    assert "(no configuration has this pose): move or turn the target into reach" in found.message


def test_the_nearest_miss_is_computed_when_asked_for() -> None:
    found = bik.solve_all(UR, bik.pose([1.2, 0.0, 0.1], rpy=[0.0, -1.5, 0.0]))
    assert found.evaluations <= 16
    miss, again = found.miss, found.miss
    assert miss is not None
    assert again is not None
    assert miss.status == bik.Status.OUT_OF_REACH
    assert 0.0 < miss.position_error < 1.0
    np.testing.assert_array_equal(miss.q, again.q)
    copy = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(copy.miss.q, miss.q)
    assert (copy.status, copy.message) == (found.status, found.message)


@pytest.mark.parametrize("name", ["panda", "iiwa14", "gen3"])
def test_redundant_arms_are_sampled(name: str) -> None:
    robot = bik.Robot.named(name)
    q = robot.random_configurations(20, seed=4)
    few = [bik.solve_all(robot, pose, redundancy=8) for pose in robot.fk(q)]
    many = [bik.solve_all(robot, pose, redundancy=32) for pose in robot.fk(q)]
    assert sum(map(len, many)) > 3 * sum(map(len, few))
    for found, pose in zip(many, robot.fk(q), strict=True):
        np.testing.assert_allclose(robot.fk(found.q), np.broadcast_to(pose, (len(found), 4, 4)), rtol=0, atol=1e-9)
        assert ((robot.lower <= found.q) & (found.q <= robot.upper)).all()
        assert not found.complete
    start = q[0]
    nearest_first = bik.solve_all(robot, robot.fk(start), start_q=start).q
    distances = np.linalg.norm(nearest_first - start, axis=1)
    assert (np.diff(distances) >= 0.0).all()


def test_the_number_of_samples_is_checked() -> None:
    with pytest.raises(bik.InvalidInputError, match=r"^redundancy must be zero or more, got -1$"):
        bik.solve_all(bik.Robot.named("panda"), POSE, redundancy=-1)


def test_completeness_is_pickled() -> None:
    for found in (bik.solve_all(UR, POSE), bik.solve_all(UR, POSE, limit=2)):
        copy = pickle.loads(pickle.dumps(found))
        assert (copy.complete, copy.singular, copy.message) == (found.complete, found.singular, found.message)
        np.testing.assert_array_equal(copy.q, found.q)


def flat_arm(off: np.ndarray) -> bik.Robot:
    """Five joints whose axes, without the offsets `off` (5, 3), are in one plane or across it."""
    at = np.array([(0.1, 0, 0.2), (0.05, 0, 0.35), (0.3, 0, -0.1), (0.2, 0, 0.25), (-0.3, 0, -0.1)]) + off
    joints = (
        f"<link name='l{i + 1}'/><joint name='j{i}' type='continuous'><parent link='l{i}'/><child link='l{i + 1}'/>"
        f"<origin xyz='{x} {y} {z}'/><axis xyz='{axis}'/></joint>"
        for i, ((x, y, z), axis) in enumerate(zip(at, ("0 0 1", "0 1 0", "0 1 0", "0 1 0", "1 0 0"), strict=True))
    )
    return bik.Robot.from_urdf(f"<robot name='flat'><link name='l0'/>{''.join(joints)}</robot>")


def test_solutions_within_the_tolerances_alone_are_in_a_complete_set() -> None:
    """A flat arm has a pose again with its first joint turned by half a turn; joints a little off it nearly so."""
    flat, rng, nearly = flat_arm(np.zeros((5, 3))), np.random.default_rng(1), 0
    for _ in range(150):
        robot = flat_arm(rng.normal(size=(5, 3)) * 10.0 ** rng.uniform(-9.0, -6.7))
        q = rng.uniform(-1.2, 1.2, 5)
        q[4] = rng.choice([0.0, np.pi]) + rng.choice([-0.003, -0.002, 0.002, 0.003])  # near a double root
        target = robot.fk(q)
        found = bik.solve_all(robot, target)
        if not found.complete or found.singular:
            continue
        for start in bik.solve_all(flat, flat.fk(q)).q:
            other = bik.solve(robot, target, start_q=start, position_tolerance=5e-7, rotation_tolerance=5e-7)
            if other.success:
                apart = (found.q - other.q + np.pi) % (2.0 * np.pi) - np.pi
                assert np.abs(apart).max(axis=1).min() < 1e-3, (other.q, found.q)
                nearly += max(other.position_error, other.rotation_error) > 1e-8
    assert nearly > 15


def test_whole_turns_of_an_unlimited_joint_are_not_complete() -> None:
    arm = bik.Robot.named("ur3e")
    pose = arm.fk([0.4, -1.2, 1.1, -1.3, 0.9, 10.0])
    assert bik.solve_all(arm, pose).complete
    turned = bik.solve_all(arm, pose, turns=True)
    assert not turned.complete
    assert "no others" not in turned.message
    within = arm.with_limits(lower=-7.0, upper=7.0)
    assert bik.solve_all(within, pose, turns=True).complete
