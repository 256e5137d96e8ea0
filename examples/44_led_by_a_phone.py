"""
Led by a phone, or by a joystick
================================

The package ``teleop`` turns a phone into a pointer in space: its page sends poses
while a finger is on the button. Here a recorded stream, made by a program, takes
its place. For a phone, install teleop, set ``LIVE = True``, and open the address
that it prints. A joystick or a space mouse gives velocities instead, for
``TwistTracker``.
"""

from collections import deque

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik
from beetle_ik.interop.teleop import TwistTracker

LIVE = False
DT = 0.01  # s

robot = bik.Robot.named("ur5e")
start = np.array([0.0, -1.5, 1.5, -1.5, -1.5, 0.0])
limits = bik.Limits(velocity=1.5, acceleration=8.0, jerk=200.0)
home = robot.fk(start)

# %%
# The callback only leaves the newest pose for the loop. The phone sends when it
# likes; the loop ticks every 10 ms and passes None where nothing came.
inbox = deque(maxlen=1)
tracker = bik.Tracker(robot, start, dt=DT, limits=limits)


def phone(pose, message):
    """Takes a pose (4, 4) of teleop, with what the page sent."""
    if message.get("move", True):
        inbox.append(pose)


def tick():
    """Takes one step of the loop, whose q goes to the drives."""
    return tracker.step(inbox.pop() if inbox else None)


if LIVE:
    from teleop import Teleop

    pointer = Teleop()
    pointer.set_pose(home)
    pointer.subscribe(phone)
    pointer.run()  # blocks: let a thread call tick() meanwhile

# %%
# The recorded stream: 60 Hz with jitter, one packet in ten lost, a pause of a
# second.
rng = np.random.default_rng(3)
arrivals = np.cumsum(rng.uniform(0.012, 0.021, 360))
arrivals = arrivals[(rng.random(360) > 0.1) & ((arrivals < 2.0) | (arrivals > 3.0))]
hand, tip = [], []
for t in DT * np.arange(600):
    while len(arrivals) and arrivals[0] <= t:
        pose = home.copy()
        pose[:3, 3] += 0.12 * np.sin([1.3 * arrivals[0], 2.1 * arrivals[0], 0.0])
        phone(pose, {})
        hand.append((arrivals[0], pose[1, 3]))
        arrivals = arrivals[1:]
    tip.append(robot.fk(tick().q)[1, 3])

# %%
# A joystick: forward until the arm is stretched out and longer, then back. The
# reference waits for the arm, so that the way back begins at once.
jog = TwistTracker(robot, start, dt=DT, limits=limits)
reach = []
for t in DT * np.arange(900):
    speed = 0.25 if t < 6.5 else -0.25 if t < 8.0 else 0.0
    reach.append(robot.fk(jog.step([speed, 0.0, 0.0, 0.0, 0.0, 0.0]).q)[0, 3])

# %%
figure, (above, below) = plt.subplots(2, figsize=(8, 5), layout="constrained")
above.plot(*np.array(hand).T, ".", color="black", markersize=3, label="phone")
above.plot(DT * np.arange(len(tip)), tip, label="tip")
above.set(ylabel="y [m]")
above.legend()
below.plot(DT * np.arange(len(reach)), reach)
below.axvline(6.5, color="gray", linestyle=":")
below.set(xlabel="time [s]", ylabel="x of the tip [m]")
plt.show()
