"""
Two arms in turns
=================

A program for two arms on a lift: the left one brings a board, the right one glues a
bead along it. Each move names the tip that it leads, and the other one stays where
it is. The nozzle may spin about its axis: a task of the right tip alone.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik
from beetle_ik.moves import Joints, Line, Wait

AXES = ["0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1"]
LENGTHS = [0.1, 0.1, 0.2, 0.2, 0.2, 0.2, 0.0]


def arm(side: str, y: float) -> str:
    """Returns the links and joints of an arm whose shoulder is at `y` (m)."""
    parts, parent = [], "chest"
    for i, (axis, length) in enumerate(zip(AXES, LENGTHS, strict=True)):
        parts += [
            f"<link name='{side}{i}'/><joint name='{side}{i}' type='revolute'>",
            f"<parent link='{parent}'/><child link='{side}{i}'/>",
            f"<origin xyz='0 {y if i == 0 else 0} {length}'/><axis xyz='{axis}'/>",
            "<limit lower='-2.8' upper='2.8' velocity='2'/></joint>",
        ]
        parent = f"{side}{i}"
    parts += [
        f"<link name='{side}'/><joint name='{side}_mount' type='fixed'>",
        f"<parent link='{parent}'/><child link='{side}'/>",
        "<origin xyz='0 0 0.1'/></joint>",
    ]
    return "".join(parts)


urdf = f"""<robot name='workers'><link name='floor'/><link name='chest'/>
<joint name='lift' type='prismatic'>
<parent link='floor'/><child link='chest'/><origin xyz='0 0 0.5'/>
<axis xyz='0 0 1'/><limit lower='0' upper='0.4' velocity='0.2'/></joint>
{arm("left", 0.3)}{arm("right", -0.3)}</robot>"""
robot = bik.Robot.from_urdf(urdf, tip=["left", "right"])


def tool(x: float, y: float, z: float, yaw: float = 0.0) -> np.ndarray:
    """The pose of a tool at this place, pointing down."""
    return bik.pose([x, y, z], rpy=[np.pi, 0.0, yaw])


program = [
    Joints(tool(0.4, 0.25, 1.0), tip="left", name="fetch"),
    Line(tool(0.4, 0.05, 1.0), speed=0.2, tip="left", name="bring"),
    Joints(tool(0.3, -0.25, 1.05), tip="right", name="above"),
    Line(tool(0.3, -0.15, 1.0), speed=0.1, blend=0.01, tip="right", name="down"),
    Line(tool(0.5, -0.15, 1.0, 2.0), speed=0.1, tip="right", name="glue"),
    Line(tool(0.5, -0.15, 1.1, 2.0), tip="right", name="up"),
    Wait(0.3, name="set"),
    Line(tool(0.4, 0.25, 1.0), speed=0.2, tip="left", name="away"),
]
start = np.zeros(robot.dof)
start[[0, 2, 4, 6, 9, 11, 13]] = 0.2, 0.8, -1.6, -0.8, 0.8, -1.6, -0.8
limits = bik.Limits(acceleration=5.0)
nozzle = bik.tasks.Pointing(axis=[0.0, 0.0, 1.0])
plans = {
    "whole poses": bik.plan_moves(robot, program, start_q=start, limits=limits),
    "nozzle may spin": bik.plan_moves(
        robot, program, start_q=start, limits=limits, task={"right": nozzle}
    ),
}
for name, plan in plans.items():
    q = plan.trajectory.sample(0.01)[1]
    travel = np.abs(np.diff(q[:, 8:], axis=0)).sum()
    print(
        f"{name}: {plan.trajectory.duration:.2f} s, the right arm's joints travel "
        f"{travel:.1f} rad"
    )

# %%
# The speed of both tips, by forward kinematics: one moves, the other stays.
plan = plans["nozzle may spin"]
time, q, _, _ = plan.trajectory.sample(0.002)
places = robot.fk(q)[:, :, :3, 3]
speeds = np.linalg.norm(np.gradient(places, time, axis=0), axis=2)
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
for tip, speed in zip(robot.tips, speeds.T, strict=True):
    axes.plot(time, speed, label=tip)
for move in plan.moves:
    axes.axvline(move.end, color="gray", linewidth=0.5)
    axes.text(
        0.5 * (move.start + move.end),
        0.95 * speeds.max(),
        move.name,
        ha="center",
        va="top",
        rotation=90,
    )
axes.set(xlabel="time [s]", ylabel="speed of the tip [m/s]")
axes.legend()

# %%
# The arms at the end of the bead.
bik.plot.robot(robot, plan.trajectory.at(plan.moves[4].end)[0])
plt.show()
