"""
A program of moves
==================

A cobot goes above a part, down at 50 mm/s, waits, along the part and round its
end, and home. The corners on the way are rounded within 10 mm, so that the tool
keeps its speed; ``plan.moves`` says how fast each move was, and what slowed it.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik
from beetle_ik.moves import Arc, Joints, Line, Wait

robot = bik.Robot.named("ur5e")
home = [0.0, -1.5, 1.8, -1.9, -1.57, 0.0]


def tool(x, y, z):
    """The pose of the tool above this place, pointing down."""
    return bik.pose([x, y, z], rpy=[np.pi, 0.0, 0.0])


program = [
    Joints(tool(0.4, -0.2, 0.3), name="above"),
    Line(tool(0.4, -0.2, 0.2), speed=0.05, name="down"),
    Wait(0.5, name="glue on"),
    Line(tool(0.4, 0.0, 0.2), speed=0.1, blend=0.01, name="along"),
    Arc(
        [0.435, 0.085, 0.2],
        tool(0.35, 0.12, 0.2),
        speed=0.1,
        blend=0.01,
        name="round",
    ),
    Line(tool(0.35, 0.12, 0.3), speed=0.25, name="up"),
    Joints(home, name="home"),
]
plan = bik.plan_moves(
    robot, program, start_q=home, limits=bik.Limits(acceleration=5.0)
)
for move in plan.moves:
    print(f"{move.name}: {move.end - move.start:.2f} s, up to {move.speed:.3f} m/s")

# %%
# The speed of the tool, by forward kinematics. Shaded: where a limit keeps it below
# the speed asked for, when it starts and stops.
time, q, _, _ = plan.trajectory.sample(0.002)
speed = np.linalg.norm(np.gradient(robot.fk(q)[:, :3, 3], time, axis=0), axis=1)
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
axes.plot(time, speed)
for move in plan.moves:
    axes.text(
        0.5 * (move.start + move.end), 0.33, move.name, ha="center", rotation=90
    )
    axes.axvline(move.end, color="gray", linewidth=0.5)
    for bound in move.bound_by:
        axes.axvspan(bound.start, bound.end, color="orange", alpha=0.3)
axes.set(xlabel="time [s]", ylabel="speed of the tool [m/s]", ylim=(0.0, 0.45))
plt.show()
