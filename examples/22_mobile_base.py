"""
An arm on wheels
================

``with_mobile_base`` puts the joints of a base before those of the arm. Base and arm
then move together: one plan drives round a pillar and reaches into a shelf.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

arm = bik.Robot.named("panda").with_base(bik.pose([0.2, 0, 0.6]))
robot = arm.with_capsules(radius=0.06).with_mobile_base(
    "planar",
    lower=[-3, -3, -np.pi],
    upper=[3, 3, np.pi],
    velocity=[0.8, 0.8, 1.0],
    acceleration=[1.0, 1.0, 2.0],
)
print(robot.joint_names[:4])

# %%
# The place in the shelf, and the pillar on the way.
shelf = bik.pose([2.0, 1.5, 1.2], rpy=[0, np.pi / 2, 0])
pillar = bik.obstacles.Cylinder((1.0, 0.7, 0.75), (0, 0, 1), radius=0.2, length=1.5)
start = np.r_[0, 0, 0, 0, -0.4, 0, -2.0, 0, 1.6, 0.8]
plan = bik.plan_point_to_point(
    robot, start_q=start, end=shelf, obstacles=[pillar], limits=robot.rated_limits
)
print(plan.message)

# %%
# Base and tip from above, and how fast the base drives.
time, q, qd, _ = plan.trajectory.sample(0.02)
tip = robot.fk(q)[:, :3, 3]
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
left.plot(q[:, 0], q[:, 1], label="base")
left.plot(tip[:, 0], tip[:, 1], label="tip")
left.add_patch(plt.Circle((1.0, 0.7), 0.2, color="0.7"))
left.plot(2.0, 1.5, "k*", markersize=10, label="shelf")
left.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", title="from above")
left.legend(fontsize="small")
right.plot(time, qd[:, :3], label=["x [m/s]", "y [m/s]", "yaw [rad/s]"])
right.set(xlabel="time [s]", ylabel="velocity of the base")
right.legend(fontsize="small")
plt.show()
