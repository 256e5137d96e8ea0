"""The dual neural network of Khan et al.'s section 1, as a baseline: velocities of least norm within joint limits.

Zhang, Wang and Xia 2003 (reference 18 of the paper; reference 30 builds on it) solve in every instant

    minimise |qd + p|^2 / 2   subject to   J qd = xd + K (x_r - x),   lower <= qd <= upper,

with velocity bounds that hold the positions too: lower = max(-limit, kappa (q_min - q)), upper likewise. With
E = [J; I], c = E p and Omega the box of the right-hand sides, the network with state u (3 + n) is

    epsilon du/dt = P(W u - c - u) - W u + c,   W = E E^T,   qd = E^T u - p,

where P projects onto Omega. The original has neither K, which takes up errors that would add up, nor in general p;
p = mu (q - q_start) is the drift-free criterion of later work on repetitive motion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import beetle_ik as bik

from .settings import Array

_ROWS = 3  # rows of a position


@dataclass(frozen=True, kw_only=True)
class DualNetwork:
    """The options of the network."""

    feedback: float = 20.0
    """Feedback gain K (1/s)."""
    drift_free: float = 0.0
    """Weight mu (1/s); 0 gives the velocity of least norm."""
    time_constant: float = 1e-3
    """Time constant epsilon (s)."""
    inner_steps: int = 1
    """Steps of the network in a tick."""
    limit_gain: float = 10.0
    """Gain kappa of the position limits (1/s)."""


@dataclass(frozen=True)
class Tracked:
    """Joints (k, n) (rad), tips and references (k, 3) (m) over time (k,) (s)."""

    time: Array
    q: Array
    tip: Array
    reference: Array

    @property
    def error(self) -> Array:
        """Distance from the reference (k,) (m)."""
        return np.asarray(np.linalg.norm(self.tip - self.reference, axis=1))


def track(
    robot: bik.Robot,
    path: bik.Path,
    start: Array,
    *,
    dt: float,
    network: DualNetwork,
    lower: Array | None = None,
    upper: Array | None = None,
    velocity: float = 2.0,
) -> Tracked:
    """Follows `path` from `start` within positions `lower`, `upper` (n,) (rad) and |qd| <= `velocity` (rad/s).

    The joints take Euler steps of `dt`, the network implicit ones: it is stiff.
    """
    n = robot.dof
    lower = np.full(n, -np.inf) if lower is None else lower
    upper = np.full(n, np.inf) if upper is None else upper
    time: Array = dt * np.arange(round(path.duration / dt) + 1, dtype=float)
    reference, feedforward = path.position(time), path.velocity(time)
    q, u = np.empty((len(time), n)), np.zeros(_ROWS + n)
    q[0] = start
    for k in range(len(time) - 1):
        at = q[k]
        wanted = feedforward[k] + network.feedback * (reference[k] - robot.fk(at)[:3, 3])
        low = np.maximum(-velocity, network.limit_gain * (lower - at))
        high = np.minimum(velocity, network.limit_gain * (upper - at))
        box = np.concatenate((wanted, low)), np.concatenate((wanted, high))
        constraint = np.vstack((robot.jacobian(at)[:3], np.eye(n)))
        p = network.drift_free * (at - start)
        for _ in range(network.inner_steps):
            u = _step(u, constraint, constraint @ p, box, dt / network.inner_steps / network.time_constant)
        q[k + 1] = at + dt * np.clip(constraint.T @ u - p, low, high)
    return Tracked(np.asarray(time), q, np.asarray(robot.fk(q)[:, :3, 3]), np.asarray(reference))


def _step(u: Array, constraint: Array, c: Array, box: tuple[Array, Array], ratio: float) -> Array:
    """Returns u after one implicit Euler step, h / epsilon = `ratio`, with the active bounds of `u` fixed."""
    w = constraint @ constraint.T
    inside = w @ u - c - u
    bound = np.clip(inside, *box)
    free = (bound == inside).astype(float)
    # Projection P(z): z where free, the bound elsewhere.
    slope = w - free[:, None] * (w - np.eye(len(u)))
    rest = (1.0 - free) * (bound + c)
    return np.asarray(np.linalg.solve(np.eye(len(u)) + ratio * slope, u + ratio * rest))
