"""
A printed layer from G-code
===========================

A slicer's program becomes poses, with the speed of each move. The arm prints the
layer at these speeds; what the program says about heat and fans is listed, not
followed.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

# %%
# A layer as a slicer writes it: a wall with round corners, and a filling.
infill = "\n".join(
    f"G1 X{x} F6000\nG1 Y{36 if i % 2 == 0 else 4} E1.1 F2400\n"
    for i, x in enumerate(range(6, 56, 2))
)
layer = f"""
M104 S210 ; heat
G21
G90
M83
G0 X5 Y0 Z0.3 F9000
M106 S255
G1 X55 E1.7 F1800
G3 X60 Y5 J5 E0.3
G1 Y35 E1.0
G3 X55 Y40 I-5 E0.3
G1 X5 E1.7
G3 X0 Y35 J-5 E0.3
G1 Y5 E1.0
G3 X5 Y0 I5 E0.3
G0 Z1
G0 X6 Y4
G0 Z0.3
{infill}
G0 Z20
"""

# %%
# ``frame`` is where the bed is: the pose of the program's origin.
program = bik.paths.from_gcode(layer, frame=bik.pose([0.42, -0.02, 0.1]))
print(program)
print("not followed:", program.ignored)
wall = program.seams()[0]
print(f"wall: {1e3 * wall.length:.3f} mm, by its formula {160 + 10 * np.pi:.3f} mm")
print(f"filament: {1e3 * program.extrusion.sum():.1f} mm")

# %%
# The nozzle points down; its turn about its own axis is free. The program has
# corners at full speed: an arm with finite accelerations rounds them, in a band.
robot = bik.Robot.named("ur5e").with_tool(bik.pose([0.0, 0.0, 0.1]))
path = program.path(rapid_speed=0.15)
result = bik.track(
    robot,
    path,
    dt=0.004,
    task=bik.tasks.Pointing(),
    limits=bik.Limits(acceleration=20.0),
    ease=True,
    position_tolerance=2e-3,
    rotation_tolerance=5e-3,
)
print(f"{result.message}; {path.duration:.1f} s by the program")
error = 1e3 * result.position_error[125:]  # after the approach
print(f"{np.median(error):.4f} mm off in the median, {error.max():.2f} at most")

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
xy = 1e3 * program.poses[:, :2, 3]
for seam in program.seams():
    left.plot(*(1e3 * seam.poses[:, :2, 3]).T, color="tab:blue")
for i in np.flatnonzero(program.rapid):
    left.plot(*xy[i : i + 2].T, color="tab:orange", linewidth=0.8)
left.set(
    xlabel="x [mm]", ylabel="y [mm]", aspect="equal", title="printed, and rapid"
)
speed = np.linalg.norm(np.diff(result.position, axis=0), axis=1) / 0.004
right.plot(result.time[1:], 1e3 * speed, linewidth=0.8)
right.set(xlabel="time [s]", ylabel="speed of the nozzle [mm/s]", ylim=(0, 180))
plt.show()
