"""The text and bars above the controls, and the line between the nearest two bodies."""

from __future__ import annotations

import html
import math
from typing import TYPE_CHECKING

import numpy as np

from .._core import Solution, Status
from ..figures.style import BLUE, VERMILION, rgb
from .loads import loads_in_html

if TYPE_CHECKING:
    from .._core import Nearest
    from .page import Page

_FAR = 1.0  # fraction of the arm: nearest bodies farther away are not marked
_AT, _NEAR = 0.002, 0.05  # distances from a limit, as fractions of the range of a joint
_BAR = (
    "<span title='{told}' "
    "style='flex:1;height:5px;margin:6px 0;border-radius:2px;background:#D3D7DC;position:relative'>"
    "<span style='position:absolute;left:calc({left:.1f}% - 2px);top:-3px;width:4px;height:11px;border-radius:2px;"
    "background:{color}'></span></span>"
)
_WORDS = {
    Status.SOLVED: "reached",
    Status.IN_COLLISION: "in collision",
    Status.HELD_BY_OBSTACLE: "held by an obstacle",
    Status.HELD_BY_CONSTRAINT: "held by what is kept",
    Status.HELD_BY_TORQUE: "held by a torque limit",
    Status.OUT_OF_REACH: "out of reach",
    Status.ROTATION_GIVEN_UP: "position reached",
    Status.POSITION_GIVEN_UP: "rotation reached",
    Status.LEVEL_GIVEN_UP: "lowest level reached",
}


class Report:
    """Status, errors, clearance, loads of the motors; the nearest two bodies; errors of the page; gaps of the model."""

    def __init__(self, page: Page, notes: list[str]) -> None:
        """Adds the text, with `notes` below it."""
        self._page = page
        self.problem = ""
        """Error of the last request, if any."""
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
            self._limits(),
        ]
        loads = loads_in_html(self._page.arm)
        if loads is not None:
            paragraphs.append(loads)
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
            return "at rest" if arm.follow != "off" else "does not follow the handle"
        if isinstance(arm.outcome, Solution) and arm.stays:
            return "no clear solution: the arm stays"
        word = _WORDS.get(arm.outcome.status, "under way" if arm.moves else "as near as it gets from here")
        return f"{word}: {_errors(arm.outcome.position_error, arm.outcome.rotation_error)} from the target"

    def _limits(self) -> str:
        """Returns a bar for each joint between its limits, and the names of joints at a limit."""
        robot, bars, at = self._page.arm.robot, [], []
        for name, q, low, high in zip(
            robot.joint_names, self._page.arm.q.tolist(), robot.lower.tolist(), robot.upper.tolist(), strict=True
        ):
            if not math.isfinite(high - low) or high <= low:
                continue
            share = min(max((q - low) / (high - low), 0.0), 1.0)
            if min(share, 1.0 - share) < _AT:
                at.append(name)
            color = VERMILION if min(share, 1.0 - share) < _NEAR else BLUE
            told = html.escape(f"{name}: {q:.3f}, between {low:.3f} and {high:.3f}", quote=True)
            bars.append(_BAR.format(told=told, left=100 * share, color=color))
        if not bars:
            return "no joint has limits"
        text = f"<b style='color:{VERMILION}'>at its limit: {html.escape(', '.join(at))}</b>" if at else "joint limits"
        return f"<span data-beetle-ik='limits'>{text}</span><span style='display:flex;gap:4px'>{''.join(bars)}</span>"

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
