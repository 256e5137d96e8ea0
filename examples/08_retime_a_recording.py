"""
Retime a recording
==================

A motion that someone guided by hand and an encoder recorded is slow, uneven and
rough in its last digit. ``time_optimal`` makes it as fast as the limits allow;
``tolerance=`` lets it smooth the roughness, which would cost minutes. Without one,
it says so.
"""

import warnings

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("ur5e")

# %%
# The recording: 12 s at 100 Hz, in steps of a 12-bit encoder, and with pauses.
# Yours may be a file: ``bik.Trajectory.from_csv("taught.csv")``.
time = np.arange(0.0, 12.0, 0.01)
# Slow, then quick, every two seconds.
progress = time - np.sin(np.pi * time) / np.pi
angles = 2 * np.pi * progress[:, None] / 12.0 * [1, 1, 2, 1, 2, 1]
angles = np.add(angles, [0, 1, 2, 0, 1, 2])
guided = np.add([0.0, -1.6, 1.6, -1.6, -1.6, 0.0], 0.4 * np.sin(angles))
step = 2 * np.pi / 4096
recorded = np.round(guided / step) * step

# %%
# Two steps of the encoder are enough to smooth its noise. Rows at rest are equal,
# and count as one.
limits = bik.Limits(velocity=2.0, acceleration=10.0, jerk=100.0)
names = robot.joint_names
motion = bik.time_optimal(recorded, limits, joint_names=names, tolerance=2 * step)
with warnings.catch_warnings(record=True, action="always") as said:
    rough = bik.time_optimal(recorded, limits)
print(said[0].message)
print(f"{rough.duration:.1f} s through every row")
print(f"{time[-1]:.1f} s recorded, {motion.duration:.2f} s within the limits")

# %%
# How far the new motion leaves the recorded one, seen at the tip.
old = robot.fk(guided)[:, :3, 3]
new = robot.fk(motion.sample(0.005)[1])[:, :3, 3]
nearest = np.linalg.norm(new[:, None] - old[None], axis=2).min(axis=1)
print(f"the tip stays within {1e3 * nearest.max():.1f} mm of the recorded path")
motion.to_csv("retimed.csv", dt=0.008)

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.8), layout="constrained")
left.plot(time, recorded)
left.set(xlabel="time [s]", ylabel="joint positions [rad]", title="recorded")
right.plot(*motion.sample(0.005)[:2])
right.set(xlabel="time [s]", title="retimed", ylim=left.get_ylim())
plt.show()
