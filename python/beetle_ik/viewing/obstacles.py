"""The obstacles of the page, which visitors add, move and remove."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from .. import obstacles as shapes
from .._core import pose
from ..figures.style import ORANGE, rgb
from .displaced import displaced
from .looks import soup
from .page import set_value
from .sizes import Grip, beside, grips, resized
from .surfaces import wxyz

if TYPE_CHECKING:
    import viser
    from numpy.typing import NDArray

    from .._core import Obstacle
    from .page import Page

_NONE = "none"
_SIZE = 0.15  # size of a new obstacle and of the handle, as a fraction of the arm
_ARROW = 0.08  # size of an arrow that resizes, as a fraction of the arm
_BESIDE = np.array([0.4, 0.4, 0.2])  # position of a new obstacle, as a fraction of the arm
_OPACITY = 0.7
_NEW: dict[str, Callable[[NDArray[np.float64], float], Obstacle]] = {
    "box": lambda center, size: shapes.Box(center, (size, size, size)),
    "sphere": lambda center, size: shapes.Sphere(center, 0.5 * size),
    "cylinder": lambda center, size: shapes.Cylinder(center, (0, 0, 1), 0.5 * size, 2 * size),
}


class Obstacles:
    """Obstacles of the arm in the scene. The chosen obstacle, clicked or selected from a list, has a handle."""

    def __init__(self, page: Page) -> None:
        """Adds the controls; `refresh` draws the obstacles."""
        self._page = page
        gui = page.server.gui
        self._shapes: list[Obstacle] = []
        self._drawn: list[_Drawn] = []
        self._handle: viser.TransformControlsHandle | None = None
        self._grips: list[viser.TransformControlsHandle] = []
        self._list = gui.add_dropdown("chosen", (_NONE,), hint="or click one in the scene")
        page.on_input(self._list, self._choose_from_list)
        page.on_input(gui.add_button("Remove"), self._remove)
        for kind in _NEW:
            page.on_input(gui.add_button(f"Add {kind}"), lambda kind=kind: self._add(kind))  # type: ignore[misc]

    def refresh(self) -> None:
        """Draws the obstacles of the arm if they have changed."""
        if self._page.arm.obstacles is not self._shapes:
            self._draw(self._page.arm.obstacles)

    def show_handles(self, shown: bool) -> None:
        """Shows or hides the handles of the chosen obstacle."""
        for handle in [*([] if self._handle is None else [self._handle]), *self._grips]:
            handle.visible = shown

    def _draw(self, obstacles: list[Obstacle]) -> None:
        self._choose(None)
        for drawn in self._drawn:
            drawn.mesh.remove()
        self._shapes = obstacles
        self._drawn = [self._made(i, each) for i, each in enumerate(obstacles)]
        self._list.options = (_NONE, *(f"{i} {type(each).__name__}" for i, each in enumerate(obstacles)))

    def _made(self, i: int, shape: Obstacle, home: NDArray[np.float64] | None = None) -> _Drawn:
        """Draws obstacle `i`, which a click chooses."""
        drawn = _Drawn(self._page.server.scene, f"/obstacles/{i}", shape, home)

        async def clicked(_: object) -> None:
            self._page.ask(self._list, lambda: self._choose(i))

        drawn.mesh.on_click(clicked)
        return drawn

    def _add(self, kind: str) -> None:
        scale = self._page.scale
        made = _NEW[kind](_BESIDE * scale, _SIZE * scale)
        self._page.arm.obstacles = [*self._page.arm.obstacles, made]
        self.refresh()
        self._choose(len(self._drawn) - 1)

    def _remove(self) -> None:
        if self._chosen is not None:
            self._page.arm.obstacles = [shape for i, shape in enumerate(self._shapes) if i != self._chosen]

    @property
    def _chosen(self) -> int | None:
        name = str(self._list.value)
        return None if name == _NONE else int(name.split()[0])

    def _choose_from_list(self) -> None:
        self._choose(self._chosen)

    def _choose(self, i: int | None) -> None:
        """Gives the handle to obstacle `i`, or to none."""
        for old in [*([] if self._handle is None else [self._handle]), *self._grips]:
            old.remove()
        self._handle, self._grips = None, []
        set_value(self._list, self._list.options[0 if i is None else i + 1])
        if i is None or displaced(self._shapes[i], np.eye(4)) is None:
            return
        place = self._drawn[i].place
        handle = self._handle = self._page.server.scene.add_transform_controls(
            "/obstacle", scale=_SIZE * self._page.scale, depth_test=False, position=place[:3, 3], wxyz=wxyz(place)
        )

        @handle.on_update
        async def _(_: object) -> None:  # runs in the thread of the server, in order
            target = pose(handle.position, wxyz=handle.wxyz)
            self._page.ask(handle, lambda: self._move(i, target))

        self._grips = [self._grip(i, k, grip) for k, grip in enumerate(grips(self._shapes[i]))]

    def _grip(self, i: int, k: int, grip: Grip) -> viser.TransformControlsHandle:
        """Adds the arrow `k`, which resizes obstacle `i` when dragged along itself."""
        handle = self._page.server.scene.add_transform_controls(
            f"/obstacle_size/{k}", scale=_ARROW * self._page.scale, depth_test=False, position=grip.point,
            wxyz=wxyz(_turned(grip.along)), active_axes=(True, False, False), disable_sliders=True,
            disable_rotations=True,
        )  # fmt: skip

        @handle.on_update
        async def _(_: object) -> None:
            point = np.array(handle.position)
            self._page.ask(handle, lambda: self._resize(i, k, point))

        return handle

    def _resize(self, i: int, k: int, point: NDArray[np.float64]) -> None:
        if i >= len(self._drawn):
            return  # removed a moment ago
        old, points = self._drawn[i], grips(self._shapes[i])
        if k >= len(points):
            return
        size = float((point - points[k].middle) @ points[k].along)
        old.mesh.remove()
        self._drawn[i] = self._made(i, resized(old.shape, k, size), old.place)
        self._changed(i, but=k)

    def _changed(self, i: int, but: int | None = None) -> None:
        """Passes the obstacles to the arm, and moves the arrows along, except arrow `but`, which is being dragged."""
        self._shapes = [drawn.shape for drawn in self._drawn]
        self._page.arm.obstacles = self._shapes
        for k, (handle, grip) in enumerate(zip(self._grips, grips(self._shapes[i]), strict=True)):
            if k != but:
                handle.position, handle.wxyz = grip.point, wxyz(_turned(grip.along))

    def _move(self, i: int, place: NDArray[np.float64]) -> None:
        if i >= len(self._drawn):
            return  # removed a moment ago
        self._drawn[i].move(place)
        self._changed(i)


class _Drawn:
    """An obstacle in the scene.

    Attributes:
        shape: the obstacle at its present position.
        place: present pose of its handle (4, 4).
    """

    def __init__(
        self, scene: viser.SceneApi, name: str, shape: Obstacle, home: NDArray[np.float64] | None = None
    ) -> None:
        """Draws the obstacle; its handle is at the pose `home` (4, 4), or in its middle for None."""
        self._first = self.shape = shape
        corners = shape.triangles
        if home is None:
            home = pose(0.5 * (corners.min(axis=(0, 1)) + corners.max(axis=(0, 1))))
        self._home = self.place = home
        self.mesh = scene.add_mesh_simple(
            name, *soup((corners - home[:3, 3]) @ home[:3, :3]), position=home[:3, 3], wxyz=wxyz(home),
            color=rgb(ORANGE), opacity=_OPACITY, flat_shading=True, side="double",
        )  # fmt: skip

    def move(self, place: NDArray[np.float64]) -> None:
        """Moves the obstacle with its handle."""
        shape = displaced(self._first, place @ np.linalg.inv(self._home))
        if shape is not None:
            self.shape, self.place = shape, place
            self.mesh.position, self.mesh.wxyz = place[:3, 3], wxyz(place)


def _turned(along: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns a rotation (3, 3) that turns the x axis to a direction."""
    side = beside(along)
    return np.column_stack((along, side, np.cross(along, side)))
