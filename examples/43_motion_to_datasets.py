"""
A motion for datasets, bags and MoveIt
======================================

A planned motion goes out as frames of a LeRobot dataset, as a message of MoveIt,
and as a bag of ROS 2 that any viewer of MCAP files plays. No ROS and no LeRobot is
needed; the bag needs the package rosbags, and is left out without it.
"""

import importlib.util
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("ur5e")
start, end = [0.0, -1.5, 1.5, -1.5, -1.5, 0.0], [1.2, -1.0, 1.0, -1.6, -1.5, 0.5]
limits = bik.Limits(velocity=1.0, acceleration=3.0, jerk=30.0)
motion = bik.plan_point_to_point(
    robot, start_q=start, end_q=end, limits=limits
).trajectory

# %%
# Frames for ``LeRobotDataset.add_frame``, 30 a second, in degrees and with a
# gripper that stays open. The action of a frame is the state of the next.
features, frames = bik.interop.to_lerobot(
    motion, fps=30, task="reach over", others={"gripper": 80.0}
)
print(features["action"]["names"])
print(len(frames), "frames")

# %%
# The message of MoveIt, and the bag.
message = bik.interop.to_moveit(motion, dt=0.02, frame_id="base_link")
print(len(message["joint_trajectory"]["points"]), "points")
if importlib.util.find_spec("rosbags"):
    with tempfile.TemporaryDirectory() as folder:
        bik.interop.to_rosbag(motion, Path(folder) / "reach", dt=0.02)
        print(*sorted(file.name for file in (Path(folder) / "reach").iterdir()))

# %%
state = np.array([frame["observation.state"] for frame in frames])
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
axes.step(np.arange(len(state)) / 30, state, where="post")
axes.legend(features["action"]["names"], fontsize="small", ncols=2)
axes.set(xlabel="time [s]", ylabel="observation.state [deg]")
plt.show()
