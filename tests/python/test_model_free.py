"""Tracking without a model, from Python: plants of all kinds, sessions, and failures."""

import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from iiwa_circle import CIRCLE, IIWA, ON_CIRCLE
from mistakes import SLACK
from numpy.typing import NDArray

import beetle_ik as bik

Array = NDArray[np.float64]

SHORT = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=2.0)
LIMITS = bik.Limits(lower=IIWA.lower, upper=IIWA.upper, velocity=2.0)


def tip(q: Array) -> Array:
    return np.asarray(IIWA.fk(q)[:3, 3])


class Mover:
    def __init__(self) -> None:
        self.calls = 0

    def move(self, q: Array) -> tuple[float, float, float]:
        self.calls += 1
        x, y, z = tip(q)
        return float(x), float(y), float(z)


def track(plant: Any = tip, path: bik.Path = CIRCLE, start: Any = ON_CIRCLE, **options: Any) -> bik.ModelFreeResult:
    return bik.track_model_free(plant, path, start, **{"dt": 0.2, **options})


def test_all_kinds_of_plants_give_the_same_track() -> None:
    mover = Mover()
    native = track(bik.KinematicPlant(IIWA), limits=LIMITS)
    assert native.success, native.message
    assert len(native) == 151
    assert native.evaluations <= 700
    assert native.max_violation == 0.0
    np.testing.assert_allclose(native.position, native.reference, atol=1e-9)
    np.testing.assert_array_equal(native.command, native.q)
    np.testing.assert_allclose(native.qd[1:], np.diff(native.q, axis=0) / 0.2)
    for plant in (tip, mover, lambda q: list(tip(q)), lambda q: np.float32(tip(q))):
        result = track(plant, limits=LIMITS, position_tolerance=1e-6)
        assert result.success, result.message
    assert mover.calls == track(mover, limits=LIMITS, position_tolerance=1e-6).evaluations


def test_a_wrong_model_and_sensor_noise_are_compensated() -> None:
    wrong = IIWA.with_errors(length=0.02, angle=np.radians(2.0), seed=4)
    assert np.linalg.norm(wrong.fk(ON_CIRCLE)[:3, 3] - tip(ON_CIRCLE)) > 1e-3
    plant = bik.KinematicPlant(wrong, noise=1e-4, seed=2)
    result = track(plant, limits=LIMITS)
    error = np.linalg.norm(wrong.fk(result.q)[20:150, :3, 3] - result.reference[20:150], axis=1)
    assert np.sqrt((error**2).mean()) <= 3e-4 * np.sqrt(3.0)
    np.testing.assert_array_equal(track(plant, limits=LIMITS).q, result.q)  # every run begins the noise anew
    assert not np.array_equal(plant.move(ON_CIRCLE), plant.move(ON_CIRCLE))


def test_a_late_sensor_is_named_and_told_to_the_controller() -> None:
    def late() -> Callable[[np.ndarray], np.ndarray]:
        sent = [np.array(ON_CIRCLE)]

        def measure(q: np.ndarray) -> np.ndarray:
            sent.append(q.copy())
            return tip(sent[-2])

        return measure

    lost = track(late(), SHORT, dt=0.05, limits=LIMITS, position_tolerance=1e-4)
    assert not lost.success
    assert "the sensor is 1 measurement late; give the controller a sensor_delay of 1. Over" in lost.message, (
        lost.message
    )
    controller = bik.BroydenBAS(sensor_delay=1)
    followed = track(late(), SHORT, dt=0.05, limits=LIMITS, position_tolerance=1e-4, controller=controller)
    assert followed.success, followed.message


def test_znnbas_measures_once_a_step() -> None:
    controller = bik.papers.ZNNBAS(gain=10, antenna_length=0.1, delay_steps=10)
    result = track(bik.KinematicPlant(IIWA), SHORT, dt=1e-3, controller=controller, position_tolerance=0.3, seed=3)
    assert set(result.step_evaluations.tolist()) == {1}
    assert result.success, result.message
    assert 1e-3 < np.abs(result.command - result.q).max() <= 0.1 + 0.01
    again = track(bik.KinematicPlant(IIWA), SHORT, dt=1e-3, controller=controller, position_tolerance=0.3, seed=3)
    np.testing.assert_array_equal(again.command, result.command)


def test_a_last_partial_tick_ends_at_the_end_of_the_path() -> None:
    result = track(dt=0.7, path=SHORT, position_tolerance=1e-6)
    np.testing.assert_allclose(result.time, [0.0, 0.7, 1.4, 2.1])
    np.testing.assert_allclose(result.reference[-1], SHORT.position(2.0))


@pytest.mark.parametrize(
    "controller", [bik.BroydenBAS(), bik.papers.ZNNBAS(), bik.BroydenBAS(max_evaluations_per_step=1)]
)
def test_a_session_gives_the_same_commands(controller: bik.BroydenBAS | bik.papers.ZNNBAS) -> None:
    result = track(path=SHORT, controller=controller, limits=LIMITS, seed=7)
    session = controller.session(ON_CIRCLE, dt=0.2, limits=LIMITS, seed=7)
    np.testing.assert_array_equal(session.limits.velocity, 2.0)
    for row, target in enumerate(result.reference):
        step = None
        while step is None:
            step = session.observe(tip(session.command(target)))
        np.testing.assert_array_equal(step.q, result.q[row])
        assert step.evaluations == result.step_evaluations[row]
        assert session.time == pytest.approx(result.time[row])
    assert repr(session) == "<ControlSession of 7 joints at t = 2 s, dt = 0.2 s>"


def after(calls: int, then: Callable[[], Any]) -> Callable[[Array], Any]:
    """A plant that works for so many calls."""
    made = 0

    def move(q: Array) -> Any:
        nonlocal made
        made += 1
        return tip(q) if made <= calls else then()

    return move


def broken() -> Array:
    raise RuntimeError("the arm is off")


@pytest.mark.parametrize(
    ("then", "reason"),
    [
        (broken, "the plant raised RuntimeError: the arm is off"),
        (lambda: None, "the plant returned None, not a position (3,)"),
        (lambda: "here", "the plant returned 'here', not a position (3,)"),
        (lambda: np.zeros(2), "the plant returned shape (2,), not a position (3,)"),
        (lambda: np.eye(5), "the plant returned shape (5, 5), not a position (3,)"),
        (
            lambda: np.diag([1.0, 1.0, 2.0, 1.0]),
            "the plant returned an invalid pose: it is not a rigid transform: R'R differs from the identity by "
            "3.000e0; the nearest rotation is U V' of its singular value decomposition U S V'",
        ),
        (lambda: (0.0, np.nan, 0.0), "the plant returned a position that is not finite: [0.0, NaN, 0.0]"),
    ],
)
def test_a_plant_that_fails_ends_the_run_with_what_was_recorded(then: Callable[[], Any], reason: str) -> None:
    result = track(after(21, then), controller=bik.papers.ZNNBAS())
    assert (result.success, result.status, len(result)) == (False, bik.Status.PLANT_FAILED, 21)
    assert result.message == f"{reason} at t = 4.2 s; the 21 rows before are recorded"
    assert isinstance(result.exception, RuntimeError) == (then is broken)
    # At the very start there is nothing to keep: the mistake comes out as what it is.
    with pytest.raises((RuntimeError, bik.InvalidInputError)) as raised:
        track(after(0, then))
    assert reason in f"the plant raised RuntimeError: {raised.value}" or str(raised.value) == reason


def interrupted() -> Array:
    raise KeyboardInterrupt


def test_an_interrupt_in_the_plant_comes_out() -> None:
    with pytest.raises(KeyboardInterrupt):
        track(after(30, interrupted))


def answered(target: Any, measured: Any) -> bik.ControlSession:
    """A session after its first measurement."""
    session = bik.BroydenBAS().session(ON_CIRCLE, dt=0.1)
    session.command(target)
    session.observe(measured)
    return session


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: track(controller=bik.papers.ZNNBAS(delay_steps=150)),
            bik.InvalidInputError,
            "delay_steps must be less than the 150 steps of the run, got 150",
        ),
        (
            lambda: bik.papers.ZNNBAS(gain=0),
            bik.InvalidInputError,
            "gain must be finite and not zero (positive to converge), got 0",
        ),
        (
            lambda: bik.papers.ZNNBAS(antenna_length=0.1, c1=0.3),
            bik.InvalidInputError,
            "give either antenna_length, for a constant antenna, or c1, for one of c1 sqrt(h)",
        ),
        (
            lambda: track(controller=bik.papers.ZNNBAS(antenna_length=[0.1, 0.2])),
            bik.InvalidInputError,
            "antenna_length: expected one number, or 7 (one per joint), got 2",
        ),
        (
            lambda: bik.papers.ZNNBAS(delay="late"),
            bik.InvalidInputError,
            "delay must be one of 'sliding', 'held', got 'late'",
        ),
        (
            lambda: bik.papers.ZNNBAS(accept="never"),
            bik.InvalidInputError,
            "accept must be one of 'always', 'improving', got 'never'",
        ),
        (
            lambda: bik.BroydenBAS(max_evaluations_per_step=0),
            bik.InvalidInputError,
            "max_evaluations_per_step must be at least 1, got 0",
        ),
        (
            lambda: track(limits=bik.Limits(upper=0.4)),
            bik.LimitError,
            f"start_q: joint '0' at 0.5449219327 is outside its limits [-inf, 0.4] by 0.1449 rad: {SLACK}",
        ),
        (
            lambda: track(limits=bik.Limits(acceleration=1.0)),
            bik.UnsupportedLimit,
            "track_model_free cannot honour acceleration limits: a controller keeps position and velocity limits; "
            "leave it out",
        ),
        (
            lambda: bik.papers.ZNNBAS().session(ON_CIRCLE, dt=0.1, limits=bik.Limits(velocity=lambda t: t)),
            bik.UnsupportedLimit,
            "session cannot honour callable velocity limits: it has no end time up to which to sample; give numbers or "
            "a Sinusoid, or use track_model_free",
        ),
        (lambda: track(dt=0.0), bik.InvalidInputError, "dt must be positive and finite, got 0"),
        (lambda: track(start=[]), bik.InvalidInputError, "start_q: expected 1 to 64 joints, got 0"),
        (
            lambda: track(bik.KinematicPlant(IIWA), start=[0.0]),
            bik.InvalidInputError,
            "start_q of robot 'iiwa14': expected 7 joints, got 1",
        ),
        (
            lambda: track(controller="znnbas"),
            bik.InvalidInputError,
            "controller must be BroydenBAS or ZNNBAS, got 'znnbas'",
        ),
        (
            lambda: track(3),
            bik.InvalidInputError,
            "plant must be a KinematicPlant, a callable of q or an object with move(q), got 3",
        ),
        (
            lambda: track(path=CIRCLE.with_orientation(np.eye(3))),
            bik.InvalidInputError,
            "the plant returned a position (3,), but the path has orientations: return a pose (4, 4), or give a path "
            "of positions alone",
        ),
        (
            lambda: track(lambda _: np.zeros((3, 4)), CIRCLE.with_orientation(np.eye(3))),
            bik.InvalidInputError,
            "the plant returned shape (3, 4), not a pose (4, 4)",
        ),
        (
            lambda: track(lambda _: np.diag([1.0, np.nan, 1.0, 1.0]), CIRCLE.with_orientation(np.eye(3))),
            bik.InvalidInputError,
            "the plant returned an invalid pose: it must be finite, but entry (1, 1) is NaN",
        ),
        (
            lambda: track(rotation_tolerance=0.0),
            bik.InvalidInputError,
            "rotation_tolerance must be positive and finite, got 0",
        ),
        (
            lambda: bik.KinematicPlant(IIWA, rotation_noise=-1.0),
            bik.InvalidInputError,
            "rotation_noise must be zero or more and finite, got -1",
        ),
        (
            lambda: bik.BroydenBAS().session(ON_CIRCLE, dt=0.1).command(np.diag([1.0, 1.0, 2.0, 1.0])),
            bik.InvalidInputError,
            "target is not a rigid transform: R'R differs from the identity by 3.000e0; "
            "the nearest rotation is U V' of its singular value decomposition U S V'",
        ),
        (
            lambda: bik.BroydenBAS().session(ON_CIRCLE, dt=0.1).command(np.zeros((3, 4))),
            bik.InvalidInputError,
            "target: expected a position (3,) or a pose (4, 4), got shape (3, 4)",
        ),
        (
            lambda: answered(np.eye(4), (0.0, 0.0, 0.0)),
            bik.InvalidInputError,
            "position: expected a pose (4, 4), like the target, got a position (3,)",
        ),
        (
            lambda: answered(np.eye(4), np.eye(4)).command((0.0, 0.0, 0.0)),
            bik.InvalidInputError,
            "target: expected a pose (4, 4), as before, got a position (3,)",
        ),
        (
            lambda: answered((0.0, 0.0, 0.0), np.eye(4)).command(np.eye(4)),
            bik.InvalidInputError,
            "target: expected a position (3,), as before, got a pose (4, 4)",
        ),
        (
            lambda: bik.KinematicPlant(IIWA, noise=-1.0),
            bik.InvalidInputError,
            "noise must be zero or more and finite, got -1",
        ),
        (
            lambda: IIWA.with_errors(length=np.nan),
            bik.InvalidInputError,
            "length must be zero or more and finite, got NaN",
        ),
        (
            lambda: bik.BroydenBAS().session(ON_CIRCLE, dt=0.1).observe((0.0, 0.0, 0.0)),
            bik.InvalidInputError,
            "observe: there is no command to answer; call command(target) first",
        ),
    ],
)
def test_wrong_input_is_named(call: Callable[[], Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        call()
    assert str(raised.value) == message


@pytest.mark.parametrize(
    "value",
    [
        bik.BroydenBAS(antenna_length=0.02, max_evaluations_per_step=3, sensor_delay=1),
        bik.papers.ZNNBAS(),
        bik.papers.ZNNBAS(
            gain=-10.0, antenna_length=0.1, delay_steps=10, delay="held", accept="improving", sensor_delay=2
        ),
        bik.papers.ZNNBAS(antenna_length=[0.1, 0.2, 0.3]),
    ],
)
def test_controllers_are_values(value: Any) -> None:
    assert pickle.loads(pickle.dumps(value)) == value
    assert eval(repr(value), {"BroydenBAS": bik.BroydenBAS, "ZNNBAS": bik.papers.ZNNBAS}) == value


def test_plants_are_values_too() -> None:
    plant = bik.KinematicPlant(IIWA, noise=1e-4, seed=3)
    assert pickle.loads(pickle.dumps(plant)) == plant
    assert plant != bik.KinematicPlant(IIWA)
    assert repr(plant) == "<KinematicPlant of 'iiwa14': noise=0.0001, seed=3>"


def test_broyden_solves_and_tracks() -> None:
    solution = bik.solve(IIWA, IIWA.fk(ON_CIRCLE), solver=bik.BroydenBAS(), start_q=ON_CIRCLE + 0.1)
    assert solution.success, solution.message
    result = bik.track(IIWA, SHORT, ON_CIRCLE, dt=0.2, solver=bik.BroydenBAS(), position_tolerance=1e-9)
    assert result.success, result.message
    many = bik.MultiStart(bik.BroydenBAS())
    assert many.solver == bik.BroydenBAS()
    assert bik.solve(IIWA, (0.4, 0.3, 0.8), solver=many).success


BUILT = IIWA.with_errors(length=0.02, angle=np.radians(2.0), seed=4)
TURNED = SHORT.with_orientation(BUILT.fk(ON_CIRCLE)[:3, :3])
"""The circle with the orientation that the arm as built begins with."""


@pytest.mark.parametrize("plant", [bik.KinematicPlant(BUILT, rotation_noise=0.0), BUILT.fk])
def test_poses_are_tracked_by_an_arm_built_wrong(plant: Any) -> None:
    result = track(plant, TURNED, dt=0.02, position_tolerance=1e-7, rotation_tolerance=1e-7)
    assert result.success, result.message
    assert result.message.startswith("in the band of 1.000e-7 m and 1.000e-7 rad from t = 0.02 s on; ")
    assert result.rotation_tolerance == 1e-7
    late = slice(20, None)
    assert result.rotation_error[late].max() <= 1e-7
    tips = BUILT.fk(result.q)[late]
    np.testing.assert_allclose(tips[:, :3, 3], result.reference[late], atol=1e-7)
    np.testing.assert_allclose(tips[:, :3, :3] - TURNED.pose(0.0)[:3, :3], 0.0, atol=2e-7)


def test_znnbas_reduces_both_errors_as_far_as_it_can() -> None:
    path = CIRCLE.with_orientation(BUILT.fk(ON_CIRCLE)[:3, :3])
    plant = bik.KinematicPlant(BUILT, rotation_noise=0.0)
    free, held = (track(plant, p, dt=1e-3, controller=bik.papers.ZNNBAS(), seed=1) for p in (CIRCLE, path))
    late = slice(len(held) // 2, None)
    turned = [angle(BUILT.fk(result.q[late]), BUILT.fk(ON_CIRCLE)).max() for result in (free, held)]
    assert turned[1] < 0.1 < turned[0]
    assert held.position_error[late].max() < 0.05
    assert np.isnan(free.rotation_error).all()


def angle(poses: Array, pose: Array) -> Array:
    trace = (poses[:, :3, :3] * pose[:3, :3]).sum(axis=(1, 2))
    return np.asarray(np.arccos(np.clip(0.5 * (trace - 1.0), -1.0, 1.0)))


@pytest.mark.parametrize("controller", [bik.BroydenBAS(), bik.papers.ZNNBAS()])
def test_a_measured_orientation_that_is_not_asked_for_is_ignored(
    controller: bik.BroydenBAS | bik.papers.ZNNBAS,
) -> None:
    with_pose, without = (
        track(plant, SHORT, controller=controller)
        for plant in (bik.KinematicPlant(IIWA, rotation_noise=0.0), lambda q: IIWA.fk(q)[:3, 3])
    )
    np.testing.assert_allclose(with_pose.q, without.q, atol=1e-9)
    assert np.isnan(with_pose.rotation_error).all()
    assert " rad" not in with_pose.message


@pytest.mark.parametrize("controller", [bik.BroydenBAS(), bik.papers.ZNNBAS()])
def test_a_session_takes_poses(controller: bik.BroydenBAS | bik.papers.ZNNBAS) -> None:
    result = track(BUILT.fk, TURNED, controller=controller, seed=7)
    session = controller.session(ON_CIRCLE, dt=0.2, seed=7)
    for row, time in enumerate(result.time):
        step = None
        while step is None:
            step = session.observe(BUILT.fk(session.command(TURNED.pose(time))))
        np.testing.assert_allclose(step.q, result.q[row], atol=1e-12)
        assert step.rotation_error == pytest.approx(result.rotation_error[row], abs=1e-12)


def test_noise_turns_the_measured_orientation() -> None:
    plant = bik.KinematicPlant(IIWA, noise=1e-3, rotation_noise=0.01, seed=2)
    still = np.array([plant.move(ON_CIRCLE) for _ in range(2000)])
    np.testing.assert_allclose(np.sqrt((angle(still, IIWA.fk(ON_CIRCLE)) ** 2).mean()), 0.01 * np.sqrt(3.0), rtol=0.1)
    np.testing.assert_allclose((still[:, :3, 3] - tip(ON_CIRCLE)).std(), 1e-3, rtol=0.1)
    assert pickle.loads(pickle.dumps(plant)) == plant
    assert plant != bik.KinematicPlant(IIWA, noise=1e-3, seed=2)
    assert repr(plant) == "<KinematicPlant of 'iiwa14': noise=0.001, rotation_noise=0.01, seed=2>"


def test_noise_of_a_sensor_of_poses_is_not_much_more_than_passed_on() -> None:
    plant = bik.KinematicPlant(BUILT, noise=1e-4, rotation_noise=1e-4, seed=2)
    result = track(plant, TURNED, dt=0.02, seed=1)
    tips, late = BUILT.fk(result.q), slice(20, None)
    off = np.linalg.norm(tips[late, :3, 3] - result.reference[late], axis=1)
    turned = angle(tips[late], TURNED.pose(0.0))
    assert np.sqrt((off**2).mean()) < 6e-4
    assert np.sqrt((turned**2).mean()) < 6e-4


def test_a_run_with_orientations_is_drawn() -> None:
    labels = [axes.get_ylabel() for axes in track(BUILT.fk, TURNED).plot().axes]
    assert sorted(labels) == sorted(
        ["y [m]", "measured error [m]", "rotation error [rad]", "joint position [rad, m]", "measurements per step"]
    )


def test_a_run_is_drawn() -> None:
    labels = [axes.get_ylabel() for axes in track(path=SHORT).plot().axes]
    assert labels == ["y [m]", "measured error [m]", "joint position [rad, m]", "measurements per step"]
