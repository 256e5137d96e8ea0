"""
Solutions that keep clear of obstacles
======================================

A pose on a shelf has a curve of solutions for an arm with seven joints. ``solve``
without obstacles takes one that hits the post beside it; with ``obstacles=`` every
body of the arm keeps a margin. The arm stands on a floor that its first link may
touch.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda").with_capsules(radius=0.06)
boards = [
    bik.obstacles.Box(center=(0.62, 0.0, z), size=(0.35, 0.9, 0.02))
    for z in (0.25, 0.75)
]
post = bik.obstacles.Box(center=(0.25, -0.3, 0.5), size=(0.06, 0.06, 1.0))
floor = bik.obstacles.HalfSpace(normal=(0, 0, 1), offset=0.0, touch=["link_1"])
scene = bik.Scene([*boards, post, floor])
target = bik.pose([0.55, 0.0, 0.5], rpy=[0.0, np.pi / 2, 0.0])

through = bik.solve(robot, target)
around = bik.solve(robot, target, obstacles=scene, margin=0.02)
away = bik.solve(
    robot,
    target,
    obstacles=scene,
    margin=0.02,
    goals=bik.goals.Clearance(up_to=0.3),
)
for name, solution in (
    ("without obstacles", through),
    ("among them", around),
    ("and away from them", away),
):
    print(
        f"{name}: "
        f"clearance {bik.obstacles.clearance(robot, solution.q, scene):.3f} m"
    )
print(away.message)

# %%
# All samples of the self-motion, and the clear ones.
every = bik.solve_all(robot, target, redundancy=64)
clear = bik.solve_all(robot, target, redundancy=64, obstacles=scene, margin=0.02)
print(f"{len(clear)} of {len(every)} solutions are clear")


# %%
# The arm as it is without obstacles, and as it is among them.
bik.plot.robot(robot, through.q, obstacles=scene)
bik.plot.robot(robot, away.q, obstacles=scene)
plt.show()
