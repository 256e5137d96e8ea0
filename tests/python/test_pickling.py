"""Values that copy, compare, pickle and show themselves."""

import copy
import pickle
from collections.abc import Callable

import numpy as np
import pytest
from generated import chain

import beetle_ik as bik

SINUSOIDS = [
    bik.Sinusoid(mean=2.0, amplitude=0.004, angular_frequency=1.0),
    bik.Sinusoid(mean=[1.0, 2.0], amplitude=0.1, angular_frequency=[3.0, 4.0], phase=-0.5),
]
SOLVERS = [
    bik.APPS(),
    bik.APPS.paper(),
    bik.APPS(learning_rate=0.1, step_limit=0.5, error_threshold=1e-7),
    bik.BAS(),
    bik.BAS(variant="chain", c1=0.3, c2=0.5, explorations=7, max_passes=9),
    bik.BroydenBAS(),
    bik.BroydenBAS(antenna_length=0.02, max_evaluations_per_step=3, sensor_delay=1),
    bik.JacobianTranspose(),
    bik.JacobianTranspose(step_size=0.125),
    bik.LevenbergMarquardt(),
    bik.LevenbergMarquardt(initial_damping=0.125),
    bik.NewtonRaphson(),
    bik.NewtonRaphson(step_fraction=0.5),
    bik.MultiStart(bik.APPS(step_limit=0.1)),
    bik.PSO(),
    bik.PSO(population=20, form="inertia", inertia=0.5, c1=1.5, c2=1.25, velocity_limit=0.25, accept="improving"),
    bik.QPSO(expansion=0.5, max_generations=9, stall_generations=None),
    bik.Firefly(population=20, attractiveness=0.5, absorption=2.0, randomness=0.1, randomness_decay=0.9),
    bik.Genetic(elite_share=0.1, crossover_share=0.5, mutation_rate=0.25, mutation_scale=0.2, mutation_decay=0.9),
    bik.BeeColony(),
    bik.BeeColony(limit=25),
    bik.BeetleSwarm(),
    bik.BeetleSwarm(inertia=1.0, velocity_limit=1.0, direction="downhill"),
    bik.DifferentialEvolution(weight=0.75, crossover_rate=0.5, update="immediate"),
    bik.MultiStart(bik.Firefly()),
    bik.MultiStart(bik.BAS(variant="greedy")),
    bik.MultiStart(bik.LevenbergMarquardt(initial_damping=0.5), max_starts=3),
]
STOPS = [bik.Stop(), bik.Stop(max_evaluations=10, max_iterations=20, max_time=0.25, value_below=-0.5)]
TURN = bik.pose([0, 0, 0], rpy=[0.1, 0.2, 0.3])[:3, :3]
OBSTACLES = [
    bik.obstacles.Sphere([0.1, 0.2, 0.3], 0.5),
    bik.obstacles.Box([0.1, 0.2, 0.3], [1, 2, 3]),
    bik.obstacles.Box([0.1, 0.2, 0.3], [1, 2, 3], rotation=TURN),
    bik.obstacles.Capsule([0.1, 0.2, 0.3], [1, 2, 3], 0.25),
    bik.obstacles.Ellipsoid([0.1, 0.2, 0.3], [1, 2, 3], rotation=TURN),
    bik.obstacles.Ellipse([0.1, 0.2], [1, 2], angle=0.7),
    bik.obstacles.ConvexMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
]
VALUES = [*SINUSOIDS, *SOLVERS, *STOPS, *OBSTACLES]

MECHANISM, MECHANISM_BASE, MECHANISM_TIP = chain(joints=9, place="branch", seed=4)
ROBOTS = [
    bik.Robot.named("iiwa14"),
    bik.Robot.planar([1.0, 0.5], velocity=0.3),
    bik.Robot.from_urdf(MECHANISM, base=MECHANISM_BASE, tip=MECHANISM_TIP),
    bik.Robot.named("ur5e").with_capsules(radius=0.05),
    bik.Robot.named("panda").with_tool(bik.pose([0, 0, 0.1], rpy=[1, 2, 3])).with_base(bik.pose([1, 2, 3])),
]

WAYS = [copy.copy, copy.deepcopy]
WAYS += [lambda value, p=p: pickle.loads(pickle.dumps(value, p)) for p in range(2, pickle.HIGHEST_PROTOCOL + 1)]


@pytest.fixture(params=WAYS, ids=["copy", "deepcopy", *(f"pickle {p}" for p in range(2, pickle.HIGHEST_PROTOCOL + 1))])
def again(request: pytest.FixtureRequest) -> Callable[[object], object]:
    return request.param


@pytest.mark.parametrize("value", VALUES, ids=repr)
def test_values_come_back_equal(value: object, again: Callable[[object], object]) -> None:
    other = again(value)
    assert other == value
    assert (type(other), repr(other)) == (type(value), repr(value))


@pytest.mark.parametrize("value", VALUES, ids=repr)
def test_the_repr_rebuilds_the_value(value: object) -> None:
    assert eval(repr(value), vars(bik)) == value


def test_different_values_differ() -> None:
    for i, one in enumerate(VALUES):
        for j, other in enumerate(VALUES):
            assert (one == other) == (i == j)


def test_defaults_are_shown_in_full() -> None:
    assert repr(bik.APPS()) == "APPS(learning_rate='auto', step_limit=0.2, error_threshold=None)"
    paper = "APPS(learning_rate=0.2, step_limit=0.017453292519943295, error_threshold=5e-10)"
    assert repr(bik.APPS.paper()) == paper
    assert repr(bik.JacobianTranspose()) == "JacobianTranspose(step_size='auto')"
    assert repr(bik.NewtonRaphson()) == "NewtonRaphson(step_fraction=1.0)"
    assert repr(bik.BAS()) == "BAS(variant='star', c1=3, c2=1, explorations=50, max_passes=200)"
    assert repr(bik.BAS(variant="chain")) == "BAS(variant='chain', c1=1, c2=1, explorations=30, max_passes=200)"
    assert repr(bik.BAS(variant="greedy")) == "BAS(variant='greedy', c1=3, c2=1, explorations=5, max_passes=200)"
    assert bik.BAS() == bik.BAS(variant="star", c1=3.0, c2=1.0, explorations=50)


@pytest.mark.parametrize("robot", ROBOTS, ids=repr)
def test_robots_come_back_with_every_bit(robot: bik.Robot, again: Callable[[bik.Robot], bik.Robot]) -> None:
    other = again(robot)
    assert other == robot
    assert (other.name, other.joint_names, other.joint_kinds) == (robot.name, robot.joint_names, robot.joint_kinds)
    assert (other.link_names, repr(other)) == (robot.link_names, repr(robot))
    for field in ("lower", "upper", "velocity_limit"):
        np.testing.assert_array_equal(getattr(other, field), getattr(robot, field))
    q = robot.random_configurations(20, seed=1)
    np.testing.assert_array_equal(other.random_configurations(20, seed=1), q)
    np.testing.assert_array_equal(other.fk(q), robot.fk(q))
    np.testing.assert_array_equal(other.jacobian(q), robot.jacobian(q))


def test_robots_are_compared_by_what_they_are() -> None:
    robot = bik.Robot.named("iiwa14")
    assert robot == bik.Robot.named("iiwa14")
    assert robot != bik.Robot.named("iiwa7")
    assert robot != robot.with_limits(velocity=1.0)
    assert robot != robot.with_tool(bik.pose([0, 0, 1e-9]))
    assert robot != "iiwa14"


@pytest.mark.parametrize("damaged", [b"", b"\x00", b"\xff" * 40])
def test_damaged_robots_are_refused(damaged: bytes) -> None:
    with pytest.raises(bik.InvalidInputError, match=r"^cannot restore robot: "):
        bik.Robot._from_bytes(damaged)


def test_limits_come_back(again: Callable[[bik.Limits], bik.Limits]) -> None:
    other = again(bik.Limits(lower=-1.0, upper=[1.0, 2.0], velocity=SINUSOIDS[1]))
    assert (other.lower, other.acceleration, other.jerk) == (-1.0, None, None)
    np.testing.assert_array_equal(other.upper, [1.0, 2.0])
    assert other.velocity == SINUSOIDS[1]
    assert repr(other).startswith("Limits(lower=-1.0, upper=array([1., 2.]), velocity=Sinusoid(mean=[1.0, 2.0], ")


def ramp(t: float) -> float:
    return 0.5 + 0.1 * t


def test_limits_keep_their_functions(again: Callable[[bik.Limits], bik.Limits]) -> None:
    assert again(bik.Limits(velocity=ramp)).velocity is ramp


def test_trajectories_come_back(again: Callable[[bik.Trajectory], bik.Trajectory]) -> None:
    q = np.array([[0.0, 1.0], [0.5, -1.0], [0.25, 2.0]])
    trajectory = bik.Trajectory.from_samples([0.0, 1.0, 3.0], q, qd=0.1 * q, joint_names=["a", "b"])
    other = again(trajectory)
    assert other == trajectory
    assert other.joint_names == ["a", "b"]
    np.testing.assert_array_equal(other.coefficients, trajectory.coefficients)
    assert other != bik.Trajectory.from_samples([0.0, 1.0, 3.0], q, joint_names=["a", "b"])


@pytest.mark.parametrize("status", bik.Status)
def test_statuses_come_back(status: bik.Status, again: Callable[[bik.Status], bik.Status]) -> None:
    assert again(status) is status


def test_errors_come_back(again: Callable[[Exception], Exception]) -> None:
    with pytest.raises(bik.UnknownNameError) as caught:
        bik.Robot.named("iiwa")
    other = again(caught.value)
    assert (type(other), str(other)) == (bik.UnknownNameError, str(caught.value))
