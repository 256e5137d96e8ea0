"""Verdicts on Khan et al. 2022: each rule with data that must flip it; and the dual network beside an oracle."""

import numpy as np
import pytest
from scipy.optimize import minimize

from beetle_ik.experiments.khan2022 import dual_network
from beetle_ik.experiments.khan2022.antennae import Antenna, law, remark_1
from beetle_ik.experiments.khan2022.constants import core_parameter, printed_gain
from beetle_ik.experiments.khan2022.figures import (
    letter_arrival,
    letter_error,
    limits_kept,
    no_spikes,
    star_arrival,
    star_equation,
    traced,
)
from beetle_ik.experiments.khan2022.obstacle import is_farther, keeps_clear
from beetle_ik.experiments.khan2022.other_methods import any_path, continuous, expensive, global_solution, real_time
from beetle_ik.experiments.khan2022.repetition import adds_up, closes, not_repeatable
from beetle_ik.experiments.khan2022.sensor import averages
from beetle_ik.experiments.khan2022.servo_arm import corrects, follows_on_servos, immune, on_servos_as_printed
from beetle_ik.experiments.khan2022.settings import IIWA, ON_CIRCLE, circle
from beetle_ik.experiments.khan2022.theorem import converges, goes_back, monotone, proof_holds, rises
from beetle_ik.report import Check, Claim, Verdict

REPRODUCED, WITH_READING, CONTRADICTED = Verdict.REPRODUCED, Verdict.WITH_READING, Verdict.CONTRADICTED
NOT_IDENTIFIABLE = Verdict.NOT_IDENTIFIABLE


def antenna(length: float | None, c1: float | None, arrival: float, late_h: float) -> Antenna:
    return Antenna(10.0, length, c1, arrival, late_h, late_h)


QUICK, EXACT = antenna(0.3, None, 1.0, 1e-3), antenna(0.01, None, 30.0, 1e-5)
FIRST, LAST = np.array([1e-3, 2e-3]), np.array([1e-3, 1.1e-3])


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        (letter_arrival({"free": 6.0, "limits": 12.0}), NOT_IDENTIFIABLE),
        (letter_arrival({"free": 6.0, "limits": 7.0}), WITH_READING),
        (letter_arrival({"free": 16.0, "limits": 12.0}), CONTRADICTED),
        (letter_error(8e-5, 1e-7, 4e-3), NOT_IDENTIFIABLE),
        (letter_error(1e-5, 1e-7, 1e-5), WITH_READING),
        (letter_error(2e-4, 2e-5, 4e-3), CONTRADICTED),
        (star_arrival({"10 ms": 2.7, "1 ms": 4.2}), NOT_IDENTIFIABLE),
        (star_arrival({"10 ms": 3.7, "1 ms": 4.2}), CONTRADICTED),
        (traced("It traces the M.", "Figure 2", {"θ": 0.008, "θ′": 0.05}, 0.4), NOT_IDENTIFIABLE),
        (traced("It traces the M.", "Figure 2", {"θ": 0.008, "θ′": 0.01}, 0.4), WITH_READING),
        (no_spikes({"θ": (0.009, 0.8), "θ′": (0.06, 80.0)}, 2.4), NOT_IDENTIFIABLE),
        (no_spikes({"θ": (0.009, 80.0), "θ′": (0.06, 80.0)}, 2.4), CONTRADICTED),
        (no_spikes({"θ": (0.009, 0.8), "θ′": (0.005, 1.0)}, 2.4), WITH_READING),
        (limits_kept({"flange": 0.06, "link 7": 0.1}), CONTRADICTED),
        (limits_kept({"flange": 0.06, "link 7": 1e-5}), NOT_IDENTIFIABLE),
        (limits_kept({"flange": 1e-5, "link 7": 1e-5}), WITH_READING),
        (star_equation(0.06), CONTRADICTED),
        (star_equation(1e-6), REPRODUCED),
        (remark_1([QUICK, EXACT, antenna(None, 1.0, 1.0, 1e-5), antenna(None, 0.3, 2.0, 1e-2)]), NOT_IDENTIFIABLE),
        (remark_1([QUICK, EXACT, antenna(None, 1.0, 1.0, 1e-5)]), WITH_READING),
        (remark_1([QUICK, EXACT, antenna(None, 0.3, 2.0, 1e-2)]), CONTRADICTED),
        (core_parameter({"ms": {1: 1.0, 9: 1.4}, "s": {1: 1.0, 9: 8.0}}, {"k": {1: 1.0, 2: 9.0}}), CONTRADICTED),
        (core_parameter({"ms": {1: 1.0, 9: 1.4}, "s": {1: 1.0, 9: 14.0}}, {"k": {1: 1.0, 2: 9.0}}), NOT_IDENTIFIABLE),
        (core_parameter({"ms": {1: 1.0, 9: 14.0}, "s": {1: 1.0, 9: 14.0}}, {"k": {1: 1.0, 2: 9.0}}), WITH_READING),
        (printed_gain([1.5, 1.5], [2.6, 1.4]), CONTRADICTED),
        (printed_gain([1.5, 1.5], [1e-4, 1e-4]), REPRODUCED),
        (monotone({"still": 30.0, "M": 45.0}), CONTRADICTED),
        (monotone({"still": 0.0, "M": 45.0}), NOT_IDENTIFIABLE),
        (monotone({"still": 0.0, "M": 0.0}), WITH_READING),
        (goes_back(100.0), CONTRADICTED),
        (goes_back(0.0), REPRODUCED),
        (converges({"still": (2e-3, 2e-3), "circle": (4e-3, 4e-3)}, 1e-31, 200.0), CONTRADICTED),
        (converges({"still, h(θ)": (2e-3, 1e-12), "still, h(θ′)": (2e-3, 2e-3)}, 1e-31, 200.0), NOT_IDENTIFIABLE),
        (converges({"still": (2e-3, 1e-12), "circle": (4e-3, 1e-12)}, 1e-31, 200.0), WITH_READING),
        (expensive(3e-6, 1e-6), NOT_IDENTIFIABLE),
        (expensive(3e-6, 4e-6), CONTRADICTED),
        (expensive(3e-4, 1e-6), WITH_READING),
        (real_time(2e-6), WITH_READING),
        (real_time(2e-3), NOT_IDENTIFIABLE),
        (continuous({"θ": [8e-4, 8e-5], "θ′": [0.08, 0.08]}), NOT_IDENTIFIABLE),
        (continuous({"θ": [8e-4, 8e-4], "θ′": [0.08, 0.08]}), CONTRADICTED),
        (continuous({"θ": [8e-4, 8e-5], "θ′": [0.08, 0.008]}), WITH_READING),
        (any_path({"M": 0.008}, {"fast M": 0.2}), NOT_IDENTIFIABLE),
        (any_path({"M": 0.008}, {"fast M": 0.01}), WITH_READING),
        (any_path({"M": 0.08}, {"fast M": 0.2}), CONTRADICTED),
        (global_solution({0.03: 25, 1e-4: 25}, 25), WITH_READING),
        (global_solution({0.03: 25, 1e-4: 0}, 25), NOT_IDENTIFIABLE),
        (global_solution({0.03: 24, 1e-4: 0}, 25), CONTRADICTED),
        (not_repeatable(0.6, 10), WITH_READING),
        (not_repeatable(1e-3, 10), NOT_IDENTIFIABLE),
        (adds_up(FIRST, LAST), WITH_READING),
        (adds_up(LAST, LAST), NOT_IDENTIFIABLE),
        (immune({"model": 0.05, "ZNNBAS, as drawn": 0.008, "ZNNBAS, built wrong": 0.009}), WITH_READING),
        (immune({"model": 0.05, "ZNNBAS, as drawn": 0.008, "ZNNBAS, built wrong": 0.02}), NOT_IDENTIFIABLE),
        (immune({"model": 0.001, "ZNNBAS, as drawn": 0.008, "ZNNBAS, built wrong": 0.008}), NOT_IDENTIFIABLE),
    ],
    ids=lambda value: value.statement[:40] if isinstance(value, Claim) else str(value),
)
def test_a_rule_decides(claim: Claim, verdict: Verdict) -> None:
    assert claim.verdict is verdict


@pytest.mark.parametrize(
    ("holds", "fails"),
    [
        (law([3.1, 4.2]), law([3.1, 9.0])),
        (proof_holds(0.0), proof_holds(0.1)),
        (closes(1e-8, 10), closes(0.6, 10)),
        (keeps_clear(np.array([1e-9]), np.array([0.04])), keeps_clear(np.array([1e-9]), np.array([0.04, 0.02]))),
        (keeps_clear(np.array([1e-9]), np.array([0.03])), keeps_clear(np.array([1e-3]), np.array([0.03]))),
        (is_farther(np.array([1e-2]), np.array([1e-9])), is_farther(np.array([1e-9]), np.array([1e-2]))),
        (averages({1e-4: 2e-4}), averages({1e-4: 2e-3})),
        (on_servos_as_printed(0.6), on_servos_as_printed(1e-3)),
        (follows_on_servos(0.02, 2e-3), follows_on_servos(0.02, 2e-2)),
        (corrects(0.05, 5e-4), corrects(0.05, 5e-3)),
    ],
    ids=lambda check: check.statement[:40],
)
def test_a_check_can_fail(holds: Check, fails: Check) -> None:
    assert holds.holds
    assert not fails.holds


def test_rises_are_counted() -> None:
    assert rises(np.array([3.0, 2.0, 2.5, 1.0, 1.0])) == 25.0


def test_the_network_finds_the_bounded_least_norm_velocity() -> None:
    """Let to settle, it gives what a general solver gives for the same quadratic program."""
    path = circle(4.0)
    network = dual_network.DualNetwork(feedback=0.0, time_constant=1e-4, inner_steps=4000)
    found = dual_network.track(IIWA, path, ON_CIRCLE, dt=1.0, network=network, velocity=0.216)
    qd = found.q[1] - found.q[0]
    jacobian, wanted = IIWA.jacobian(ON_CIRCLE)[:3], path.velocity(np.zeros(1))[0]
    oracle = minimize(
        lambda v: 0.5 * v @ v,
        np.zeros(7),
        jac=lambda v: v,
        bounds=[(-0.216, 0.216)] * 7,
        constraints={"type": "eq", "fun": lambda v: jacobian @ v - wanted, "jac": lambda _: jacobian},
        method="SLSQP",
        options={"ftol": 1e-14},
    )
    assert oracle.success
    assert np.abs(oracle.x).max() == pytest.approx(0.216)  # a bound is met, or nothing is tested
    np.testing.assert_allclose(qd, oracle.x, atol=1e-6)


def test_the_network_keeps_positions_and_comes_back() -> None:
    upper = ON_CIRCLE + 0.05
    network = dual_network.DualNetwork()
    kept = dual_network.track(IIWA, circle(10.0), ON_CIRCLE, dt=0.01, network=network, upper=upper)
    free = dual_network.track(IIWA, circle(10.0), ON_CIRCLE, dt=0.01, network=network)
    assert (kept.q <= upper + 1e-12).all()
    assert not (free.q <= upper).all()
    repeated = dual_network.track(
        IIWA, circle(10.0), ON_CIRCLE, dt=0.01, network=dual_network.DualNetwork(drift_free=5.0)
    )
    assert np.abs(repeated.q[-1] - ON_CIRCLE).max() < 0.02 * np.abs(free.q[-1] - ON_CIRCLE).max()
