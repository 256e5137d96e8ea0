"""
Tracking with joints at their limits
====================================

Three joints are limited to 70 % of the speed that they would need on this path. The
other joints compensate as far as possible. No limit is violated, because each tick
is solved inside the box that the limits allow.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("iiwa14")
circle = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=6.0)
free = bik.track(robot, circle, dt=0.01)
narrow = robot.velocity_limit.copy()
# rad/s, less than these joints need without limits
narrow[[0, 1, 3]] = 0.7 * np.abs(free.qd).max(axis=0)[[0, 1, 3]]
result = bik.track(
    robot, circle, free.q[0], dt=0.01, limits=bik.Limits(velocity=narrow)
)
print(result.message)
print(
    f"largest excess: {result.max_violation:.1e} rad, "
    f"largest error: {result.position_error.max():.1e} m"
)

# %%
# The fraction of its limit that each joint uses.
used = np.abs(result.qd[1:]) / result.velocity_limit[1:]
print("share of the time at the limit:", np.round((used > 0.9999).mean(axis=0), 2))

figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
cells = axes.pcolormesh(
    result.time[1:],
    np.arange(1, robot.dof + 1),
    100 * used.T,
    cmap="inferno",
    vmin=0,
    vmax=100,
)
axes.invert_yaxis()
axes.set(
    xlabel="time [s]", ylabel="joint", title="Velocity as a fraction of its limit"
)
figure.colorbar(cells, label="[%]")
plt.show()
