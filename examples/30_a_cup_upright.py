"""
A cup that stays upright
========================

The hand holds a cup, so its axis must point down all the way, within ten degrees.
``keep=`` takes what holds at every instant of a motion, here ``upright``. Both
plans go past a wall; only one spills. What is kept is certified between samples
too, and ``plan.kept`` has bounds of the largest errors.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda").with_capsules(radius=0.06)
down = bik.pose([0.5, -0.4, 0.35], rpy=[np.pi, 0.0, 0.0])
start = bik.solve(robot, down, start_q=[-0.7, 0.2, 0.0, -2.2, 0.0, 2.4, 0.0]).q
end = start * [-1, 1, 1, 1, 1, 1, 1]
wall = bik.obstacles.Box(center=(0.55, 0.0, 0.25), size=(0.5, 0.06, 0.5))
limits = bik.Limits(acceleration=5.0)
most = np.radians(10)
cup = bik.upright(robot, tilt=most)

plans = {
    name: bik.plan_point_to_point(
        robot, start_q=start, end_q=end, obstacles=[wall], limits=limits, keep=keep
    )
    for name, keep in (("without keep", None), ("within 10 degrees", cup))
}

# %%
# The tilt along both motions, by forward kinematics.
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
for name, plan in plans.items():
    time, q, _, _ = plan.trajectory.sample(plan.trajectory.duration / 500)
    tilt = np.arccos(np.clip(-robot.fk(q)[:, 2, 2], -1.0, 1.0))
    axes.plot(time, np.degrees(tilt), label=name)
    print(f"{name}: {time[-1]:.2f} s, tilt up to {np.degrees(tilt.max()):.1f} deg")
axes.axhline(np.degrees(most), color="gray", linestyle="--")
axes.set(xlabel="time [s]", ylabel="tilt of the cup [deg]")
axes.legend()
[(_, largest)] = plans["within 10 degrees"].kept
print(f"certified: at most {np.degrees(largest[3]):.2f} deg")

# %%
# The arm halfway, with the cup upright.
plan = plans["within 10 degrees"]
halfway = plan.trajectory.at(plan.trajectory.duration / 2)[0]
bik.plot.robot(robot, halfway, obstacles=[wall])
plt.show()
