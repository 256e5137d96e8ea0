"""Wrong calls for motions: the exception and the exact message that a user sees."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from iiwa_circle import IIWA, START
from mistakes import RADIANS, TURNED, Invalid, Limit, Unknown, Urdf, assert_told, told, with_entry

import beetle_ik as bik

SOLVERS = (
    "solver must be BAS, BeeColony, BeetleSwarm, DifferentialEvolution, Firefly, Genetic, PSO, QPSO, APPS, "
    "BroydenBAS, JacobianTranspose, LevenbergMarquardt, NewtonRaphson or MultiStart of one of them"
)
CIRCLE = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=3.0)
TURN = "2.9670597283903604"  # 170 degrees


def solve(target: object = (0.3, 0.3, 1.0), **options: object) -> bik.Solution:
    return bik.solve(IIWA, target, **options)


def track(start: object = START, **options: object) -> bik.TrackResult:
    return bik.track(IIWA, CIRCLE, start, **{"dt": 0.1, **options})


def circle(center: object = (0, 0, 0), diameter: float = 1.0, duration: float = 1.0, **axes: object) -> bik.Path:
    return bik.paths.circle(center, diameter, duration, **axes)


def test_the_classes_of_errors() -> None:
    for error in (Invalid, Unknown):
        assert issubclass(error, bik.BeetleIkError)
    assert issubclass(Invalid, ValueError)
    assert issubclass(Unknown, LookupError)
    assert issubclass(Urdf, Invalid)
    assert issubclass(Limit, Invalid)
    assert issubclass(bik.UnsupportedLimit, Limit)
    for error in (bik.BeetleIkError, Invalid, Unknown, Urdf, Limit, bik.UnsupportedLimit):
        assert error.__module__ == "beetle_ik"
        assert error.__doc__


@told(
    [
        (lambda: solve([0.3, 0.3]), Invalid, "target: expected a pose (4, 4) or a position (3,), got shape (2,)"),
        (lambda: solve(np.eye(3)), Invalid, "target: expected a pose (4, 4) or a position (3,), got shape (3, 3)"),
        (lambda: solve(None), Invalid, "target must be an array of numbers, got None"),
        (lambda: solve("up"), Invalid, "target must be an array of numbers, got 'up'"),
        (lambda: solve("1.0"), Invalid, "target must be an array of numbers, got '1.0'"),
        (
            lambda: solve(np.ma.masked_greater([0.3, 0.3, 1.0], 0.5)),
            Invalid,
            "target has masked entries: replace them first, such as by .filled(value)",
        ),
        (lambda: solve(prefer="\ud800"), Invalid, "text must be valid Unicode, got '\\ud800'"),
        (
            lambda: bik.Trajectory([0, 1], np.zeros((1, 1, 2)), joint_names=["\ud800"]),
            Invalid,
            "text must be valid Unicode, got ['\\ud800']",
        ),
        (lambda: bik.Robot.from_urdf("<robot/>", tip="\udfff"), Invalid, "text must be valid Unicode, got '\\udfff'"),
        (
            lambda: solve(prefer="n" * 10**6),
            Invalid,
            f"prefer must be one of 'any', 'nearest', 'best', got '{'n' * 200}...'",
        ),
        (
            lambda: solve(np.ones(3) * 1j),
            Invalid,
            "target must be an array of numbers, got array([0.+1.j, 0.+1.j, 0.+1.j])",
        ),
        (
            lambda: solve(np.ones(3, dtype="m8[s]")),
            Invalid,
            "target must be an array of numbers, got array([1, 1, 1], dtype='timedelta64[s]')",
        ),
        (lambda: solve([0.3, 0.3, np.nan]), Invalid, "target must be finite, but coordinate z is NaN"),
        (lambda: solve([0.3, 1e300, 0.0]), Invalid, "target: coordinate y must be from -1e100 to 1e100 m, got 1e300"),
        (lambda: solve(np.full((4, 4), np.inf)), Invalid, "target must be finite, but entry (0, 0) is inf"),
        (
            lambda: solve(2 * np.eye(4)),
            Invalid,
            "target is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)",
        ),
        (lambda: solve(start_q=[0.0] * 6), Invalid, "start_q of robot 'iiwa14': expected 7 joints, got 6"),
        (lambda: solve(start_q=np.zeros((1, 7))), Invalid, "start_q: expected one dimension, got shape (1, 7)"),
        (lambda: solve(start_q=with_entry(6, np.nan)), Invalid, "start_q must be finite, but joint 'joint_a7' is NaN"),
        (
            lambda: solve(start_q=with_entry(0, -np.inf)),
            Invalid,
            "start_q must be finite, but joint 'joint_a1' is -inf",
        ),
        (
            lambda: solve(solver="BAS"),
            Invalid,
            f"{SOLVERS}, got 'BAS': give an object, such as bik.LevenbergMarquardt()",
        ),
        (
            lambda: solve(solver=bik.papers.BAS),
            Invalid,
            f"{SOLVERS}, got the class BAS itself: did you mean BAS()?",
        ),
        (lambda: solve(position_tolerance=0.0), Invalid, "position_tolerance must be positive, got 0"),
        (lambda: solve(rotation_tolerance=np.nan), Invalid, "rotation_tolerance must be positive, got NaN"),
        (lambda: solve(seed=-1), Invalid, "seed must be zero or more, got -1"),
        (
            lambda: solve(limits=bik.Limits(lower=1, upper=-1)),
            Limit,
            "joint 'joint_a1': lower limit 1 is above upper limit -1",
        ),
        (
            lambda: solve(limits=bik.Limits(lower=[1, 2])),
            Invalid,
            "lower limit: expected one number, or 7 (one per joint), got 2",
        ),
    ]
)
def test_wrong_solve_arguments_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


@told(
    [
        (
            lambda: bik.papers.BAS(variant="stars"),
            Invalid,
            "variant must be one of 'star', 'chain', 'greedy', got 'stars'",
        ),
        (lambda: bik.papers.BAS(c1=-1.0), Invalid, "c1 must be positive and finite, got -1"),
        (lambda: bik.papers.BAS(c2=np.nan), Invalid, "c2 must be positive and finite, got NaN"),
        (lambda: bik.papers.BAS(explorations=0), Invalid, "explorations must be at least 1, got 0"),
        (lambda: bik.papers.BAS(explorations=-5), Invalid, "explorations must be zero or more, got -5"),
        (lambda: bik.papers.BAS(max_passes=0), Invalid, "max_passes must be at least 1, got 0"),
        (
            lambda: bik.LevenbergMarquardt(initial_damping=0.0),
            Invalid,
            "initial_damping must be positive and finite, got 0",
        ),
        (
            lambda: bik.MultiStart(bik.MultiStart(bik.papers.BAS())),
            Invalid,
            "MultiStart takes a single solver, not another MultiStart",
        ),
        (lambda: bik.MultiStart(3), Invalid, f"{SOLVERS}, got 3"),
        (lambda: bik.MultiStart(bik.papers.BAS(), max_starts=0), Invalid, "max_starts must be at least 1, got 0"),
        (lambda: bik.Stop(max_evaluations=0), Invalid, "max_evaluations must be at least 1, got 0"),
        (lambda: bik.Stop(max_evaluations=-1), Invalid, "max_evaluations must be zero or more, got -1"),
        (lambda: bik.Stop(max_iterations=-1), Invalid, "max_iterations must be zero or more, got -1"),
        (lambda: bik.Stop(max_time=-0.5), Invalid, "max_time must be zero or more seconds, got -0.5"),
        (lambda: bik.Stop(max_time=np.nan), Invalid, "max_time must be zero or more seconds, got NaN"),
    ]
)
def test_wrong_solver_options_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


@told(
    [
        (lambda: track(dt=0.0), Invalid, "dt must be positive and finite, got 0"),
        (lambda: track(dt=-0.1), Invalid, "dt must be positive and finite, got -0.1"),
        (lambda: track(dt=np.nan), Invalid, "dt must be positive and finite, got NaN"),
        (lambda: track(dt=3.5), Invalid, "dt must be at most 3 s, which the path takes, got 3.5"),
        (
            lambda: track(dt=1e-12),
            Invalid,
            "dt must be at least 0.0000003 s to cover 3 s in 10 million ticks, got 0.000000000001",
        ),
        (lambda: track(START[:6]), Invalid, "start_q of robot 'iiwa14': expected 7 joints, got 6"),
        (
            lambda: track(START + 9),
            Limit,
            f"start_q: joint 'joint_a1' at 9.6449219327 is outside its limits [-{TURN}, {TURN}] by 6.678 rad: "
            f"{TURNED}; {RADIANS}",
        ),
        (lambda: track("home"), Invalid, "start_q must be an array of numbers, got 'home'"),
        (lambda: track(solver="bas"), Invalid, f"{SOLVERS} or WeightedPseudoInverse, got 'bas'"),
        (lambda: track(position_tolerance=-1.0), Invalid, "position_tolerance must be positive, got -1"),
        (lambda: track(limit_at="end"), Invalid, "limit_at must be one of 'interval', 'start', got 'end'"),
        (lambda: track(seed=-1), Invalid, "seed must be zero or more, got -1"),
        (lambda: track(progress=3), Invalid, "progress must be True, False or a callable of (done, total), got 3"),
        (
            lambda: track(limits=bik.Limits(velocity=lambda t: [1.0, t])),
            Invalid,
            "velocity limit at t = 0 s: expected a number, or 7 values at all times, got 2",
        ),
        (
            lambda: track(limits=bik.Limits(velocity=lambda _: "fast")),
            Invalid,
            "velocity limit at t = 0 s must be an array of numbers, got 'fast'",
        ),
        (
            lambda: track(limits=bik.Limits(velocity=lambda _: None)),
            Invalid,
            "velocity limit at t = 0 s must be an array of numbers, got None",
        ),
        (
            lambda: track(limits=bik.Limits(lower=lambda t: t - 1, upper=1.5)),
            Limit,
            "joint 'joint_a1': lower limit 1.6 is above upper limit 1.5 at t = 2.5 s",
        ),
        (
            lambda: track(limits=bik.Limits(velocity=np.nan)),
            Invalid,
            "velocity limit of joint 'joint_a1' must be a number, got NaN",
        ),
    ]
)
def test_wrong_track_arguments_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


@told(
    [
        (lambda: bik.Limits(velocity="fast"), Invalid, "velocity limit must be an array of numbers, got 'fast'"),
        (lambda: bik.Limits(velocity=[]), Invalid, "velocity limit: expected a number or one per joint, got none"),
        (
            lambda: bik.Limits(upper=np.ones((2, 2))),
            Invalid,
            "upper limit: expected a number or one dimension, got shape (2, 2)",
        ),
        (
            lambda: bik.Sinusoid(mean=[1, 2], amplitude=[1, 2, 3], angular_frequency=1),
            Invalid,
            "Sinusoid: its fields have 3 and 2 values; give a number or one per joint",
        ),
        (
            lambda: bik.Sinusoid(mean="a", amplitude=1, angular_frequency=1),
            Invalid,
            "mean must be an array of numbers, got 'a'",
        ),
        (
            lambda: bik.Sinusoid(mean=None, amplitude=1, angular_frequency=1),
            Invalid,
            "mean must be an array of numbers, got None",
        ),
    ]
)
def test_wrong_limits_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


@told(
    [
        (lambda: circle(diameter=0.0), Invalid, "diameter must be positive and finite, got 0"),
        (lambda: circle(duration=-1.0), Invalid, "duration must be positive and finite, got -1"),
        (lambda: circle(duration=0.0), Invalid, "duration must be positive and finite, got 0"),
        (lambda: circle((0, 0)), Invalid, "center: expected shape (3,), got (2,)"),
        (lambda: circle((0, 0, np.nan)), Invalid, "path center must be finite, but entry 2 is NaN"),
        (
            lambda: circle(b=(1, 0, 0)),
            Invalid,
            "path: axes a and b must be orthonormal, but |a| = 1, |b| = 1 and a.b = 1",
        ),
        (lambda: bik.paths.rose((0, 0, 0), 1.0, radius=1.0, k=-1), Invalid, "k must be zero or more, got -1"),
        (lambda: bik.paths.polyline([], 1.0), Invalid, "path: it needs at least 2 points, got 0"),
        (lambda: bik.paths.polyline([[0, 0, 0]], 1.0), Invalid, "path: it needs at least 2 points, got 1"),
        (lambda: bik.paths.polyline([[0, 0], [1, 1]], 1.0), Invalid, "points: expected shape (k, 3), got (2, 2)"),
        (lambda: bik.paths.polyline(None, 1.0), Invalid, "points must be an array of numbers, got None"),
        (
            lambda: bik.paths.polyline([[0, 0, 0], [1, np.nan, 0]], 1.0),
            Invalid,
            "path points must be finite, but y of row 1 is NaN",
        ),
        (lambda: bik.paths.from_samples([], []), Invalid, "path: it needs at least 2 points, got 0"),
        (
            lambda: bik.paths.from_samples([0, 0], np.eye(3)[:2]),
            Invalid,
            "path times must increase, but row 1 has 0 after 0",
        ),
        (
            lambda: bik.paths.from_samples([1, 2], np.eye(3)[:2]),
            Invalid,
            "path times: row 0 must be 0, where the clock starts (take the first time from all), got 1",
        ),
        (
            lambda: bik.paths.from_samples([0, 1], [np.eye(4), 2 * np.eye(4)]),
            Invalid,
            "pose 1 is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)",
        ),
        (lambda: bik.paths.from_function(3, 1.0), Invalid, "function must be a callable of t, got 3"),
        (
            lambda: bik.paths.from_function(lambda t: [t], 1.0).position(0.5),
            Invalid,
            "path at t = 0.5 s: expected shape (3,), got (1,)",
        ),
        (
            lambda: bik.paths.from_function(lambda _: None, 1.0).sample(0.5),
            Invalid,
            "path at t = 0 s must be an array of numbers, got None",
        ),
        (lambda: CIRCLE.sample(0.0), Invalid, "dt must be positive and finite, got 0"),
        (lambda: CIRCLE.position(None), Invalid, "t must be an array of numbers, got None"),
        (lambda: CIRCLE.pose(0.0), Invalid, "this path has no orientation: use path.with_orientation(R)"),
        (lambda: CIRCLE.with_orientation(np.eye(4)), Invalid, "orientation: expected shape (3, 3), got (4, 4)"),
        (
            lambda: CIRCLE.with_orientation(lambda _: np.eye(2)).sample(0.5),
            Invalid,
            "orientation at t = 0 s: expected shape (3, 3), got (2, 2)",
        ),
    ]
)
def test_wrong_paths_are_named(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


@told(
    [
        (lambda: bik.pose([0, 0]), Invalid, "position: expected shape (3,), got (2,)"),
        (lambda: bik.pose(["a"]), Invalid, "position must be an array of numbers, got ['a']"),
        (
            lambda: bik.pose(None),
            Invalid,
            "pose needs a position (3,) or an orientation: xyzw= or wxyz= for a quaternion, rpy=, rotvec= or matrix=",
        ),
        (
            lambda: bik.pose([0, 0, 0], degrees=True),
            Invalid,
            "degrees=True belongs to rpy= or rotvec=: leave it out",
        ),
        (
            lambda: bik.pose([0, 0, 0], matrix=np.eye(4)),
            Invalid,
            "matrix (4, 4) has a position: leave out position, or give its rotation (3, 3)",
        ),
        (
            lambda: bik.pose([0, 0, 0], rpy=[0, 0, 0], rotvec=[0, 0, 0]),
            Invalid,
            "give one description of the orientation, got rpy, rotvec",
        ),
        (lambda: bik.pose([0, 0, 0], xyzw=[0, 0, 1]), Invalid, "xyzw: expected shape (4,), got (3,)"),
        (
            lambda: bik.pose([0, 0, 0], wxyz=[0, 0, 0, 0]),
            Invalid,
            "length of the quaternion must be positive and finite, got 0",
        ),
        (
            lambda: bik.pose([0, 0, 0], matrix=np.ones((3, 3))),
            Invalid,
            "matrix is not a rigid transform: R'R differs from the identity by 3.000e0; "
            "the nearest rotation is U V' of its singular value decomposition U S V'",
        ),
        (
            lambda: bik.pose([0, 0, 0], [0, 0, 0, 1]),
            Invalid,
            "pose takes an orientation by keyword only, since orders differ: xyzw= or wxyz= for a quaternion, rpy=, "
            "rotvec= or matrix=",
        ),
        (
            lambda: bik.pose([0, 0, 0], quat=[0, 0, 0, 1]),
            Invalid,
            "pose has no argument 'quat'; orientations are xyzw= or wxyz= for a quaternion, rpy=, rotvec= or matrix=",
        ),
        (
            lambda: bik.Trajectory([0, 1], np.zeros((1, 2))),
            Invalid,
            "coefficients: expected shape (k - 1, n, degree + 1), degree at most 6, got (1, 2)",
        ),
        (lambda: bik.Trajectory([0], np.zeros((0, 2, 2))), Invalid, "trajectory times: expected at least 2, got 1"),
        (
            lambda: bik.Trajectory.from_samples([0, 1], np.zeros((3, 2))),
            Invalid,
            "q: expected shape (2, n), a row for each time, got (3, 2)",
        ),
        (
            lambda: bik.Trajectory.from_samples([0, 1], np.zeros((2, 2)), qdd=np.zeros((2, 2))),
            Invalid,
            "trajectory: accelerations need velocities too",
        ),
    ]
)
def test_wrong_poses_and_trajectories_are_named(
    call: Callable[[], object], error: type[Exception], message: str
) -> None:
    assert_told(call, error, message)


def test_rows_in_place_of_a_path_and_numbers_in_place_of_a_name_are_told() -> None:
    hint = "path must be a Path, got [[0, 0, 0]]; bik.paths.from_samples(time, positions_or_poses) makes one from rows"
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.track(IIWA, [[0, 0, 0]], dt=0.1)  # type: ignore[arg-type]
    assert str(caught.value) == hint
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.Robot.named(14)  # type: ignore[arg-type]
    names = ", ".join(bik.Robot.names())
    assert str(caught.value) == f"name must be the name of a built-in robot, got 14; known robots: {names}"


@told(
    [
        (
            lambda: bik.solve("iiwa14", [0.3, 0.3, 1.0]),
            bik.CallError,
            "robot must be a Robot, such as Robot.named('iiwa14'), got 'iiwa14'",
        ),
        (
            lambda: track(limits=2.0),
            bik.CallError,
            "limits must be a Limits, such as Limits(velocity=1.5, acceleration=5.0), got 2.0",
        ),
        (
            lambda: solve(stop=5),
            bik.CallError,
            "stop must be a Stop, such as Stop(max_evaluations=1000), got 5",
        ),
        (lambda: track(dt="0.1"), bik.CallError, "dt must be a number, got '0.1'"),
        (lambda: track(dt=None), bik.CallError, "dt must be a number, got None"),
        (lambda: circle(diameter="wide"), bik.CallError, "diameter must be a number, got 'wide'"),
        (lambda: bik.papers.BAS(explorations=2.5), bik.CallError, "explorations must be a whole number, got 2.5"),
        (lambda: bik.Robot.planar([1, 1]).fk([0, 0], link=3), bik.CallError, "link must be text, got 3"),
    ]
)
def test_a_wrong_type_is_told(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)


def test_errors_of_functions_of_the_caller_pass_unchanged() -> None:
    def fails(_: object) -> float:
        raise TypeError("solve() got an unexpected keyword argument 'x'")

    mine = "solve() got an unexpected keyword argument 'x'"
    assert_told(lambda: bik.minimize(fails, [-1], [1], solver=bik.papers.BAS()), TypeError, mine)


@pytest.mark.parametrize(
    "call",
    [
        lambda: bik.papers.BAS("star"),
        lambda: bik.Limits(3.0),
        lambda: bik.Stop(5),
        lambda: bik.track(IIWA, CIRCLE, START, 0.1),
        lambda: bik.solve(IIWA, [0.3, 0.3, 1.0], START),
    ],
)
def test_options_are_named(call: Callable[[], object]) -> None:
    with pytest.raises(TypeError, match="positional argument"):
        call()


def test_a_csv_with_a_missing_column_is_told(tmp_path: Path) -> None:
    file = tmp_path / "motion.csv"
    file.write_text("time,q:a,q:b\n0,1,2\n1,2\n")
    assert_told(lambda: bik.Trajectory.from_csv(file), Invalid, f"{file}, line 3: column 'q:b' is missing")
    file.write_text("seconds,q:a\n0,1\n")
    message = f"{file}, line 1: column 'time' is missing; columns found: seconds, q:a"
    assert_told(lambda: bik.Trajectory.from_csv(file), Invalid, message)


def test_a_masked_array_without_masked_entries_is_an_array() -> None:
    target = np.array([0.3, 0.3, 1.0])
    np.testing.assert_array_equal(solve(np.ma.masked_array(target)).q, solve(target).q)


def test_unaligned_arrays_are_copied() -> None:
    packed = np.zeros(1, dtype=[("flag", "u1"), ("target", "f8", 3)])
    packed["target"] = (0.3, 0.3, 1.0)
    target = packed["target"][0]
    assert not target.flags.aligned
    np.testing.assert_array_equal(solve(target).q, solve([0.3, 0.3, 1.0]).q)


@pytest.mark.parametrize(
    "call",
    [
        lambda name: bik.Robot.named(name),
        lambda name: bik.Robot.from_urdf(name),
        lambda name: IIWA.with_capsules([(name, [0, 0, 0], [0, 0, 1], 0.1)]),
        lambda name: bik.Robot.from_urdf(f"<robot><joint name='{name}' type='x'/></robot>"),
        lambda name: bik.Robot.from_dh(a=[1], alpha=[0], d=[0], kinds=[name]),
    ],
)
def test_long_names_are_cut_in_messages(call: Callable[[str], object]) -> None:
    with pytest.raises(bik.BeetleIkError) as caught:
        call("n" * 10**6)
    assert len(str(caught.value)) < 1000
