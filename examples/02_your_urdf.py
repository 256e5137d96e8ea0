"""
Your robot from a URDF
======================

``Robot.from_urdf`` reads a URDF file or its text. Base and tip may be any two
links; by default they are the root and the only leaf.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

LINK = """
  <link name="{child}"/>
  <joint name="{name}" type="{kind}">
    <parent link="{parent}"/><child link="{child}"/>
    <origin xyz="0 0 {offset}" rpy="{turn} 0 0"/><axis xyz="{axis}"/>
    <limit lower="{lower}" upper="{upper}" velocity="{velocity}" effort="100"/>
  </joint>"""


def joint(
    name: str, kind: str, parent: str, child: str, **numbers: float | str
) -> str:
    """Returns the XML of one joint and the link that it moves."""
    given = {
        "offset": 0.3,
        "turn": 0.0,
        "axis": "0 1 0",
        "lower": -2.0,
        "upper": 2.0,
        "velocity": 1.5,
    } | numbers
    return LINK.format(name=name, kind=kind, parent=parent, child=child, **given)


urdf = (
    '<robot name="crane"><link name="world"/>'
    + joint(
        "turn", "revolute", "world", "column", axis="0 0 1", lower=-3.0, upper=3.0
    )
    + joint("shoulder", "revolute", "column", "boom")
    + joint("elbow", "revolute", "boom", "arm", offset=0.5)
    + joint(
        "telescope",
        "prismatic",
        "arm",
        "hook",
        axis="0 0 1",
        lower=0.0,
        upper=0.4,
        velocity=0.2,
    )
    + "</robot>"
)

# %%
# In practice: ``bik.Robot.from_urdf("crane.urdf", tip="hook")``.
robot = bik.Robot.from_urdf(urdf, tip="hook")
print(robot)
print(dict(zip(robot.joint_names, robot.joint_kinds, strict=True)))

# %%
solution = bik.solve(robot, [0.6, 0.2, 0.5])
print(solution.message)
print("joint angles and extension:", np.round(solution.q, 4))

# %%
# An error names the mistake and lists what is known.
try:
    bik.Robot.from_urdf(urdf, tip="gripper")
except bik.UnknownNameError as error:
    print(error)

# %%
bik.plot.robot(robot, solution.q)
plt.show()
