"""
Where the tool must leave its path
==================================

A seam turns the tool two and a half times about its own axis. No wrist turns that
far, so the tool draws back once, unwinds and goes on.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("ur5e")
limits = bik.Limits(acceleration=5.0)

# %%
# A line of 0.2 m, on which the tool turns by five times pi.
turned = np.linspace(0.0, 5 * np.pi, 101)
along = np.linspace(-0.1, 0.1, 101)
seam = np.array([
    bik.pose([0.5, y, 0.3], rpy=[np.pi, 0.0, angle])
    for y, angle in zip(along, turned, strict=True)
])

# %%
# Without breaks the error says where and why.
try:
    bik.plan_along_path(robot, seam, limits=limits)
except bik.InvalidInputError as error:
    print(error)

# %%
# With them, as few as possible are made. Each says where the tool leaves the path,
# when, and which joint is the reason.
plan = bik.plan_along_path(robot, seam, limits=limits, breaks=True)
print(plan.message)
for each in plan.breaks:
    print(f"at point {each.at:.1f}, from {each.start:.2f} to {each.end:.2f} s")

# %%
# The way beside the path is dotted, and its time is shaded.
plan.plot()
plt.show()
