"""
Pick and place
==============

A gripper moves to a part, down to it along a straight line, lifts it, carries it
over a wall and sets it down. The part is a body of the robot as long as it is held;
fingers may touch it on the line to the grasp, and nothing else may touch anything.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

panda = bik.Robot.named("panda")
arm = panda.with_capsules(radius=0.05)
fingers = [("link_7", (0, y, 0.15), (0, y, 0.31), 0.01) for y in (-0.03, 0.03)]
grasp_point = bik.pose((0.0, 0.0, 0.2))  # between the fingers, seen from the flange
gripper = arm.with_capsules([*arm.capsules, *fingers]).with_tool(grasp_point)

part = bik.obstacles.Box(center=(0.5, 0.2, 0.05), size=(0.05, 0.05, 0.2))
wall = bik.obstacles.Box(center=(0.45, -0.1, 0.1), size=(0.3, 0.02, 0.3))
table = bik.obstacles.HalfSpace(normal=(0, 0, 1), offset=-0.055, touch=["link_1"])
limits = bik.Limits(acceleration=5.0)
ready = np.array([0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8])

# %%
# Two grasps, from two sides of the part: the motion goes to the one that is reached
# sooner.
grasps = [
    bik.pose((0.5, 0.2, 0.14), rpy=(np.pi, 0.0, yaw)) for yaw in (0.0, np.pi / 2)
]
pick = bik.plan_point_to_point(
    gripper,
    start_q=ready,
    end=grasps,
    approach=bik.StraightLine(0.1, touch={0: ["link_7"]}),  # obstacle 0 is the part
    limits=limits,
    obstacles=[part, wall, table],
)
print(pick.message)

# %%
# The part in the hand, up from the table, over the wall, and down again.
grasped = pick.trajectory.q[-1]
center = np.linalg.inv(gripper.fk(grasped, link="link_7")) @ [0.5, 0.2, 0.05, 1.0]
in_hand = bik.obstacles.Box(center=center[:3], size=(0.05, 0.05, 0.2))
loaded = gripper.with_attached("link_7", in_hand, touch=["link_6"], name="part")
there = grasps[pick.chosen_end].copy()
there[:3, 3] = (0.4, -0.35, 0.14)
place = bik.plan_point_to_point(
    loaded,
    start_q=grasped,
    end=there,
    retreat=bik.StraightLine(0.1, direction=(0, 0, 1), frame="base"),
    approach=bik.StraightLine(0.1, direction=(0, 0, -1), frame="base"),
    limits=limits,
    obstacles=[wall, table],
)
print(place.message)
whole = pick.trajectory.then(place.trajectory, pause=0.4)  # the gripper closes
whole.to_csv("pick_and_place.csv", dt=0.01)

# %%
# The way of the grasp point, and its height over time.
time, q, _, _ = whole.sample(0.01)
tip = gripper.fk(q)[:, :3, 3]
closes = pick.trajectory.duration
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.8), layout="constrained")
left.plot(*tip[time <= closes, :2].T, label="to the part")
left.plot(*tip[time >= closes, :2].T, label="with the part")
left.plot(*tip[[np.argmax(time >= closes), -1], :2].T, "ks", label="pick, place")
left.plot([0.3, 0.6], [-0.1, -0.1], color="0.5", linewidth=4, label="wall")
left.set(xlabel="x [m]", ylabel="y [m]", xlim=(0.1, 0.9), title="from above")
left.legend(fontsize="small", loc="upper left")
right.plot(time, tip[:, 2])
right.axvspan(closes, closes + 0.4, color="0.8", label="the gripper closes")
right.set(xlabel="time [s]", ylabel="height of the grasp point [m]")
right.legend(fontsize="small")
plt.show()
