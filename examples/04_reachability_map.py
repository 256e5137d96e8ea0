"""
A batch, and the reachability map of an arm
===========================================

``solve_batch`` solves many targets on all cores. Here it computes a reachability map: how many of twelve orientations
the Panda reaches at each point of a vertical plane.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda")
x, z = np.linspace(-0.9, 0.9, 37), np.linspace(-0.4, 1.3, 35)

# %%
# Twelve orientations: the tool points along each axis, in both directions, with two roll angles.
quarter = np.pi / 2
pointing = [[0, 0, 0], [np.pi, 0, 0], [quarter, 0, 0], [-quarter, 0, 0], [0, quarter, 0], [0, -quarter, 0]]
orientations = [
    bik.pose([0, 0, 0], rpy=rpy) @ bik.pose([0, 0, 0], rpy=[0, 0, roll]) for rpy in pointing for roll in (0.0, quarter)
]

# %%
# All poses in one array: (points, orientations, 4, 4).
targets = np.empty((len(z), len(x), len(orientations), 4, 4))
targets[:] = orientations
targets[..., 0, 3] = x[None, :, None]
targets[..., 1, 3] = 0.0
targets[..., 2, 3] = z[:, None, None]

# %%
# Targets out of reach cost the whole budget, so it is set low here. A low budget misses some reachable targets.
batch = bik.solve_batch(robot, targets.reshape(-1, 4, 4), stop=bik.Stop(max_evaluations=400))
print(batch.message)
share = batch.success.reshape(len(z), len(x), -1).mean(axis=2)

# %%
figure, axes = plt.subplots(figsize=(7, 5.5), layout="constrained")
cells = axes.pcolormesh(x, z, np.where(share > 0, 100 * share, np.nan), cmap="viridis", vmin=0, vmax=100)
axes.set(xlabel="x [m]", ylabel="z [m]", title="Panda, y = 0: share of 12 orientations reached", aspect="equal")
figure.colorbar(cells, label="reached [%] (white: none)")
plt.show()
