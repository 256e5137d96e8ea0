"""
Payload and torques
===================

How heavy may a part be that a Panda holds at arm's length? The torques that hold
the arm up, in every posture between folded and stretched, say how loaded its motors
are. Then the torques of a motion, empty and with 3 kg in the hand.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda")
folded = np.array([0.0, -0.8, 0.0, -2.6, 0.0, 1.8, 0.8])
stretched = np.array([0.0, 1.1, 0.0, -0.4, 0.0, 1.6, 0.8])
share = np.linspace(0.0, 1.0, 101)
q = folded + share[:, None] * (stretched - folded)
reach = np.linalg.norm(robot.fk(q)[:, :2, 3], axis=1)

# %%
# Torques as a share of the limits of the maker, at rest.
figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
for mass in (0.0, 1.5, 3.0, 4.5):
    holding = robot.with_payload(mass, center=(0, 0, 0.1)).torques(q)
    worst = np.max(np.abs(holding) / robot.torque_limit, axis=1)
    axes.plot(reach, 100 * worst, label=f"{mass:g} kg")
axes.set(xlabel="reach [m]", ylabel="most loaded motor [%]", title="holding still")
axes.legend()
plt.show()

# %%
# The same motion, empty and with 3 kg, by the torque of the second motor; then the
# fastest one with 3 kg that keeps 90 % of the limits at every instant.
carrying = robot.with_payload(3.0, center=(0, 0, 0.1))
limits = bik.Limits(velocity=1.5, acceleration=5.0)
within = bik.Limits(velocity=1.5, acceleration=5.0, torque=0.9 * robot.torque_limit)
figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
for name, arm, kept in (
    ("empty", robot, limits),
    ("3 kg", carrying, limits),
    ("3 kg, torques kept", carrying, within),
):
    plan = bik.plan_point_to_point(
        arm, start_q=stretched, end_q=folded, limits=kept
    )
    time = np.linspace(0.0, plan.trajectory.duration, 200)
    axes.plot(time, plan.torques(time)[:, 1], label=name)
axes.axhline(-0.9 * 87.0, color="k", linewidth=0.8)
axes.set(xlabel="time [s]", ylabel="torque of joint 2 [N m]", title="moving")
axes.legend()
plt.show()

# %%
# The center of mass moves outward by this much:
before, after = robot.center_of_mass(np.array([folded, stretched]))
print(f"center of mass: {before.round(3)} folded, {after.round(3)} stretched")
