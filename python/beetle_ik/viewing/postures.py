"""Other postures for the same target, and the velocity ellipsoid of the tip."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .._core import self_motion, solve_all
from ..calls.text import counted
from ..figures.style import GREEN, rgb
from .arm import QUICKLY
from .page import set_value
from .surfaces import Links, wxyz

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .page import Page

_MOST = 32  # largest number of ghosts
_ELLIPSOID = 0.15  # s: scale of the ellipsoid, the travel of the tip in this time at unit joint speeds
_FLAT = 1e-3  # thickness of the ellipsoid along a lost direction


class Postures:
    """All solutions as ghosts, the self-motion, and the velocity ellipsoid of the tip."""

    def __init__(self, page: Page, links: Links) -> None:
        """Adds the controls."""
        self._page, self._links = page, links
        gui = page.server.gui
        find = gui.add_button("Show all solutions")
        self._text = gui.add_markdown("")
        self._solution = gui.add_slider("solution", min=0, max=1, step=1, initial_value=0, visible=False)
        hide = gui.add_button("Hide them")
        one = len(page.arm.targets) == 1  # the controls below are for one tip
        follow = gui.add_button("Find the self-motion", visible=one, hint="postures that keep the tip at the target")
        self._along = gui.add_slider("self-motion", min=0, max=1, step=1, initial_value=0, visible=False)
        self._wanted = gui.add_checkbox("velocity ellipsoid of the tip", False, visible=one)
        self._ellipsoid = page.server.scene.add_icosphere("/ellipsoid", color=rgb(GREEN), opacity=0.4, visible=False)
        self._solutions: NDArray[np.float64] = np.empty((0, page.arm.robot.dof))
        self._curve = self._solutions
        page.on_input(find, self._show_all)
        page.on_input(hide, self._hide)
        page.on_input(follow, self._find_self_motion)
        page.on_input(self._solution, lambda: self._put(self._solutions, self._solution.value))
        page.on_input(self._along, lambda: self._put(self._curve, self._along.value))
        page.on_input(self._wanted, lambda: None)

    def show_ghosts(self, q: NDArray[np.float64], text: str) -> None:
        """Shows configurations (k, n) as ghosts, with a slider to choose one."""
        self._solutions = q
        self._links.show_ghosts(q[:_MOST])
        self._text.content = text
        self._solution.visible = len(q) > 1
        self._solution.max = max(len(q) - 1, 1)
        set_value(self._solution, 0)

    def show_curve(self, q: NDArray[np.float64]) -> None:
        """Adds a slider over the configurations (k, n) of a curve."""
        self._curve = q
        self._along.visible = len(q) > 1
        self._along.max = max(len(q) - 1, 1)
        set_value(self._along, 0)

    def _show_all(self) -> None:
        arm = self._page.arm
        found = solve_all(arm.robot, arm.goal, task=arm.task, start_q=arm.inside, obstacles=arm.avoided, stop=QUICKLY)
        proven = f" No other is inside the limits{' and clear' if arm.keeps_clear else ''}." if found.complete else ""
        self.show_ghosts(found.q, f"{counted(len(found), 'solution')}.{proven}" if len(found) else found.message)

    def _hide(self) -> None:
        self.show_ghosts(self._solutions[:0], "")
        self.show_curve(self._curve[:0])

    def _find_self_motion(self) -> None:
        arm = self._page.arm
        curves = self_motion(arm.robot, arm.goal, start_q=arm.inside)
        if not curves:
            self._text.content = "The target is not reached: no self-motion."
            return
        kept = curves[0].q
        self.show_curve(kept)
        set_value(self._along, int(np.linalg.norm(kept - arm.q, axis=1).argmin()))
        self._text.content = f"{counted(len(curves), 'self-motion curve')}; the slider moves along the nearest."

    def _put(self, configurations: NDArray[np.float64], i: int) -> None:
        if i < len(configurations):
            self._page.arm.put(configurations[i])

    def refresh(self) -> None:
        """Moves the ellipsoid to the tip."""
        self._ellipsoid.visible = bool(self._wanted.value)
        if not self._wanted.value:
            return
        arm = self._page.arm
        ellipsoid = arm.robot.velocity_ellipsoid(arm.q)
        # Adds axes for the lost directions, in which the ellipsoid is flat.
        axes, lengths, _ = np.linalg.svd(ellipsoid.axes[:, :3].T * ellipsoid.lengths)
        axes[:, 2] *= np.linalg.det(axes)
        x, y, z = np.maximum(_ELLIPSOID * np.append(lengths, np.zeros(3 - len(lengths))), _FLAT).tolist()
        self._ellipsoid.scale, self._ellipsoid.wxyz = (x, y, z), wxyz(axes)
        self._ellipsoid.position = arm.robot.fk(arm.q)[:3, 3]
