"""
Drawing at constant speed
=========================

Glue, paint and pens want a constant speed along the line. The points of a drawing
get times in proportion to the length between them, and ``track`` follows the path
with the pen upright; the rotation about the pen is left free.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("ur5e")
SPEED = 0.1  # m/s
DT = 0.004  # s

# %%
# A drawing, here a flower, as points on a table in the order of the line.
angle = np.linspace(0.0, 2 * np.pi, 6000)
radius = 0.12 + 0.04 * np.cos(5 * angle)
points = np.column_stack([
    0.45 + radius * np.cos(angle),
    radius * np.sin(angle),
    np.full(len(angle), 0.05),
])

# %%
# The time of a point is its distance along the line over the speed.
lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
times = np.concatenate([[0.0], np.cumsum(lengths)]) / SPEED
down = np.array([bik.pose(point, rpy=[np.pi, 0.0, 0.0]) for point in points])
path = bik.paths.from_samples(times, down)

# %%
# ``Pointing`` leaves the rotation about the pen free. With ``ease=True`` the arm
# gets up to speed and onto the line as soon as it can.
limits = bik.Limits(acceleration=10.0)
result = bik.track(
    robot,
    path,
    dt=DT,
    task=bik.tasks.Pointing(),
    limits=limits,
    ease=True,
    position_tolerance=5e-4,
    rotation_tolerance=1e-3,
)
print(result.message)

speed = np.linalg.norm(np.diff(result.position, axis=0), axis=1) / DT
drawing = slice(25, -1)  # after the first 0.1 s, without the last part of a tick
print(f"{speed[drawing].min():.4f} to {speed[drawing].max():.4f} m/s on the line")

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
left.plot(*result.position[:, :2].T, color="0.7", label="tip, with the approach")
left.plot(*result.position[drawing, :2].T, label="drawn")
left.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
left.legend(fontsize="small")
right.plot(result.time[1:], speed)
right.set(xlabel="time [s]", ylabel="speed of the tip [m/s]", ylim=(0, 1.5 * SPEED))
plt.show()
