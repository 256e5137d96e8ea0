"""
A motion for ROS 2
==================

ROS sends joint states in an order of its own, with the joints of the gripper
among them, and controllers take a ``JointTrajectory``. This program shows
conversions, and needs no ROS. :doc:`Two nodes <../ros2>` use them: one follows
poses, one plans to them.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda").with_capsules(radius=0.06)

# %%
# A message of ``sensor_msgs/JointState``: names and positions side by side. The
# configuration takes the joints of the robot by name.
names = ["panda_finger_joint1", *reversed(robot.joint_names)]
position = [0.02, 0.8, 1.8, 0.0, -2.0, 0.0, -0.3, 0.0]
state = dict(zip(names, position, strict=True))
q = np.array([state[name] for name in robot.joint_names])

# %%
# A pose of ``geometry_msgs/PoseStamped``: its quaternion is x, y, z, w.
target = bik.pose([0.4, 0.35, 0.4], xyzw=[1.0, 0.0, 0.0, 0.0])

# %%
# The plan, and the fields of ``trajectory_msgs/JointTrajectory``. Positions,
# velocities and accelerations are continuous, as controllers want them.
box = bik.obstacles.Box(center=(0.5, 0.15, 0.2), size=(0.3, 0.05, 0.4))
limits = bik.Limits(acceleration=5.0, jerk=50.0)
plan = bik.plan_point_to_point(
    robot, start_q=q, end=target, obstacles=[box], limits=limits
)
print(plan.message)
message = bik.interop.to_ros(plan.trajectory, dt=0.02)
print(message["joint_names"])
print(len(message["points"]), "points with", ", ".join(message["points"][0]))

# %%
# What the controller gets.
seconds = [
    point["time_from_start"]["sec"] + 1e-9 * point["time_from_start"]["nanosec"]
    for point in message["points"]
]
velocities = [point["velocities"] for point in message["points"]]
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
axes.plot(seconds, velocities, marker=".", label=message["joint_names"])
axes.set(xlabel="time_from_start [s]", ylabel="velocities [rad/s]")
axes.legend(fontsize="small")
plt.show()
