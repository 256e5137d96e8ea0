"""
A new target during a motion
============================

``state_to_state`` finds the fastest motion of all joints within velocity,
acceleration and jerk limits. It starts from any state, so a motion can be replaced
while the arm moves: velocity and acceleration stay continuous.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda")
limits = bik.Limits(velocity=1.5, acceleration=5.0, jerk=50.0)
home = np.array([0.0, -0.5, 0.0, -2.0, 0.0, 1.5, 0.8])
first = home + np.array([0.8, 0.3, -0.3, 0.4, 0.0, -0.2, 0.5])
second = home + np.array([-0.4, 0.1, 0.5, -0.3, 0.4, 0.3, -0.6])

# %%
# The arm moves to the first target. After 0.4 s a second one arrives.
to_first = bik.state_to_state(home, first, limits, joint_names=robot.joint_names)
change = 0.4
q, qd, qdd = to_first.at(change)
to_second = bik.state_to_state(
    q, second, limits, start_qd=qd, start_qdd=qdd, joint_names=robot.joint_names
)
print(
    f"{to_first.duration:.3f} s to the first target, "
    f"{to_second.duration:.3f} s from the change to the second"
)
print("largest jerk:", np.round(to_second.max_jerk(), 1), "rad/s^3")

# %%
# The first joint turns back without a jump of its acceleration.
before, after = (
    np.linspace(0.0, change, 200),
    np.linspace(0.0, to_second.duration, 400),
)
time = np.concatenate((before, change + after))
states = [
    np.vstack(pair)[:, 0]
    for pair in zip(to_first.at(before), to_second.at(after), strict=True)
]
figure, axes = plt.subplots(3, 1, sharex=True, layout="constrained")
units = ("position [rad]", "velocity [rad/s]", "acceleration [rad/s²]")
for axis, values, label in zip(axes, states, units, strict=True):
    axis.plot(time, values)
    axis.axvline(change, color="0.6", linestyle=":")
    axis.set_ylabel(label)
axes[0].set_title(f"{robot.joint_names[0]}: a new target at {change} s")
axes[-1].set_xlabel("time [s]")
plt.show()
