"""Section 2.4: the contour of the arm in a picture, and the posture that it tells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ... import Robot, vision
from ...report import Claim, Column, Figure, Part, Section, Table, drawing, line, number
from ..experiment import Context

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "The arm in a picture: section 2.4"
ARM = Robot.planar([0.5, 0.45, 0.4])
POSE = np.array([0.9, -0.7, -0.6])
GUESS = POSE + np.array([0.1, -0.1, 0.1])
NOISE = 0.08
_NEAR = 0.01  # rad: as good as found
_ASTRAY = 0.02  # rad: not to be returned as right

_TEXT = """
A picture of the arm, rendered with noise; a contour, by an active contour or by a plain threshold; and the joint angles
at which every point of the contour is half a link's width from the nearest link. The plain threshold is as good, and
does not need a guess.
"""


@dataclass(frozen=True)
class Trials:
    """Random poses in pictures, by threshold."""

    count: int
    near: int
    """From a good guess: how many were found."""
    lies: int
    """From a guess that is off by 1 rad: how many wrong postures were returned as right."""


def picture(context: Context) -> Part:
    """One pose by both contours, and many random ones."""
    image = vision.render(ARM, POSE, noise=NOISE, seed=context.seed)
    found = {name: vision.locate_arm(image, ARM, GUESS, method=name) for name in ("threshold", "snake")}
    figure = Figure(
        name="contour",
        title="The arm in a picture",
        drawing=_draw(image, found),
        caption="The guess is off by 0.1 rad a joint; contour and fitted links lie on the arm.",
    )
    return Section(TITLE, [_TEXT, figure, _table(found)]), [_claim(found["snake"], _trials(context))]


def _trials(context: Context) -> Trials:
    rng = np.random.default_rng(context.seed)
    near = lies = 0
    seeds = context.seeds(context.pick(full=100, short=10))
    for seed in context.each("pso-tracking: pictures", seeds):
        q = np.array([rng.uniform(-np.pi, np.pi), *rng.uniform(-2.0, 2.0, 2)])
        view = vision.render(ARM, q, noise=NOISE, seed=seed)
        located = vision.locate_arm(view, ARM, q + rng.uniform(-0.1, 0.1, 3))
        near += bool(located.success and np.abs(located.q - q).max() < _NEAR)
        astray = vision.locate_arm(view, ARM, q + rng.choice([-1.0, 1.0], 3))
        off = np.abs((astray.q - q + np.pi) % (2 * np.pi) - np.pi).max()
        lies += bool(astray.success and off > _ASTRAY)
    return Trials(len(seeds), near, lies)


def _claim(snake: vision.ArmLocation, trials: Trials) -> Claim:
    off = float(np.abs(snake.q - POSE).max())
    return Claim.judged(
        "An active contour locates the arm.",
        source="Section 2.4",
        rule=f"Off by less than {_NEAR} rad on the pose drawn and in 95 % of the random poses; no "
        f"wrong posture is returned as right.",
        measured=f"off by {number(off)} rad on one pose; by threshold {trials.near} of {trials.count} random poses "
        f"within {_NEAR} rad, {trials.lies} of {trials.count} guesses off by 1 rad returned a wrong posture as right",
        holds=off < _NEAR and trials.near >= 0.95 * trials.count and trials.lies == 0,
        reading="the paper shows no picture; the energy is that of scikit-image, not eq. (19) to (21), and joint "
        "angles are fitted to the contour, which the paper does not say how to do",
        section=TITLE,
    )


def _table(found: dict[str, vision.ArmLocation]) -> Table:
    return Table(
        name="contours",
        title="Joint angles from a picture",
        columns=[
            Column(name="contour"),
            Column(name="largest error", unit="rad"),
            Column(name="rms", unit="pixel"),
            Column(name="overlap"),
            Column(name="time", unit="s"),
        ],
        rows=[
            [name, float(np.abs(where.q - POSE).max()), where.rms, where.overlap, where.elapsed]
            for name, where in found.items()
        ],
    )


def _draw(image: NDArray[np.float64], found: dict[str, vision.ArmLocation]) -> Drawing:
    with drawing(height=4.0) as figure:
        panels = figure.subplots(1, 2)
        for axes, (name, where) in zip(panels, found.items(), strict=True):
            axes.imshow(image, cmap="gray", vmin=-0.3, vmax=1.3)
            axes.plot(*vision.outline(ARM, GUESS).T, label="guess", **line(4))
            axes.plot(*where.contour.T, label="contour", **line(1))
            axes.plot(*vision.Camera().joint_points(ARM, where.q).T, marker="o", label="fitted links", **line(0))
            axes.set(title=name, xlabel="column [pixel]", ylabel="row [pixel]")
            axes.grid(visible=False)
            axes.set(xlim=(90, 256), ylim=(170, 40))
            axes.legend(loc="lower right", fontsize="small", labelcolor="white")
    return figure
