"""Position and orientation: both controllers with a sensor that measures poses."""

from __future__ import annotations

import numpy as np

import beetle_ik as bik

from ...report import Check, Column, Part, Section, Table, number
from ..experiment import Context
from .settings import ADAPTIVE, DT, IIWA, ON_CIRCLE, PUBLISHED, Array, circle, rms

TITLE = "Orientation"
_DURATION, _DURATION_SHORT = 50.0, 10.0  # s
_HELD = 1e-6  # m and rad
_SECANTS = "BroydenBAS"

_TEXT = """
The paper controls the position of the tool alone. With a sensor that measures poses the same two controllers hold an
orientation as well: h adds the squared angle to the squared distance, a radian counting as much as a metre, and the
secants of `BroydenBAS` get six rows. The arm is built wrong by up to 2 cm and 1.7°; the tool keeps the orientation of
the start along the circle.
"""

_METHODS = {
    "ZNNBAS, printed constants": PUBLISHED,
    "ZNNBAS, eq. (16), k = 100": ADAPTIVE,
    _SECANTS: bik.BroydenBAS(max_evaluations_per_step=1),
}


def orientation(context: Context) -> Part:
    """The circle by each controller, with the orientation free and with it held."""
    built = IIWA.with_errors(length=0.02, angle=0.03, seed=3)
    free = circle(context.pick(full=_DURATION, short=_DURATION_SHORT))
    found = {}
    for name in context.each("khan2022: orientation", list(_METHODS)):
        for path in (free, free.with_orientation(built.fk(ON_CIRCLE)[:3, :3])):
            found[name, path is not free] = _off(built, path, name, context.seed)
    table = Table(
        name="orientation",
        title="Tool of the arm as commanded, second half of the circle (rms)",
        columns=[
            Column(name="controller"),
            Column(name="off, orientation free", unit="mm", digits=4),
            Column(name="off, orientation held", unit="mm", digits=4),
            Column(name="turned, orientation free", unit="rad", digits=4),
            Column(name="turned, orientation held", unit="rad", digits=4),
        ],
        rows=[
            [name, *(1e3 * found[name, held][0] for held in (False, True)), *(found[name, held][1] for held in (False, True))]
            for name in _METHODS
        ],
        caption="One measurement every millisecond. Turned: from the orientation of the start. Of ZNNBAS at θ′, where "
        "the arm is sent.",
    )
    return Section(TITLE, [_TEXT, table]), [holds(*found[_SECANTS, True])]


def holds(off: float, turned: float) -> Check:
    """Rms errors of BroydenBAS (m, rad) with the orientation held."""
    return Check(
        statement="`BroydenBAS` holds position and orientation on an arm built otherwise than drawn.",
        rule=f"Over the second half of the circle both errors are below {number(_HELD, 1)} (m and rad, rms).",
        measured=f"{number(off)} m, {number(turned)} rad",
        holds=max(off, turned) < _HELD,
        section=TITLE,
    )


def _off(built: bik.Robot, path: bik.Path, name: str, seed: int) -> tuple[float, float]:
    """Distance from the path (m) and angle from the first orientation (rad), rms over the second half."""
    plant = bik.KinematicPlant(built, rotation_noise=0.0)
    result = bik.track_model_free(plant, path, ON_CIRCLE, dt=DT, controller=_METHODS[name], seed=seed)
    late = slice(len(result.time) // 2, None)
    turns = built.fk(result.command[late])[:, :3, :3] @ built.fk(ON_CIRCLE)[:3, :3].T
    return rms(result.position_error[late] ** 2), rms(_angle(turns) ** 2)


def _angle(rotations: Array) -> Array:
    """Angles of rotation matrices (k, 3, 3), accurate near zero."""
    chord = np.linalg.norm(rotations - np.eye(3), axis=(1, 2)) / np.sqrt(8.0)
    return 2.0 * np.arcsin(np.minimum(chord, 1.0))
