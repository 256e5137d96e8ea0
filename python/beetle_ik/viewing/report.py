"""The text above the controls, and the line between the nearest two bodies."""

from __future__ import annotations

import html
import math
from typing import TYPE_CHECKING

import numpy as np

from .._core import Solution, Status
from .._style import BLUE, VERMILION, rgb

if TYPE_CHECKING:
    from .._core import Nearest
    from .page import Page

_FAR = 1.0  # a nearest body farther away than this fraction of the arm is not pointed out
_WORDS = {
    Status.SOLVED: "reached",
    Status.IN_COLLISION: "in collision",
    Status.HELD_BY_OBSTACLE: "held by an obstacle",
    Status.OUT_OF_REACH: "out of reach",
}


class Report:
    """Status, errors, clearance and the nearest two bodies; errors of the page; what the model lacks."""

    def __init__(self, page: Page, notes: list[str]) -> None:
        """Adds the text; `notes` stand below it."""
        self._page = page
        self.problem = ""
        """What went wrong with the last request, if anything did."""
        self._text = page.server.gui.add_html("")
        self._notes = "".join(f"<p>{html.escape(note)}</p>" for note in notes)
        self._line = page.server.scene.add_line_segments(
            "/nearest", np.zeros((1, 2, 3)), rgb(VERMILION), thickness=3.0, thickness_units="screen", visible=False
        )

    def refresh(self) -> None:
        """Shows the state of the arm."""
        nearest = self._page.arm.nearest
        paragraphs = [
            f"<b data-beetle-ik='status'>{html.escape(self._status())}</b>",
            *self._tips(),
            _clearance(nearest),
        ]
        if self.problem:
            paragraphs.insert(0, f"<b style='color:{VERMILION}'>{html.escape(self.problem)}</b>")
        text = "".join(f"<p>{each}</p>" for each in paragraphs)
        self._text.content = (
            f"<div style='padding:0 1em;font-size:0.85em'>{text}<div style='color:{BLUE}'>{self._notes}</div></div>"
        )
        near = nearest is not None and nearest.distance < _FAR * self._page.scale
        self._line.visible = near
        if nearest is not None and near:
            other = nearest.point - nearest.distance * nearest.normal
            self._line.points = np.array([[nearest.point, other]], dtype=np.float32)

    def _status(self) -> str:
        arm = self._page.arm
        if arm.outcome is None:
            return "at rest" if arm.follow != "off" else "moved from outside"
        if isinstance(arm.outcome, Solution) and arm.stays:
            return "no clear solution: the arm stays"
        word = _WORDS.get(arm.outcome.status, "under way" if arm.moves else "as near as it gets from here")
        return f"{word}: {_errors(arm.outcome.position_error, arm.outcome.rotation_error)} from the target"

    def _tips(self) -> list[str]:
        """Returns a line for each of several tips."""
        arm = self._page.arm
        if len(arm.targets) == 1 or arm.outcome is None:
            return []
        escaped = [(html.escape(str(tip), quote=True), errors) for tip, errors in arm.outcome.errors.items()]
        return [f"{tip}: <span data-beetle-ik='{tip}'>{_errors(*errors)}</span>" for tip, errors in escaped]


def _errors(position: float, rotation: float) -> str:
    turned = "" if math.isnan(rotation) else f", {math.degrees(rotation):.1f}°"
    return f"{1e3 * position:.1f} mm{turned}"


def _clearance(nearest: Nearest | None) -> str:
    if nearest is None:
        return "nothing can touch"
    names = html.escape(f"{nearest.body} to {nearest.other}")
    return f"clearance <b data-beetle-ik='clearance'>{1e3 * nearest.distance:.1f}</b> mm, {names}"
