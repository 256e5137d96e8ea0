"""
Steer a simulated arm from the browser
======================================

The handle of the viewer is the operator's hand, and MuJoCo simulates the arm, with
gravity and servos that yield. A loop of 500 Hz takes the handle as target, keeps
the limits up to jerk and the clearance from a table, and commands the servos. The
page shows the arm as it really stands. Keys move the handle too: W, A, S, D, R and
F; and the sticks of a gamepad.

Here a program moves the handle, for two seconds. For a hand of your own, set
``SECONDS = float("inf")`` and ``STEERED = False``, and open the address that is
printed; Ctrl-C ends the loop. For a gamepad set ``GAMEPAD = True``: GLFW, which
comes with MuJoCo, reads it on the machine of the loop, which needs a screen for
that. A page cannot pass one on. The machine that built this page has no gamepad:
this part alone was not tried there.
"""

import sys
import threading
import time

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik
from beetle_ik.sim import MujocoPlant

DT = 0.002  # s
SECONDS = 2.0
STEERED = True
GAMEPAD = False

robot = bik.Robot.named("panda").with_capsules(radius=0.06)
start = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
table = bik.obstacles.Box(center=(0.5, 0.0, 0.2), size=(0.6, 1.2, 0.02))
limits = bik.Limits(velocity=2.0, acceleration=10.0, jerk=200.0)

plant = MujocoPlant(robot, dt=DT)
plant.reset(start)
tracker = bik.Tracker(
    robot, start, dt=DT, limits=limits, obstacles=[table], margin=0.01
)
viewer = bik.view(robot, start, obstacles=[table], port=0)
viewer.follow = "off"  # the loop below moves the arm
home = viewer.target

# %%
# Each key moves the handle by a centimetre.
KEYS = {
    "W": (1, 0, 0),
    "S": (-1, 0, 0),
    "A": (0, 1, 0),
    "D": (0, -1, 0),
    "R": (0, 0, 1),
    "F": (0, 0, -1),
}


def bind(key: str, direction: tuple[int, int, int]) -> None:
    """Has a key of the page move the handle."""
    command = viewer.server.gui.add_command(
        f"move the handle by {direction} cm", hotkey=key
    )

    @command.on_trigger
    def _(_: object) -> None:
        viewer.target = viewer.target[:3, 3] + 0.01 * np.array(direction)


for key, direction in KEYS.items():
    bind(key, direction)

# %%
# The left stick moves the handle sideways, the right one up and down.
STICKS = 16  # ticks from one look at them to the next
SPEED = 0.3  # m/s
DEAD = 0.1  # a stick at rest is not quite at zero


def sticks() -> np.ndarray:
    """Returns the velocity of the handle (m/s) by the sticks, zero without any."""
    glfw.poll_events()
    state = glfw.get_gamepad_state(glfw.JOYSTICK_1)
    if not state:
        return np.zeros(3)
    left, forward, _, up, *_ = -np.array(list(state.axes))
    velocity = np.array([forward, left, up])
    return SPEED * np.where(np.abs(velocity) > DEAD, velocity, 0.0)


if GAMEPAD:
    import glfw

    if not glfw.init():
        raise SystemExit("GLFW reads no gamepad without a screen")

# %%
# The page is refreshed 30 times a second, in a thread of its own: the loop does not
# wait for it.
joints = [start]
running = threading.Event()
running.set()


def refresh() -> None:
    """Shows the arm, and moves the handle in a loop that dips into the table."""
    begin = time.perf_counter()
    while running.is_set():
        viewer.q = joints[-1]
        if STEERED:
            angle = np.pi * (time.perf_counter() - begin)
            viewer.target = home[:3, 3] + [
                0.0,
                0.2 * np.sin(angle),
                0.2 * (np.cos(angle) - 1.0),
            ]
        time.sleep(1 / 30)


# %%
# The loop. Python changes threads every 5 ms by default, which is longer than a
# tick.
sys.setswitchinterval(2e-4)
page = threading.Thread(target=refresh)
page.start()
late, handle, tip, clearance = [], [], [], []
begin = time.perf_counter()
try:
    while len(late) * DT < SECONDS:
        due = begin + len(late) * DT
        while (left := due - time.perf_counter()) > 0.0:
            time.sleep(max(0.0, left - 2e-4))
        late.append(-left)
        if GAMEPAD and len(late) % STICKS == 0:
            viewer.target = viewer.target[:3, 3] + STICKS * DT * sticks()
        target = viewer.target
        step = tracker.step(target)
        plant.move(step.q)
        joints.append(plant.q)
        handle.append(target[:3, 3])
        tip.append(plant.tip)
        clearance.append(step.clearance)
except KeyboardInterrupt:
    pass
finally:
    running.clear()
    page.join()
    viewer.close()
    sys.setswitchinterval(0.005)
print(
    "late by {:.0f} us (median), {:.0f} us (99 %), {:.0f} us (most)".format(
        *np.percentile(late, [50, 99, 100]) * 1e6
    )
)
print(f"least clearance {1e3 * min(clearance):.1f} mm")

# %%
# The tip follows the handle, but not into the table.
t = DT * np.arange(len(late))
figure, (above, below) = plt.subplots(
    2, sharex=True, figsize=(8, 5), layout="constrained"
)
above.plot(t, np.array(handle)[:, 2], color="black", linestyle=":", label="handle")
above.plot(t, np.array(tip)[:, 2], label="tip, simulated")
above.set(ylabel="z [m]")
above.legend()
below.plot(t, 1e3 * np.array(late))
below.set(xlabel="time [s]", ylabel="late by [ms]")
plt.show()
