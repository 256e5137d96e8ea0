"""
A pentagram in minimum time
===========================

A planar arm with three links has one redundant degree of freedom.
``plan_along_path`` optimises redundancy and timing together, and keeps the tip
within the requested accuracy along the whole star; it stops at the corners. In the
fastest motion some joint is at a limit at any time.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.planar([1.0, 1.0, 1.0])
limits = bik.Limits(velocity=np.pi, acceleration=4 * np.pi)
star = bik.paths.pentagram((1.0, 1.0, 0.0), 5.0, radius=0.5)
plan = bik.plan_along_path(robot, star, limits=limits, accuracy=0.001)
print(plan.message)
print(f"at most {1e3 * plan.accuracy:.2f} mm off the star")

# %%
# The tip on the star, and the arm every 0.2 s.
time, q, _, _ = plan.trajectory.sample(0.01)
tip = robot.fk(q)[:, :3, 3]
figure, axes = plt.subplots(figsize=(6, 5), layout="constrained")
for posture in q[::20]:
    axes.plot(
        *robot.link_poses(posture)[:, :2, 3].T,
        color="0.8",
        marker="o",
        markersize=3,
    )
axes.plot(*tip[:, :2].T, color="#D55E00", linewidth=2, label="tip")
axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", title=f"{plan.cost:.2f} s")
axes.legend()

# %%
# The fraction of each limit that is used.
bik.plot.saturation(plan.trajectory, limits)
plt.show()
