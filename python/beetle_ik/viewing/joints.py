"""Sliders of the joints."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from .page import set_value

if TYPE_CHECKING:
    import viser

    from .page import Page

_STEP = 0.001  # rad, m
_UNLIMITED = {"prismatic": 2.0}  # m; other joints without limits: one turn each way


class Joints:
    """Sliders between the limits of the joints, which move the arm."""

    def __init__(self, page: Page) -> None:
        """Adds the sliders."""
        self._arm = arm = page.arm
        robot = arm.robot
        self._sliders: list[viser.GuiSliderHandle[float]] = []
        for name, kind, low, high, q in zip(
            robot.joint_names, robot.joint_kinds, robot.lower, robot.upper, arm.q, strict=True
        ):
            span = _UNLIMITED.get(kind, 2 * np.pi)
            low, high = (float(each) for each in (max(low, -span), min(high, span)))
            slider = page.server.gui.add_slider(
                name, min=low, max=high, step=_STEP, initial_value=float(np.clip(q, low, high)),
                hint=f"{kind}, {'m' if kind == 'prismatic' else 'rad'}",
            )  # fmt: skip
            page.on_input(slider, partial(self._put, len(self._sliders)))
            self._sliders.append(slider)

    def _put(self, joint: int) -> None:
        q = self._arm.q.copy()
        q[joint] = self._sliders[joint].value
        self._arm.put(self._arm.robot.clip(q))

    def refresh(self) -> None:
        """Shows the positions of the joints."""
        for slider, q in zip(self._sliders, self._arm.q.tolist(), strict=True):
            shown = min(max(q, slider.min), slider.max)
            if abs(slider.value - shown) > 0.5 * _STEP:
                set_value(slider, round(shown, 3))
