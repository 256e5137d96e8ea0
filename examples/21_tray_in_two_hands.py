"""
A tray in two hands
===================

Two arms on a lift carry a tray along a circle that leaves their reach, and the
right arm is slow. The right hand is to be where the tray has its other handle, as
seen from the left hand: a target for the pair ``("left", "right")``. Whatever else
gives way, the pair is held first, so the tray stays in both hands while both arms
fall behind together. Two tracks of their own pull it out of them.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

AXES = ["0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1"]
LENGTHS = [0.1, 0.1, 0.2, 0.2, 0.2, 0.2, 0.0]


def arm(side: str, y: float) -> str:
    """Returns the links and joints of an arm whose shoulder is at `y` (m)."""
    parts, parent = [], "chest"
    for i, (axis, length) in enumerate(zip(AXES, LENGTHS, strict=True)):
        parts += [
            f"<link name='{side}{i}'/><joint name='{side}{i}' type='revolute'>",
            f"<parent link='{parent}'/><child link='{side}{i}'/>",
            f"<origin xyz='0 {y if i == 0 else 0} {length}'/><axis xyz='{axis}'/>",
            "<limit lower='-2.8' upper='2.8' velocity='2'/></joint>",
        ]
        parent = f"{side}{i}"
    parts += [
        f"<link name='{side}'/><joint name='{side}_mount' type='fixed'>",
        f"<parent link='{parent}'/><child link='{side}'/>",
        "<origin xyz='0 0 0.1'/></joint>",
    ]
    return "".join(parts)


urdf = f"""<robot name='carrier'><link name='floor'/><link name='chest'/>
<joint name='lift' type='prismatic'>
<parent link='floor'/><child link='chest'/><origin xyz='0 0 0.5'/>
<axis xyz='0 0 1'/><limit lower='0' upper='0.4' velocity='0.2'/></joint>
{arm("left", 0.3)}{arm("right", -0.3)}</robot>"""
robot = bik.Robot.from_urdf(urdf, tip=["left", "right"])

FORWARD = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
circle = bik.paths.circle(
    center=(0.72, 0.25, 1.0), diameter=0.6, duration=10.0, a=(0, 1, 0), b=(0, 0, 1)
)
path = circle.with_orientation(FORWARD)
tray = bik.pose((0.0, -0.5, 0.0))
limits = bik.Limits(velocity=[0.2] + 7 * [0.6] + 7 * [0.2], acceleration=3.0)
together = bik.track(
    robot, {"left": path, ("left", "right"): tray}, dt=0.02, limits=limits
)

# The same circle for each hand on its own, half a metre apart.
beside = bik.paths.circle(
    center=(0.72, -0.25, 1.0), diameter=0.6, duration=10.0, a=(0, 1, 0), b=(0, 0, 1)
)
apart = bik.track(
    robot,
    {"left": path, "right": beside.with_orientation(FORWARD)},
    together.q[0],
    dt=0.02,
    limits=limits,
)

# %%
# How far the handle is from the right hand, by forward kinematics.
figure, (slip, lag) = plt.subplots(2, 1, sharex=True, layout="constrained")
for name, result in {"pair held": together, "each on its own": apart}.items():
    left, right = robot.fk(result.q).swapaxes(0, 1)
    handle = (left @ tray)[:, :3, 3]
    away = np.linalg.norm(handle - right[:, :3, 3], axis=1)
    slip.semilogy(result.time, np.maximum(away, 1e-16), label=name)
    lag.plot(result.time, 1e3 * result.errors["left"][0])
    print(f"{name}: the tray slips by up to {away.max():.1e} m")
slip.axhline(1e-6, color="gray", linestyle="--")
slip.set_ylabel("slip of the tray [m]")
slip.legend()
lag.set(xlabel="time [s]", ylabel="left hand off its path [mm]")

# %%
# The path, and the arms where they are farthest behind.
bik.plot.robot(robot, together.q[together.position_error.argmax()])
together.plot()
plt.show()
