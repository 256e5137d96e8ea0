"""
Around an obstacle
==================

Capsules model the links, and a box models the obstacle. The plan keeps all capsules
clear of the box: the clearance is certified along the whole motion, not only at
samples.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda").with_capsules(radius=0.06)
wall = bik.obstacles.Box(center=(0.55, 0.0, 0.25), size=(0.5, 0.1, 0.5))
here = np.array([-0.7, 0.6, 0.0, -1.9, 0.0, 2.4, 0.8])
there = here * [-1, 1, 1, 1, 1, 1, 1]
# rad/s^2; position and velocity limits are the robot's
limits = bik.Limits(acceleration=5.0)

# %%
# The straight motion would collide.
straight = here + np.linspace(0, 1, 201)[:, None] * (there - here)
print(f"straight: {bik.obstacles.clearance(robot, straight, [wall]).min():.3f} m")

plan = bik.plan_point_to_point(
    robot, start_q=here, end_q=there, limits=limits, obstacles=[wall], margin=0.01
)
print(plan.message)
print(f"{plan.cost:.2f} s, least clearance {plan.clearance:.3f} m")

# %%
# Distance to the box along the plan.
time, q, _, _ = plan.trajectory.sample(0.01)
figure, axes = plt.subplots(figsize=(7, 3), layout="constrained")
axes.plot(time, 100 * bik.obstacles.clearance(robot, q, [wall]))
axes.axhline(1.0, color="black", linestyle=":", label="margin")
axes.set(xlabel="time [s]", ylabel="clearance [cm]", ylim=(0, None))
axes.legend()

# %%
# The figure of the plan.
plan.plot()
plt.show()
