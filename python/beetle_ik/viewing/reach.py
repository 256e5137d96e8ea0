"""A map of reach: a slice of it, or all of it, with a legend."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from .._core import InvalidInputError
from .._style import BLUE, ORANGE, rgb
from ..mapping.map_figure import cloud
from .page import set_value

if TYPE_CHECKING:
    import viser

    from ..mapping import ReachabilityMap
    from .page import Page

_SLICES = ("x", "y", "z")  # the axis across the slice
_ALL = "all"
_DOT, _TILE = 0.25, 0.95  # sizes of a point, of all and of a slice, as fractions of a voxel
_ROUND: Literal["circle"] = "circle"
_SQUARE: Literal["square"] = "square"
_LEGEND = (
    "<div style='padding:0 1em;font-size:0.85em'>orientations reached, of {orientations}"
    f"<div style='height:0.7em;background:linear-gradient(to right,{BLUE},{ORANGE})'></div>"
    "<div style='display:flex;justify-content:space-between'><span>few</span><span>50 %</span><span>100 %</span></div>"
    "</div>"
)


class Reach:
    """The voxels that are reached, blue where few orientations are and orange where all are."""

    def __init__(self, page: Page) -> None:
        """Adds the controls, hidden until there is a map."""
        self._page = page
        self._map: ReachabilityMap | None = None
        self._points: viser.PointCloudHandle | None = None
        gui = page.server.gui
        self._folder = gui.add_folder("Reach", visible=False)
        with self._folder:
            self._legend = gui.add_html("")
            self._across = gui.add_dropdown("slice across", (*_SLICES, _ALL), initial_value="y")
            self._at = gui.add_slider("at [m]", min=-1.0, max=1.0, step=0.001, initial_value=0.0)
            hide = gui.add_button("Hide the map")
        page.on_input(self._across, self._cut)
        page.on_input(self._at, self._draw)
        page.on_input(hide, self._hide)

    def show(self, found: ReachabilityMap) -> None:
        """Shows a map in place of the last one: the slice across y through the base.

        Raises:
            InvalidInputError: it is a map of another robot.
        """
        mapped, shown = found.robot.name, self._page.arm.robot.name
        if mapped != shown:
            raise InvalidInputError(f"result is a map of robot '{mapped}', not of '{shown}'")
        self._map = found
        self._legend.content = _LEGEND.format(orientations=found.orientations)
        flat = min(found.index.shape) == 1
        set_value(self._across, _ALL if flat else "y")
        self._folder.visible = True
        self._cut()

    def _cut(self) -> None:
        """Puts the slice through the base, or through the middle of the map if the base is beside it."""
        found = self._map
        assert found is not None, "the controls are hidden until there is a map"
        self._at.visible = self._across.value != _ALL
        if self._at.visible:
            axis = _SLICES.index(self._across.value)
            low, high = found.origin[axis], found.origin[axis] + found.voxel * found.index.shape[axis]
            self._at.step = 0.001
            self._at.min, self._at.max = float(low), float(high)
            set_value(self._at, 0.0 if low <= 0.0 <= high else float(0.5 * (low + high)))
        self._draw()

    def _draw(self) -> None:
        found = self._map
        assert found is not None, "the controls are hidden until there is a map"
        points, share = cloud(found)
        shape: Literal["circle", "square"]
        dot, shape = _DOT, _ROUND
        if self._across.value != _ALL:
            axis = _SLICES.index(self._across.value)
            layer = np.floor((self._at.value - found.origin[axis]) / found.voxel)
            layer = min(max(layer, 0), found.index.shape[axis] - 1)
            kept = np.abs(points[:, axis] - (found.origin[axis] + found.voxel * (layer + 0.5))) < 0.25 * found.voxel
            points, share, dot, shape = points[kept], share[kept], _TILE, _SQUARE
        low, high = (np.array(rgb(color)) for color in (BLUE, ORANGE))
        colors = (low + share[:, None] * (high - low)).astype(np.uint8)
        self._points = self._page.server.scene.add_point_cloud(
            "/map", points.astype(np.float32), colors, point_size=dot * found.voxel, point_shape=shape
        )

    def _hide(self) -> None:
        self._folder.visible = False
        if self._points is not None:
            self._points.remove()
            self._points = None
