"""Distances to obstacles and between links, and their gradients."""

from typing import Any

import numpy as np

from ... import obstacles as shapes
from ..._core import Robot
from .rows import Rows


def distances(robot: Robot, scene: Any, q: Rows) -> Rows:
    """Returns the smallest distance at each configuration (m,) (m); inf where nothing can touch."""
    return np.asarray(shapes.clearance(robot, q, scene))


def gradients(robot: Robot, scene: Any, q: Rows) -> Rows:
    """Returns the gradients of the distances (m, n): of one of the pairs where several are equally near, else exact."""
    result = np.zeros(q.shape)
    for row, configuration in zip(result, q, strict=True):
        pair = shapes.nearest(robot, configuration, scene)
        if pair is not None:
            row[:] = pair.gradient
    return result
