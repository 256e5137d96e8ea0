"""Properties common to all results, values and solvers."""

import inspect
from collections.abc import Callable

import numpy as np
import pytest
from iiwa_circle import IIWA, START

import beetle_ik as bik

PLANAR = bik.Robot.planar([1, 1, 1])
LINE = bik.paths.polyline([(0.3, 0.3, 1.0), (0.3, 0.31, 1.0)], duration=0.2)
LIMITS = bik.Limits(velocity=1.0, acceleration=2.0)
TARGET = (0.3, 0.3, 1.0)
SESSION = bik.papers.ZNNBAS().session(START, dt=0.1)
SESSION.command(TARGET)
RESULTS = [
    bik.solve(IIWA, TARGET),
    bik.solve_all(IIWA, TARGET, limit=2),
    bik.solve_batch(IIWA, [TARGET], threads=1),
    bik.minimize(np.sum, [-1], [1], solver=bik.papers.BAS(), stop=bik.Stop(max_evaluations=100)),
    bik.track(IIWA, LINE, START, dt=0.1),
    bik.Tracker(IIWA, START, dt=0.1).step(TARGET),
    SESSION.observe(TARGET),
    bik.track_model_free(bik.KinematicPlant(IIWA), LINE, START, dt=0.1),
    bik.plan_point_to_point(IIWA, start_q=START, end_q=START + 0.1, limits=LIMITS),
    bik.papers.planar_posture(PLANAR, (1, 1, 0)),
]
IN_COMMON = ("success", "status", "message", "evaluations", "elapsed", "limits")
SOLVERS = [
    bik.papers.BeeColony(),
    bik.papers.BeetleSwarm(),
    bik.BroydenBAS(),
    bik.DifferentialEvolution(),
    bik.papers.Firefly(),
    bik.papers.Genetic(),
    bik.LevenbergMarquardt(),
    bik.NewtonRaphson(),
    bik.papers.PSO(),
    bik.papers.QPSO(),
    bik.WeightedPseudoInverse(),
]


@pytest.mark.parametrize("result", RESULTS, ids=lambda result: type(result).__name__)
def test_all_results_share_the_same_properties(result: object) -> None:
    assert [name for name in IN_COMMON if not hasattr(result, name)] == []
    assert result.message  # type: ignore[attr-defined]
    assert result.elapsed >= 0.0  # type: ignore[attr-defined]
    assert isinstance(result.limits, bik.Limits)  # type: ignore[attr-defined]
    for name in dir(result):
        value = getattr(result, name)
        if isinstance(value, np.ndarray):
            assert not value.flags.writeable, name


@pytest.mark.parametrize("solver", SOLVERS, ids=lambda solver: type(solver).__name__)
def test_defaults_are_told_where_the_signature_cannot(solver: object) -> None:
    told = " ".join((inspect.getdoc(type(solver)) or "").split())
    assert f"Defaults: `{solver!r}`." in told


def test_every_public_name_is_documented() -> None:
    for module in (bik, bik.goals, bik.interop, bik.obstacles, bik.paths, bik.plot, bik.tasks, bik.vision):
        for name in module.__all__:
            thing = getattr(module, name)
            assert name == "__version__" or inspect.getdoc(thing), name
            for member, value in vars(thing).items() if isinstance(thing, type) else ():
                assert member.startswith("_") or member.isupper() or inspect.getdoc(value), f"{name}.{member}"


def test_limits_compare_by_value() -> None:
    def falling(t: float) -> float:
        return 2.0 - t

    sinusoid = bik.Sinusoid(mean=1.0, amplitude=0.5, angular_frequency=2.0)
    for limit in (1.0, [1.0, 2.0], sinusoid, falling):
        assert bik.Limits(velocity=limit) == bik.Limits(velocity=limit)
        assert bik.Limits(velocity=limit) != bik.Limits(acceleration=limit)
        assert bik.Limits(velocity=limit) != bik.Limits(velocity=3.0)
        assert bik.Limits(velocity=limit) != limit
    assert bik.Limits() == bik.Limits()
    assert bik.solve(IIWA, TARGET).limits == IIWA.limits


@pytest.mark.parametrize(("angles", "joints"), [(0, ""), (6, ""), (14, r" \(joint_a1 to joint_a7\)")])
def test_clearance_takes_one_configuration_or_rows_of_them(angles: int, joints: str) -> None:
    with pytest.raises(
        bik.InvalidInputError, match=rf"^joint angles of robot 'iiwa14': expected 7 joints{joints}, got {angles}$"
    ):
        bik.obstacles.clearance(IIWA.with_capsules(radius=0.05), np.zeros(angles))


def test_options_that_would_be_ignored_are_refused() -> None:
    with pytest.raises(bik.InvalidInputError, match=r"^margin must be zero or more and finite, got NaN$"):
        bik.plan_point_to_point(IIWA, start_q=START, end_q=START + 0.1, limits=LIMITS, margin=np.nan)


def test_a_track_tells_the_tolerance_that_was_asked_for() -> None:
    with pytest.raises(bik.InvalidInputError, match=r"^position_tolerance must be positive, got -1$"):
        bik.track(IIWA, LINE, dt=0.1, position_tolerance=-1.0)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: bik.papers.ZNNBAS(delay_steps=2**62), "delay_steps must be at most 100000 ticks, got "),
        (lambda: bik.papers.ZNNBAS(sensor_delay=2**62), "sensor_delay must be at most 100000 ticks, got "),
        (lambda: bik.papers.CircleSwarm(population=10**12), "population must be at most 1000000, got "),
    ],
)
def test_numbers_beyond_memory_are_refused(call: Callable[[], object], message: str) -> None:
    with pytest.raises(bik.InvalidInputError, match=f"^{message}"):
        call()
