"""Reference paths from the command line: a built-in curve with its parameters, or points from a file."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any

import numpy as np

from .. import InvalidInputError, paths
from .. import Path as ReferencePath
from .._csv import read_table

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
    defaults: dict[str, Any]


# Sized and placed for arms with about a metre of reach; the circle is that of the BAS paper for the iiwa 14.
_PLACE = (0.3, 0.3, 1.0)
_CURVES = {
    CurveName.CIRCLE: _Curve(paths.circle, {"center": _PLACE, "diameter": 0.2}),
    CurveName.HYPOTROCHOID: _Curve(
        paths.hypotrochoid, {"center": _PLACE, "outer_radius": 0.1, "inner_radius": 0.06, "distance": 0.06}
    ),
    CurveName.LETTER_M: _Curve(paths.letter_m, {"center": (0.4, 0.25, 0.75), "width": 0.3, "height": 0.3}),
    CurveName.PENTAGRAM: _Curve(paths.pentagram, {"center": _PLACE, "radius": 0.1}),
    CurveName.ROSE: _Curve(paths.rose, {"center": _PLACE, "radius": 0.1, "k": 3}),
}


def make_curve(name: CurveName, duration: float | None, given: dict[str, Any]) -> ReferencePath:
    """The curve `name` with the parameters that were given and defaults for the others."""
    curve = _CURVES[name]
    for parameter in given:
        if parameter not in (*curve.defaults, "a", "b"):
            takes = ", ".join(_option(p) for p in (*curve.defaults, "a", "b"))
            raise InvalidInputError(f"{_option(parameter)} does not belong to the curve '{name}', which takes {takes}")
    return curve.make(**(curve.defaults | given), duration=_DEFAULT_DURATION if duration is None else duration)


def read_points(file: Path, duration: float | None) -> ReferencePath:
    """The path through the points of a CSV file: columns x, y, z (m) and, optionally, time (s)."""
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
