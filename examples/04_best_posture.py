"""
The best posture for a position
===============================

A redundant arm reaches a position in many postures. Goals rate the postures, and
``prefer="best"`` searches all of the self-motion that it finds for the best one.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.planar([0.5, 0.5, 0.5, 0.5])
target = [0.9, 0.6, 0.0]
motion = "position"

# %%
# Any solution, the best one for the tip, and the best one for the whole arm.
found = {
    "any": bik.solve(robot, target),
    "best for the tip": bik.solve(
        robot, target, goals=bik.goals.Manipulability(motion=motion), prefer="best"
    ),
    "best for all links": bik.solve(
        robot, target, goals=bik.goals.LinkManipulability(), prefer="best"
    ),
}
figure, axes = plt.subplots(
    1, 3, sharex=True, sharey=True, figsize=(11, 4), layout="constrained"
)
angle = np.linspace(0.0, 2.0 * np.pi, 100)
for panel, (name, solution) in zip(axes, found.items(), strict=True):
    w = robot.manipulability(solution.q, motion=motion)
    print(
        f"{name}: manipulability of the tip {w:.3f}, "
        f"of all links {robot.link_manipulability(solution.q).sum():.3f}"
    )
    ellipsoid = robot.velocity_ellipsoid(solution.q)
    a, b = (
        length * axis[:2]
        for length, axis in zip(ellipsoid.lengths, ellipsoid.axes, strict=True)
    )
    outline = np.array(target[:2]) + 0.2 * (
        np.cos(angle)[:, None] * a + np.sin(angle)[:, None] * b
    )
    panel.plot(*robot.link_poses(solution.q)[:, :2, 3].T, marker="o", linewidth=3)
    panel.plot(*outline.T, color="#D55E00", label="velocities of the tip (scaled)")
    panel.set(title=f"{name}: {w:.2f}", xlabel="x [m]", aspect="equal")
axes[0].set_ylabel("y [m]")
axes[0].legend(loc="lower left")
plt.show()
