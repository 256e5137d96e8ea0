"""Poses as they are written: rounded, drifted, transposed and mirrored matrices; arrays that may be written to."""

import pickle

import numpy as np
import pytest

import beetle_ik as bik

PANDA = bik.Robot.named("panda").with_capsules(radius=0.05)
READY = np.radians([0.0, -45.0, 0.0, -135.0, 0.0, 90.0, 45.0])
LIMITS = bik.Limits(acceleration=8.0, jerk=80.0)


def nearest(rotation: np.ndarray) -> np.ndarray:
    u, _, v = np.linalg.svd(rotation)
    return u @ v


@pytest.mark.parametrize("decimals", [3, 4, 5])
def test_rounded_matrices_become_the_nearest_rotation(decimals: int) -> None:
    for pose in PANDA.fk(PANDA.random_configurations(50, seed=decimals)):
        rounded = pose.round(decimals)
        for made in (bik.pose(matrix=rounded), bik.pose(rounded[:3, 3], matrix=rounded[:3, :3])):
            np.testing.assert_allclose(made[:3, :3], nearest(rounded[:3, :3]), rtol=0, atol=1e-14)
            np.testing.assert_array_equal(made[:3, 3], rounded[:3, 3])
        assert bik.solve(PANDA, rounded).success


def test_a_pose_needs_no_position() -> None:
    pose = PANDA.fk(READY)
    np.testing.assert_allclose(bik.pose(matrix=pose), pose, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(bik.pose(rpy=[0, 0, 1.0]), bik.pose([0, 0, 0], rpy=[0, 0, 1.0]))


MIRRORED = "its rotation is a reflection (determinant -1): turn one of its axes round"
TRANSPOSED = (
    "its last row is (0.3, 0.1, 0.5, 1), not (0, 0, 0, 1): transpose it, so that the position is its last column"
)
R_OFF = "; the nearest rotation is U V' of its singular value decomposition U S V'"


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (lambda pose: pose * np.diag([1.2, 1, 1, 1]), "R'R differs from the identity by 4.400e-1" + R_OFF),
        (lambda pose: pose @ np.diag([1, 1, -1, 1]), MIRRORED),
        (lambda pose: pose.T, TRANSPOSED),
        (lambda pose: pose + np.diag([0, 0, 0, 1.0]), "its last row is (0, 0, 0, 2), not (0, 0, 0, 1)"),
    ],
    ids=["scaled", "mirrored", "transposed", "last row"],
)
def test_what_is_no_pose_is_refused_with_a_remedy(change: object, problem: str) -> None:
    wrong = change(bik.pose([0.3, 0.1, 0.5]))
    expected = f"{{0}} is not a rigid transform: {problem}"
    tracker = bik.Tracker(PANDA, READY, dt=0.01)
    for name, call in (
        ("target", lambda: bik.solve(PANDA, wrong)),
        ("target", lambda: tracker.step(wrong)),
        ("matrix", lambda: bik.pose(matrix=wrong)),
    ):
        with pytest.raises(bik.InvalidInputError) as told:
            call()
        assert str(told.value) == expected.format(name)


def test_sixteen_numbers_are_told_their_shape() -> None:
    with pytest.raises(bik.InvalidInputError) as told:
        bik.solve(PANDA, np.eye(4).ravel())
    assert str(told.value) == (
        "target: expected a pose (4, 4) or a position (3,), got shape (16,); "
        ".reshape(4, 4) makes a matrix of 16 numbers, row by row"
    )


@pytest.mark.parametrize("limits", [None, LIMITS], ids=["velocity", "jerk"])
def test_a_tracker_takes_turns_accumulated_in_float32(limits: bik.Limits | None) -> None:
    """Half an hour at 1 kHz in a few hundred steps: the drift of products in single precision, made faster."""
    pose = PANDA.fk(READY)
    tracker = bik.Tracker(PANDA, READY, dt=0.01, limits=limits)
    turn = bik.pose(rotvec=[0, 0, 0.002])[:3, :3].astype(np.float32) * np.float32(1.0 + 1e-4)
    rotation, messages, drifted = pose[:3, :3].astype(np.float32), [], []
    for _ in range(600):
        rotation = turn @ rotation
        target = bik.pose(pose[:3, 3]).astype(np.float32)
        target[:3, :3] = rotation
        step = tracker.step(target)
        messages.append(step.message)
        drifted.append(abs(rotation.T @ rotation - np.eye(3)).max())
        if limits is None:
            assert step.success, step.message
    told = [i for i, message in enumerate(messages) if "drifted" in message]
    assert max(drifted) > 0.1
    assert told == [next(i for i, size in enumerate(drifted) if size > 2e-3)]
    expected = "the rotation of the target has drifted: R'R differs from the identity by 2.0"
    assert expected in messages[told[0]]
    assert messages[told[0]].endswith("; the nearest rotation is taken")


def test_a_step_with_a_drifted_target_is_pickled_with_its_message() -> None:
    pose = PANDA.fk(READY)
    pose[:3, :3] *= 1.01
    step = bik.Tracker(PANDA, READY, dt=0.01).step(pose)
    assert step.success
    assert "drifted" in step.message
    assert pickle.loads(pickle.dumps(step)).message == step.message


def test_arrays_that_a_call_returns_may_be_written_to() -> None:
    several, one = np.array([READY, READY]), [0.1, 0.2]
    path = bik.paths.circle((0.4, 0.1, 0.4), diameter=0.1, duration=1.0)
    plan = bik.plan_point_to_point(PANDA, start_q=READY, end_q=0.9 * READY)
    two = bik.Robot.from_urdf(
        "<robot name='two'><link name='a'/><link name='b'/><link name='c'/>"
        + "".join(
            f"<joint name='j{tip}' type='continuous'><parent link='a'/><child link='{tip}'/></joint>" for tip in "bc"
        )
        + "</robot>",
        tip=["b", "c"],
    )
    arrays = [
        *[PANDA.fk(q) for q in (READY, several)],
        *[PANDA.fk(q, link="link_4") for q in (READY, several)],
        *[PANDA.jacobian(q) for q in (READY, several)],
        *[PANDA.clip(q) for q in (READY, several)],
        *[two.fk(q) for q in (one, [one, one])],
        *[two.jacobian(q) for q in (one, [one, one])],
        PANDA.link_poses(READY),
        PANDA.all_link_poses(READY),
        PANDA.random_configurations(3),
        PANDA.manipulability(several),
        PANDA.link_manipulability(READY),
        bik.obstacles.clearance(PANDA, several),
        bik.pose([0, 0, 0]),
        path.position(0.5),
        *path.sample(0.1),
        *plan.trajectory.at(0.1),
        *plan.trajectory.at([0.1, 0.2]),
        *plan.trajectory.sample(0.1),
        plan.trajectory.max_velocity(),
    ]
    before = [PANDA.fk(READY), PANDA.lower.copy()]
    for array in arrays:
        array[...] = 0.0
    np.testing.assert_array_equal(PANDA.fk(READY), before[0])
    np.testing.assert_array_equal(PANDA.lower, before[1])


def test_arrays_of_attributes_stay_as_they_are() -> None:
    solution = bik.solve(PANDA, [0.4, 0.1, 0.4])
    step = bik.Tracker(PANDA, READY, dt=0.01).step([0.4, 0.1, 0.4])
    for array in (solution.q, step.q, PANDA.lower, PANDA.velocity_limit):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
