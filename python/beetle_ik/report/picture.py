"""Figures as files: PNG, and GIF for animations."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

    from ..figures.frames import Frames


def png(drawing: Drawing, dpi: int) -> bytes:
    """Returns the drawing as PNG, without metadata: the same figure gives the same bytes."""
    file = io.BytesIO()
    _canvas(drawing, dpi).print_png(file, metadata={"Software": None})
    return file.getvalue()


def gif(drawing: Drawing, frames: Frames, dpi: int) -> bytes:
    """Returns all frames as a looped GIF. The static part is drawn once."""
    from PIL import Image

    canvas, moving = _canvas(drawing, dpi), frames.moving
    moving.set_visible(False)
    canvas.draw()
    still = canvas.copy_from_bbox(drawing.bbox)
    moving.set_visible(True)
    pictures: list[Any] = []
    for i in range(frames.count):
        canvas.restore_region(still)
        frames.show(i)
        moving.draw(canvas.get_renderer())
        picture = Image.frombytes("RGBA", canvas.get_width_height(), bytes(canvas.buffer_rgba())).convert("RGB")
        pictures.append(picture.quantize(method=Image.Quantize.FASTOCTREE))
    file = io.BytesIO()
    pictures[0].save(file, "gif", save_all=True, append_images=pictures[1:], duration=round(1e3 / frames.rate), loop=0)
    return file.getvalue()


def _canvas(drawing: Drawing, dpi: int) -> Any:
    """Returns a canvas for the drawing, laid out once: savefig would repeat the layout for every frame."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    drawing.set_dpi(dpi)
    layout = drawing.get_layout_engine()
    if layout is not None:
        layout.execute(drawing)
        drawing.set_layout_engine("none")
    return FigureCanvasAgg(drawing)
