"""
The self-motion of a seven-joint arm
====================================

An arm with one joint more than its task can move without moving its tip. ``self_motion`` returns every curve of such
configurations: closed ones, and those that a joint limit cuts at both ends.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda")
target = bik.pose([0.45, 0.15, 0.4], rpy=[np.pi, 0.0, 0.3])
curves = bik.self_motion(robot, target)
print(robot.closed_form)
for curve in curves[:6]:
    print(curve)

# %%
# Each curve in the plane of the elbow joint and joint 7, the parameter of the closed form; on the right, the arm along the
# longest curve. Its tip stays.
figure = plt.figure(figsize=(9, 4.2))
plane = figure.add_subplot(1, 2, 1)
for curve in curves:
    plane.plot(curve.q[:, 6], curve.q[:, 3], linewidth=1.5)
    if not curve.closed:
        plane.plot(curve.q[[0, -1], 6], curve.q[[0, -1], 3], ".", color="black", markersize=5)
plane.set(xlabel="joint 7 [rad]", ylabel="joint 4 [rad]", title=f"{len(curves)} curves; dots: a joint limit")

space = figure.add_subplot(1, 2, 2, projection="3d")
longest = curves[0]
for k in np.linspace(0, len(longest) - 1, 9).astype(int):
    x, y, z = robot.link_poses(longest.q[k])[:, :3, 3].T
    space.plot(x, y, z, marker="o", markersize=2, color=plt.get_cmap("viridis")(k / len(longest)))
space.plot(*target[:3, 3], marker="*", markersize=12, color="black")
space.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", title="along the longest one")
space.set_aspect("equal")
figure.tight_layout()
plt.show()
