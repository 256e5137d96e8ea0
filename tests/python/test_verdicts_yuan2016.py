"""Verdicts on Yuan et al. 2016: each rule with data that must flip it."""

import numpy as np
import pytest

from beetle_ik.experiments.yuan2016.comparison import (
    accuracy_claim,
    guess_claim,
    iterations_claim,
    newton_claim,
    time_claim,
)
from beetle_ik.experiments.yuan2016.motions import angles_claim, counts_claim, positions_claim, system_error_claim
from beetle_ik.experiments.yuan2016.published import ERRORS, ITERATIONS, MOTIONS
from beetle_ik.experiments.yuan2016.rates import _AUTO, _PAPER, best_rate_claim, no_guess_claim
from beetle_ik.experiments.yuan2016.singularities import passed_claim, solved_claim, start_claim
from beetle_ik.experiments.yuan2016.typos import robot_claim
from beetle_ik.report import Verdict

REPRODUCED, WITH_READING, CONTRADICTED = Verdict.REPRODUCED, Verdict.WITH_READING, Verdict.CONTRADICTED
NOT_IDENTIFIABLE = Verdict.NOT_IDENTIFIABLE


def test_iterations() -> None:
    assert counts_claim(ITERATIONS, solved=True).verdict is WITH_READING
    assert counts_claim(ITERATIONS, solved=False).verdict is NOT_IDENTIFIABLE
    assert counts_claim((439, *ITERATIONS[1:]), solved=True).verdict is NOT_IDENTIFIABLE


def test_angles_and_positions() -> None:
    assert angles_claim(1e-4, 42).verdict is WITH_READING
    assert angles_claim(3e-4, 42).verdict is NOT_IDENTIFIABLE
    assert angles_claim(1e-4, 41).verdict is NOT_IDENTIFIABLE
    assert positions_claim(0.0, 0.011).verdict is WITH_READING
    assert positions_claim(2e-5, 0.011).verdict is NOT_IDENTIFIABLE
    assert positions_claim(0.0, 0.012).verdict is NOT_IDENTIFIABLE


def test_the_error_of_the_system() -> None:
    printed = ERRORS[:, 2]
    assert system_error_claim(printed + 0.004).verdict is WITH_READING
    assert system_error_claim(printed + 0.01 * np.eye(7)[3]).verdict is NOT_IDENTIFIABLE


@pytest.mark.parametrize(
    ("full", "slow", "verdict"),
    [
        (False, False, WITH_READING),
        (True, False, NOT_IDENTIFIABLE),
        (True, True, CONTRADICTED),
    ],
)
def test_newton_raphson(full: bool, slow: bool, verdict: Verdict) -> None:
    solved = {share: dict.fromkeys(MOTIONS, outcome) for share, outcome in ((1.0, full), (0.1, slow))}
    assert newton_claim(solved).verdict is verdict
    assert guess_claim(solved).verdict is verdict


def test_one_solved_motion_refutes_newton_raphsons_failure() -> None:
    solved = {1.0: dict.fromkeys(MOTIONS, False) | {"3-4": True}}
    assert newton_claim(solved).verdict is CONTRADICTED
    assert guess_claim(solved).verdict is CONTRADICTED
    assert guess_claim({1.0: dict.fromkeys(MOTIONS, False) | {"1-2": True}}).verdict is WITH_READING


def test_accuracy_time_and_iterations() -> None:
    assert accuracy_claim([0.01, 0.01], [2.0, 204.5]).verdict is REPRODUCED
    assert accuracy_claim([0.01, 0.01], [1e-5, 1e-5]).verdict is CONTRADICTED
    assert time_claim([13.2], [22.7]).verdict is REPRODUCED
    assert time_claim([1e-4], [1e-5]).verdict is CONTRADICTED
    assert iterations_claim([438, 256], [4000, 4000]).verdict is REPRODUCED
    assert iterations_claim([438, 3], [4000, 4]).verdict is REPRODUCED
    assert iterations_claim([438, 256], [7, 4000]).verdict is CONTRADICTED


def test_singularities() -> None:
    near, far = 0.006, 0.3
    assert passed_claim("I-1", {"APPS": near, "straight": near}, 0.02).verdict is WITH_READING
    assert passed_claim("5-6", {"APPS": far, "straight": near}, 0.02).verdict is NOT_IDENTIFIABLE
    assert passed_claim("5-6", {"APPS": far, "straight": far}, 0.02).verdict is CONTRADICTED
    assert solved_claim("5-6", solved=True).verdict is WITH_READING  # wherever the motion passes
    assert solved_claim("5-6", solved=False).verdict is NOT_IDENTIFIABLE
    assert start_claim(84.0, 82.0).verdict is WITH_READING
    assert start_claim(84.0, 60.0).verdict is NOT_IDENTIFIABLE


def test_learning_rate_and_initial_guess() -> None:
    solved = {1.0: 0, 0.5: 0, 0.1: 0, 0.05: 0, 0.02: 0, 0.01: 7}
    assert best_rate_claim(solved).verdict is WITH_READING
    assert best_rate_claim(solved | {0.01: 6}).verdict is NOT_IDENTIFIABLE
    assert best_rate_claim(solved | {0.1: 1}).verdict is NOT_IDENTIFIABLE
    assert no_guess_claim({_PAPER: 97.0, _AUTO: 99.0}).verdict is WITH_READING
    assert no_guess_claim({_PAPER: 34.0, _AUTO: 99.0}).verdict is NOT_IDENTIFIABLE
    assert no_guess_claim({_PAPER: 34.0, _AUTO: 85.0}).verdict is CONTRADICTED


def test_the_robot_of_table_1() -> None:
    assert robot_claim(4.8e-6).verdict is REPRODUCED
    assert robot_claim(6e-6).verdict is CONTRADICTED
