"""Section 2.4: the contour of the arm in a picture, and the posture read from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ... import Robot, vision
from ...report import Check, Claim, Column, Figure, Part, Section, Table, drawing, line, number
from ...vision.camera import distance_to_links
from ..experiment import Context

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "The arm in a picture: section 2.4"
ARM = Robot.planar([0.5, 0.45, 0.4])
POSE = np.array([0.9, -0.7, -0.6])
GUESS = POSE + np.array([0.1, -0.1, 0.1])
NOISE = 0.08
_Method: TypeAlias = Literal["threshold", "snake"]
_NAMES: dict[_Method, str] = {"snake": "active contour", "threshold": "plain threshold"}
_NEAR = 0.01  # rad: counts as found
_ASTRAY = 0.02  # rad: must not be returned as right
_SHARE = 0.8
_ENOUGH = 20  # pictures needed to judge a fraction
_OUTSIDE = 6.0  # pixels from the guess, at which an active contour begins

_TEXT = """
Pictures of the arm, rendered with noise; a contour, by the active contour of the paper or by a plain threshold; and the
joint angles at which every point of the contour is half a link's width from the nearest link, which the paper does not
say how to find. Both start from a guess that is up to 0.1 rad off in each joint. The threshold finds the arm in
{threshold} of {count} pictures, the active contour in {snake} of {count}, and takes {slower} times as long.

The energy of eq. (19) to (21) is that of Kass's active contour, which scikit-image minimises, except that the squares
are missing: as printed, ½(λ₁v′ + λ₂v″) is linear, and its sum over any closed contour is zero. Without squares nothing
holds the points together, and they run to the nearest edges, {printed} pixels off the outline (rms, median) against
{squared} with them. λ₁, λ₂ and the external energy are not given: 0.01, 0.05 and the strength of edges here.
"""


@dataclass(frozen=True)
class Trials:
    """Random poses in pictures, by one method."""

    count: int
    near: int
    """Postures found from a good guess."""
    lies: int
    """Wrong postures returned as right from a guess that is off by 1 rad; threshold method alone."""
    seconds: float
    """Average time of a picture (s)."""


def picture(context: Context) -> Part:
    """Locates one pose by both contours and many random ones, and tries the energy as printed."""
    image = vision.render(ARM, POSE, noise=NOISE, seed=context.seed)
    found = {method: vision.locate_arm(image, ARM, GUESS, method=method) for method in _NAMES}
    trials = {method: _trials(method, context) for method in _NAMES}
    printed, squared = _energies(context)
    text = _TEXT.format(
        threshold=trials["threshold"].near,
        snake=trials["snake"].near,
        count=trials["snake"].count,
        slower=number(trials["snake"].seconds / trials["threshold"].seconds, 2),
        printed=number(printed),
        squared=number(squared),
    )
    figure = Figure(
        name="contour",
        title="The arm in a picture",
        drawing=_draw(image, found),
        caption="The guess is off by 0.1 rad a joint; contour and fitted links lie on the arm.",
    )
    return Section(TITLE, [text, figure, _table(found, trials)]), [
        locates(trials["snake"], trials["threshold"]),
        threshold_locates(trials["threshold"]),
    ]


def locates(snake: Trials, threshold: Trials) -> Claim:
    """Judges the paper's active contour, with the threshold method beside it."""
    return Claim.judged(
        "The active contour model can accurately locate the contour of the arm.",
        source="Section 2.4, eq. (19) to (21)",
        rule=f"In at least {100 * _SHARE:g} % of random poses the joint angles fitted to the active contour are "
        f"within {_NEAR} rad.",
        measured=f"{snake.near} of {snake.count} by the active contour; {threshold.near} of {threshold.count} by a "
        "plain threshold",
        holds=snake.near >= _SHARE * snake.count if snake.count >= _ENOUGH else None,
        reading="Squares are put back into eq. (20), the external energy is the strength of edges, the contour begins "
        "around a guess up to 0.1 rad off, and joint angles are fitted to it. The paper shows no picture.",
        reason="" if snake.count >= _ENOUGH else "Too few pictures to decide: run without --short.",
        section=TITLE,
    )


def threshold_locates(trials: Trials) -> Check:
    """Checks the threshold method, which is the library's default."""
    return Check(
        statement="`locate_arm` by threshold finds the arm, and returns no wrong posture as right.",
        rule=f"At least 95 % of random poses within {_NEAR} rad; of guesses off by 1 rad none is returned as right "
        f"that is over {_ASTRAY} rad off.",
        measured=f"{trials.near} of {trials.count} found; {trials.lies} of {trials.count} wrong ones returned as right",
        holds=trials.near >= 0.95 * trials.count and trials.lies == 0,
        section=TITLE,
    )


def _trials(method: _Method, context: Context) -> Trials:
    rng = np.random.default_rng(context.seed)
    near = lies = 0
    seconds = 0.0
    seeds = context.seeds(context.pick(full=50, short=3))
    for seed in context.each(f"pso-tracking: pictures, {_NAMES[method]}", seeds):
        q = np.array([rng.uniform(-np.pi, np.pi), *rng.uniform(-2.0, 2.0, 2)])
        view = vision.render(ARM, q, noise=NOISE, seed=seed)
        located = vision.locate_arm(view, ARM, q + rng.uniform(-0.1, 0.1, 3), method=method)
        seconds += located.elapsed / len(seeds)
        near += bool(located.success and np.abs(located.q - q).max() < _NEAR)
        wrong = q + rng.choice([-1.0, 1.0], 3)
        if method == "threshold":
            astray = vision.locate_arm(view, ARM, wrong)
            off = np.abs((astray.q - q + np.pi) % (2 * np.pi) - np.pi).max()
            lies += bool(astray.success and off > _ASTRAY)
    return Trials(len(seeds), near, lies, seconds)


def _energies(context: Context) -> tuple[float, float]:
    """Returns the median rms distance of the contour from the arm (pixels): with eq. (20) as printed, and squared."""
    from skimage.filters import gaussian
    from skimage.segmentation import active_contour

    camera = vision.Camera()
    rng = np.random.default_rng(context.seed)
    off: dict[str, list[float]] = {"printed": [], "squared": []}
    for seed in context.seeds(context.pick(full=8, short=1)):
        q = np.array([rng.uniform(-np.pi, np.pi), *rng.uniform(-2.0, 2.0, 2)])
        smooth = gaussian(vision.render(ARM, q, noise=NOISE, seed=seed), 2.0)
        begin = vision.outline(ARM, q + rng.uniform(-0.1, 0.1, 3), margin=_OUTSIDE)[:, ::-1]
        for name, alpha, beta in (("printed", 0.0, 0.0), ("squared", 0.01, 0.05)):
            contour = active_contour(smooth, begin, alpha=alpha, beta=beta, gamma=0.05, max_num_iter=1000)[:, ::-1]
            distance = distance_to_links(contour, camera.joint_points(ARM, q)) - camera.half_width
            off[name].append(float(np.sqrt(np.mean(distance**2))))
    return float(np.median(off["printed"])), float(np.median(off["squared"]))


def _table(found: dict[_Method, vision.ArmLocation], trials: dict[_Method, Trials]) -> Table:
    return Table(
        name="contours",
        title="Joint angles from a picture",
        columns=[
            Column(name="contour"),
            Column(name="found, random poses"),
            Column(name="largest error, pose drawn", unit="rad", digits=4),
            Column(name="rms", unit="pixel", digits=4),
            Column(name="overlap", digits=4),
            Column(name="time", unit="s", digits=4),
        ],
        rows=[
            [
                _NAMES[method],
                f"{trials[method].near} of {trials[method].count}",
                float(np.abs(where.q - POSE).max()),
                where.rms,
                where.overlap,
                trials[method].seconds,
            ]
            for method, where in found.items()
        ],
    )


def _draw(image: NDArray[np.float64], found: dict[_Method, vision.ArmLocation]) -> Drawing:
    with drawing(height=4.4) as figure:
        panels = figure.subplots(1, 2)
        for axes, (method, where) in zip(panels, found.items(), strict=True):
            axes.imshow(image, cmap="gray", vmin=-0.3, vmax=1.3)
            axes.plot(*vision.outline(ARM, GUESS).T, label="guess", **line(4))
            axes.plot(*where.contour.T, label="contour", **line(1))
            axes.plot(*vision.Camera().joint_points(ARM, where.q).T, marker="o", label="fitted links", **line(0))
            axes.set(title=_NAMES[method], xlabel="column [pixel]", ylabel="row [pixel]")
            axes.grid(visible=False)
            axes.set(xlim=(90, 256), ylim=(170, 40))
            axes.legend(loc="lower right", fontsize="small", labelcolor="white")
    return figure
