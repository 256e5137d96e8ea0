"""
A circle by beetle antennae search
==================================

A KUKA iiwa 14 follows the circle of Cheng et al. (2020) under velocity limits that
vary in time. Beetle antennae search uses only values of the error. The start is 0.1
m off the path.
"""

import matplotlib.pyplot as plt

import beetle_ik as bik

robot = bik.Robot.named("iiwa14")
circle = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=30.0)
limits = bik.Limits(
    velocity=bik.Sinusoid(mean=2.0, amplitude=0.004, angular_frequency=1.0)
)
start = [0.6449, 0.2037, 0.1969, -0.7714, 0.2028, 0.7179, 0.1]

# %%
# The error band of the paper is the tolerance of the call: each step ends as soon
# as the error is inside.
result = bik.track(
    robot,
    circle,
    start,
    dt=0.2,
    solver=bik.papers.BAS(),
    limits=limits,
    position_tolerance=1.7e-5,
)
print(result.message)
print(f"largest excess over a limit: {result.max_violation} rad")

# %%
# Levenberg-Marquardt, which uses the Jacobian, needs far fewer evaluations for a
# far smaller error.
by_jacobian = bik.track(
    robot,
    circle,
    start,
    dt=0.2,
    solver=bik.LevenbergMarquardt(),
    limits=limits,
    position_tolerance=1e-9,
)
settled = slice(75, None)
for name, run in (("BAS", result), ("Levenberg-Marquardt", by_jacobian)):
    evaluations = run.step_evaluations[settled].mean()
    print(
        f"{name}: {run.position_error[settled].mean():.1e} m, "
        f"{evaluations:.0f} evaluations per step"
    )

# %%
result.plot()
plt.show()
