"""
Pointing: five of six degrees of freedom
========================================

A glue nozzle, a welding torch or a drill has no preferred roll angle.
``tasks.Pointing`` constrains the position and the direction of one axis. The
rotation about that axis is free, and a goal can use it.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

# A torch bent by 45°.
robot = bik.Robot.named("ur5e").with_tool(
    bik.pose([0.05, 0.0, 0.12], rpy=[0.0, np.pi / 4, 0.0])
)
circle = bik.paths.circle((0.45, 0.1, 0.25), diameter=0.2, duration=8.0)
down = bik.pose([0, 0, 0], rpy=[np.pi, 0, 0])[:3, :3]
path = circle.with_orientation(down)
start = bik.solve(
    robot,
    path.pose(0.0),
    start_q=[0.0, -1.2, 1.8, -2.2, -1.5, 0.0],
    prefer="nearest",
).q

# %%
# First the whole pose, then only the pointing task, with a goal that keeps the arm
# away from singularities.
whole = bik.track(robot, path, start, dt=0.02)
pointing = bik.track(
    robot,
    path,
    start,
    dt=0.02,
    task=bik.tasks.Pointing(),
    goals=bik.goals.Manipulability(),
)
for name, run in (("pose", whole), ("pointing", pointing)):
    print(f"{name}: {run.message}")

# %%
figure, (above, below) = plt.subplots(
    2, sharex=True, figsize=(7, 5), layout="constrained"
)
for name, run in (("pose", whole), ("pointing, with goal", pointing)):
    axes = robot.fk(run.q)[:, :3, :3]
    spin = np.unwrap(np.arctan2(axes[:, 1, 0], axes[:, 0, 0]))
    above.plot(run.time, np.degrees(spin - spin[0]), label=name)
    below.plot(run.time, robot.manipulability(run.q), label=name)
above.set(
    ylabel="rotation of the tool [°]",
    title="The tool points down; its rotation about z is free in one run",
)
below.set(xlabel="time [s]", ylabel="manipulability")
above.legend()
plt.show()
