"""
A loop of 1 kHz with a noisy, slow camera
=========================================

A camera at 60 Hz sees the target 50 ms late and with 2 mm of noise; the arm wants a
command every millisecond, inside limits up to jerk. The loop runs in a thread of
its own: it waits for the next millisecond, asks the camera for a new target and
steps the tracker. At the end it prints how late its ticks were.
"""

import threading
import time

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

DT = 0.001  # s
LATENCY = 0.05  # s
TICKS = 4000

robot = bik.Robot.named("panda")
start = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
limits = bik.Limits(velocity=1.5, acceleration=5.0, jerk=100.0)
tracker = bik.Tracker(robot, start, dt=DT, limits=limits, timeout=0.2)
home = robot.fk(start)[:3, 3]
rng = np.random.default_rng(0)


def hand(t: float) -> np.ndarray:
    """Where the hand is at time t."""
    return home + np.array([0.0, 0.12 * np.sin(1.5 * t), 0.05 * np.sin(3.0 * t)])


def camera(tick: int) -> tuple[np.ndarray, float] | None:
    """Returns a noisy target and when the camera saw it, if this tick has one."""
    seen = tick * DT - LATENCY
    if tick % 17 or seen < 0.0:
        return None
    return hand(seen) + rng.normal(0.0, 0.002, 3), seen


# %%
# The loop. Python's own threads can hold it up; a tick itself takes a few
# microseconds.
commands = np.empty((TICKS, robot.dof))
lateness = np.empty(TICKS)


def loop() -> None:
    """One call a millisecond."""
    begin = time.perf_counter()
    for tick in range(TICKS):
        due = begin + tick * DT
        while (left := due - time.perf_counter()) > 0.0:
            if left > 0.0003:
                time.sleep(left - 0.0002)
        lateness[tick] = -left
        image = camera(tick)
        step = (
            tracker.step(None)
            if image is None
            else tracker.step(image[0], stamp=image[1])
        )
        commands[tick] = step.q


thread = threading.Thread(target=loop)
thread.start()
thread.join()
late = 1e6 * np.percentile(lateness, [50.0, 99.0, 100.0])
print(
    f"ticks begin late by {late[0]:.0f} us (median), "
    f"{late[1]:.0f} us (99 %), {late[2]:.0f} us (most)"
)
print(f"stops within {tracker.stop():.2f} s from here")

# %%
# Without stamps the tip would lag by the 50 ms of the camera.
t = DT * np.arange(1, TICKS + 1)
tip = robot.fk(commands)[:, :3, 3]
truth = np.array([hand(instant) for instant in t])
error = np.linalg.norm(tip - truth, axis=1)[1000:]
jerk = np.abs(np.diff(commands, 3, axis=0)).max() / DT**3
print(
    f"tip error {1e3 * np.sqrt(np.mean(error**2)):.1f} mm rms, "
    f"largest jerk {jerk:.0f} rad/s^3"
)

figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
axes.plot(t, truth[:, 1], color="black", linestyle=":", label="hand")
axes.plot(t, tip[:, 1], label="tip")
axes.set(xlabel="time [s]", ylabel="y [m]")
axes.legend()
plt.show()
