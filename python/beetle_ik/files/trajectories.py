"""Writes trajectories to files and reads them.

npz stores the polynomial segments themselves. CSV stores samples at the knots, with the derivatives that determine the
segments: positions for degree 1, velocities too up to degree 3, accelerations too up to degree 5 or where they are
continuous. Samples at knots do not determine segments of degree 6 with jumps of the acceleration, which `time_optimal`
produces: CSV then stores positions and velocities, and reads back as cubics.
"""

import os

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInputError, Trajectory
from ..calls.text import listed
from .csv_table import read_table, write_table
from .derivatives import has_continuous_acceleration
from .npz import read_arrays, with_ending
from .whole import whole_file

# Columns are named "q:joint", "qd:joint", "qdd:joint": position, velocity and acceleration of each joint.
_DERIVATIVES = ("q", "qd", "qdd")
_QUINTIC = 5
_PREFIXES = tuple(f"{derivative}:" for derivative in _DERIVATIVES)


def to_csv(trajectory: Trajectory, file: str | os.PathLike[str], dt: float | None = None) -> None:
    """Writes samples as CSV: time (s), then positions and the derivatives that the trajectory's degree needs.

    Args:
        trajectory: the motion.
        file: the file to write; it appears complete or not at all.
        dt: time between samples (s); the end is always included. None: samples at the knots.
    """
    degree = trajectory.coefficients.shape[2] - 1
    count = max(degree, 1) // 2 + 1 if degree <= _QUINTIC else 2
    if degree > 1 and has_continuous_acceleration(trajectory):
        count = len(_DERIVATIVES)
    kept = _DERIVATIVES[:count]
    knots = trajectory.time, trajectory.q, trajectory.qd, trajectory.qdd
    time, *samples = knots if dt is None else trajectory.sample(dt)
    columns = ["time", *(f"{derivative}:{joint}" for derivative in kept for joint in trajectory.joint_names)]
    write_table(file, columns, np.column_stack((time, *samples[: len(kept)])))


def from_csv(file: str | os.PathLike[str]) -> Trajectory:
    """Reads a trajectory from CSV; the columns present decide the degree of its segments.

    Positions are in columns `q:joint`. In a file without such columns, every column but `time` is a joint.

    Raises:
        InvalidInputError: a column is missing or an entry is not a number; the message gives line and column.
    """
    table = read_table(file, ["time"])
    joints, q = joint_positions(file, table)
    qd, qdd = (_joint_columns(file, table, derivative, joints) for derivative in _DERIVATIVES[1:])
    return Trajectory.from_samples(table["time"], q, qd=qd, qdd=qdd, joint_names=joints)


def joint_positions(
    file: str | os.PathLike[str], table: dict[str, NDArray[np.float64]]
) -> tuple[list[str], NDArray[np.float64]]:
    """Returns joint names and positions (k, n), from columns `q:joint` or else from columns named after the joints.

    Raises:
        InvalidInputError: no such columns.
    """
    columns = {column.removeprefix("q:"): column for column in table if column.startswith("q:")}
    if not columns:
        columns = {column: column for column in table if column != "time" and not column.startswith(_PREFIXES)}
    if not columns:
        raise InvalidInputError(
            f"{os.fspath(file)}, line 1: no joint positions: expected a column for each joint, "
            f"named 'q:joint' or 'joint'; columns found: {listed(table)}"
        )
    return list(columns), np.column_stack([table[column] for column in columns.values()])


def _joint_columns(
    file: str | os.PathLike[str], table: dict[str, NDArray[np.float64]], derivative: str, joints: list[str]
) -> NDArray[np.float64] | None:
    """Returns the columns of one derivative, or None if the file has none of them."""
    columns = [f"{derivative}:{joint}" for joint in joints]
    present = [column for column in columns if column in table]
    if not present:
        return None
    for column in columns:
        if column not in table:
            raise InvalidInputError(
                f"{os.fspath(file)}, line 1: column '{column}' is missing, though '{present[0]}' is there"
            )
    return np.column_stack([table[column] for column in columns])


def to_npz(trajectory: Trajectory, file: str | os.PathLike[str]) -> None:
    """Writes the trajectory's knots, coefficients and joint names as npz; a name without ending gets .npz."""
    with whole_file(with_ending(file)) as stream:
        np.savez(
            stream,
            time=trajectory.time,
            coefficients=trajectory.coefficients,
            joint_names=np.array(trajectory.joint_names, dtype=np.str_),
        )


def from_npz(file: str | os.PathLike[str]) -> Trajectory:
    """Reads a trajectory that `to_npz` wrote.

    Raises:
        InvalidInputError: the file is not an npz file or is damaged, an array is too large for the memory, or an array
            of a trajectory is missing; the message names it.
        FileNotFoundError, PermissionError, IsADirectoryError: there is no such file, or it may not be read.
    """
    stored = read_arrays(file)
    for name in ("time", "coefficients", "joint_names"):
        if name not in stored:
            raise InvalidInputError(
                f"{os.fspath(file)}: not a trajectory: '{name}' is missing; "
                f"the file holds: {listed(stored) or 'nothing'}"
            )
    joint_names = stored["joint_names"]
    if joint_names.ndim != 1 or joint_names.dtype.kind != "U":
        raise InvalidInputError(
            f"{os.fspath(file)}: not a trajectory: 'joint_names' must be a list of text, "
            f"got shape {joint_names.shape} of {joint_names.dtype}"
        )
    return Trajectory(stored["time"], stored["coefficients"], joint_names=joint_names.tolist())
