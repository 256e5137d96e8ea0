"""The figure of a calibration: errors by measurement, and their distribution."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .style import BLUE, ORANGE, VERMILION, new_figure, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .._core import Calibration

_SIZE = (9.0, 3.4)  # inches
_MILLIMETRES = 1e3


def draw(result: Calibration) -> Figure:
    """Draws errors before and after by measurement, and the part of measurements below each error."""
    unit, factor = (result.unit, 1.0) if result.unit == "pixels" else ("mm", _MILLIMETRES)
    before, after = factor * result.errors_before, factor * result.errors_after
    kept = np.ones(len(after), bool)
    kept[result.outliers] = False
    with style():
        figure = new_figure(*_SIZE)
        rows, parts = figure.subplots(1, 2, width_ratios=(2, 1))
        number = np.arange(len(after))
        rows.semilogy(number, before, "o", ms=3.5, color=ORANGE, label="before")
        rows.semilogy(number[kept], after[kept], "o", ms=3.5, color=BLUE, label="after")
        if result.outliers:
            rows.semilogy(number[~kept], after[~kept], "x", color=VERMILION, label="after, left out")
        rows.axhline(factor * result.rms_held_out, color=BLUE, linestyle="--", linewidth=1, label="held out, rms")
        rows.set(xlabel="measurement", ylabel=f"error [{unit}]")
        rows.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize="small")
        for values, color in ((before[kept], ORANGE), (after[kept], BLUE)):
            parts.step(np.sort(values), np.arange(1, values.size + 1) / values.size, where="post", color=color)
        parts.set(xscale="log", xlabel=f"error [{unit}]", ylabel="part of measurements")
    return figure
