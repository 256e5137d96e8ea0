"""The handle at the tip, and how the arm follows it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .._core import pose
from .arm import FOLLOWS, PARTS
from .page import set_value
from .surfaces import wxyz

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .page import Page

_SIZE = 0.2  # of the handle, as a fraction of the arm
_DECIMALS = 4  # m, of the position that is typed


class Handle:
    """A handle that is dragged, turned or typed."""

    def __init__(self, page: Page) -> None:
        """Adds the handle, and the controls of what follows it."""
        self._arm = arm = page.arm
        gui = page.server.gui
        self._gizmo = page.server.scene.add_transform_controls("/target", scale=_SIZE * page.scale, depth_test=False)
        self._position = gui.add_vector3("target [m]", (0.0, 0.0, 0.0), step=0.001)
        self._part = gui.add_dropdown("what counts", PARTS, initial_value=arm.part)
        self._follow = gui.add_dropdown("the arm follows", FOLLOWS, initial_value=arm.follow)
        self._clear = gui.add_checkbox("keep clear", arm.keeps_clear, hint="of obstacles, and of the arm's own links")
        solve = gui.add_button("Solve", hint="jump to a solution, where following comes to no end")
        back = gui.add_button("Handle to the tip")

        @self._gizmo.on_update
        async def _(_: object) -> None:  # in the thread of the server, in order
            target = pose(self._gizmo.position, wxyz=self._gizmo.wxyz)
            page.ask(self._gizmo, lambda: self._drag(target))

        page.on_input(self._position, lambda: self._aim(pose(self._position.value, matrix=arm.target[:3, :3])))
        page.on_input(self._part, lambda: setattr(arm, "part", self._part.value))
        page.on_input(self._follow, lambda: setattr(arm, "follow", self._follow.value))
        page.on_input(self._clear, lambda: setattr(arm, "keeps_clear", self._clear.value))
        page.on_input(solve, arm.solve)
        page.on_input(back, lambda: self._aim(arm.robot.fk(arm.q)))
        self._shown = np.full((4, 4), np.nan)

    def _aim(self, target: NDArray[np.float64]) -> None:
        self._arm.target = target

    def _drag(self, target: NDArray[np.float64]) -> None:
        self._arm.target = self._shown = target  # moved by the hand that holds it, it is not to be moved back

    def refresh(self) -> None:
        """Shows the target and the choices of the arm."""
        target = self._arm.target
        if (target != self._shown).any():
            self._gizmo.position, self._gizmo.wxyz = target[:3, 3], wxyz(target)
            self._shown = target
        if np.abs(np.subtract(self._position.value, target[:3, 3])).max() > 0.5 * 10.0**-_DECIMALS:
            x, y, z = target[:3, 3].round(_DECIMALS).tolist()
            set_value(self._position, (x, y, z))
        set_value(self._part, self._arm.part)
        set_value(self._follow, self._arm.follow)
