"""
Where to put the base
=====================

One UR5e is to serve six places on two shelves. The inverse of its reachability map
shows from where a single place is reached; ``best_base`` finds where the base
reaches all six, and verifies it.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("ur5e")
found = bik.reachability(robot, voxel=0.05, directions=30, rolls=4)
targets = [
    bik.pose([x, y, 0.4], rpy=[np.pi, 0, 0])
    for x in (0.3, 0.9, 1.5)
    for y in (-0.3, 0.3)
]

# %%
# From where one place is reached.
figure = found.inverse().plot(targets[0])
plt.show()

# %%
# From where most places are reached, and how far off the base may be.
placed = bik.best_base(
    robot, targets, region=[(-0.5, -1, 0), (2.0, 1, 0)], map=found
)
print(placed)
print(f"margin: {100 * placed.margin:.0f} cm")

# %%
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
places = np.array(targets)[:, :2, 3]
axes.plot(*places[placed.reached].T, "o", color="#009E73", label="reached")
axes.plot(*placed.pose[:2, 3], "s", color="#0072B2", markersize=12, label="base")
axes.set(xlabel="x [m]", ylabel="y [m]", title=placed.message, aspect="equal")
axes.legend()
plt.show()
