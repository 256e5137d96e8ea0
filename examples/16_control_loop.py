"""
Your control loop: one call per tick
====================================

``track`` needs the whole path in advance. A ``Tracker`` takes one target per tick,
from a joystick, a camera or another machine, and keeps the same limits. A tick
takes microseconds.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

DT = 0.01  # s
robot = bik.Robot.named("ur5e")
start = np.array([0.0, -1.2, 1.8, -2.2, -1.5, 0.0])
tracker = bik.Tracker(robot, start, dt=DT, limits=bik.Limits(velocity=1.0))

# %%
# The operator's hand jumps by 25 cm every two seconds. A tracker only looks one
# tick ahead, so the target moves at a speed that the arm can follow, here 0.3 m/s,
# with constant orientation.
home = robot.fk(start)
hand = np.where(np.arange(800) // 200 % 2, 0.25, 0.0)
target = home.copy()
wanted, steps = [], []
for y in hand:
    target[1, 3] += np.clip(home[1, 3] + y - target[1, 3], -0.3 * DT, 0.3 * DT)
    wanted.append(target[1, 3])
    steps.append(tracker.step(target))
print(f"fastest joint: {max(np.abs(step.qd).max() for step in steps):.2f} rad/s")
print(f"largest error: {max(step.position_error for step in steps):.1e} m")
print(steps[210].status.name, "-", steps[210].message)

# %%
time = DT * np.arange(1, len(steps) + 1)
figure, (above, below) = plt.subplots(
    2, sharex=True, figsize=(8, 5), layout="constrained"
)
above.plot(time, home[1, 3] + hand, color="black", linestyle=":", label="hand")
above.plot(time, wanted, linewidth=4, alpha=0.3, label="target")
above.plot(time, [robot.fk(step.q)[1, 3] for step in steps], label="tip")
above.set(ylabel="y [m]")
above.legend(loc="upper right")
below.plot(time, [step.qd for step in steps])
below.set(xlabel="time [s]", ylabel="joint velocities [rad/s]")
plt.show()
