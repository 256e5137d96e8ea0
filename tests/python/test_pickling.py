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
    bik.papers.APPS(),
    bik.papers.APPS.paper(),
    bik.papers.APPS(learning_rate=0.1, step_limit=0.5, error_threshold=1e-7),
    bik.papers.BAS(),
    bik.papers.BAS(variant="chain", c1=0.3, c2=0.5, explorations=7, max_passes=9),
    bik.BroydenBAS(),
    bik.BroydenBAS(antenna_length=0.02, max_evaluations_per_step=3, sensor_delay=1),
    bik.JacobianTranspose(),
    bik.JacobianTranspose(step_size=0.125),
    bik.LevenbergMarquardt(),
    bik.LevenbergMarquardt(initial_damping=0.125),
    bik.NewtonRaphson(),
    bik.NewtonRaphson(step_fraction=0.5),
    bik.MultiStart(bik.papers.APPS(step_limit=0.1)),
    bik.papers.PSO(),
    bik.papers.PSO(
        population=20, form="inertia", inertia=0.5, c1=1.5, c2=1.25, velocity_limit=0.25, accept="improving"
    ),
    bik.papers.QPSO(expansion=0.5, max_generations=9, stall_generations=None),
    bik.papers.Firefly(population=20, attractiveness=0.5, absorption=2.0, randomness=0.1, randomness_decay=0.9),
    bik.papers.Genetic(
        elite_share=0.1, crossover_share=0.5, mutation_rate=0.25, mutation_scale=0.2, mutation_decay=0.9
    ),
    bik.papers.BeeColony(),
    bik.papers.BeeColony(limit=25),
    bik.papers.BeetleSwarm(),
    bik.papers.BeetleSwarm(inertia=1.0, velocity_limit=1.0, direction="downhill"),
    bik.DifferentialEvolution(weight=0.75, crossover_rate=0.5, update="immediate"),
    bik.MultiStart(bik.papers.Firefly()),
    bik.MultiStart(bik.papers.BAS(variant="greedy")),
    bik.MultiStart(bik.LevenbergMarquardt(initial_damping=0.5), max_starts=3),
]
STOPS = [
    bik.Stop(),
    bik.Stop(value_below=float("inf")),
    bik.Stop(max_evaluations=10, max_iterations=20, max_time=0.25, value_below=-0.5),
]
TURN = bik.pose([0, 0, 0], rpy=[0.1, 0.2, 0.3])[:3, :3]
OBSTACLES = [
    bik.obstacles.Sphere([0.1, 0.2, 0.3], 0.5),
    bik.obstacles.Box([0.1, 0.2, 0.3], [1, 2, 3]),
    bik.obstacles.Box([0.1, 0.2, 0.3], [1, 2, 3], rotation=TURN),
    bik.obstacles.Capsule([0.1, 0.2, 0.3], [1, 2, 3], 0.25),
    bik.obstacles.Ellipsoid([0.1, 0.2, 0.3], [1, 2, 3], rotation=TURN),
    bik.obstacles.Ellipse([0.1, 0.2], [1, 2], angle=0.7),
    bik.obstacles.Cylinder([0.1, 0.2, 0.3], [1, 2, 3], 0.25, 0.5),
    bik.obstacles.HalfSpace([1, 2, 3], 0.25),
    bik.obstacles.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]),
    bik.obstacles.PointCloud([[0, 0, 0], [1, 0, 0]], 0.1),
    bik.obstacles.Grid([0.1, 0.2, 0.3], 0.5, np.array([[[True, False]]])),
    bik.obstacles.ConvexMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
]
METHODS = [
    bik.papers.CircleSwarm(),
    bik.papers.CircleSwarm(population=7, generations=20, c1=2.5, c2=2.0, velocity_limit=0.1, signed=True),
    bik.papers.TPBSO(),
    bik.papers.TPBSO(elbows=(-1, 1), solver=bik.MultiStart(bik.papers.PSO(), max_starts=3)),
    bik.WeightedPseudoInverse(),
    bik.WeightedPseudoInverse(gain=5.0, integrator="rk4", weights=[1.0, 2.0], posture_gain=10.0, damping=0.01),
    bik.papers.ZNNBAS(),
    bik.papers.ZNNBAS(
        gain=10.0, antenna_length=[0.1, 0.2], delay_steps=10, delay="held", accept="improving", sensor_delay=2
    ),
]
VALUES = [*SINUSOIDS, *SOLVERS, *STOPS, *OBSTACLES, *METHODS]

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
def test_equal_values_hash_alike(value: object) -> None:
    assert hash(copy.deepcopy(value)) == hash(value)
    assert {value: 1}[copy.copy(value)] == 1


def test_hashes_tell_values_apart() -> None:
    assert len({hash(value) for value in VALUES}) == len({repr(value) for value in VALUES})
    assert hash(bik.Stop(value_below=0.0)) == hash(bik.Stop(value_below=-0.0))
    assert bik.tasks.Position() in {bik.tasks.Position()}
    assert bik.goals.Centring() in {bik.goals.Centring()}


@pytest.mark.parametrize("value", VALUES, ids=repr)
def test_the_repr_rebuilds_the_value(value: object) -> None:
    assert eval(repr(value), vars(bik) | vars(bik.papers)) == value


def test_different_values_differ() -> None:
    for i, one in enumerate(VALUES):
        for j, other in enumerate(VALUES):
            assert (one == other) == (i == j)


def test_defaults_are_shown_in_full() -> None:
    assert repr(bik.papers.APPS()) == "APPS(learning_rate='auto', step_limit=0.2, error_threshold=None)"
    paper = "APPS(learning_rate=0.2, step_limit=0.017453292519943295, error_threshold=5e-10)"
    assert repr(bik.papers.APPS.paper()) == paper
    assert repr(bik.JacobianTranspose()) == "JacobianTranspose(step_size='auto')"
    assert repr(bik.NewtonRaphson()) == "NewtonRaphson(step_fraction=1.0)"
    assert repr(bik.papers.BAS()) == "BAS(variant='star', c1=3.0, c2=1.0, explorations=50, max_passes=200)"
    assert (
        repr(bik.papers.BAS(variant="chain")) == "BAS(variant='chain', c1=1.0, c2=1.0, explorations=30, max_passes=200)"
    )
    assert (
        repr(bik.papers.BAS(variant="greedy"))
        == "BAS(variant='greedy', c1=3.0, c2=1.0, explorations=5, max_passes=200)"
    )
    assert bik.papers.BAS() == bik.papers.BAS(variant="star", c1=3.0, c2=1.0, explorations=50)


@pytest.mark.parametrize("robot", ROBOTS, ids=repr)
def test_robots_come_back_with_every_bit(robot: bik.Robot, again: Callable[[bik.Robot], bik.Robot]) -> None:
    other = again(robot)
    assert other == robot
    assert hash(other) == hash(robot)
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
        bik.Robot._restore(damaged)


def test_limits_come_back(again: Callable[[bik.Limits], bik.Limits]) -> None:
    limits = bik.Limits(lower=-1.0, upper=[1.0, 2.0], velocity=SINUSOIDS[1])
    other = again(limits)
    assert other == limits
    assert (other.lower, other.acceleration, other.jerk) == (-1.0, None, None)
    np.testing.assert_array_equal(other.upper, [1.0, 2.0])
    assert other.velocity == SINUSOIDS[1]
    assert eval(repr(other), vars(bik)) == limits


@pytest.mark.parametrize(
    "limits",
    [
        bik.Limits(),
        bik.Limits(lower=-1.0, upper=[1.0, 2.0], velocity=SINUSOIDS[1]),
        bik.Limits(lower=[-np.inf, 0.5], velocity=np.inf, acceleration=2.0, jerk=[1e-9, 1e9]),
        bik.Robot.planar([1.0, 0.5]).limits,
    ],
    ids=repr,
)
def test_the_repr_rebuilds_limits(limits: bik.Limits) -> None:
    assert eval(repr(limits), vars(bik)) == limits


def test_limits_compare_as_given() -> None:
    limits = bik.Limits(lower=-1.0, upper=[1.0, 2.0], velocity=SINUSOIDS[1], acceleration=ramp)
    assert limits == bik.Limits(lower=-1.0, upper=[1.0, 2.0], velocity=SINUSOIDS[1], acceleration=ramp)
    assert bik.Limits() == bik.Limits()
    for other in (
        bik.Limits(),
        bik.Limits(lower=-1.5, upper=[1.0, 2.0], velocity=SINUSOIDS[1], acceleration=ramp),
        bik.Limits(lower=[-1.0, -1.0], upper=[1.0, 2.0], velocity=SINUSOIDS[1], acceleration=ramp),
        bik.Limits(lower=-1.0, upper=[1.0, 2.0], velocity=SINUSOIDS[0], acceleration=ramp),
        bik.Limits(lower=-1.0, upper=[1.0, 2.0], velocity=SINUSOIDS[1], acceleration=line),
        bik.Limits(lower=-1.0, upper=[1.0, 2.0], velocity=SINUSOIDS[1], acceleration=ramp, jerk=1.0),
    ):
        assert limits != other
    assert limits != -1.0
    assert hash(bik.Limits(lower=-1.0, velocity=ramp)) == hash(bik.Limits(lower=-1.0, velocity=ramp))
    assert len({hash(bik.Limits(velocity=limit)) for limit in (None, 1.0, [1.0, 1.0], ramp, SINUSOIDS[0])}) == 5
    assert bik.Robot.named("iiwa14").limits == bik.Robot.named("iiwa14").limits


def ramp(t: float) -> float:
    return 0.5 + 0.1 * t


def test_limits_keep_their_functions(again: Callable[[bik.Limits], bik.Limits]) -> None:
    assert again(bik.Limits(velocity=ramp)).velocity is ramp


def test_trajectories_come_back(again: Callable[[bik.Trajectory], bik.Trajectory]) -> None:
    q = np.array([[0.0, 1.0], [0.5, -1.0], [0.25, 2.0]])
    trajectory = bik.Trajectory.from_samples([0.0, 1.0, 3.0], q, qd=0.1 * q, joint_names=["a", "b"])
    other = again(trajectory)
    assert other == trajectory
    assert hash(other) == hash(trajectory)
    assert other.joint_names == ["a", "b"]
    np.testing.assert_array_equal(other.coefficients, trajectory.coefficients)
    assert other != bik.Trajectory.from_samples([0.0, 1.0, 3.0], q, joint_names=["a", "b"])


@pytest.mark.parametrize("motion", ["pose", "position", "rotation"])
def test_ellipsoids_come_back(motion: str, again: Callable[[object], object]) -> None:
    robot = bik.Robot.named("panda")
    one, elsewhere = (robot.velocity_ellipsoid(q, motion=motion) for q in robot.random_configurations(2, seed=1))
    other = again(one)
    assert (other, repr(other), hash(other)) == (one, repr(one), hash(one))
    assert_same(properties(one), properties(other))
    assert one != elsewhere


def turned(t: float) -> np.ndarray:
    return bik.pose([0, 0, 0], rpy=[0.0, 0.0, t])[:3, :3]


def line(t: float) -> tuple[float, float, float]:
    return (0.1 * t, 0.2, 0.3)


POSES = np.stack([bik.pose([0, 0, 0], rpy=[0.1, 0.2, 0.3]), bik.pose([1, 0, 0], rpy=[0.4, 0.2, -0.3])])
PATHS = {
    "circle": bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=30.0),
    "letter m": bik.paths.letter_m((0.4, 0.1, 0.5), 4.0, width=0.2, height=0.3),
    "hypotrochoid": bik.paths.hypotrochoid((0, 0, 0), 4.0, outer_radius=0.5, inner_radius=0.3, distance=0.2),
    "pentagram": bik.paths.pentagram((0, 0, 0), 4.0, radius=0.3),
    "rose": bik.paths.rose((0, 0, 0), 4.0, radius=0.3, k=4),
    "polyline": bik.paths.polyline([(0, 0, 0), (1, 0, 0), (1, 2, 0)], 3.0),
    "positions": bik.paths.from_samples([0, 1, 2], [(0, 0, 0), (1, 0, 0), (1, 1, 0)]),
    "poses": bik.paths.from_samples([0, 1], POSES),
    "turned circle": bik.paths.circle((0, 0, 1), diameter=0.2, duration=3.0).with_orientation(TURN),
    "turning circle": bik.paths.circle((0, 0, 1), diameter=0.2, duration=3.0).with_orientation(turned),
    "function": bik.paths.from_function(line, 3.0),
    "turned function": bik.paths.from_function(line, 3.0).with_orientation(TURN),
}


@pytest.mark.parametrize("path", PATHS.values(), ids=PATHS)
def test_paths_come_back(path: bik.Path, again: Callable[[bik.Path], bik.Path]) -> None:
    other = again(path)
    assert other == path
    assert (other.duration, repr(other), hash(other)) == (path.duration, repr(path), hash(path))
    t = np.linspace(-0.5, path.duration + 0.5, 23)
    np.testing.assert_array_equal(other.position(t), path.position(t))
    np.testing.assert_array_equal(other.velocity(t), path.velocity(t))
    if "with orientation" in repr(path):
        np.testing.assert_array_equal(other.pose(t), path.pose(t))


def test_different_paths_differ() -> None:
    for i, one in enumerate(PATHS.values()):
        for j, other in enumerate(PATHS.values()):
            assert (one == other) == (i == j)
    assert PATHS["circle"] != "circle"


def test_a_path_along_a_lambda_does_not_pickle_but_copies() -> None:
    path = bik.paths.from_function(lambda t: (t, 0.0, 0.0), 1.0)
    with pytest.raises((pickle.PicklingError, AttributeError), match="lambda"):
        pickle.dumps(path)
    assert copy.copy(path) == path


def failing_plant() -> Callable[[np.ndarray], np.ndarray]:
    plant = bik.KinematicPlant(bik.Robot.planar([1.0] * 3))
    calls = iter(range(30))

    def move(q: np.ndarray) -> np.ndarray:
        if next(calls, None) is None:
            raise OSError(5, "the cable came off")
        return plant.move(q)

    return move


def step_without_a_model() -> bik.Step:
    session = bik.papers.ZNNBAS().session([0.1, 0.2, 0.3], dt=0.1)
    plant = bik.KinematicPlant(bik.Robot.planar([1.0] * 3))
    steps = (session.observe(plant.move(session.command((1.5, 1.0, 0.0)))) for _ in range(9))
    return next(step for step in steps if step is not None)


def lowered(arm: bik.Robot, q: np.ndarray) -> np.ndarray:
    pose = arm.fk(q)
    pose[2, 3] -= 0.02
    return pose


def results() -> dict[str, object]:
    arm, planar = bik.Robot.named("iiwa14"), bik.Robot.planar([1.0] * 3, velocity=1.0)
    q = arm.random_configurations(4, seed=3)
    limits = bik.Limits(lower=-2.0, velocity=SINUSOIDS[0])
    circle = bik.paths.circle((1.5, 1.0, 0.0), diameter=0.4, duration=2.0)
    plane = bik.Limits(velocity=2.0, acceleration=4.0)
    obstacle = bik.obstacles.Sphere([5.0, 5.0, 0.0], 0.1)
    targets = np.concatenate((arm.fk(q), np.full((1, 4, 4), np.nan)))
    return {
        "solution": bik.solve(arm, arm.fk(q[0]), limits=limits),
        "position": bik.solve(arm, (0.4, 0.1, 0.5)),
        "miss": bik.solve(arm, (9.0, 0.0, 0.0)),
        "batch": bik.solve_batch(arm, targets, on_invalid="skip", threads=1),
        "set": bik.solve_all(arm, arm.fk(q[0]), limit=3),
        "empty set": bik.solve_all(arm, (9.0, 0.0, 0.0), stop=bik.Stop(max_evaluations=500)),
        "track": bik.track(planar, circle, dt=0.1, limits=limits),
        "plan": bik.plan_point_to_point(
            planar.with_capsules(radius=0.05), start_q=[0.1, 0.2, 0.3], end_q=[0.5, 0.2, -0.3], limits=plane,
            obstacles=[obstacle], keep=bik.Keep((0.0, 0.0, 0.0), bik.tasks.Position(tolerance=[9.0, 9.0, 1e-9])),
        ),
        "plan along": bik.plan_along_path(planar, [(1.5, 1.0, 0.0), (1.4, 1.2, 0.0)], limits=plane),
        "program": bik.plan_moves(
            arm, [bik.moves.Wait(0.5, name="here"), bik.moves.Line(lowered(arm, q[0]), speed=9.0, name="down")],
            start_q=q[0], limits=bik.Limits(acceleration=5.0),
        ),
        "model free": bik.track_model_free(bik.KinematicPlant(planar), circle, [0.1, 0.2, 0.3], dt=0.1),
        "failed plant": bik.track_model_free(failing_plant(), circle, [0.1, 0.2, 0.3], dt=0.1),
        "step": bik.Tracker(arm, q[0], dt=0.1, limits=limits).step(arm.fk(q[1])),
        "step without a model": step_without_a_model(),
        "minimum": bik.minimize(
            np.linalg.norm, [-1, -1], [2, 2], solver=bik.papers.PSO(), stop=bik.Stop(value_below=1e-3)
        ),
        "no minimum": bik.minimize(
            lambda _: np.nan, [-1.0], [2.0], solver=bik.papers.BAS(), stop=bik.Stop(max_evaluations=9)
        ),
        "posture": bik.papers.planar_posture(planar, (1.5, 1.0, 0.0), swarm=bik.papers.CircleSwarm()),
        "no posture": bik.papers.planar_posture(planar, (4.0, 0.0, 0.0)),
        "nearest": bik.obstacles.nearest(planar.with_capsules(radius=0.1), [0.1] * planar.dof, [obstacle]),
    }  # fmt: skip


RESULTS = results()


def properties(value: object) -> dict[str, object]:
    """All that a result says, methods aside."""
    names = [name for name in dir(value) if not name.startswith("_")]
    return {name: shown for name in names if not callable(shown := getattr(value, name))}


def assert_same(one: object, other: object) -> None:
    assert type(one) is type(other)
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other)
        assert (one.dtype, one.flags.writeable) == (other.dtype, False)
    elif isinstance(one, BaseException):
        assert repr(one) == repr(other)
    elif isinstance(one, bik.Solution):
        assert_same(properties(one), properties(other))
    elif isinstance(one, dict):
        assert one.keys() == other.keys()
        for name in one:
            assert_same(one[name], other[name])
    elif isinstance(one, tuple | list):
        assert len(one) == len(other)  # type: ignore[arg-type]
        for mine, theirs in zip(one, other, strict=True):  # type: ignore[call-overload]
            assert_same(mine, theirs)
    elif isinstance(one, float):
        np.testing.assert_array_equal(one, other)
    else:
        assert one == other


@pytest.mark.parametrize("result", RESULTS.values(), ids=RESULTS)
def test_results_come_back_with_every_property(result: object, again: Callable[[object], object]) -> None:
    other = again(result)
    assert repr(other) == repr(result)
    assert_same(properties(result), properties(other))
    if hasattr(result, "__len__"):
        assert len(other) == len(result)
    if isinstance(result, bik.BatchSolution | bik.SolutionSet):
        for one, item in zip(result, other, strict=True):
            assert_same(one, item)


LATER = "it was stored in format 99 by a later version of beetle-ik, and this one reads format 3: make it anew"
DAMAGED = "the bytes were damaged: their checksum differs"


@pytest.mark.parametrize(
    ("damage", "problem"),
    [
        (lambda stored: stored[:0], "no bytes"),
        (lambda stored: b"\x63" + stored[1:], LATER),
        (lambda stored: stored[:-1], DAMAGED),
        (lambda stored: stored[:20] + bytes([stored[20] ^ 1]) + stored[21:], DAMAGED),
        (lambda stored: stored[:5], DAMAGED),
    ],
)  # fmt: skip
def test_damaged_results_are_refused(damage: Callable[[bytes], bytes], problem: str) -> None:
    restore, (stored, *others) = RESULTS["solution"].__reduce__()
    with pytest.raises(bik.InvalidInputError) as caught:
        restore(damage(stored), *others)
    assert str(caught.value) == f"cannot restore solution: {problem}"


@pytest.mark.parametrize("status", bik.Status)
def test_statuses_come_back(status: bik.Status, again: Callable[[bik.Status], bik.Status]) -> None:
    assert again(status) is status


def test_errors_come_back(again: Callable[[Exception], Exception]) -> None:
    with pytest.raises(bik.UnknownNameError) as caught:
        bik.Robot.named("iiwa")
    other = again(caught.value)
    assert (type(other), str(other)) == (bik.UnknownNameError, str(caught.value))


def forged(stored: bytes, place: int, value: int) -> bytes:
    """The stored bytes with one byte of the payload replaced, and the checksum (FNV-1a) that belongs to it."""
    payload = bytearray(stored[9:])
    payload[place] = value
    checksum = 0xCBF29CE484222325
    for byte in payload:
        checksum = (checksum ^ byte) * 0x100000001B3 % 2**64
    return stored[:1] + checksum.to_bytes(8, "little") + payload


def use(value: object) -> None:
    """Computes with what a forged pickle gave."""
    match value:
        case bik.Path():
            for t in (0.0, 0.3 * value.duration, np.inf):
                value.position(t)
                value.velocity(t)
            value.sample(value.duration / 7)
        case bik.Plan():
            repr(value)
            value.trajectory.at([0.0, 0.1, np.inf])
            value.trajectory.max_velocity()
        case _:
            repr(value)
            properties(value)


STORED = {name: path for name, path in PATHS.items() if isinstance(path.__reduce__()[1][0], bytes)} | RESULTS


@pytest.mark.parametrize("value", STORED.values(), ids=STORED)
def test_forged_bytes_are_refused_or_used(value: object) -> None:
    restore, (stored, *others) = value.__reduce__()
    rng = np.random.default_rng(0)
    places = rng.permutation(len(stored) - 9)[: max(6, min(120, 60_000 // len(stored)))]  # long ones take long
    refused = 0
    # The first byte is a length or a kind in every value. Results hold times, so what lies at the others varies.
    for place in [0, *places.tolist()]:
        for byte in (0x00, 0x01, 0x7F, 0xF0, 0xFF):
            try:
                use(restore(forged(stored, place, byte), *others))
            except bik.BeetleIkError:
                refused += 1
    assert refused > 0


def test_a_restored_grid_without_voxels_is_shown() -> None:
    stored = bytes.fromhex(
        "03e27ee31ea5d1ca4d066c696e6b5f318a000000000000000000000000000000000000000000000000000000000000e0"
        "3f000000000000000000000000000000007b14ae47e17a943f0000"
    )
    assert "[]" in repr(bik.Body._restore(stored).shape)
