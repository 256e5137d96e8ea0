"""
Pick and place with the calls of mplib
======================================

ManiSkill and SAPIEN plan with mplib. The planner here has its calls and results, so
that a program changes one line, ``import mplib``, and its motions are certified
clear and within limits. Neither of these libraries need be installed.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik.interop.maniskill as mplib
from beetle_ik.interop.maniskill import Pose


# %%
# A robot file; yours comes with the simulator. The arm has six joints and two
# fingers.
def joint(name, parent, child, xyz, axis, limits=(-3.0, 3.0), kind="revolute"):
    """Returns a link with a ball around its origin, and the joint before it."""
    ball = "<collision><geometry><sphere radius='0.03'/></geometry></collision>"
    return (
        f"<link name='{child}'>{ball}</link><joint name='{name}' type='{kind}'>"
        f"<parent link='{parent}'/><child link='{child}'/><origin xyz='{xyz}'/>"
        f"<axis xyz='{axis}'/><limit lower='{limits[0]}' upper='{limits[1]}' "
        "velocity='2'/></joint>"
    )


X, Y, Z = "1 0 0", "0 1 0", "0 0 1"
urdf = (
    "<robot name='picker'><link name='base'/>"
    + joint("turn", "base", "shoulder", "0 0 0.2", Z)
    + joint("lift", "shoulder", "upper", "0 0 0.1", Y)
    + joint("bend", "upper", "fore", "0 0 0.4", Y)
    + joint("roll", "fore", "wrist", "0 0 0.2", Z)
    + joint("tilt", "wrist", "palm", "0 0 0.2", Y)
    + joint("spin", "palm", "hand", "0 0 0.1", Z)
    + joint("left", "hand", "left_tip", "0 0.04 0.08", Y, (0, 0.04), "prismatic")
    + joint(
        "right", "hand", "right_tip", "0 -0.04 0.08", Y, (-0.04, 0), "prismatic"
    )
    + "</robot>"
)
planner = mplib.Planner(
    urdf=urdf,
    move_group="hand",
    joint_vel_limits=np.full(6, 2.0),
    joint_acc_limits=np.full(6, 5.0),
)

# %%
# A wall between the places, as points of a depth camera.
x, z = np.meshgrid(np.linspace(0.3, 0.6, 16), np.linspace(0.0, 0.45, 24))
wall = np.column_stack((x.ravel(), np.zeros(x.size), z.ravel()))
planner.update_point_cloud(wall, resolution=0.02)

# %%
# To the part, down, up with it, and over the wall. Poses have the quaternion
# w x y z; the configuration has the fingers too.
qpos = np.array([0.8, 0.6, 1.2, 0.0, 1.3, 0.0, 0.02, -0.02])
down, motions = [0.0, 1.0, 0.0, 0.0], []


def move(call, place):
    """Plans, notes the motion and goes to its end."""
    result = call(Pose(place, down), qpos, time_step=0.02)
    print(call.__name__, result["status"])
    motions.append(result)
    qpos[:6] = result["position"][-1]


move(planner.plan_pose, [0.45, 0.25, 0.35])
move(planner.plan_screw, [0.45, 0.25, 0.25])
planner.robot.set_qpos(qpos)
planner.update_attached_box([0.04, 0.04, 0.1], [0, 0, 0.12, 1, 0, 0, 0])
move(planner.plan_screw, [0.45, 0.25, 0.35])
move(planner.plan_pose, [0.45, -0.25, 0.35])

# %%
arm = planner.robot.arm_at(qpos)
figure, axes = plt.subplots(figsize=(7, 3.6), layout="constrained")
axes.plot(wall[:, 1], wall[:, 2], "s", color="gray", label="wall")
for number, motion in enumerate(motions, 1):
    hand = arm.fk(motion["position"])[:, :3, 3]
    axes.plot(hand[:, 1], hand[:, 2], label=f"motion {number}")
axes.set(xlabel="y [m]", ylabel="z [m]", aspect="equal")
axes.legend(fontsize="small", loc="upper left", bbox_to_anchor=(1.0, 1.0))
plt.show()
