"""Robots on mobile bases, and robots of many joints: against Pinocchio, in all calls, and refused arguments."""

import pickle
from collections.abc import Callable

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik

ARM = bik.Robot.named("panda").with_base(bik.pose([0.1, -0.2, 0.4], rpy=[0.1, 0.2, 0.3])).with_capsules(radius=0.05)
BOX = np.array([2.0, 2.0, 1.0, np.pi, np.pi, np.pi])
PLANAR = ARM.with_mobile_base(
    "planar", lower=-BOX[[0, 1, 3]], upper=BOX[[0, 1, 3]], velocity=1.0, acceleration=[1, 1, 2]
)
FLOATING = ARM.with_mobile_base("floating", lower=-BOX, upper=BOX, velocity=1.0)
READY = [0, -0.4, 0, -2.0, 0, 1.6, 0.8]


def test_joints_of_the_base_come_first() -> None:
    assert PLANAR.joint_names[:4] == ["base_x", "base_y", "base_yaw", *ARM.joint_names[:1]]
    assert FLOATING.joint_names[:6] == ["base_x", "base_y", "base_z", "base_rx", "base_ry", "base_rz"]
    assert (PLANAR.dof, FLOATING.dof) == (10, 13)
    assert PLANAR.all_link_names[0] == "world"
    np.testing.assert_array_equal(PLANAR.rated_limits.acceleration[:3], [1, 1, 2])
    assert pickle.loads(pickle.dumps(FLOATING)) == FLOATING


def test_kinematics_agree_with_pinocchio() -> None:
    pin = pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
    for q in FLOATING.random_configurations(50, seed=2):
        base = pin.SE3(pin.exp3(q[3:6]), q[:3]).homogeneous
        np.testing.assert_allclose(FLOATING.fk(q), base @ ARM.fk(q[6:]), rtol=0, atol=1e-13)
        # The derivative of exp: the left Jacobian is the right one of the opposite vector.
        turns = FLOATING.jacobian(q)[3:, 3:6]
        np.testing.assert_allclose(turns, pin.Jexp3(-q[3:6]), rtol=0, atol=1e-13)


@pytest.mark.parametrize("robot", [PLANAR, FLOATING], ids=["planar", "floating"])
def test_the_calls_of_the_library_take_it(robot: bik.Robot) -> None:
    base = robot.dof - 7
    limits = bik.Limits(velocity=1.0, acceleration=3.0)
    start = np.r_[np.zeros(base), READY]
    pillar = bik.obstacles.Cylinder(center=(0.8, 0.6, 0.5), axis=(0, 0, 1), radius=0.2, length=1.0)
    ends = robot.random_configurations(40, seed=5)
    batch = bik.solve_batch(robot, robot.fk(ends))
    assert batch.success.all()
    clear = bik.solve(robot, robot.fk(ends[0]), obstacles=[pillar])
    assert clear.success
    assert bik.obstacles.clearance(robot, clear.q, [pillar]) >= 0.0
    assert bik.solve_all(robot, robot.fk(ends[0])).q.shape[1] == robot.dof
    plan = bik.plan_point_to_point(robot, start_q=start, end_q=clear.q, obstacles=[pillar], limits=limits)
    assert plan.success, plan.message
    path = bik.paths.circle(center=robot.fk(start)[:3, 3] - [0.3, 0, 0], diameter=0.6, duration=4.0)
    run = bik.track(robot, path, dt=0.01, start_q=start, limits=limits, ease=True)
    assert run.position_error[-1] < 1e-4
    along = bik.plan_along_path(robot, path, start_q=start, limits=limits)
    assert along.success, along.message
    tracker = bik.Tracker(robot, start, dt=0.01, limits=limits, obstacles=[pillar])
    target = bik.pose([0.2, 0, 0]) @ robot.fk(start)
    for _ in range(400):
        step = tracker.step(target)
    assert step.success


def test_both_hands_on_wheels() -> None:
    torso = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
    robot = torso.with_mobile_base("planar", lower=[-1, -1, -np.pi], upper=[1, 1, np.pi])
    assert robot.dof == torso.dof + 3
    for seed, q in enumerate(robot.random_configurations(20, seed=1)):
        wanted = dict(zip(robot.tips, robot.fk(q), strict=True))
        assert bik.solve(robot, wanted, seed=seed).success


def snake(joints: int) -> bik.Robot:
    """A spatial arm of many joints, each turned by a right angle to the one before."""
    return bik.Robot.from_dh(
        a=[0.05] * joints,
        alpha=[np.pi / 2, -np.pi / 2] * (joints // 2),
        d=[0.02] * joints,
        lower=-1.0,
        upper=1.0,
        velocity=1.0,
    )


@pytest.mark.parametrize("joints", [34, 64])
def test_robots_of_many_joints(joints: int) -> None:
    robot = snake(joints)
    limits = bik.Limits(acceleration=5.0)
    qs = robot.random_configurations(20, seed=3)
    jacobian, step = robot.jacobian(qs[0]), 1e-6
    for j in range(joints):
        ahead, behind = (robot.fk(qs[0] + sign * step * np.eye(joints)[j])[:3, 3] for sign in (1, -1))
        np.testing.assert_allclose((ahead - behind) / (2 * step), jacobian[:3, j], atol=1e-8)
    assert bik.solve_batch(robot, robot.fk(qs)).success.all()
    for solver in (
        bik.NewtonRaphson(),
        bik.JacobianTranspose(),
        bik.BroydenBAS(),
        bik.papers.APPS(),
        bik.papers.PSO(),
        bik.papers.BAS(),
    ):
        s = bik.solve(robot, robot.fk(qs[0])[:3, 3], solver=solver, stop=bik.Stop(max_evaluations=3000))
        assert s.q.shape == (joints,)
    robot.manipulability(qs)
    robot.manipulability_gradient(qs[0])
    goals = [bik.goals.Centring(), bik.goals.Manipulability()]
    assert bik.solve(robot, robot.fk(qs[1]), goals=goals, task=bik.tasks.Pose()).success
    start = qs[2]
    path = bik.paths.circle(center=robot.fk(start)[:3, 3] - [0.05, 0, 0], diameter=0.1, duration=3.0)
    for rule in (None, bik.WeightedPseudoInverse()):
        assert bik.track(robot, path, dt=0.01, start_q=start, limits=bik.Limits(), solver=rule).q.shape[1] == joints
    assert bik.track(robot, path, dt=0.01, start_q=start, limits=limits, ease=True).q.shape[1] == joints
    plan = bik.plan_point_to_point(robot, start_q=qs[3], end_q=qs[4], limits=limits)
    assert plan.success
    thick, ball = robot.with_capsules(radius=0.005), [bik.obstacles.Sphere((1.0, 1.0, 1.0), 0.5)]
    for within in (bik.Limits(), limits):
        tracker = bik.Tracker(thick, start, dt=0.01, limits=within, obstacles=ball)
        for _ in range(20):
            tracker.step(robot.fk(qs[1]))
        assert bik.obstacles.clearance(thick, tracker.q, ball) >= 0.0
    clear = bik.solve(thick, robot.fk(qs[1]), obstacles=ball, self_collision=False)
    assert clear.q.shape == (joints,)
    # Where so many joints stand near their limits, it may say that it found no plan.
    assert bik.plan_along_path(robot, path, start_q=start, limits=limits).message


MISTAKES: list[tuple[Callable[[], object], type[Exception], str]] = [
    (
        lambda: ARM.with_mobile_base("planar"),
        bik.InvalidInputError,
        "a planar base needs lower=(3,), the limits of base_x, base_y, base_yaw: configurations are drawn from the "
        "range",
    ),
    (
        lambda: ARM.with_mobile_base("wheeled", lower=[0] * 3, upper=[1] * 3),  # type: ignore[arg-type]
        bik.InvalidInputError,
        "kind of mobile base must be one of 'planar', 'floating', got 'wheeled'",
    ),
    (
        lambda: ARM.with_mobile_base("planar", lower=-BOX, upper=BOX),
        bik.InvalidInputError,
        "lower of a planar base: expected 3 joints: base_x, base_y, base_yaw, got 6",
    ),
    (
        lambda: ARM.with_mobile_base("planar", lower=[-1, -np.inf, -1], upper=[1, 1, 1]),
        bik.InvalidInputError,
        "lower limit of joint 'base_y' must be finite: configurations are drawn from the range, got -inf",
    ),
    (
        lambda: ARM.with_mobile_base("floating", lower=[-4] * 6, upper=[4] * 6),
        bik.InvalidInputError,
        "length of the rotation vector at the limits of base_rx, base_ry and base_rz must be below 5.97 rad, 0.95 of a "
        "turn; limits of -pi and pi are, got 6.928",
    ),
    (
        lambda: bik.solve(FLOATING, FLOATING.fk(np.zeros(13)), goals=[bik.goals.Manipulability()]),
        bik.InvalidInputError,
        "the goals Manipulability and LinkManipulability are not for robots on a floating base",
    ),
    (
        lambda: FLOATING.with_mobile_base("planar", lower=[-1] * 3, upper=[1] * 3),
        bik.InvalidInputError,
        "robot 'panda': two joints are named 'base_x'",
    ),
    (
        lambda: FLOATING.with_mobile_base("floating", lower=-BOX, upper=BOX),
        bik.InvalidInputError,
        "robot 'panda': its base floats already",
    ),
]


@pytest.mark.parametrize(("call", "error", "message"), MISTAKES, ids=range(len(MISTAKES)))
def test_mistakes_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    with pytest.raises(error) as told:
        call()
    assert message in str(told.value)
