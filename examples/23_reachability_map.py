"""
The reachability map of an arm
==============================

``reachability`` computes which orientations an arm reaches in each voxel of space.
Slices show where the Panda works best: at arm's length around its shoulder, and
neither close to its axis nor stretched out.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda")
found = bik.reachability(robot, voxel=0.05, directions=30, rolls=2)
print(found)

# %%
# The share of the orientations that is reached, in three planes.
figure = found.plot()
plt.show()

# %%
# Any pose can be looked up.
above = [bik.pose([x, 0.0, 0.1], rpy=[np.pi, 0, 0]) for x in (0.2, 0.5, 0.8, 1.1)]
print(dict(zip((0.2, 0.5, 0.8, 1.1), found.query(above).tolist(), strict=True)))
