"""
A LeRobot arm, led by a phone
=============================

LeRobot drives hobby arms of five joints in degrees, with the gripper as a sixth
entry. ``RobotKinematics`` has the calls of LeRobot's class of that name: change the
import. An arm of five joints cannot turn its hand as it likes, so the place comes
first, exactly, and the turn as near as that allows. LeRobot need not be installed.
"""

import matplotlib.pyplot as plt
import numpy as np

from beetle_ik.interop.lerobot import RobotKinematics

LINKS = ["base", "shoulder", "upper", "fore", "wrist", "gripper_frame_link"]
NAMES = ["shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll"]
PLACES = ["0 0 0.06", "0.03 0 0.05", "0.03 0 0.11", "0.13 0 0", "0.06 0 0"]
AXES = ["0 0 1", "0 1 0", "0 1 0", "0 1 0", "1 0 0"]
urdf = "<robot name='hobby'><link name='base'/>" + "".join(
    f"<link name='{child}'/><joint name='{name}' type='revolute'>"
    f"<parent link='{parent}'/><child link='{child}'/><origin xyz='{place}'/>"
    f"<axis xyz='{axis}'/><limit lower='-1.8' upper='1.8' velocity='10'/></joint>"
    for name, parent, child, place, axis in zip(
        NAMES, LINKS, LINKS[1:], PLACES, AXES, strict=False
    )
)
kinematics = RobotKinematics(urdf + "</robot>", joint_names=NAMES)

# %%
# One call, in degrees. The sixth entry is the gripper's, and passes through.
joints = np.array([0.0, -30.0, 40.0, 30.0, 0.0, 55.0])
target = kinematics.forward_kinematics(joints)
target[:3, 3] += [0.0, 0.03, 0.01]
joints = kinematics.inverse_kinematics(joints, target)
print(joints.round(1))
print(kinematics.result.message)

# %%
# A stream: 50 poses a second, of which some are lost, for three seconds, and for
# another one none at all. Limits are in degrees too; the arm stops smoothly.
DT = 0.02  # s
tracker = kinematics.tracker(joints, dt=DT, velocity=120.0, acceleration=600.0)
lost = np.random.default_rng(1)
wanted, commands = [], []
for t in DT * np.arange(200):
    pose = target.copy()
    pose[1, 3] += 0.08 * np.sin(3.0 * t)
    arrived = t < 3.0 and lost.random() > 0.2
    commands.append(tracker.step(pose if arrived else None))
    wanted.append(pose[1, 3] if arrived else np.nan)
print("within the limits:", tracker.result.inside_limits)

# %%
place = [kinematics.forward_kinematics(command)[1, 3] for command in commands]
time = DT * np.arange(1, len(commands) + 1)
figure, (above, below) = plt.subplots(
    2, sharex=True, figsize=(8, 5), layout="constrained"
)
above.plot(time, wanted, ".", color="black", markersize=3, label="poses")
above.plot(time, place, label="gripper")
above.set(ylabel="y [m]")
above.legend(loc="lower left")
below.plot(time, np.gradient(np.array(commands)[:, :5], DT, axis=0), label=NAMES)
below.set(xlabel="time [s]", ylabel="speed [deg/s]")
below.legend(fontsize="small", ncols=3)
plt.show()
