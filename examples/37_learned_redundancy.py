"""
A redundancy learned by gradient
================================

An arm of seven joints reaches a pose in many ways. Here a small policy learns which
one to take: it looks at the target and gives the start of ``solve``, which brings
the tip exactly to the target in any case. ``interop.jax`` passes the gradient of a
cost of the configuration through ``solve`` to the policy. The cost keeps the elbow
clear of a post, and joints away from their limits.
"""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik
from beetle_ik.interop import jax as bjax

robot = bik.Robot.named("iiwa14").with_capsules(radius=0.06)
post = bik.obstacles.Cylinder(
    (0.25, -0.35, 0.6), axis=(0, 0, 1), radius=0.05, length=1.2
)
home = jnp.array([0.0, 0.6, 0.0, -1.3, 0.0, 0.9, 0.0])
solve, clearance = bjax.solve(robot), bjax.clearance(robot, [post])

draw = np.random.default_rng(3)
places = draw.uniform([0.45, -0.35, 0.3], [0.65, 0.35, 0.7], (300, 3))
targets = jnp.array([bik.pose(place, rpy=[0.0, np.pi, 0.0]) for place in places])
training, test = targets[:200], targets[200:]


# %%
# The policy: a start as a polynomial of the place. Nothing needs float64 here.
def start_of(weights, target):
    """The start (7,) that the policy chooses."""
    place = target[:3, 3] - jnp.array([0.55, 0.0, 0.5])
    terms = jnp.concatenate([jnp.ones(1), place, jnp.outer(place, place).ravel()])
    return home + terms @ weights


def cost(weights, target):
    """Nearness to the post, and joints away from the middle of their ranges."""
    q = solve(target, start_of(weights, target))
    middle = 0.02 * jnp.sum((q / jnp.array(robot.upper)) ** 2)
    return jax.nn.softplus(60.0 * (0.10 - clearance(q))) / 60.0 + middle


def mean_cost(weights, targets):
    """The cost that is learned from."""
    return jax.vmap(cost, (None, 0))(weights, targets).mean()


# %%
# Adam, the usual method, with the gradient of all targets at once.
weights = jnp.zeros((13, 7))
mean, square = jnp.zeros_like(weights), jnp.zeros_like(weights)
step = jax.jit(jax.value_and_grad(mean_cost))
history = []
for k in range(1, 101):
    value, gradient = step(weights, training)
    history.append(float(value))
    mean = 0.9 * mean + 0.1 * gradient
    square = 0.99 * square + 0.01 * gradient**2
    scale = jnp.sqrt(square / (1 - 0.99**k)) + 1e-8
    weights = weights - 0.03 * mean / (1 - 0.9**k) / scale


# %%
# Targets that the policy has not seen.
def clearances(weights):
    """Distances from the post, at the targets of the test."""
    starts = jax.vmap(start_of, (None, 0))(weights, test)
    return np.asarray(clearance(solve(test, starts)))


before, after = clearances(jnp.zeros((13, 7))), clearances(weights)
print(f"cost: {history[0]:.3f} before, {history[-1]:.3f} after")
print(
    f"nearest to the post: {before.min():.3f} m before, {after.min():.3f} m after"
)

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.2), layout="constrained")
left.plot(history, color="#0072B2")
left.set(xlabel="step", ylabel="mean cost")
bins = np.linspace(
    min(before.min(), after.min()), max(before.max(), after.max()), 20
)
right.hist(before, bins, color="#999999", alpha=0.8, label="before")
right.hist(after, bins, color="#009E73", alpha=0.8, label="after")
right.set(xlabel="clearance [m]", ylabel="targets")
right.legend()
plt.show()
