"""Trajectories as pandas tables."""

from typing import TYPE_CHECKING

import numpy as np

from .._core import Trajectory
from ..installed.needs import library
from .samples import samples

if TYPE_CHECKING:
    import pandas as pd


def to_dataframe(trajectory: Trajectory, *, dt: float | None = None) -> "pd.DataFrame":
    """Makes a pandas table: index `time` (s), columns `q:joint`, `qd:joint`, `qdd:joint` (rad, m, s).

    Args:
        trajectory: the motion.
        dt: time between rows (s); None: rows at the knots.

    Raises:
        BeetleIkError: pandas is not installed.
    """
    time, q, qd, qdd = samples(trajectory, dt)
    pandas = library("pandas", "pandas", "a table")
    columns = [f"{derivative}:{joint}" for derivative in ("q", "qd", "qdd") for joint in trajectory.joint_names]
    return pandas.DataFrame(np.hstack((q, qd, qdd)), index=pandas.Index(time, name="time"), columns=columns)
