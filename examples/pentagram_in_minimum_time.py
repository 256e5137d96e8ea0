"""
A pentagram in minimum time
===========================

A planar arm with three links has one degree of freedom more than its tip needs. ``plan_along_path`` finds redundancy
and timing together. The accuracy is asked for at the points given; between them the joints follow splines, which round
the star's corners: dense points keep that small. A motion that takes no longer than it must meets a limit all the time.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.planar([1.0, 1.0, 1.0])
limits = bik.Limits(velocity=np.pi, acceleration=4 * np.pi)
star = bik.paths.pentagram((1.0, 1.0, 0.0), 5.0, radius=0.5)
points = star.sample(0.025)[1]
plan = bik.plan_along_path(robot, points, limits=limits, accuracy=0.001)
print(plan.message)
print(f"at the {len(points)} points at most {1e3 * plan.accuracy:.2f} mm off")

# %%
# The tip on the star, and the arm every 0.2 s.
time, q, _, _ = plan.trajectory.sample(0.01)
tip = robot.fk(q)[:, :3, 3]
beside = np.linalg.norm(tip[:, None] - star.sample(0.001)[1], axis=2).min(axis=1)
print(f"between them too at most {1e3 * beside.max():.1f} mm off the star")
figure, axes = plt.subplots(figsize=(6, 5), layout="constrained")
for posture in q[::20]:
    axes.plot(*robot.link_poses(posture)[:, :2, 3].T, color="0.8", marker="o", markersize=3)
axes.plot(*tip[:, :2].T, color="#D55E00", linewidth=2, label="tip")
axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", title=f"{plan.cost:.2f} s")
axes.legend()

# %%
# How much of each limit is used.
bik.plot.saturation(plan.trajectory, limits)
plt.show()
