"""
Pointing: five of six degrees
=============================

A glue nozzle, a welding torch or a drill has no preferred roll. ``tasks.Pointing`` asks for the position and for the
direction of one axis; the spin about it is left free, and goes where a goal wants it.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

# A torch that is bent by 45°.
robot = bik.Robot.named("ur5e").with_tool(bik.pose([0.05, 0.0, 0.12], rpy=[0.0, np.pi / 4, 0.0]))
circle = bik.paths.circle((0.45, 0.1, 0.25), diameter=0.2, duration=8.0)
down = bik.pose([0, 0, 0], rpy=[np.pi, 0, 0])[:3, :3]
path = circle.with_orientation(down)
start = bik.solve(robot, path.pose(0.0), start=[0.0, -1.2, 1.8, -2.2, -1.5, 0.0], prefer="nearest").q

# %%
# The whole pose first, then the pointing task alone, which stays as far from singularities as it can.
whole = bik.track(robot, path, start, dt=0.02)
pointing = bik.track(robot, path, start, dt=0.02, task=bik.tasks.Pointing(), goals=bik.goals.Manipulability())
for name, run in (("pose", whole), ("pointing", pointing)):
    print(f"{name}: {run.message}")

# %%
figure, (above, below) = plt.subplots(2, sharex=True, figsize=(7, 5), layout="constrained")
for name, run in (("pose", whole), ("pointing, with goal", pointing)):
    axes = robot.fk(run.q)[:, :3, :3]
    spin = np.unwrap(np.arctan2(axes[:, 1, 0], axes[:, 0, 0]))
    above.plot(run.time, np.degrees(spin - spin[0]), label=name)
    below.plot(run.time, robot.manipulability(run.q), label=name)
above.set(ylabel="spin of the tool [°]", title="The tool points down all the way; its spin is free in one of the runs")
below.set(xlabel="time [s]", ylabel="manipulability")
above.legend()
plt.show()
