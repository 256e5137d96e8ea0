"""
A path among obstacles
======================

The hand of a Panda draws a loop behind a post, with a wall at its back. Planned
without obstacles, the elbow runs into the post; with ``obstacles=`` the hand
follows the same loop while the arm takes other postures, certified to keep a margin
at every instant. Where the rotation about the tool does not matter, ``task=``
leaves it to the planner.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda").with_capsules(radius=0.06)
limits = bik.Limits(acceleration=5.0)
angle = np.linspace(0.0, 2 * np.pi, 60)
poses = np.repeat(
    bik.pose([0.5, 0.0, 0.4], rpy=[np.pi, 0.0, 0.0])[None], 60, axis=0
)
poses[:, 1, 3] -= 0.25 * np.cos(angle)
poses[:, 2, 3] += 0.2 * np.sin(angle)

post = bik.obstacles.Box(center=(0.25, 0.0, 0.62), size=(0.06, 0.06, 0.5))
wall = bik.obstacles.Box(center=(-0.2, 0.0, 0.5), size=(0.05, 1.0, 1.0))
scene = bik.Scene([post, wall])
through = bik.plan_along_path(robot, poses, limits=limits)
around = bik.plan_along_path(
    robot, poses, limits=limits, obstacles=scene, margin=0.02
)
free = bik.plan_along_path(
    robot,
    poses,
    task=bik.tasks.Pointing(),
    limits=limits,
    obstacles=scene,
    margin=0.02,
)
plans = {
    "without obstacles": through,
    "among them": around,
    "with free rotation": free,
}
print(around.message)

# %%
# The clearance along the motions.
figure, axes = plt.subplots()
for name, plan in plans.items():
    times = np.linspace(0.0, plan.trajectory.duration, 500)
    clearance = bik.obstacles.clearance(robot, plan.trajectory.at(times)[0], scene)
    axes.plot(times, clearance, label=name)
    print(
        f"{name}: {plan.trajectory.duration:.2f} s, "
        f"smallest clearance {clearance.min():.3f} m"
    )
axes.axhline(0.02, color="gray", linestyle="--", label="margin")
axes.set(xlabel="time [s]", ylabel="clearance [m]")
axes.legend()

# %%
# The arm where the first motion is deepest in collision, and the other one at the
# same place of the path.
times = np.linspace(0.0, through.trajectory.duration, 500)
q = through.trajectory.at(times)[0]
deepest = q[bik.obstacles.clearance(robot, q, scene).argmin()]
others = around.trajectory.at(np.linspace(0.0, around.trajectory.duration, 500))[0]
same = others[
    np.linalg.norm(
        robot.fk(others)[:, :3, 3] - robot.fk(deepest)[:3, 3], axis=1
    ).argmin()
]
bik.plot.robot(robot, deepest, obstacles=scene)
bik.plot.robot(robot, same, obstacles=scene)
plt.show()
