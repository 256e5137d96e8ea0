"""
Torques of a plan in MuJoCo
===========================

A Panda with 3 kg in its hand moves as fast as 90 % of its torques allow. MuJoCo
plays the motion: its motors get the torques of the plan, and a little feedback.
Where the controller knows the payload the arm follows; where it does not, it sags.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik
from beetle_ik.sim import TorquePlant

empty = bik.Robot.named("panda")
robot = empty.with_payload(3.0, center=(0, 0, 0.05))
start = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])
end = np.array([1.2, 0.8, 0.3, -1.0, 0.2, 1.5, 0.8])
limits = bik.Limits(
    acceleration=[15, 7.5, 10, 12.5, 15, 20, 20], torque=0.9 * robot.torque_limit
)
plan = bik.plan_point_to_point(robot, start_q=start, end_q=end, limits=limits)

# %%
# The plant is the arm as it is. The model is what the controller takes it for.
plant = TorquePlant(robot)
known = plant.follow(plan, hold=0.5)
unknown = plant.follow(plan, model=empty, hold=0.5)
for name, run in (("known", known), ("unknown", unknown)):
    print(f"payload {name}: {1e3 * run.error.max():.2f} mm off at most")

# %%
# The distance of the tip from the plan.
figure, axes = plt.subplots(figsize=(6, 3.4), layout="constrained")
axes.semilogy(known.t, 1e3 * known.error + 1e-6, label="payload known")
axes.semilogy(unknown.t, 1e3 * unknown.error + 1e-6, label="payload unknown")
axes.set(xlabel="time [s]", ylabel="tip off the plan [mm]", ylim=(1e-4, 1e2))
axes.legend()
plt.show()

# %%
# The torques of MuJoCo's motors, as shares of their limits, beside the plan's.
plt.figure(figsize=(6, 3.4), layout="constrained")
for run, name in ((known, "motors"), (unknown, "motors, payload unknown")):
    share = np.max(np.abs(run.torques) / robot.torque_limit, axis=1)
    plt.plot(run.t, 100 * share, label=name)
inside = known.t[known.t <= plan.trajectory.duration]
planned = np.max(np.abs(plan.torques(inside)) / robot.torque_limit, axis=1)
plt.plot(inside, 100 * planned, "k--", label="plan")
plt.xlabel("time [s]")
plt.ylabel("most loaded motor [%]")
plt.legend()
plt.show()
