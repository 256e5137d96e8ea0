"""Handles at the tips, and the mode of following them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .._core import pose
from .arm import FOLLOWS, PARTS
from .page import set_value
from .surfaces import node_name, wxyz

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .page import Page

_SIZE = 0.2  # size of a handle, as a fraction of the arm
_DECIMALS = 4  # decimals of a typed position (m)


class Handles:
    """Handles of all tips, and their common controls."""

    def __init__(self, page: Page) -> None:
        """Adds the handles, and the controls of the arm that follows them."""
        self._arm = arm = page.arm
        gui = page.server.gui
        self._handles = [_Handle(page, tip) for tip in arm.targets]
        self._part = gui.add_dropdown("what counts", PARTS, initial_value=arm.part)
        self._follow = gui.add_dropdown("the arm follows", FOLLOWS, initial_value=arm.follow)
        self._clear = gui.add_checkbox("keep clear", arm.keeps_clear, hint="of obstacles, and of the arm's own links")
        solve = gui.add_button("Solve", hint="jump to a solution, where following comes to no end")
        back = gui.add_button("Handle to the tip" if len(self._handles) == 1 else "Handles to the tips")
        page.on_input(self._part, lambda: setattr(arm, "part", self._part.value))
        page.on_input(self._follow, lambda: setattr(arm, "follow", self._follow.value))
        page.on_input(self._clear, lambda: setattr(arm, "keeps_clear", self._clear.value))
        page.on_input(solve, arm.solve)
        page.on_input(back, lambda: setattr(arm, "targets", arm.tips_at(arm.q)))

    def refresh(self) -> None:
        """Shows the targets and the choices of the arm."""
        for handle in self._handles:
            handle.refresh()
        set_value(self._part, self._arm.part)
        set_value(self._follow, self._arm.follow)

    def show_handles(self, shown: bool) -> None:
        """Shows or hides the handles."""
        for handle in self._handles:
            handle.gizmo.visible = shown


class _Handle:
    """The handle of one tip, which is dragged, turned or typed.

    Attributes:
        gizmo: the arrows, squares and arcs.
    """

    def __init__(self, page: Page, tip: str) -> None:
        """Adds the handle, and the numbers of its position."""
        self._arm, self._tip = page.arm, tip
        scene, only = page.server.scene, len(page.arm.targets) == 1
        name = "/target" if only else f"/target/{node_name(tip)}"
        self.gizmo = scene.add_transform_controls(name, scale=_SIZE * page.scale, depth_test=False)
        if not only:
            scene.add_label(f"{name}/name", tip)
        label = "target [m]" if only else f"{tip} [m]"
        self._position = page.server.gui.add_vector3(label, (0.0, 0.0, 0.0), step=0.001)
        self._shown = np.full((4, 4), np.nan)

        @self.gizmo.on_update
        async def _(_: object) -> None:  # runs in the thread of the server, in order
            target = pose(self.gizmo.position, wxyz=self.gizmo.wxyz)
            page.ask(self.gizmo, lambda: self._drag(target))

        page.on_input(self._position, self._type)

    def _drag(self, target: NDArray[np.float64]) -> None:
        self._shown = target  # the handle already shows the dragged target
        self._arm.aim(self._tip, target)

    def _type(self) -> None:
        self._arm.aim(self._tip, pose(self._position.value, matrix=self._arm.targets[self._tip][:3, :3]))

    def refresh(self) -> None:
        """Shows the target of the tip."""
        target = self._arm.targets[self._tip]
        if (target != self._shown).any():
            self.gizmo.position, self.gizmo.wxyz = target[:3, 3], wxyz(target)
            self._shown = target
        if np.abs(np.subtract(self._position.value, target[:3, 3])).max() > 0.5 * 10.0**-_DECIMALS:
            x, y, z = target[:3, 3].round(_DECIMALS).tolist()
            set_value(self._position, (x, y, z))
