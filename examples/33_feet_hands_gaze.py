"""
Feet, then hands, then gaze
===========================

A body stands on one foot. The other foot stays where it is, the hand reaches for
a place that moves away, and the head looks at it. Where not all of this is
possible, the levels of the tasks say what comes first.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

X, Y, Z = "1 0 0", "0 1 0", "0 0 1"


def limb(name, parent, tip, joints, most):
    """Returns a chain of joints, each an axis and a place."""
    parts = []
    for i, (axis, xyz) in enumerate(joints):
        link = tip if i + 1 == len(joints) else f"{name}_{i}"
        parts += [
            f"<link name='{link}'/><joint name='{name}_{i}' type='revolute'>",
            f"<parent link='{parent}'/><child link='{link}'/>",
            f"<origin xyz='{xyz}'/><axis xyz='{axis}'/>",
            f"<limit lower='-{most}' upper='{most}' velocity='2'/></joint>",
        ]
        parent = link
    return "".join(parts)


hip, knee, up = "0 0 0", "0 0 -0.4", "0 0 0.4"
leg = [(X, "0 0 0.1"), (Y, hip), (Y, up), (Y, up), (X, hip), (Z, "0 0 0.05")]
other = [(Z, "0 0.2 0"), (X, "0 0 -0.05"), (Y, hip), (Y, knee), (Y, knee), (X, hip)]
arm = [(Y, "0 0.2 0.3"), (X, hip), *((axis, "0 0 -0.15") for axis in (Z, Y, Z))]
neck = [(Z, "0 0 0.4"), (Y, "0 0 0.1")]
robot = bik.Robot.from_urdf(
    "<robot name='body'><link name='right_foot'/>"
    + limb("right", "right_foot", "pelvis", leg, 2.0)
    + limb("left", "pelvis", "left_foot", other, 2.0)
    + limb("waist", "pelvis", "chest", [(Z, "0 0.1 0.1"), (Y, "0 0 0.1")], 1.0)
    + limb("arm", "chest", "hand", [*arm, (Y, "0 0 -0.1")], 2.0)
    + limb("neck", "chest", "head", neck, 1.0)
    + "</robot>",
    tip=["left_foot", "hand", "head"],
)

# %%
# The foot stays where it is in a slight crouch, by its whole pose.
standing = np.zeros(robot.dof)
standing[[1, 2, 3]] = 0.3, -0.6, 0.3
standing[[8, 9, 10]] = -0.3, 0.6, -0.3
foot, hand, head = robot.fk(standing)
in_order = {
    "left_foot": bik.tasks.Pose(),
    "hand": bik.tasks.Position(level=1),
    "head": bik.tasks.Orientation(level=2),
}


def looking_at(place):
    """Returns the pose of the head when it looks at a place."""
    forward = (place - head[:3, 3]) / np.linalg.norm(place - head[:3, 3])
    side = np.cross([0.0, 0.0, 1.0], forward)
    side /= np.linalg.norm(side)
    gaze = head.copy()
    gaze[:3, :3] = np.stack([forward, side, np.cross(forward, side)], axis=1)
    return gaze


# %%
# The place moves forward, out of reach. With levels the foot does not move at all;
# with all tasks at one level it gives way, as a part of the error.
distances = np.linspace(1.3, 2.1, 17)
errors = {"levels": [], "one level": []}
for distance in distances:
    place = hand[:3, 3] + [distance, 0.0, 0.1]
    targets = {"left_foot": foot, "hand": place, "head": looking_at(place)}
    flat = {tip: type(task)() for tip, task in in_order.items()}
    for name, task in (("levels", in_order), ("one level", flat)):
        found = bik.solve(robot, targets, task=task, start_q=standing)
        off = found.errors
        errors[name].append([max(off["left_foot"]), off["hand"][0]])
        if name == "levels":
            last = found
print(last.status.name)
print(last.message)

figure, axes = plt.subplots(1, 2, figsize=(8, 3.2), layout="constrained")
titles = "foot off its place [m, rad]", "hand off its place [m]"
for i, title in enumerate(titles):
    for name, rows in errors.items():
        axes[i].plot(distances, np.array(rows)[:, i], label=name)
    axes[i].set(xlabel="place in front of the hand [m]", ylabel=title)
axes[0].legend()
plt.show()
