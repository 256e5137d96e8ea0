"""The fastest timing of joint paths: against toppra, against limits sampled finely, and wrong input by its messages."""

import json
import logging
import re
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import beetle_ik as bik
from beetle_ik.cli.app import app

SAMPLES = 10_000


def problem(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Waypoints, velocity and acceleration limits."""
    rng = np.random.default_rng(seed)
    rows, joints = rng.integers(3, 9), rng.integers(1, 8)
    return rng.uniform(-2, 2, (rows, joints)), rng.uniform(0.5, 3, joints), rng.uniform(1, 20, joints)


def largest_share(trajectory: bik.Trajectory, velocity: np.ndarray, acceleration: np.ndarray) -> float:
    """Of any limit, over fine samples."""
    _, qd, qdd = trajectory.at(np.linspace(0, trajectory.duration, SAMPLES))
    return max(np.max(np.abs(qd) / velocity), np.max(np.abs(qdd) / acceleration))


@pytest.mark.parametrize("gridpoints", [3, 10, 150, 1000, None])
@pytest.mark.parametrize("spline", ["natural", "not-a-knot", "clamped", "polyline"])
def test_limits_hold_between_grid_points(spline: str, gridpoints: int | None) -> None:
    for seed in range(5):
        q, velocity, acceleration = problem(seed)
        limits = bik.Limits(velocity=velocity, acceleration=acceleration)
        blend = 0.1 if spline == "polyline" else None
        trajectory = bik.time_optimal(q, limits, spline=spline, gridpoints=gridpoints, blend=blend)
        assert largest_share(trajectory, velocity, acceleration) <= 1 + 1e-6
        np.testing.assert_allclose(trajectory.q[[0, -1]], q[[0, -1]], atol=1e-9)
        np.testing.assert_allclose(trajectory.at([0.0, trajectory.duration])[1], 0.0, atol=1e-6)


def toppra_duration(q: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray, segments: int) -> float:
    """What toppra takes on so many segments of the natural spline."""
    toppra = pytest.importorskip("toppra")
    from toppra import algorithm, constraint

    logging.getLogger("toppra").setLevel(logging.ERROR)
    path = toppra.SplineInterpolator(np.linspace(0, 1, len(q)), q, bc_type="natural")
    grid = np.linspace(0, 1, segments + 1)
    limits = [
        constraint.JointVelocityConstraint(np.column_stack((-velocity, velocity))),
        constraint.JointAccelerationConstraint(np.column_stack((-acceleration, acceleration))),
    ]
    _, speeds, _ = algorithm.TOPPRA(limits, path, gridpoints=grid).compute_parameterization(0, 0)
    return float(np.sum(2 * np.diff(grid) / (speeds[1:] + speeds[:-1])))


@pytest.mark.filterwarnings("ignore")  # toppra's own
@pytest.mark.parametrize("seed", range(4))
def test_durations_are_those_of_toppra(seed: int) -> None:
    q, velocity, acceleration = problem(100 + seed)
    expected = toppra_duration(q, velocity, acceleration, 2000)
    limits = bik.Limits(velocity=velocity, acceleration=acceleration)
    assert bik.time_optimal(q, limits, gridpoints=2001).duration == pytest.approx(expected, rel=1e-3)
    chosen = bik.time_optimal(q, limits).duration
    assert (1 - 2e-4) * expected <= chosen <= (1 + 2e-3) * expected
    assert bik.time_optimal(q, limits, gridpoints=150).duration <= 1.01 * expected


def test_splines_are_those_of_scipy() -> None:
    interpolate = pytest.importorskip("scipy.interpolate")
    q, velocity, acceleration = problem(7)
    knots = np.cumsum(np.random.default_rng(1).uniform(0.5, 2.0, len(q)))
    limits = bik.Limits(velocity=velocity, acceleration=acceleration)
    for spline in ("natural", "not-a-knot", "clamped"):
        trajectory = bik.time_optimal(q, limits, knots=knots, spline=spline, gridpoints=400)
        expected = interpolate.CubicSpline(knots, q, bc_type=spline)(np.linspace(knots[0], knots[-1], 20_001))
        passed = trajectory.at(np.linspace(0, trajectory.duration, 200))[0]
        gaps = [np.min(np.linalg.norm(expected - row, axis=1)) for row in passed]
        assert max(gaps) < 6e-3  # the distance between samples of the curve


def test_jerk_limits_hold() -> None:
    q, velocity, acceleration = problem(3)
    limits = bik.Limits(velocity=velocity, acceleration=acceleration, jerk=20 * acceleration)
    trajectory = bik.time_optimal(q, limits)
    assert np.all(trajectory.max_velocity() <= velocity * (1 + 1e-9))
    assert np.all(trajectory.max_acceleration() <= acceleration * (1 + 1e-9))
    assert np.all(trajectory.max_jerk() <= 20 * acceleration * (1 + 1e-9))


def test_the_noise_of_an_encoder_costs_no_time() -> None:
    time = np.linspace(0, 20, 2000)
    clean = np.stack([0.8 * np.sin(2 * np.pi * time / (9 + 2 * i) + i) for i in range(4)], axis=1)
    step = 2 * np.pi / 4096
    # A second of rest before it.
    recorded = np.round(np.vstack((np.repeat(clean[:1], 100, axis=0), clean)) / step) * step
    limits = bik.Limits(velocity=2.0, acceleration=10.0, jerk=100.0)
    fastest = bik.time_optimal(clean[::20], limits).duration
    motion = bik.time_optimal(recorded, limits, tolerance=2 * step)
    with pytest.warns(UserWarning, match="this noise sets the duration"):
        exact = bik.time_optimal(recorded, limits)
    assert motion.duration < 1.02 * fastest < 0.3 * exact.duration
    passed = motion.sample(1e-3)[1]
    missed = [np.abs(passed - row).max(axis=1).min() for row in recorded[::20]]
    assert max(missed) <= 2 * step + 1e-3  # joints move by less between two samples
    each = bik.time_optimal(recorded, limits, tolerance=[2 * step] * 4)
    assert each.duration == motion.duration


def recording(rng: np.random.Generator, rows: int, joints: int) -> np.ndarray:
    """A slow motion, sampled closely: of sines, or of a spline through a few places with rests."""
    at = np.linspace(0, 1, rows)[:, None]
    if rng.random() < 0.5:
        return np.asarray(0.8 * np.sin(2 * np.pi * at * rng.uniform(0.3, 3, joints) + rng.uniform(0, 6, joints)))
    places = np.round(rng.uniform(-1, 1, (6, joints)), int(rng.integers(0, 3)))
    whole = np.minimum((5 * at).astype(int), 4)
    part = np.clip(1.3 * (5 * at - whole), 0, 1)
    smooth = part**3 * (10 - 15 * part + 6 * part**2)
    return np.asarray(places[whole[:, 0]] * (1 - smooth) + places[whole[:, 0] + 1] * smooth)


@pytest.mark.parametrize("jerk", [None, 100.0])
def test_noise_that_sets_the_duration_is_told(jerk: float | None) -> None:
    limits = bik.Limits(velocity=2.0, acceleration=10.0, jerk=jerk)
    told = re.compile(r"joint 'q\d' jitters by (.*) from row to row, and this noise sets the duration: (.*) s, "
                      r"without it about (.*) s; give tolerance=(.*), which smooths it")  # fmt: skip
    told_of = 0
    for seed in range(6):
        rng = np.random.default_rng(seed)
        rows = recording(rng, int(rng.integers(300, 900)), int(rng.integers(1, 7)))
        step = float(rng.choice([2 * np.pi / 4096, 1e-3, 0.005]))
        noisy = np.round(rows / step) * step if seed % 2 else rows + 0.3 * step * rng.normal(size=rows.shape)
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            exact = bik.time_optimal(noisy, limits)
        if not warned:
            # It costs little.
            assert exact.duration < 1.3 * bik.time_optimal(noisy, limits, tolerance=2 * step).duration
            continue
        told_of += 1
        said = told.fullmatch(str(warned[0].message))
        assert said is not None, str(warned[0].message)
        jitter, duration, without, tolerance = map(float, said.groups())
        assert 0.2 * step < jitter < 2.5 * step
        assert duration == pytest.approx(exact.duration, rel=1e-3)
        # What it says comes true, and is then not said again.
        smooth = bik.time_optimal(noisy, limits, tolerance=tolerance)
        assert smooth.duration <= 1.02 * without < 0.82 * duration
        with pytest.warns(UserWarning, match=f"give tolerance={said[4]}, "):
            bik.time_optimal(noisy, limits, tolerance=0.1 * jitter)
    assert told_of >= 3


def test_the_command_line_tells_of_noise_in_its_own_words(tmp_path: Path) -> None:
    at, file = np.linspace(0, 6, 400), tmp_path / "recorded.csv"
    file.write_text("joint\n" + "\n".join(f"{q:.3f}" for q in np.sin(at) + 2e-3 * (np.arange(400) % 2)))
    command = [sys.executable, "-m", "beetle_ik", "plan", "retime", str(file), "--acceleration-limit", "10"]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    assert ran.stderr.startswith("Warning: joint 'joint' jitters by 0.00")
    assert re.search(r" s; give --tolerance 0\.00\d+, which smooths it\n$", ran.stderr)


def test_paths_without_noise_are_not_called_noisy() -> None:
    limits = bik.Limits(velocity=2.0, acceleration=10.0)
    for seed in range(30):
        rng = np.random.default_rng(seed)
        rows, joints = int(rng.choice([2, 3, 50, 200, 500])), int(rng.integers(1, 7))
        clean = recording(rng, rows, joints)
        chosen = [
            clean,
            np.round(clean, 9),
            np.repeat(clean, 2, axis=0),
            rng.uniform(-1, 1, (12, joints)),
            # Places to go back and forth between are a motion, however many.
            np.tile([[0.0] * joints, [0.1] * joints], (60, 1)),
        ]
        for path in chosen:
            if np.ptp(path, axis=0).max() > 0:
                bik.time_optimal(path, limits)  # every warning is an error here


LIMITS = bik.Limits(velocity=1.0, acceleration=1.0)
WRONG: list[tuple[Any, dict[str, Any], type[Exception], str]] = [
    ([0.0, 1.0], {}, bik.InvalidInputError, "waypoints_q: expected shape (k, n), a row for each waypoint, got (2,)"),
    (
        [[], []],
        {},
        bik.InvalidInputError,
        "waypoints_q: expected shape (k, n), a row for each waypoint, got (2, 0)",
    ),
    ([[0.0, 1.0]], {}, bik.InvalidInputError, "waypoints: expected at least 2, got 1"),
    ([[0.0], [np.nan]], {}, bik.InvalidInputError, "waypoints must be finite, but joint 'q1' of row 1 is NaN"),
    (
        [[1.0], [1.0]],
        {},
        bik.InvalidInputError,
        "path: all waypoints are the same: give at least two that differ",
    ),
    (
        [[0.0, 0.0], [1.0, 1.0]],
        {"tolerance": [0.1, 0.1, 0.1]},
        bik.InvalidInputError,
        "tolerance: expected 2 (one per joint), got 3",
    ),
    (
        [[0.0], [1.0]],
        {"limits": bik.Limits(acceleration=1.0, velocity=0.0)},
        bik.InfeasibleError,
        "infeasible: the path moves joint 'q1', where the velocity limit is 0: give limits=Limits(velocity=...)",
    ),
    (
        [[0.0], [1.0]],
        {"limits": bik.Limits(acceleration=1.0, upper=0.5)},
        bik.InfeasibleError,
        "infeasible: the path takes joint 'q1' to 1, beyond its upper limit 0.5",
    ),
    (
        [[0.0, 0.0], [1.0, 2.0]],
        {"limits": bik.Limits(acceleration=[1.0, 2.0, 3.0])},
        bik.InvalidInputError,
        "acceleration limit: expected one number, or 2 (one per joint), got 3",
    ),
    (
        [[0.0], [1.0]],
        {"limits": bik.Limits(velocity=1.0)},
        bik.UnsupportedLimit,
        "time_optimal cannot honour infinite acceleration limits: joint 'q1' could start at any speed; give "
        "acceleration limits",
    ),
    (
        [[0.0], [1.0]],
        {"limits": bik.Limits(velocity=lambda t: 1.0 + t, acceleration=1.0)},
        bik.UnsupportedLimit,
        "time_optimal cannot honour time-varying velocity limits: when a point of the path is passed is what it looks "
        "for; give numbers",
    ),
    (
        [[0.0], [1.0]],
        {"spline": "cubic"},
        bik.InvalidInputError,
        "spline must be one of 'natural', 'not-a-knot', 'clamped', 'polyline', got 'cubic'",
    ),
    (
        [[0.0], [1.0]],
        {"blend": 0.1},
        bik.InvalidInputError,
        "blend can only be given for spline='polyline': 'natural' has no corners",
    ),
    (
        [[0.0], [1.0]],
        {"knots": [0.0, 1.0], "spline": "polyline"},
        bik.InvalidInputError,
        "knots can only be given for a spline: the parameter of a polyline is its length",
    ),
    ([[0.0], [1.0]], {"knots": [0.0, 0.0]}, bik.InvalidInputError, "knots must increase, but row 1 has 0 after 0"),
    ([[0.0], [1.0]], {"gridpoints": 2}, bik.InvalidInputError, "gridpoints must be from 3 to 200000, got 2"),
    (
        [[0.0], [1.0]],
        {"end_speed": 9.0},
        bik.InfeasibleError,
        "infeasible: the speed at the end of the path is beyond what the limits allow there",
    ),
]


@pytest.mark.parametrize(("waypoints", "options", "error", "message"), WRONG)
def test_mistakes_are_named(waypoints: Any, options: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=f"^{re.escape(message)}$"):
        bik.time_optimal(waypoints, **{"limits": LIMITS, **options})


def test_retime_from_the_command_line(tmp_path: Any) -> None:
    file = tmp_path / "points.csv"
    file.write_text("time,a,b\n0,0,0\n1,1,-0.5\n3,0.5,1\n")
    arguments = [
        "plan",
        "retime",
        str(file),
        "--acceleration-limit",
        "5,4",
        "--velocity-limit",
        "2",
        "--json",
        "--out",
        str(tmp_path / "out"),
    ]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    summary = json.loads(result.output)
    assert summary["joints"] == ["a", "b"]
    assert summary["duration"] < summary["duration_before"] == 3.0
    assert 0.999 < summary["saturation"]["acceleration"] <= 1 + 1e-9
    assert {"trajectory.csv", "trajectory.npz", "summary.json"} <= {path.name for path in (tmp_path / "out").iterdir()}
    again = bik.Trajectory.from_npz(tmp_path / "out" / "trajectory.npz")
    assert again.duration == summary["duration"]
    told = CliRunner().invoke(app, [argument for argument in arguments if argument != "--json"]).stdout
    assert told.startswith("2 joints, 3 waypoints\n")
    assert "duration in the file [s]" in told
    assert "share of the acceleration limit" in told


def test_retime_needs_joint_positions(tmp_path: Any) -> None:
    file = tmp_path / "points.csv"
    file.write_text("time,qd:a\n0,0\n1,1\n")
    result = CliRunner().invoke(app, ["plan", "retime", str(file), "--acceleration-limit", "5"])
    assert result.exit_code == 2
    assert "no joint positions: expected a column for each joint" in result.stderr


def test_saturation_is_drawn() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    q, velocity, acceleration = problem(2)
    limits = bik.Limits(velocity=velocity, acceleration=acceleration)
    figure = bik.plot.saturation(bik.time_optimal(q, limits), limits)
    assert [axes.get_ylabel() for axes in figure.axes] == ["share of velocity limit", "share of acceleration limit"]


@pytest.mark.parametrize("apart", [0.0, 1e-16, 4e-16, 1e-13])
def test_rows_that_differ_by_rounding_are_one(apart: float) -> None:
    limits = bik.Limits(velocity=1.0, acceleration=1.0)
    motion = bik.time_optimal([[0, 0], [1, 0], [1 + apart, 0], [2, 0]], limits)
    assert motion.duration == pytest.approx(3.0, abs=1e-6)
    assert (np.diff(motion.sample(0.01)[1][:, 0]) >= -1e-12).all()
