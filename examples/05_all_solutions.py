"""
All solutions of a six-joint arm
================================

Away from singularities, an arm with six joints has a finite number of solutions for
a pose, modulo whole turns. ``solve_all`` finds them by the closed form of the arm,
where it has one, and ``complete`` says whether it is proven that none is missing.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("ur5e")
target = bik.pose([0.4, 0.2, 0.3], rpy=[np.pi, 0.0, 0.5])
start = np.array([0.8, -1.5, -1.5, -1.6, 1.6, -1.3])
solutions = bik.solve_all(robot, target, start_q=start)
print(robot.closed_form)
print(solutions.message)
for solution in solutions:
    print(
        np.round(solution.q, 3),
        f"{np.linalg.norm(solution.q - start):.2f} rad from the start",
    )

# %%
# Each solution reaches the pose in a different configuration.
figure, axes = plt.subplots(subplot_kw={"projection": "3d"}, figsize=(7, 5.5))
for i, solution in enumerate(solutions):
    x, y, z = robot.link_poses(solution.q)[:, :3, 3].T
    axes.plot(x, y, z, marker="o", markersize=3, label=f"{i + 1}")
axes.plot(
    *target[:3, 3],
    marker="*",
    markersize=14,
    color="black",
    linestyle="none",
    label="target",
)
axes.set(
    xlabel="x [m]",
    ylabel="y [m]",
    zlabel="z [m]",
    title=f"{len(solutions)} solutions of one pose",
)
axes.set_aspect("equal")
axes.view_init(elev=20, azim=-60)
figure.legend(loc="center left")
plt.show()
