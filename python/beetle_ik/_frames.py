"""What moves in a figure, apart from the figure itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True)
class Frames:
    """A moving picture: one thing moves, all else in the figure stands still."""

    moving: Artist
    show: Callable[[int], None]
    """Puts what moves where it is in the frame of this number, from 0."""
    count: int
    rate: int
    """Frames a second."""

    def animation(self, figure: Figure) -> FuncAnimation:
        """The same as matplotlib has it."""
        from matplotlib.animation import FuncAnimation

        def draw(frame: int) -> tuple[Artist]:
            self.show(frame)
            return (self.moving,)

        return FuncAnimation(figure, draw, frames=self.count, interval=1e3 / self.rate)
