"""
Inverse kinematics of a pose
============================

``solve`` returns joint positions, both errors and a message. A target that cannot
be reached raises no exception.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

robot = bik.Robot.named("panda")
target = bik.pose([0.5, 0.2, 0.4], rpy=[np.pi, 0.0, 0.3])
solution = bik.solve(robot, target)
print(solution.message)
print("q =", np.round(solution.q, 4))
print(f"errors: {solution.position_error:.1e} m, {solution.rotation_error:.1e} rad")

# %%
# Forward kinematics confirms the solution.
print(np.allclose(robot.fk(solution.q), target, atol=2e-6))

# %%
# ``prefer="nearest"`` returns the solution with the smallest joint motion from a
# start.
ready = np.array([0.0, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8])
nearest = bik.solve(robot, target, start_q=ready, prefer="nearest")
print(
    f"joint motion: {np.linalg.norm(nearest.q - ready):.2f} rad, "
    f"any solution: {np.linalg.norm(solution.q - ready):.2f}"
)

# %%
# For a target out of reach, the status says so, and ``missed.q`` is the best
# configuration found.
missed = bik.solve(robot, [2.0, 0.0, 0.5])
print(missed.success, missed.status.name)
print(missed.message)

# %%
bik.plot.robot(robot, nearest.q)
plt.show()
