"""
An arm with a wrong model
=========================

The arm differs from its model: links by up to 2 cm, joints by up to 2°. Joint
positions computed with the model miss the circle by centimetres. ``BroydenBAS``
uses no model: it commands the arm, measures the tip and learns the relation.

``examples/29_wrong_model.py`` does the same on a simulated arm with gravity and
servos, and writes a film.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

drawn = bik.Robot.named("iiwa14")
built = drawn.with_errors(length=0.02, angle=np.radians(2.0), seed=1)
circle = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=30.0)
start = np.array([0.6449, 0.2037, 0.1969, -0.7714, 0.2028, 0.7179, 0.1])

# %%
# With the model: the joint positions are exact for the model only.
by_model = bik.track(drawn, circle, start, dt=0.2)
reached = built.fk(by_model.q)[:, :3, 3]
error_by_model = np.linalg.norm(reached - by_model.reference, axis=1)

# %%
# Without a model: one command per tick, measured with 0.05 mm of noise.
plant = bik.KinematicPlant(built, noise=5e-5, seed=0)
controller = bik.BroydenBAS(max_evaluations_per_step=1)
without = bik.track_model_free(
    plant,
    circle,
    start,
    dt=0.2,
    controller=controller,
    limits=drawn.limits,
    position_tolerance=1e-3,
)
print(without.message)
settled = slice(20, None)
print(f"with the model: {1e3 * error_by_model[settled].max():.1f} mm off at most")
print(
    f"without: {1e3 * without.position_error[settled].max():.2f} mm off at most, "
    "as measured"
)

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
left.plot(
    *by_model.reference[:, :2].T, color="black", linestyle=":", label="reference"
)
left.plot(*reached[settled, :2].T, label="with the model")
left.plot(*without.position[settled, :2].T, label="without")
left.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", title="Seen from above")
left.legend(loc="center")
right.semilogy(by_model.time, 1e3 * error_by_model, label="with the model")
right.semilogy(without.time, 1e3 * without.position_error, label="without")
right.set(xlabel="time [s]", ylabel="distance from the path [mm]")
right.legend()
plt.show()
