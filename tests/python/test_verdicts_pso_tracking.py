"""Verdicts on trajectory tracking by PSO: each rule with data that must flip it; and its rivals' plant."""

from importlib import import_module

import numpy as np
import pytest

from beetle_ik import Robot
from beetle_ik.experiments import Context
from beetle_ik.experiments.pso_tracking import servo, servo_pseudo_inverse
from beetle_ik.experiments.pso_tracking.posture_claims import (
    PosturesAt,
    area_is_balance,
    balanced,
    best_so_far,
    constriction,
    found_best,
    own_search,
    printed_optima,
    second_joint_small,
    straight_arm_singular,
    text_and_tables,
)
from beetle_ik.experiments.pso_tracking.tracking_claims import (
    closer,
    control_time,
    jacobian_entry,
    jumps,
    limits_kept,
    null_space,
    order,
    other_swarms,
    own_error,
    printed_rivals,
)
from beetle_ik.report import Check, Claim, Verdict

# The names of the modules stand for their functions in the package.
tracking = import_module("beetle_ik.experiments.pso_tracking.tracking")
picture = import_module("beetle_ik.experiments.pso_tracking.picture")
REPRODUCED, WITH_READING, CONTRADICTED = Verdict.REPRODUCED, Verdict.WITH_READING, Verdict.CONTRADICTED
NOT_IDENTIFIABLE, NOT_TESTED = Verdict.NOT_IDENTIFIABLE, Verdict.NOT_TESTED

BENT, STRAIGHT = (0.3, 1.2, 1.3), (0.8, 0.1, 0.2)
RIVALS = {
    "PID, by hand": 3e-2,
    "PID, tuned": 6.7e-3,
    "PID, tuned, fed forward": 1.5e-3,
    "artificial bee colony": 6.7e-3,
    "GA-RBF": 2.2e-3,
}
ORDERED = RIVALS | {"PID, tuned": 2e-2, "PID, tuned, fed forward": 1e-2}


def postures_at(tip: tuple[float, ...], overall: tuple[float, ...]) -> dict[str, PosturesAt]:
    return {"0.5 m": PosturesAt(tip=tip, overall=overall, tip_in_quadrant=tip)}


def trials(near: int, lies: int = 0) -> object:
    return picture.Trials(50, near, lies, 0.1)


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        (found_best({"all": 1e-5, "quadrant": 1e-5}, 50), WITH_READING),
        (found_best({"all": 1e-5, "quadrant": 1e-2}, 50), NOT_IDENTIFIABLE),
        (found_best({"all": 1e-2}, 50), NOT_IDENTIFIABLE),
        (printed_optima({"all": (1.3, 12.4)}, 10.8003), CONTRADICTED),
        (printed_optima({"all": (1.3, 10.81)}, 10.8003), WITH_READING),
        (text_and_tables({"SM": (10.6883, 10.8003)}), CONTRADICTED),
        (text_and_tables({"SM": (10.8, 10.8003)}), REPRODUCED),
        (best_so_far({"SM": [1.0, 1.2, 1.1]}), NOT_IDENTIFIABLE),
        (best_so_far({"SM": [1.0, 1.2, 1.2]}), WITH_READING),
        (second_joint_small(postures_at(BENT, BENT), postures_at(STRAIGHT, BENT)), CONTRADICTED),
        (second_joint_small(postures_at(STRAIGHT, BENT), {}), WITH_READING),
        (straight_arm_singular(0.4), CONTRADICTED),
        (straight_arm_singular(1e-9), REPRODUCED),
        (balanced(postures_at(STRAIGHT, BENT)), WITH_READING),
        (balanced(postures_at(BENT, STRAIGHT)), CONTRADICTED),
        (balanced(postures_at(STRAIGHT, BENT) | {"0.3 m": postures_at(BENT, STRAIGHT)["0.5 m"]}), NOT_IDENTIFIABLE),
        (area_is_balance({"0.3 m": (0.29, 0.30), "0.5 m": (0.53, 0.73)}), NOT_IDENTIFIABLE),
        (area_is_balance({"0.5 m": (0.73, 0.73)}), WITH_READING),
        (constriction([3.5, 4.1]), CONTRADICTED),
        (constriction([4.05, 4.1]), REPRODUCED),
        (own_error({"1 ms": 8e-6, "10 ms": 8e-5}), NOT_IDENTIFIABLE),
        (own_error({"1 ms": 8e-6, "10 ms": 3e-5}), WITH_READING),
        (own_error({"1 ms": 8e-5, "10 ms": 8e-5}), NOT_IDENTIFIABLE),
        (closer({"free": 2e-4, "servos": 4e-3}, RIVALS, 1.2), NOT_IDENTIFIABLE),
        (closer({"free": 2e-4, "servos": 1e-3}, RIVALS, 1e-3), WITH_READING),
        (closer({"free": 2e-2, "servos": 4e-2}, RIVALS, 1.2), NOT_IDENTIFIABLE),
        (jumps({"free": 2e-4, "servos": 4e-3}, RIVALS), NOT_IDENTIFIABLE),
        (jumps({"free": 2e-4, "servos": 1e-3}, RIVALS), WITH_READING),
        (jumps({"free": 2e-2, "servos": 4e-2}, RIVALS), NOT_IDENTIFIABLE),
        (order(RIVALS), NOT_IDENTIFIABLE),
        (order(ORDERED), WITH_READING),
        (order(RIVALS | {"GA-RBF": 1.0}), NOT_IDENTIFIABLE),
        (printed_rivals(RIVALS, ["plant"]), NOT_IDENTIFIABLE),
        (control_time(["what it is"]), NOT_IDENTIFIABLE),
        (jacobian_entry({"+": 0.8, "-": 0.2}, 1.3), CONTRADICTED),
        (jacobian_entry({"+": 1.3, "-": 0.2}, 1.3), NOT_IDENTIFIABLE),
        (null_space(4.6, 0.15, 0.13), NOT_IDENTIFIABLE),
        (null_space(4.6, 0.15, 0.16), CONTRADICTED),
        (null_space(0.13, 0.15, 0.14), WITH_READING),
        (other_swarms(), NOT_TESTED),
        (picture.locates(trials(46), trials(50)), WITH_READING),
        (picture.locates(trials(30), trials(50)), NOT_IDENTIFIABLE),
        (picture.locates(picture.Trials(3, 3, 0, 0.1), trials(50)), NOT_TESTED),
    ],
    ids=lambda value: value.statement[:40] if isinstance(value, Claim) else str(value),
)
def test_a_rule_decides(claim: Claim, verdict: Verdict) -> None:
    assert claim.verdict is verdict


@pytest.mark.parametrize(
    ("holds", "fails"),
    [
        (own_search(1e-7), own_search(1e-3)),
        (limits_kept(0.0, 8e-5), limits_kept(1e-9, 8e-5)),
        (limits_kept(0.0, 8e-5), limits_kept(0.0, 8e-4)),
        (picture.threshold_locates(trials(50)), picture.threshold_locates(trials(40))),
        (picture.threshold_locates(trials(50)), picture.threshold_locates(trials(50, lies=1))),
    ],
)
def test_a_check_can_fail(holds: Check, fails: Check) -> None:
    assert holds.holds
    assert not fails.holds


def test_the_tuned_pid_is_the_best_of_its_grid() -> None:
    context = Context(short=True)
    motion = servo.paper_motion(2.0)
    tuned = servo.best_on_grid(motion, context)
    rms = {gains: np.sqrt(np.mean(servo.simulate(motion, gains) ** 2)) for gains in (tuned, servo.Gains())}
    assert rms[tuned] < 0.5 * rms[servo.Gains()]
    bounds = servo.MOST_GAINS
    assert (tuned.proportional, tuned.integral) == bounds[:2]  # in the corner of the box, as the report says


def test_the_pseudo_inverse_on_servos_follows_without_lag(monkeypatch: pytest.MonkeyPatch) -> None:
    arm = Robot.named("hydraulic3")
    slow = servo_pseudo_inverse.on_servos(arm, tracking.wanted, tracking.wanted_velocity, 1.0)
    monkeypatch.setattr(servo_pseudo_inverse, "TIME_CONSTANT", servo.DT)
    monkeypatch.setattr(servo_pseudo_inverse, "DISTURBANCE", 0.0)
    quick = servo_pseudo_inverse.on_servos(arm, tracking.wanted, tracking.wanted_velocity, 1.0)
    assert np.abs(quick).max() < 0.2 * np.abs(slow).max()


def test_the_sign_of_equation_13_decides() -> None:
    arm = Robot.named("hydraulic3")
    costs = [
        servo_pseudo_inverse.null_space_cost(arm, tracking.wanted, tracking.wanted_velocity, sign=sign)
        for sign in (1.0, 0.0, -1.0)
    ]
    assert costs[0] > costs[1] > costs[2]
