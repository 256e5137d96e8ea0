"""
The place exactly, the orientation as near as it can be
=======================================================

An arm with five joints cannot turn its hand freely. Asked for a whole pose, it puts
the hand at the place exactly, and comes as near to the orientation as the place
allows. Its status says so.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

JOINTS = [
    ("pan", "0 0 1", "0.04 0 0.06"),
    ("lift", "0 1 0", "0.03 0 0.055"),
    ("elbow", "0 1 0", "0.03 0 0.115"),
    ("wrist", "0 1 0", "0.135 0 0"),
    ("roll", "1 0 0", "0.06 0 0"),
]
parts, parent = ["<link name='base'/>"], "base"
for name, axis, xyz in JOINTS:
    parts += [
        f"<link name='{name}_link'/><joint name='{name}' type='revolute'>",
        f"<parent link='{parent}'/><child link='{name}_link'/>",
        f"<origin xyz='{xyz}'/>",
        f"<axis xyz='{axis}'/>",
        "<limit lower='-1.8' upper='1.8' velocity='3'/></joint>",
    ]
    parent = f"{name}_link"
parts += [
    "<link name='hand'/><joint name='mount' type='fixed'>",
    f"<parent link='{parent}'/><child link='hand'/><origin xyz='0.1 0 0'/></joint>",
]
robot = bik.Robot.from_urdf(
    f"<robot name='hobby'>{''.join(parts)}</robot>", tip="hand"
)

# %%
# Along a line to the side, the hand is asked to point straight ahead.
asked = [
    bik.pose([0.25, y, 0.15], rpy=[0, 0.6, 0]) for y in np.linspace(0, 0.15, 31)
]
found = bik.solve_batch(robot, asked)
print(found[0].status.name, "...", found[-1].status.name)
print(found[-1].message)
print(f"off the place by at most {found.position_error.max():.1e} m")

figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
side = [1e3 * pose[1, 3] for pose in asked]
axes.plot(
    side, np.degrees(found.rotation_error), label="as near as the place allows"
)
axes.set(xlabel="place to the side [mm]", ylabel="off the orientation [deg]")
axes.legend()

# %%
# The arm at the last place. With the orientation first, the place gives way.
turned = bik.solve(robot, asked[-1], task=bik.tasks.Pose(first="orientation"))
print(f"{turned.status.name}: {1e3 * turned.position_error:.0f} mm from the place")
bik.plot.robot(robot, found[-1].q)
plt.show()
