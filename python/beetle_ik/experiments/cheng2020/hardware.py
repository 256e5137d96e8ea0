"""Figure 9: the resolved angles on an arm, which is simulated here."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

from ... import sim
from ...report import (
    BLUE,
    SKY,
    VERMILION,
    Claim,
    Figure,
    Part,
    Section,
    draw_arm_in_space,
    drawing,
    number,
    scale_alike,
)
from ..experiment import Context
from .settings import DT, IIWA, STAR

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "On an arm with servos"
_CIRCULAR = 0.05  # allowed variation of the radius, as a fraction

_TEXT = """
The paper sends the joint angles found by BAS to a real iiwa, and reads a circle back from it. We have no iiwa, and send
them to a simulated one in MuJoCo: rods of 20 kg in total, moved by position servos that sag under gravity, with a
command every 0.2 s.
"""


def hardware(context: Context) -> Part:
    """Replays angles resolved by BAS on the servos of a simulated arm."""
    setting = STAR[IIWA.name]
    resolved = IIWA.track(setting.solver, band=setting.band, seed=context.seed, start=IIWA.on_path)
    try:
        plant = sim.MujocoPlant(IIWA.robot, dt=DT)
    except bik.BeetleIkError as missing:
        return Section(TITLE, [_TEXT, f"Not run: {missing}"]), [circle_claim(None, str(missing))]
    tips = _send(plant, resolved.q)
    figure = Figure(
        name="figure_9",
        title="Figure 9: the circle read back from the simulated arm",
        drawing=_draw(resolved, tips),
        caption="Left: arm, circle and measured tip. Right: distances of the tip from its target, and from the "
        "circle's radius. The servos sag, which moves the circle by a millimetre or two.",
    )
    return Section(TITLE, [_TEXT, figure]), [circle_claim(_radii(tips))]


def circle_claim(radii: NDArray[np.float64] | None, missing: str = "") -> Claim:
    """Judges the distances of the tip from the axis of the circle (m); `missing` says why there are none."""
    radius = 0.1
    off = float("nan") if radii is None else float(np.abs(radii - radius).max())
    return Claim.judged(
        "The path read back from the arm is a circle as expected.",
        source="Section IV-B, Figure 9",
        rule=f"Seen from above, the distance from the centre varies by at most {100 * _CIRCULAR:g} % of the radius.",
        measured="" if radii is None else f"radius {number(radius)} m, off by {number(1e3 * off, 2)} mm at most",
        holds=None if radii is None else off <= _CIRCULAR * radius,
        reading="A simulated iiwa in place of the real one.",
        reason=missing,
        section=TITLE,
    )


def _send(plant: sim.MujocoPlant, angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the tips (k, 3) at the ends of the steps."""
    plant.reset(angles[0])
    tips = [plant.tip]
    for q in angles[1:]:
        plant.move(q)
        tips.append(plant.tip)
    return np.array(tips)


def _radii(tips: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns distances from the middle of the circle, seen from above, without the steps when servos take up load."""
    radii: NDArray[np.float64] = np.linalg.norm(tips[5:, :2] - [0.3, 0.3], axis=1)
    return radii


def _draw(resolved: bik.TrackResult, tips: NDArray[np.float64]) -> Drawing:
    with drawing(5.0) as figure:
        grid = figure.add_gridspec(2, 2, width_ratios=[1.2, 1.0])
        space = figure.add_subplot(grid[:, 0], projection="3d")
        draw_arm_in_space(space, resolved.robot, resolved.q[0])
        space.plot(*resolved.reference.T, color=VERMILION, linewidth=4.0, alpha=0.45, label="circle", zorder=5)
        space.plot(*tips.T, color=BLUE, label="tip", zorder=6)
        space.set_zlim(0.0, None)
        scale_alike(space)
        space.legend(loc="upper left")
        error, radius = figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1])
        error.plot(resolved.time, 1e3 * np.linalg.norm(tips - resolved.reference, axis=1), color=BLUE)
        error.set(ylabel="distance from target [mm]", xlim=(0.0, resolved.time[-1]))
        radius.plot(resolved.time[5:], 1e3 * (_radii(tips) - 0.1), color=SKY)
        radius.set(xlabel="time [s]", ylabel="off the radius [mm]", xlim=(0.0, resolved.time[-1]))
    return figure
