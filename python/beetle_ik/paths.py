"""Reference paths: where the tip should be at which time."""

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
