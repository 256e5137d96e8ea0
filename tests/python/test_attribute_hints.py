"""Attributes that a value lacks: the message names the one that was probably meant."""

import copy
import pickle
from typing import Any

import numpy as np
import pytest

import beetle_ik as bik

PANDA = bik.Robot.named("panda")
READY = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
PLAN = bik.plan_point_to_point(
    PANDA, start_q=READY, end_q=READY + 0.1, limits=bik.Limits(velocity=1.0, acceleration=3.0)
)
SOLUTION = bik.solve(PANDA, PANDA.fk(READY))


@pytest.mark.parametrize(
    ("value", "name", "hint"),
    [
        (PLAN, "duration", ": its trajectory has it, .trajectory.duration"),
        (PLAN, "velocity", ": its trajectory has it, .trajectory.qd"),
        (PLAN, "clearence", " (did you mean 'clearance'?)"),
        (PLAN, "waypoints", ""),
        (PLAN, "__array__", ""),
        (PLAN.trajectory, "duraton", " (did you mean 'duration'?)"),
        (PLAN.trajectory, "positions", " (did you mean 'q'?)"),
        (SOLUTION, "x", " (did you mean 'q'?)"),
        (PLAN, "iterations", " (did you mean 'evaluations'?)"),
    ],
)
def test_a_missing_attribute_names_the_one_meant(value: Any, name: str, hint: str) -> None:
    with pytest.raises(AttributeError) as told:
        getattr(value, name)
    assert str(told.value) == f"'{type(value).__name__}' object has no attribute '{name}'{hint}"


def test_the_trajectory_has_what_a_hint_names() -> None:
    assert PLAN.trajectory.duration > 0.0
    assert not hasattr(PLAN, "duration")


def test_values_with_hints_are_copied_and_pickled() -> None:
    for value in (PLAN, SOLUTION, PANDA):
        assert pickle.loads(pickle.dumps(value)).__class__ is value.__class__
        assert copy.deepcopy(value).__class__ is value.__class__
