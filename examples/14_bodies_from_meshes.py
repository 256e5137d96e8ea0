"""
Bodies from meshes
==================

The links of most robots are meshes. `collision="fit"` covers each by few capsules,
which are the quickest to check; `collision="hulls"` takes convex hulls, which are
closer. Both hold all of the mesh: what they call clear is clear.

A real robot comes with its meshes; here a small arm is turned on a lathe.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

STEPS = 24  # around a turned part


def turned(profile: list[tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
    """Returns vertices and faces of a profile (radius, height) turned about z."""
    angle = np.linspace(0, 2 * np.pi, STEPS, endpoint=False)
    rings = [
        (r * np.cos(angle), r * np.sin(angle), np.full(STEPS, z))
        for r, z in profile
    ]
    vertices = np.concatenate([np.stack(ring, axis=1) for ring in rings])
    faces = []
    for ring in range(len(profile) - 1):
        for i in range(STEPS):
            a, b = ring * STEPS + i, ring * STEPS + (i + 1) % STEPS
            faces += [(a, b, b + STEPS), (a, b + STEPS, a + STEPS)]
    return vertices, np.array(faces)


def across(vertices: np.ndarray) -> np.ndarray:
    """Turns a part from the z axis to the y axis."""
    return vertices[:, [1, 2, 0]]


def joined(*parts: tuple[np.ndarray, np.ndarray]) -> str:
    """Returns parts as the text of an OBJ file."""
    lines, first = [], 1
    for vertices, faces in parts:
        lines += [f"v {x} {y} {z}" for x, y, z in vertices]
        lines += [f"f {a + first} {b + first} {c + first}" for a, b, c in faces]
        first += len(vertices)
    return "\n".join(lines)


def hub(radius: float, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Returns the housing of a joint that turns about the y axis."""
    half = [(radius, 0.8 * width), (0.8 * radius, width), (0, width)]
    vertices, faces = turned([(r, -z) for r, z in reversed(half)] + half)
    return across(vertices), faces


PARTS = {
    "base": [
        turned([
            (0, 0),
            (0.14, 0),
            (0.14, 0.04),
            (0.09, 0.08),
            (0.08, 0.2),
            (0, 0.2),
        ])
    ],
    "shoulder": [
        turned([(0, 0), (0.085, 0), (0.085, 0.04), (0.06, 0.1), (0, 0.14)]),
        hub(0.085, 0.11),
    ],
    "upper": [
        turned([
            (0, 0.02),
            (0.07, 0.05),
            (0.045, 0.15),
            (0.045, 0.32),
            (0.06, 0.4),
            (0, 0.42),
        ]),
        hub(0.065, 0.08),
    ],
    "fore": [
        turned([
            (0, 0.02),
            (0.05, 0.05),
            (0.03, 0.14),
            (0.025, 0.32),
            (0.05, 0.36),
            (0.05, 0.4),
            (0, 0.4),
        ])
    ],
}
PLACES = {"base": 0.0, "shoulder": 0.2, "upper": 0.1, "fore": 0.44}
folder = Path(tempfile.mkdtemp())
urdf = ["<robot name='turned arm'>"]
for link, parts in PARTS.items():
    if link == "shoulder":  # its housing is above its own axis
        parts[1] = (parts[1][0] + np.array([0, 0, 0.1]), parts[1][1])
    if link == "upper":  # and this one at the elbow
        parts[1] = (parts[1][0] + np.array([0, 0, 0.44]), parts[1][1])
    (folder / f"{link}.obj").write_text(joined(*parts))
    urdf.append(
        f"<link name='{link}'><collision><geometry><mesh filename='{link}.obj'/>"
        "</geometry></collision></link>"
    )
for i, (parent, child) in enumerate(zip(PARTS, list(PARTS)[1:], strict=False)):
    urdf.append(
        f"<joint name='j{i + 1}' type='revolute'>"
        f"<parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='0 0 {PLACES[child]}'/>"
        f"<axis xyz='{'0 0 1' if i == 0 else '0 1 0'}'/>"
        "<limit lower='-2.5' upper='2.5' velocity='1' effort='1'/></joint>"
    )
file = folder / "arm.urdf"
file.write_text("\n".join([*urdf, "</robot>"]))

# %%
# By how much the capsules are larger than the meshes.
flange = bik.pose((0, 0, 0.4))
fitted = bik.Robot.from_urdf(file, collision="fit").with_tool(flange)
hulls = bik.Robot.from_urdf(file, collision="hulls").with_tool(flange)
for link, _, volume_ratio, largest_distance in fitted.mesh_fits:
    print(
        f"{link}: {volume_ratio:.2f} times the volume, "
        f"at most {1000 * largest_distance:.0f} mm from the mesh"
    )

# %%
# The same configuration beside the same shelf: the closer the bodies, the larger
# the clearance.
q = [0.5, 0.7, 1.3]
shelf = bik.obstacles.Box(center=(0.62, 0.35, 0.4), size=(0.3, 0.3, 0.02))
for name, robot in (("capsules", fitted), ("hulls", hulls)):
    nearest = bik.obstacles.nearest(robot, q, [shelf])
    print(
        f"{name}: {nearest.body} is {1000 * nearest.distance:.1f} mm "
        f"from {nearest.other}"
    )

# %%
# The meshes, with the capsules around them.
bik.plot.robot(fitted, q, obstacles=[shelf])

# %%
# The hulls alone.
bik.plot.robot(hulls, q, obstacles=[shelf], meshes=False)
plt.show()
