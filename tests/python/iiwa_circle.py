"""The circle and the limits of Cheng et al. (2020) for a KUKA iiwa 14."""

import numpy as np

import beetle_ik as bik

IIWA = bik.Robot.named("iiwa14")
CIRCLE = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=30.0)
LIMITS = bik.Limits(velocity=bik.Sinusoid(mean=2.0, amplitude=0.004, angular_frequency=1.0))
START = np.array([0.6449219327, 0.2036664288, 0.1969337234, -0.7713896072, 0.2027968992, 0.7179441060, 0.1])
"""The paper's, with the tip 0.1 m off the circle."""
ON_CIRCLE = np.array([0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.6179441060, 0.0])
"""The same with the tip on the circle's first point."""
