"""
A hand-eye pose by gradient
===========================

A camera beside the arm sees a marker at its tool. Where is the camera, where is the
marker, and how far off are the joint encoders? ``interop.jax`` differentiates the
forward kinematics, so that any model of the measurement can be fitted: here by a
few steps of Gauss-Newton. For a complete calibration of an arm, with outliers and
with what cannot be known, take ``bik.calibrate``.
"""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik
from beetle_ik.interop import jax as bjax

robot = bik.Robot.named("ur5e")
fk = bjax.fk(robot)


# %%
# The model: x holds the camera's place and rotation vector, the marker in the frame
# of the tool, and offsets of joints 2 to 5. The turn of the first joint cannot be
# told from that of the camera, nor the last from the marker's place.
def rotation(vector):
    """The rotation (3, 3) of a rotation vector."""
    x, y, z = vector
    skew = jnp.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return jax.scipy.linalg.expm(skew)


def seen(x, q):
    """The marker (3,) in the frame of the camera."""
    tip = fk(q.at[1:5].add(x[9:]))
    marker = tip[:3, :3] @ x[6:9] + tip[:3, 3]
    return rotation(x[3:6]).T @ (marker - x[:3])


# %%
# Measurements with noise of half a millimetre, from 60 configurations.
draw = np.random.default_rng(1)
truth = jnp.array([
    1.2,
    0.3,
    0.8,
    0.4,
    -1.9,
    0.2,
    0.02,
    -0.01,
    0.08,
    0.01,
    -0.02,
    0.015,
    0.01,
])
q = jnp.array(robot.random_configurations(60, seed=4))
measured = jax.vmap(seen, (None, 0))(truth, q)
measured = measured + draw.normal(scale=5e-4, size=measured.shape)

# %%
# Gauss-Newton from a rough guess: 20 cm, 0.2 rad and 5 degrees off.
x = truth + jnp.array(draw.uniform(-1, 1, 13)) * jnp.array(
    [0.2] * 6 + [0.05] * 3 + [0.09] * 4
)


def residuals(x):
    """Measured places against those of the model."""
    return (jax.vmap(seen, (None, 0))(x, q) - measured).ravel()


errors = [x - truth]
for _ in range(8):
    slope = jax.jacfwd(residuals)(x)
    x = x - jnp.linalg.lstsq(slope, residuals(x))[0]
    errors.append(x - truth)

print(f"camera off by {1000 * float(jnp.linalg.norm(errors[-1][:3])):.2f} mm")
worst = float(jnp.abs(errors[-1][9:]).max())
print(f"encoders off by {np.degrees(worst):.3f} degrees")

figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
for part, label in ((slice(0, 3), "camera [m]"), (slice(9, 13), "encoders [rad]")):
    sizes = [float(jnp.linalg.norm(error[part])) for error in errors]
    axes.semilogy(sizes, "o-", label=label)
axes.set(xlabel="step", ylabel="error")
axes.legend()
plt.show()
