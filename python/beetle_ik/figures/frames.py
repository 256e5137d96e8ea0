"""Animation frames, separate from the figure that they are drawn in."""

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
    """An animation in which one artist moves and the rest of the figure stays."""

    moving: Artist
    show: Callable[[int], None]
    """Moves the artist to its place in the given frame, counted from 0."""
    count: int
    rate: int
    """Frames per second."""

    def animation(self, figure: Figure) -> FuncAnimation:
        """Returns the frames as a matplotlib animation."""
        from matplotlib.animation import FuncAnimation

        def draw(frame: int) -> tuple[Artist]:
            self.show(frame)
            return (self.moving,)

        return FuncAnimation(figure, draw, frames=self.count, interval=1e3 / self.rate)
