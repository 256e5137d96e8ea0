"""A few streams of `benches/hostile_streams.py`, and a test that its check notices errors."""

import sys
from pathlib import Path

import numpy as np
import pytest

import beetle_ik as bik

sys.path.insert(0, str(Path(__file__).parents[2] / "benches"))

from hostile_streams import HISTORY, SLACK, excesses, lowest, run
from hostile_targets import TARGETS, Stream

DT = 0.01
LIMITS = {"velocity": 1.0, "acceleration": 5.0, "jerk": 50.0}


def test_no_tick_is_beyond_a_limit_and_every_stream_stops() -> None:
    outcomes = run(ticks=20_000, seed=1)
    assert {name: outcome.complaints for name, outcome in outcomes.items()} == {name: [] for name in TARGETS}
    assert min(outcome.stops for outcome in outcomes.values()) > 5
    assert outcomes["NaN"].refused > 5


@pytest.mark.parametrize(("order", "kind"), [*enumerate(LIMITS, 1)])
def test_a_rate_a_millionth_beyond_its_limit_is_noticed(order: int, kind: str) -> None:
    robot = bik.Robot.planar([1.0])
    stream = Stream("by hand", robot, np.zeros(1), DT, {kind: LIMITS[kind]}, [])
    q = np.full((20, 1), LIMITS[kind] * DT**order)  # its differences of this order, from rest on
    q[:HISTORY] = 0.0
    for _ in range(order):
        q = np.cumsum(q, axis=0)
    assert abs(excesses(stream, q)[kind]) < SLACK
    assert excesses(stream, (1.0 + 1e-6) * q)[kind] == pytest.approx(1e-6, rel=1e-3)


def test_a_joint_beyond_its_position_limit_is_noticed() -> None:
    robot = bik.Robot.planar([1.0], lower=[-0.5], upper=[0.5])
    stream = Stream("by hand", robot, np.zeros(1), DT, {}, [])
    assert excesses(stream, np.array([[0.0], [0.0], [0.0], [0.5], [-0.5]]))["position"] == 0.0
    assert excesses(stream, np.array([[0.0], [0.0], [0.0], [0.6], [0.0]]))["position"] == pytest.approx(0.1)


def test_the_lowest_value_over_each_tick_is_that_of_dense_samples() -> None:
    limit = bik.Sinusoid(mean=1.0, amplitude=0.4, angular_frequency=90.0, phase=0.3)
    dense = np.linspace(0.0, 50 * DT, 50 * 400 + 1)
    values = 1.0 + 0.4 * np.sin(90.0 * dense + 0.3)
    sampled = [values[400 * i : 400 * i + 401].min() for i in range(50)]
    assert lowest(limit, DT, 50)[:, 0] == pytest.approx(sampled, abs=1e-5)
