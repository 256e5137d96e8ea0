"""Joint values over time, a line for each joint."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .style import line

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

ROW_HEIGHT = 2.4  # inches per panel over time
_LEGEND_ROWS = 10


def draw_joints(axes: Axes, time: NDArray[np.float64], values: NDArray[np.float64], names: Sequence[str]) -> None:
    """Draws the columns of `values` (k, n) over `time` (k,)."""
    for j, name in enumerate(names):
        axes.plot(time, values[:, j], label=name, **line(j))


def legend_columns(names: Sequence[str]) -> int:
    """Returns the number of columns of a legend with these names."""
    return -(-len(names) // _LEGEND_ROWS)
