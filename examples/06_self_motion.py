"""
The self-motion of a seven-joint arm
====================================

An arm with one joint more than its task can move without moving its tip.
``self_motion`` returns every curve of such configurations: closed ones, and those
that a joint limit cuts at both ends.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda")
target = robot.fk([0.3, 0.2, -0.4, -1.7, 0.2, 1.9, 0.5])
curves = bik.self_motion(robot, target)
print(robot.closed_form)
for curve in curves[:6]:
    print(curve)

# %%
# Each curve over joint 7, the parameter of the closed form; on the right, the arm
# along the longest curve. Its tip stays.
figure = plt.figure(figsize=(9, 4.2))
plane = figure.add_subplot(1, 2, 1)
for curve in curves:
    plane.plot(curve.q[:, 6], curve.q[:, 0], linewidth=1.5)
    if not curve.closed:
        plane.plot(
            curve.q[[0, -1], 6],
            curve.q[[0, -1], 0],
            ".",
            color="black",
            markersize=5,
        )
plane.set(
    xlabel="joint 7 [rad]",
    ylabel="joint 1 [rad]",
    title=f"{len(curves)} curves; dots: a joint limit",
)

space = figure.add_subplot(1, 2, 2, projection="3d")
longest = curves[0]
for k in np.linspace(0, len(longest) - 1, 9).astype(int):
    x, y, z = np.vstack([robot.link_poses(longest.q[k])[:, :3, 3], target[:3, 3]]).T
    space.plot(
        x,
        y,
        z,
        marker="o",
        markersize=2,
        color=plt.get_cmap("viridis")(k / len(longest)),
    )
space.plot(*target[:3, 3], marker="*", markersize=12, color="black")
space.set(
    xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", title="along the longest one"
)
space.set_aspect("equal")
figure.tight_layout()
plt.show()
