"""The figure that plots return."""

import io

from matplotlib.figure import Figure


class PlotFigure(Figure):
    """A figure that only its caller keeps: pyplot's list, which holds figures until they are closed, is without it."""

    def _repr_png_(self) -> bytes:
        """How notebooks show a figure that pyplot does not show for them."""
        picture = io.BytesIO()
        self.savefig(picture, format="png")
        return picture.getvalue()
