"""One joint with a velocity servo, and the three controllers that the paper compares with: our own baselines.

The paper gives neither plant nor gains, so nothing of its Figure 8 can be matched by number. All controllers drive the
same plant under the same disturbance. The PID is tried twice: tuned by hand, and by a rule, which takes the best of a
grid over the box that the bee colony searches, with as many trials and the colony's criterion.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ... import Stop, minimize
from ...papers import BeeColony, Genetic
from ..experiment import Context

_Array = NDArray[np.float64]

DT = 1e-3  # s
TIME_CONSTANT = 0.05  # s, of the servo
MOST = 2.0  # rad/s, largest command
DISTURBANCE = 0.05  # rad/s, amplitude
DISTURBANCE_RATE = 3.0  # rad/s
MOST_GAINS = (60.0, 120.0, 2.0)  # largest proportional, integral and derivative gain in any tuning
CENTRES = np.array([(q, qd) for q in (-0.5, 0.0, 0.5) for qd in (-0.8, 0.0, 0.8)])
WIDTH = 0.45
ADAPTATION = 200.0  # 1/s^2, adaptation rate of the network's weights


@dataclass(frozen=True)
class Motion:
    """Desired motion of a joint: positions and velocities at the steps (rad, rad/s)."""

    time: _Array
    q: _Array
    qd: _Array


def paper_motion(duration: float) -> Motion:
    """Returns the motion of joints 1 and 2 in the paper: 0.5 cos(pi t / 2)."""
    time: _Array = np.arange(0.0, duration, DT, dtype=float)
    return Motion(time, 0.5 * np.cos(np.pi / 2 * time), -np.pi / 4 * np.sin(np.pi / 2 * time))


@dataclass(frozen=True)
class Gains:
    """Gains of a PID controller."""

    proportional: float = 20.0
    integral: float = 10.0
    derivative: float = 0.0


def features(motion: Motion) -> _Array:
    """Evaluates Gaussian radial basis functions of the desired position and velocity: (steps, 9)."""
    wanted = np.stack((motion.q, motion.qd), axis=1)[:, None, :]
    return np.asarray(np.exp(-np.sum((wanted - CENTRES) ** 2, axis=2) / (2 * WIDTH**2)))


def simulate(
    motion: Motion,
    gains: Gains,
    *,
    weights: _Array | None = None,
    basis: _Array | None = None,
    adaptation: float = 0.0,
    feedforward: bool = False,
) -> _Array:
    """Returns the errors (steps,) (rad) of a PID, plus an adaptive network if `weights` are given.

    With `feedforward` the desired velocity is added to the command.

    Plant: q' = v, T v' = -v + u + d, |u| bounded, by Euler steps; it begins at the desired position at rest.
    """
    q, v, sum_of_errors, before = float(motion.q[0]), 0.0, 0.0, 0.0
    errors = np.empty(len(motion.time))
    network = None if weights is None else weights.copy()
    disturbance = DISTURBANCE * np.sin(DISTURBANCE_RATE * motion.time)
    for i in range(len(motion.time)):
        error = motion.q[i] - q
        errors[i] = error
        sum_of_errors += DT * error
        u = gains.proportional * error + gains.integral * sum_of_errors + gains.derivative * (error - before) / DT
        before = error
        if feedforward:
            u += motion.qd[i]
        if network is not None and basis is not None:
            u += network @ basis[i]
            network += DT * adaptation * error * basis[i]
        u = min(max(u, -MOST), MOST)
        v += DT / TIME_CONSTANT * (u + disturbance[i] - v)
        q += DT * v
    return errors


def best_on_grid(motion: Motion, context: Context) -> Gains:
    """Returns the gains of least rms error over the first two seconds, from as many trials as the bee colony has."""
    per_axis = context.pick(full=(10, 8, 5), short=(5, 4, 3))
    grid = [np.linspace(0.0, most, count) for most, count in zip(MOST_GAINS, per_axis, strict=True)]
    trial = _beginning(motion)
    candidates = [Gains(*map(float, gains)) for gains in np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 3)]
    return min(candidates, key=lambda gains: _cost(simulate(trial, gains)))


def bee_pid(motion: Motion, context: Context) -> _Array:
    """Simulates a PID whose gains a bee colony tuned on the first two seconds."""
    trial = _beginning(motion)

    def cost(gains: _Array) -> float:
        return _cost(simulate(trial, Gains(*gains)))

    found = _least(cost, [0.0] * 3, list(MOST_GAINS), BeeColony(), context.pick(full=400, short=60), context.seed)
    return simulate(motion, Gains(*found))


def genetic_network(motion: Motion, context: Context) -> _Array:
    """Simulates a PID with a radial-basis network: weights by a genetic algorithm, then adapted during the run."""
    trial, gains = _beginning(motion), Gains()
    basis = features(trial)

    def cost(weights: _Array) -> float:
        return _cost(simulate(trial, gains, weights=weights, basis=basis, adaptation=ADAPTATION))

    size = len(CENTRES)
    found = _least(cost, [-1.0] * size, [1.0] * size, Genetic(), context.pick(full=300, short=60), context.seed)
    return simulate(motion, gains, weights=found, basis=features(motion), adaptation=ADAPTATION)


def controllers(motion: Motion, context: Context) -> dict[str, _Array]:
    """Returns the errors (steps,) (rad) of each controller."""
    tuned = best_on_grid(motion, context)
    return {
        "PID, by hand": simulate(motion, Gains()),
        "PID, tuned": simulate(motion, tuned),
        "PID, tuned, fed forward": simulate(motion, tuned, feedforward=True),  # like the pseudo-inverse
        "artificial bee colony": bee_pid(motion, context),
        "GA-RBF": genetic_network(motion, context),
    }


def _cost(errors: _Array) -> float:
    """Returns the rms error (rad)."""
    return float(np.sqrt(np.mean(errors**2)))


def _beginning(motion: Motion) -> Motion:
    """Returns the first two seconds, used for tuning."""
    steps = min(len(motion.time), round(2.0 / DT))
    return Motion(motion.time[:steps], motion.q[:steps], motion.qd[:steps])


def _least(
    cost: Callable[[_Array], float],
    lower: list[float],
    upper: list[float],
    solver: BeeColony | Genetic,
    evaluations: int,
    seed: int,
) -> _Array:
    # Starts at the hand-tuned gains, or without a network, so that tuning never makes the controller worse.
    begin = [Gains().proportional, Gains().integral, Gains().derivative] if len(lower) == 3 else np.zeros(len(lower))
    stop = Stop(max_evaluations=evaluations)
    return np.array(minimize(cost, lower, upper, solver=solver, start=begin, stop=stop, seed=seed).x)


def settled(errors: _Array, band: float = 2e-3) -> float:
    """Returns the time at which the error enters `band` (rad) for good (s); NaN if it does not."""
    outside = np.flatnonzero(np.abs(errors) > band)
    if len(outside) == 0:
        return 0.0
    return float("nan") if outside[-1] == len(errors) - 1 else (outside[-1] + 1) * DT
