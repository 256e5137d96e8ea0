"""Motions as dicts of arrays."""

from typing import Any, TypeAlias

import numpy as np

from ..._core import Trajectory
from .poses import Array

Result: TypeAlias = dict[str, Any]


def sampled(motion: Trajectory, time_step: float) -> Result:
    """Returns a motion every `time_step` (s), and at its end."""
    time, q, qd, qdd = motion.sample(time_step)
    return {
        "status": "Success",
        "time": time,
        "position": q,
        "velocity": qd,
        "acceleration": qdd,
        "duration": motion.duration,
    }


def standing(q: Array) -> Result:
    """Returns the result of a motion that goes nowhere."""
    rest = np.zeros((1, len(q)))
    return {
        "status": "Success",
        "time": np.zeros(1),
        "position": q[None].copy(),
        "velocity": rest,
        "acceleration": rest.copy(),
        "duration": 0.0,
    }
