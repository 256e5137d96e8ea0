"""Reference paths from the command line: a built-in curve with its parameters, or points from a file."""

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import InvalidInputError, Robot, paths
from .. import Path as ReferencePath
from ..files.csv_table import read_table

_DEFAULT_DURATION = 30.0  # s, as in the circle of the BAS paper


class CurveName(StrEnum):
    """Built-in curves by their names on the command line."""

    CIRCLE = "circle"
    HYPOTROCHOID = "hypotrochoid"
    LETTER_M = "letter-m"
    PENTAGRAM = "pentagram"
    ROSE = "rose"


@dataclass(frozen=True)
class _Curve:
    make: Callable[..., ReferencePath]
    lengths: dict[str, float]  # fractions of the arm's stretched length
    others: dict[str, Any] = field(default_factory=dict)


_CURVES = {
    CurveName.CIRCLE: _Curve(paths.circle, {"diameter": 0.1}),
    CurveName.HYPOTROCHOID: _Curve(paths.hypotrochoid, {"outer_radius": 0.05, "inner_radius": 0.03, "distance": 0.03}),
    CurveName.LETTER_M: _Curve(paths.letter_m, {"width": 0.1, "height": 0.1}),
    CurveName.PENTAGRAM: _Curve(paths.pentagram, {"radius": 0.05}),
    CurveName.ROSE: _Curve(paths.rose, {"radius": 0.05}, {"k": 3}),
}
# The x-y plane, in which planar arms move.
_PLANE = {"a": (1.0, 0.0, 0.0), "b": (0.0, 1.0, 0.0)}
_PLACES_TRIED = 1000
_FULL_RANK = 1e-9


def make_curve(name: CurveName, robot: Robot, duration: float | None, given: dict[str, Any]) -> ReferencePath:
    """Makes the curve `name` with the given parameters; the others get defaults that suit the robot."""
    curve = _CURVES[name]
    parameters = ("center", *curve.lengths, *curve.others, "a", "b")
    for parameter in given:
        if parameter not in parameters:
            takes = ", ".join(_option(p) for p in parameters)
            raise InvalidInputError(f"{_option(parameter)} does not belong to the curve '{name}', which takes {takes}")
    center, arm_length = _agile_place(robot)
    lengths = {length: share * arm_length for length, share in curve.lengths.items()}
    defaults = {"center": center, **lengths, **curve.others, **_PLANE}
    return curve.make(**(defaults | given), duration=_DEFAULT_DURATION if duration is None else duration)


def _agile_place(robot: Robot) -> tuple[NDArray[np.float64], float]:
    """Returns the tip position (m) at the most manipulable of many random configurations, and the arm's length (m).

    Directions in which no configuration moves the tip, for example out of a planar arm's plane, do not count.
    """
    configurations = robot.random_configurations(_PLACES_TRIED)
    gains = np.linalg.svd(robot.jacobian(configurations), compute_uv=False)
    rank = (gains > _FULL_RANK).sum(axis=1).max()
    origins = robot.link_poses(configurations[gains[:, :rank].prod(axis=1).argmax()])[:, :3, 3]
    return origins[-1], float(np.linalg.norm(np.diff(origins, axis=0), axis=1).sum())


def read_points(file: Path, duration: float | None) -> ReferencePath:
    """Reads a path from a CSV file: columns x, y, z (m) and, optionally, time (s)."""
    table = read_table(file, ["x", "y", "z"])
    points = np.column_stack([table[axis] for axis in "xyz"])
    if "time" not in table:
        return paths.polyline(points, _DEFAULT_DURATION if duration is None else duration)
    if duration is not None:
        raise InvalidInputError(
            f"--duration: '{file}' has a column 'time', which sets the duration; leave one of them out"
        )
    return paths.from_samples(table["time"], points)


def _option(parameter: str) -> str:
    return "--" + parameter.replace("_", "-")
