"""A reachability map on the page: a slice or all of it, with a legend."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .._core import InvalidInputError
from ..figures.style import BLUE, ORANGE, rgb
from ..mapping.map_figure import cloud
from .page import set_value
from .surfaces import wxyz

if TYPE_CHECKING:
    import viser
    from numpy.typing import NDArray

    from ..mapping import ReachabilityMap
    from .page import Page

    Array = NDArray[np.float64]

_SLICES = ("x", "y", "z")  # the axis across the slice
_ALL = "all"
_DOT = 0.25  # size of a dot, as a fraction of a voxel
_OPACITY = 160  # opacity of a slice, of 255
_PIXELS = 12  # pixels of a voxel, for sharp edges
_LEGEND = (
    "<div style='padding:0 1em;font-size:0.85em'>orientations reached, of {orientations}"
    f"<div style='height:0.7em;background:linear-gradient(to right,{BLUE},{ORANGE})'></div>"
    "<div style='display:flex;justify-content:space-between'><span>few</span><span>50 %</span><span>100 %</span></div>"
    "</div>"
)


class Reach:
    """The reached voxels, blue for few orientations and orange for all."""

    def __init__(self, page: Page) -> None:
        """Adds the controls, hidden until there is a map."""
        self._page = page
        self._map: ReachabilityMap | None = None
        self._drawn: viser.SceneNodeHandle | None = None
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
        """Shows a map in place of the previous one: the slice across y through the base.

        Raises:
            InvalidInputError: the map is of another robot.
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

    @property
    def bounds(self) -> list[tuple[Array, Array]]:
        """Least and greatest coordinates (3,) of the voxels shown; empty without any."""
        found = self._map
        if found is None or self._drawn is None:
            return []
        points, _ = cloud(found)
        low, high = points.min(axis=0), points.max(axis=0)
        if self._across.value != _ALL:
            axis = _SLICES.index(self._across.value)
            low[axis] = high[axis] = self._at.value
        return [(low, high)]

    def _cut(self) -> None:
        """Puts the slice through the base, or through the middle of a map that does not contain the base."""
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
        self._remove()
        if self._across.value != _ALL:
            self._drawn = self._slice(found, _SLICES.index(self._across.value))
            return
        points, share = cloud(found)
        self._drawn = self._page.server.scene.add_point_cloud(
            "/map", points.astype(np.float32), _colors(share), point_size=_DOT * found.voxel, point_shape="circle"
        )

    def _slice(self, found: ReachabilityMap, axis: int) -> viser.SceneNodeHandle:
        """Draws the layer of voxels at the slider as a translucent image: the arm stands in it."""
        layer = int(np.floor((self._at.value - found.origin[axis]) / found.voxel))
        layer = min(max(layer, 0), found.index.shape[axis] - 1)
        share = np.take(found.index, layer, axis=axis).T[::-1]  # rows from above, columns from the left
        image = np.dstack((_colors(share), np.where(share > 0, _OPACITY, 0).astype(np.uint8)))
        sharp = image.repeat(_PIXELS, axis=0).repeat(_PIXELS, axis=1)
        middle = found.origin + 0.5 * found.voxel * np.array(found.index.shape)
        middle[axis] = found.origin[axis] + found.voxel * (layer + 0.5)
        right, up = np.delete(np.eye(3), axis, axis=0)
        height, width = (found.voxel * n for n in share.shape)
        # Turns the image: viser gives it the frame of a camera, whose y axis points down.
        return self._page.server.scene.add_image(
            "/map", sharp, width, height, format="png", cast_shadow=False, receive_shadow=False, position=middle,
            wxyz=wxyz(np.column_stack((right, -up, np.cross(right, -up)))),
        )  # fmt: skip

    def _remove(self) -> None:
        if self._drawn is not None:
            self._drawn.remove()
            self._drawn = None

    def _hide(self) -> None:
        self._folder.visible = False
        self._remove()


def _colors(share: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Returns a colour (..., 3) for each fraction of reached orientations."""
    low, high = (np.array(rgb(color)) for color in (BLUE, ORANGE))
    return np.asarray(low + share[..., None] * (high - low)).astype(np.uint8)
