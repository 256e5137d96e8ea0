"""Loads of the motors: torques as shares of their limits, as text and bars."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING

import numpy as np

from ..figures.style import BLUE, ORANGE, VERMILION

if TYPE_CHECKING:
    from .arm import Arm

_HIGH = 0.8  # share of a limit that is marked
_BAR = (
    "<span title='{told}' data-beetle-ik-share='{share:.3f}' "
    "style='flex:1;height:5px;margin:6px 0;border-radius:2px;background:#D3D7DC;overflow:hidden'>"
    "<span style='display:block;width:{width:.1f}%;height:100%;background:{color}'></span></span>"
)


def loads_in_html(arm: Arm) -> str | None:
    """Returns the largest load and a bar for each motor with a torque limit; None for a robot without dynamics.

    At rest the torques hold the arm up; in a motion they move it too. Friction and payload count.
    """
    robot = arm.robot
    if not robot.has_dynamics:
        return None
    torques, limits = robot.torques(arm.q, *arm.rates), robot.torque_limit
    limited = np.isfinite(limits)
    if not limited.any():
        most = int(np.argmax(np.abs(torques)))
        name = html.escape(robot.joint_names[most])
        return f"<span data-beetle-ik='load'>largest torque {abs(torques[most]):.1f} {_unit(arm, most)}, {name}</span>"
    shares = np.where(limited, np.abs(torques) / limits, 0.0)
    bars = "".join(_bar(arm, j, torques[j], limits[j]) for j in range(robot.dof) if limited[j])
    return f"<span data-beetle-ik='load'>{_largest(arm, shares)}</span><span style='display:flex;gap:4px'>{bars}</span>"


def _largest(arm: Arm, shares: np.ndarray) -> str:
    over = np.flatnonzero(shares > 1.0)
    if len(over):
        names = ", ".join(f"{arm.robot.joint_names[j]} {100 * shares[j]:.0f} %" for j in over)
        return f"<b style='color:{VERMILION}'>beyond its motor: {html.escape(names)}</b>"
    most = int(np.argmax(shares))
    return f"motor load up to {100 * shares[most]:.0f} %, {html.escape(arm.robot.joint_names[most])}"


def _bar(arm: Arm, joint: int, torque: float, limit: float) -> str:
    share = abs(torque) / limit
    color = VERMILION if share > 1.0 else ORANGE if share > _HIGH else BLUE
    told = f"{arm.robot.joint_names[joint]}: {torque:.1f} of {limit:.1f} {_unit(arm, joint)}, {100 * share:.0f} %"
    return _BAR.format(told=html.escape(told, quote=True), share=share, width=100 * min(share, 1.0), color=color)


def _unit(arm: Arm, joint: int) -> str:
    return "N" if arm.robot.joint_kinds[joint] == "prismatic" else "N m"
