"""
A hand of other measures
========================

A camera gives the fingertips of a human hand, and a robot hand of four fingers is
to move alike. Its measures are others: one posture that both take gives scale,
frame and offsets. Then each tick of 1 ms brings the tips to their points inside all
limits. The human's motion here is made by a program: the fingers close one after
another, and open.
"""

import time

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik
from beetle_ik.interop.retarget import Retargeter

FINGERS = ["index", "middle", "ring", "thumb"]
ROOTS = np.array([
    [0, 0.045, 0.09],
    [0, 0, 0.095],
    [0, -0.045, 0.09],
    [0.03, 0.06, 0.02],
])


def finger(name, root, toward="0 0 0"):
    """Returns a finger of four joints: one that spreads, three that bend."""
    place = "{} {} {}".format(*root)
    parts, parent = [], "palm"
    for i, (axis, length) in enumerate(
        zip("xyyy", (0, 0, 0.05, 0.04), strict=True)
    ):
        child, low, high = f"{name}_{i}", *((-0.5, 0.5) if i == 0 else (0.05, 1.7))
        origin = (
            f"xyz='{place}' rpy='{toward}'" if i == 0 else f"xyz='0 0 {length}'"
        )
        along = "1 0 0" if axis == "x" else "0 1 0"
        parts.append(
            f"<link name='{child}'/><joint name='{child}_joint' type='revolute'>"
            f"<parent link='{parent}'/><child link='{child}'/><origin {origin}/>"
            f"<axis xyz='{along}'/>"
            f"<limit lower='{low}' upper='{high}' velocity='8'/></joint>"
        )
        parent = child
    return "".join(parts) + (
        f"<link name='{name}_tip'/><joint name='{name}_end' type='fixed'>"
        f"<parent link='{parent}'/><child link='{name}_tip'/>"
        "<origin xyz='0 0 0.03'/></joint>"
    )


urdf = "<robot name='hand'><link name='palm'/>"
urdf += "".join(map(finger, FINGERS[:3], ROOTS[:3]))
urdf += finger("thumb", ROOTS[3], toward="0 0.9 -0.7") + "</robot>"
tips = [f"{name}_tip" for name in FINGERS]
hand = bik.Robot.from_urdf(urdf, tip=tips)

# %%
# The human: other lengths from finger to finger, seen by a camera that is turned.
LENGTHS = np.array([1.15, 1.3, 1.2, 1.0])
camera = bik.pose([0.3, 0.1, 0.6], rotvec=[0.4, 2.0, 0.3])


def seen(q):
    """Returns the fingertips of a human with joints q, as the camera sees them."""
    reach = hand.fk(q)[:, :3, 3] - ROOTS
    points = 1.2 * ROOTS + 1.2 * LENGTHS[:, None] * reach
    points = points @ camera[:3, :3].T + camera[:3, 3]
    return dict(zip(FINGERS, points, strict=True))


# %%
# The posture that both take. The thumb counts most, where not all can be met.
half = np.tile([0.0, 0.4, 0.5, 0.4], 4)
led = Retargeter(
    hand,
    half,
    dict(zip(FINGERS, tips, strict=True)),
    dt=0.001,
    weights={"thumb": 4.0},
    limits=bik.Limits(acceleration=200.0),
)
led.fit(seen(half), half)
print(f"scale {led.scale:.3f}")
print(f"offset of the thumb {1e3 * led.offsets['thumb'].round(4)} mm")

# %%
# Three seconds at 1 kHz. Where a finger cannot reach as far as the human's, its tip
# goes as near as it can.
bends = [[0.0, 1.0, 0.9, 0.6]] * 3 + [[0.0, 0.5, 0.5, 0.3]]
bend, late = np.concatenate(bends), np.repeat([0.0, 0.2, 0.4, 0.6], 4)
moments = np.arange(3000) * 1e-3
commands, errors, spent = [], [], []
for t in moments:
    phase = np.clip(t - 0.3 - late, 0.0, 2.0)
    human = seen(half + 0.5 * (1.0 - np.cos(np.pi * phase)) * bend * 0.4)
    begin = time.perf_counter()
    step = led.step(human)
    spent.append(time.perf_counter() - begin)
    commands.append(step.q)
    errors.append([1e3 * step.errors[tip][0] for tip in tips])
print(f"{1e6 * np.median(spent):.0f} us a tick (median)")

# %%
figure, (above, below) = plt.subplots(
    2, sharex=True, figsize=(8, 5), layout="constrained"
)
above.plot(moments, np.array(commands)[:, 1::4], label=FINGERS)
above.set(ylabel="first bend [rad]")
above.legend()
below.plot(moments, errors, label=FINGERS)
below.set(xlabel="time [s]", ylabel="tip off its point [mm]")
plt.show()
