"""Reference paths: the desired tip position as a function of time."""

from ._core import (
    circle,
    from_function,
    from_samples,
    hypotrochoid,
    letter_m,
    pentagram,
    polyline,
    rose,
)

__all__ = [
    "circle",
    "from_function",
    "from_samples",
    "hypotrochoid",
    "letter_m",
    "pentagram",
    "polyline",
    "rose",
]
