"""
Polishing a dome
================

``raster`` covers a surface with parallel passes, with the tool along the normal
everywhere. The surface is a mesh: a file, arrays, or what other libraries have.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

RADIUS = 0.25  # m, of the sphere that the dome is cut from
CENTER = np.array([0.45, 0.0, -0.1])  # m
WIDTH = 0.02  # m, of the pad
SPEED = 0.05  # m/s

# %%
# A square dome as vertices and faces: a grid of 60 x 60 points on the sphere.
x, y = np.meshgrid(np.linspace(-0.12, 0.12, 60), np.linspace(-0.12, 0.12, 60))
vertices = np.column_stack([
    c.ravel() for c in (x, y, np.sqrt(RADIUS**2 - x**2 - y**2))
])
corner = (np.arange(59)[:, None] * 60 + np.arange(59)).ravel()
faces = corner[:, None] + np.array([[[0, 1, 61]], [[0, 61, 60]]])
dome = (CENTER + vertices, faces.reshape(-1, 3))

# %%
# Passes a pad's width apart along the surface, and one line of them all. The tool
# lifts off between passes.
passes = bik.paths.raster(dome, spacing=WIDTH, direction=(0, 1, 0), step=0.005)
line = bik.paths.join(passes, lift=0.02)
print(f"{len(passes)} passes, {line.length:.2f} m with the ways between")

# %%
# On a sphere the distances between rows, the places and the normals are known.
middles = np.array([row.poses[len(row) // 2, :3, 3] for row in passes]) - CENTER
apart = RADIUS * np.abs(np.diff(np.arctan2(middles[:, 0], middles[:, 2])))
print(f"rows {1e3 * apart.min():.1f} to {1e3 * apart.max():.1f} mm apart")
touching = line.poses[line.contact]
outward = touching[:, :3, 3] - CENTER
height = np.linalg.norm(outward, axis=1)
off = np.degrees(np.arccos((-touching[:, :3, 2] * outward).sum(axis=1) / height))
print(f"below the sphere by at most {1e3 * (RADIUS - height).max():.3f} mm")
print(f"normals within {off.max():.2f} degrees")

# %%
# The pad turns freely about its axis. Between passes it rounds the corners, in a
# band.
robot = bik.Robot.named("ur5e").with_tool(bik.pose([0.0, 0.0, 0.1]))
result = bik.track(
    robot,
    line.path(SPEED),
    dt=0.01,
    task=bik.tasks.Pointing(),
    limits=bik.Limits(acceleration=10.0),
    ease=True,
    position_tolerance=4e-3,
    rotation_tolerance=0.02,
)
print(result.message)
contact = np.interp(result.time * SPEED, line.distance, line.contact) == 1.0
on_the_dome = 1e3 * result.position_error[contact]
print(
    f"{np.percentile(on_the_dome, 95):.4f} mm off the passes for 95 % of the time"
)

# %%
figure = plt.figure(figsize=(10, 4.5), layout="constrained")
space = figure.add_subplot(1, 2, 1, projection="3d")
space.plot_trisurf(*dome[0].T, triangles=dome[1], color="0.85", alpha=0.5)
for row in passes:
    space.plot(*row.poses[:, :3, 3].T, color="tab:blue")
space.plot(*result.position.T, color="tab:orange", linewidth=0.6)
space.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
space.set_aspect("equal")
space.locator_params(nbins=4)
error = figure.add_subplot(1, 2, 2)
error.semilogy(result.time, np.maximum(1e3 * result.position_error, 1e-6))
error.set(xlabel="time [s]", ylabel="distance from the line [mm]")
plt.show()
