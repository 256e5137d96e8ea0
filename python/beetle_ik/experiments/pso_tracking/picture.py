"""Section 2.4: the contour of the arm in a picture, and the posture that it tells."""

from __future__ import annotations

import numpy as np

from ... import Robot, vision
from ...report import Block, Cell, Claim, Column, Figure, Part, Section, Table, drawing, line, number
from ..experiment import Context

ARM = Robot.planar([0.5, 0.45, 0.4])
POSE = np.array([0.9, -0.7, -0.6])
NOISE = 0.08


def picture(context: Context) -> Part:
    """All of it."""
    image = vision.render(ARM, POSE, noise=NOISE, seed=context.seed)
    guess = POSE + np.array([0.1, -0.1, 0.1])
    found = {name: vision.locate_arm(image, ARM, guess, method=name) for name in ("threshold", "snake")}
    rng = np.random.default_rng(context.seed)
    count = context.pick(full=100, short=10)
    errors, lies = [], 0
    for seed in context.each("pso-tracking: pictures", context.seeds(count)):
        q = np.array([rng.uniform(-np.pi, np.pi), *rng.uniform(-2.0, 2.0, 2)])
        view = vision.render(ARM, q, noise=NOISE, seed=seed)
        located = vision.locate_arm(view, ARM, q + rng.uniform(-0.1, 0.1, 3))
        errors.append(float(np.abs(located.q - q).max()) if located.success else np.inf)
        astray = vision.locate_arm(view, ARM, q + rng.choice([-1.0, 1.0], 3))
        off = np.abs((astray.q - q + np.pi) % (2 * np.pi) - np.pi).max()
        lies += bool(astray.success and off > 0.02)
    near = sum(error < 0.01 for error in errors)
    snake_error = float(np.abs(found["snake"].q - POSE).max())
    rows: list[list[Cell]] = [
        [name, float(np.abs(where.q - POSE).max()), where.rms, where.overlap, where.elapsed]
        for name, where in found.items()
    ]
    with drawing(height=4.0) as figure:
        panels = figure.subplots(1, 2)
        for axes, (name, where) in zip(panels, found.items(), strict=True):
            axes.imshow(image, cmap="gray", vmin=-0.3, vmax=1.3)
            axes.plot(*vision.outline(ARM, guess).T, label="guess", **line(4))
            axes.plot(*where.contour.T, label="contour", **line(1))
            axes.plot(*vision.Camera().joint_points(ARM, where.q).T, marker="o", label="fitted links", **line(0))
            axes.set(title=name, xlabel="column [pixel]", ylabel="row [pixel]")
            axes.grid(visible=False)
            axes.set(xlim=(90, 256), ylim=(170, 40))
            axes.legend(loc="lower right", fontsize="small", labelcolor="white")
    claim = Claim.checked(
        "An active contour locates the arm.",
        source="Section 2.4",
        measured=f"off by {number(snake_error)} rad on one pose; by threshold {near} of {count} random poses "
        f"within 0.01 rad, {lies} of {count} guesses off by 1 rad returned a wrong posture as right",
        holds=snake_error < 0.01 and near >= 0.95 * count and lies == 0,
        reading="the paper shows no picture; the energy is that of scikit-image, not eq. (19) to (21), and joint "
        "angles are fitted to the contour, which the paper does not say how to do",
        section=_TITLE,
    )
    blocks: list[Block] = [
        "A picture of the arm, rendered with noise; a contour, by an active contour or by a plain threshold; and the "
        "joint angles at which every point of the contour is half a link's width from the nearest link. The plain "
        "threshold is as good, and does not need a guess.",
        Figure(
            name="contour",
            title="The arm in a picture",
            drawing=figure,
            caption="The guess is off by 0.1 rad a joint; contour and fitted links lie on the arm.",
        ),
        Table(
            name="contours",
            title="Joint angles from a picture",
            columns=[
                Column(name="contour"),
                Column(name="largest error", unit="rad"),
                Column(name="rms", unit="pixel"),
                Column(name="overlap"),
                Column(name="time", unit="s"),
            ],
            rows=rows,
        ),
    ]
    return Section(_TITLE, blocks), [claim]


_TITLE = "The arm in a picture: section 2.4"
