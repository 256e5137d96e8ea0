"""
A weld where two pipes meet
===========================

A branch pipe is welded onto a larger one. The seam is a saddle curve, known in
closed form. The torch halves the angle between the pipes all the way round, and
turns about its own axis as the arm likes.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

MAIN, BRANCH = (
    0.10,
    0.05,
)  # m, radii; the main pipe lies along y, the branch along z
AT = np.array([0.45, 0.0, 0.0])  # m, where their axes meet
SPEED = 0.01  # m/s

# %%
# The saddle: on the branch, and at the height of the main pipe.
angle = np.linspace(0.0, 2 * np.pi, 361)
x, y = BRANCH * np.cos(angle), BRANCH * np.sin(angle)
z = np.sqrt(MAIN**2 - x**2)
points = AT + np.column_stack([x, y, z])

# %%
# The outward normals of both pipes. The torch points against their mean; the x axis
# of each pose is along the seam.
of_main = np.column_stack([x, 0 * y, z]) / MAIN
of_branch = np.column_stack([np.cos(angle), np.sin(angle), 0 * z])
torch = -(of_main + of_branch)
torch /= np.linalg.norm(torch, axis=1, keepdims=True)
along = np.cross(of_main, of_branch)
along /= np.linalg.norm(along, axis=1, keepdims=True)
poses = np.tile(np.eye(4), (len(points), 1, 1))
poses[:, :3, :] = np.stack([along, np.cross(torch, along), torch, points], axis=2)

# %%
# The torch stands at half of this angle to both normals.
opening = np.degrees(np.arccos((of_main * of_branch).sum(axis=1)))
print(f"the normals are {opening.min():.1f} to {opening.max():.1f} degrees apart")
length = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
print(
    f"the seam is {1e3 * length[-1]:.2f} mm long, round the branch it is 314.16 mm"
)

# %%
# Times in proportion to the length give a constant speed. ``Pointing`` leaves the
# turn about the torch free; the stickout of the wire is part of the tool.
robot = bik.Robot.named("ur5e").with_tool(bik.pose([0.0, 0.0, 0.15]))
path = bik.paths.from_samples(length / SPEED, poses)
result = bik.track(
    robot,
    path,
    dt=0.02,
    task=bik.tasks.Pointing(),
    limits=bik.Limits(acceleration=5.0),
    ease=True,
    position_tolerance=2e-5,
    rotation_tolerance=1e-3,
)
print(result.message)
speed = np.linalg.norm(np.diff(result.position, axis=0), axis=1) / 0.02
welding = slice(50, -1)  # after the approach
print(
    f"{1e3 * speed[welding].min():.2f} to {1e3 * speed[welding].max():.2f} mm/s, "
    f"{1e6 * result.position_error[welding].max():.0f} um off at most"
)

# %%
figure = plt.figure(figsize=(10, 4.5), layout="constrained")
space = figure.add_subplot(1, 2, 1, projection="3d")
height, turn = np.meshgrid([-0.12, 0.12], np.linspace(0, 2 * np.pi, 60))
cylinder = (MAIN * np.cos(turn), height, MAIN * np.sin(turn))
space.plot_surface(*(a + c for a, c in zip(AT, cylinder, strict=True)), alpha=0.2)
space.plot(*points.T, color="tab:red", label="seam")
space.quiver(*points[::20].T, *-torch[::20].T, length=0.05, label="torch")
space.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
space.set_aspect("equal")
space.locator_params(nbins=4)
space.legend(fontsize="small")
motion = figure.add_subplot(1, 2, 2)
motion.plot(result.time, result.q, label=robot.joint_names)
motion.set(xlabel="time [s]", ylabel="joint position [rad]")
motion.legend(fontsize="small")
plt.show()
