"""
Waypoints in minimum time
=========================

``time_optimal`` turns taught joint positions into a motion. It keeps the shape of
the spline through them and computes the fastest timing within the velocity and
acceleration limits, which hold at every instant.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("ur5e")
taught = np.array([
    [0.0, -1.6, 1.6, -1.6, -1.6, 0.0],
    [0.6, -1.2, 1.4, -1.8, -1.6, 0.3],
    [1.2, -1.4, 1.9, -2.0, -1.4, 0.8],
    [1.6, -1.8, 1.5, -1.2, -1.6, 0.2],
])
limits = bik.Limits(velocity=robot.velocity_limit, acceleration=8.0)
trajectory = bik.time_optimal(taught, limits, joint_names=robot.joint_names)
print(f"{trajectory.duration:.3f} s")
print("largest velocities:", np.round(trajectory.max_velocity(), 3), "rad/s")
print(
    "largest accelerations:", np.round(trajectory.max_acceleration(), 3), "rad/s^2"
)

# %%
# With a jerk limit the motion takes slightly longer.
gentle = bik.time_optimal(
    taught,
    bik.Limits(velocity=robot.velocity_limit, acceleration=8.0, jerk=100.0),
    joint_names=robot.joint_names,
)
print(f"{gentle.duration:.3f} s with jerk limits")

# %%
# At any time one of the joints is at a limit.
bik.plot.saturation(trajectory, limits)
plt.show()
