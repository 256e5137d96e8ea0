"""
A base that drives only where it must
=====================================

A base on wheels is heavier than the arm, and drives less exactly. ``joint_weights``
is the price of moving each joint: where the arm can follow a target alone, a heavy
base stays, and it drives only where the arm does not reach.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda").with_mobile_base(
    "planar", lower=[-3, -3, -np.pi], upper=[3, 3, np.pi], velocity=[0.8, 0.8, 1.0]
)
start = np.r_[0, 0, 0, 0, -0.4, 0, -2.0, 0, 1.6, 0.8]
heavy_base = np.r_[100, 100, 100, np.ones(7)]

# %%
# The hand writes a circle in front of the arm, then goes a metre and a half ahead.
place = robot.fk(start)
turn = np.linspace(0, 2 * np.pi, 200)
across = np.column_stack((0 * turn, np.sin(turn), 1 - np.cos(turn)))
circle = place[:3, 3] + 0.1 * across
ahead = place[:3, 3] + np.linspace(0, 1.5, 300)[:, None] * [1, 0, 0]
targets = np.tile(place, (500, 1, 1))
targets[:, :3, 3] = np.vstack((circle, ahead))


def followed(weights):
    """Returns the configurations of a tracker that follows the targets."""
    tracker = bik.Tracker(robot, start, dt=0.02, joint_weights=weights)
    steps = [tracker.step(target) for target in targets]
    print(
        f"off by at most {1e3 * max(step.position_error for step in steps):.1f} mm"
    )
    return np.array([step.q for step in steps])


equal, heavy = followed(None), followed(heavy_base)

# %%
# How far the base has driven and turned.
time = 0.02 * np.arange(1, 501)
figure, axes = plt.subplots(
    1, 2, figsize=(9, 3.5), layout="constrained", sharey=True
)
drawn = zip(axes, (equal, heavy), ("equal joints", "a heavy base"), strict=True)
for axis, q, title in drawn:
    axis.plot(time, q[:, :3], label=["x [m]", "y [m]", "yaw [rad]"])
    axis.axvline(4.0, color="0.7")
    axis.set(xlabel="time [s]", title=title)
axes[0].set(ylabel="base")
axes[0].legend(fontsize="small")
circle_alone = np.abs(np.diff(heavy[:200, :2], axis=0)).sum()
print(f"during the circle the heavy base drives {1e3 * circle_alone:.0f} mm")
plt.show()
