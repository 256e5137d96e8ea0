"""The common style of all figures: palette and sizes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ..installed.needs import library

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Okabe and Ito's palette, which colour-blind readers can tell apart too; its yellow is too faint for lines on white.
BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK = PALETTE = (
    "#0072B2",
    "#D55E00",
    "#009E73",
    "#CC79A7",
    "#E69F00",
    "#56B4E9",
    "#000000",
)
FORBIDDEN = "#D9D9D9"  # shade of regions beyond a limit
LINKS = ("#E9EBEE", "#9FB3C8")  # alternating colours of link meshes
_DASHES = ("-", "--", ":", "-.")


def rgb(color: str) -> tuple[int, int, int]:
    """Returns a colour, for example "#0072B2", as three numbers from 0 to 255."""
    red, green, blue = bytes.fromhex(color.removeprefix("#"))
    return red, green, blue


def line(i: int) -> dict[str, Any]:
    """Returns colour and dash pattern of line `i`; when the colours repeat, the dash pattern changes."""
    return {"color": PALETTE[i % len(PALETTE)], "linestyle": _DASHES[i // len(PALETTE) % len(_DASHES)]}


@contextmanager
def style() -> Iterator[None]:
    """Applies the common style to figures made inside the block."""
    mpl = library("matplotlib", "matplotlib", "a figure", extra="plot")
    settings: dict[str, Any] = {
        "axes.grid": True,
        "axes.spines.right": False,
        "axes.spines.top": False,
        "axes.titlesize": "medium",
        "axes.titley": 1.0,  # just above; to see whether it must be higher, matplotlib measures all labels again
        "figure.labelsize": "medium",
        "font.size": 9.5,
        "grid.alpha": 0.3,
        "legend.frameon": False,
        "lines.linewidth": 1.3,
    }
    with mpl.rc_context(settings):
        yield


def new_figure(width: float, height: float) -> Figure:
    """Makes a figure of this size (inches) that `matplotlib.pyplot.show()` displays."""
    import matplotlib.pyplot as plt

    return plt.figure(figsize=(width, height), layout="constrained", dpi=120)
