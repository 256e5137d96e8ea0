"""Logarithmic axes, labelled in plain text.

Matplotlib sets every power of ten as a formula and marks each axis with up to eight ticks a decade. Together these
took a third of the time of a figure, and on an axis of less than two decades the labels left little to read.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .numbers import brief, superscript

if TYPE_CHECKING:
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

# Bounds on the upper over the lower end of an axis.
_NARROW = 60.0  # below this, powers of ten alone are too few labels
_WIDE = 1000.0  # above this, powers of ten are enough


def label_log_axes(figure: Figure) -> None:
    """Labels the logarithmic axes of a finished drawing, except axes with ticks of their own."""
    from matplotlib.ticker import LogFormatterSciNotation

    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if isinstance(axis.get_major_formatter(), LogFormatterSciNotation):
                _label(axis)


def _label(axis: Axis) -> None:
    from matplotlib.ticker import LogLocator, NullLocator

    low, high = sorted(axis.get_view_interval())
    if high <= _NARROW * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(lambda value, _: brief(value))
    else:
        axis.set_major_formatter(lambda value, _: f"10{superscript(round(np.log10(value)))}")
    if high <= _NARROW * low or high >= _WIDE * low:
        axis.set_minor_locator(NullLocator())
