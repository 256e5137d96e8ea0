"""Figures for reports: the package's style, and the few things that most of them need."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from .._style import FORBIDDEN, VERMILION, line, style
from .log_axes import label_log_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

WIDTH = 9.0  # inches: the width of the page


@contextmanager
def drawing(height: float, width: float = WIDTH) -> Iterator[Figure]:
    """A figure of this size (inches) to draw on, in the style of the package.

    with drawing(3.0) as figure:
        axes = figure.subplots()
    """
    from matplotlib.figure import Figure

    with style():
        figure = Figure(figsize=(width, height), layout="constrained")
        yield figure
        label_log_axes(figure)


def draw_error(axes: Axes, time: ArrayLike, error: ArrayLike, *, band: float | None = None, **line: Any) -> None:
    """An error (m) over time (s) on a logarithmic scale, with its tolerance as a dashed line."""
    axes.semilogy(time, error, **line)
    if band is not None:
        axes.axhline(band, color=VERMILION, linestyle="--", linewidth=1.0, label="error band")
    axes.set_ylabel("position error [m]")


def draw_velocities(
    axes: Axes, time: NDArray[np.float64], velocity: NDArray[np.float64], limit: ArrayLike, *, linewidth: float = 0.9
) -> None:
    """Joint velocities (k, n) in rad/s over time; shaded is what lies beyond `limit`: a number, or (k,)."""
    for j, joint in enumerate(velocity.T):
        axes.plot(time, joint, label=f"joint {j + 1}", linewidth=linewidth, **line(j))
    bound = np.broadcast_to(np.asarray(limit, dtype=float), time.shape)
    if np.isfinite(bound).all():
        top = 1.15 * bound.max()
        axes.fill_between(time, bound, top, color=FORBIDDEN, linewidth=0)
        axes.fill_between(time, -bound, -top, color=FORBIDDEN, linewidth=0)
        axes.set_ylim(-top, top)
    axes.set_ylabel("joint velocity [rad/s]")
