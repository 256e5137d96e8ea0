"""Eq. (5): the tip within a box."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

from ...calls.text import counted
from ...report import BLUE, FORBIDDEN, VERMILION, Check, Claim, Figure, Part, Section, drawing, not_given, number
from ..experiment import Context
from .settings import FIVE_LINK, IIWA, PARAMETERS, ROUNDING, STAR, Task, excess_velocity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

TITLE = "The tip kept in a box"
_SEEDS = 10
_SEEDS_SHORT = 1

# Lower and upper corner (m). A box cuts three sides off its circle, by 0.2 m or 0.03 m; the arm starts on the fourth.
_BOXES = {
    FIVE_LINK.name: np.array([[3.5, 0.5, -np.inf], [np.inf, 1.5, np.inf]]),
    IIWA.name: np.array([[0.23, 0.23, -np.inf], [np.inf, 0.37, np.inf]]),
}

_TEXT = """
In confined spaces the tip has to stay within pₘᵢₙ < p < pₘₐₓ, eq. (5). The paper says no more about it: Algorithm 1
clips joints, not the tip. The library takes the box as a `region` of the task. The beetle searches for the point of the
box nearest to the target, and a step that would end outside is shortened. Beetle and velocity limits stay the same.
"""


@dataclass(frozen=True)
class Boxed:
    """An arm in its box, over several seeds."""

    task: Task
    results: list[bik.TrackResult]

    @property
    def box(self) -> NDArray[np.float64]:
        """Lower and upper corner (m)."""
        return _BOXES[self.task.name]

    @property
    def outside(self) -> float:
        """Largest distance of the tip beyond a face (m); negative inside."""
        tips = np.concatenate([result.position for result in self.results])
        return float(np.maximum(self.box[0] - tips, tips - self.box[1]).max())

    @property
    def away(self) -> float:
        """Largest distance of the tip from the point of the box nearest to its target (m)."""
        nearest = [np.clip(result.reference, *self.box) for result in self.results]
        tips = [result.position for result in self.results]
        return float(np.linalg.norm(np.array(tips) - np.array(nearest), axis=2).max())

    @property
    def is_kept(self) -> bool:
        """Whether no step broke box or limits, and each was as near to its target as band and box allow."""
        excess = max(excess_velocity(result) for result in self.results)
        # The tip moves along the inside of a face, up to half a band from it, and the beetle rests within its band.
        return self.outside < 0.0 and excess <= ROUNDING and self.away <= 2.0 * STAR[self.task.name].band


def tip_box(context: Context) -> Part:
    """Follows circles that leave their boxes with both arms."""
    seeds = context.seeds(context.pick(full=_SEEDS, short=_SEEDS_SHORT))
    boxed = [
        Boxed(task, [_track(task, seed) for seed in seeds])
        for task in context.each("cheng2020: eq. (5)", [FIVE_LINK, IIWA])
    ]
    figure = Figure(
        name="equation_5",
        title="Eq. (5): circles that leave the box",
        drawing=_draw(boxed),
        caption="Seen from above. The shade is forbidden; the tip slides along its faces where the circle enters it.",
    )
    beyond = max(Boxed(task, [_track(task, context.seed, kept=False)]).outside for task in (FIVE_LINK, IIWA))
    return Section(TITLE, [_TEXT, figure]), [region_claim(beyond), _check(boxed)]


def _track(task: Task, seed: int, *, kept: bool = True) -> bik.TrackResult:
    setting = STAR[task.name]
    region = bik.tasks.Position(region=_BOXES[task.name]) if kept else None
    return task.track(setting.solver, band=setting.band, seed=seed, start=task.on_path, task=region)


def region_claim(beyond: float) -> Claim:
    """Judges eq. (5); `beyond` is the largest distance by which Algorithm 1 as printed leaves our boxes (m)."""
    return Claim.judged(
        "The end-effector stays within specific spaces, pₘᵢₙ < p(t) < pₘₐₓ.",
        source="Section II-B, eq. (5)",
        rule="By Algorithm 1 as printed the tip stays inside the box.",
        measured=f"the tip leaves the boxes we chose, which cut three sides off the circles, by {number(beyond, 2)} m",
        holds=beyond <= 0.0,
        missing=not_given({"pₘᵢₙ and pₘₐₓ": PARAMETERS["pₘᵢₙ and pₘₐₓ"]}),
        reason="Eq. (5) is a requirement only: Algorithm 1 does not use it, and no experiment of the paper tests it.",
        section=TITLE,
    )


def _check(boxed: list[Boxed]) -> Check:
    runs = sum(len(one.results) for one in boxed)
    nearest = min(-one.outside for one in boxed)
    away = ", ".join(f"{number(one.away, 2)} m ({one.task.name})" for one in boxed)
    return Check(
        statement="A task's `region` keeps the tip in a box, within the velocity limits.",
        rule="In every step the tip is inside and at most two error bands from the point of the box nearest to its "
        f"target; velocities exceed their limits by at most {number(ROUNDING, 1)} rad/s.",
        measured=f"{counted(runs, 'run')}: inside by at least {number(nearest, 2)} m, from that point at most {away}",
        holds=all(one.is_kept for one in boxed),
        section=TITLE,
    )


def _draw(boxed: list[Boxed]) -> Drawing:
    with drawing(3.6) as figure:
        panels = figure.subplots(1, len(boxed))
        for axes, one in zip(panels, boxed, strict=True):
            _draw_one(axes, one)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


def _draw_one(axes: Axes, one: Boxed) -> None:
    result = one.results[0]
    reference, (low, high) = result.reference[:, :2], one.box[:, :2]
    reach = 0.15 * np.ptp(reference, axis=0)
    (left, bottom), (right, top) = reference.min(axis=0) - reach, reference.max(axis=0) + reach
    axes.axvspan(left, low[0], color=FORBIDDEN, linewidth=0)
    for edges in ((bottom, low[1]), (high[1], top)):
        axes.fill_between([low[0], right], *edges, color=FORBIDDEN, linewidth=0)
    axes.plot(*reference.T, color=VERMILION, linewidth=4.0, alpha=0.45, label="circle")
    axes.plot(*result.position[:, :2].T, color=BLUE, label="tip")
    axes.set(title=one.task.name, xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axes.set(xlim=(left, right), ylim=(bottom, top))
