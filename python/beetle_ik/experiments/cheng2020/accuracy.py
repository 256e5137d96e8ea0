"""Cost of accuracy: beetle antennae search beside trackers that use more than the size of the error."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import beetle_ik as bik

from ...report import Claim, Column, Figure, Part, Section, Table, drawing, line, number
from ..experiment import Context
from .boxes import evaluations_a_step, track
from .settings import DT, IIWA, STEPS, Run, steady_error

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "What accuracy costs"
_BANDS = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
_BANDS_SHORT = (1e-3, 1e-6, 1e-9)
_BEETLES = _CHAIN, _GREEDY = "BAS, chain", "BAS, greedy"
_INVERSE = "weighted pseudo-inverse"
_GAIN = 5.0  # 1/s: the whole error within one step of 0.2 s

_TEXT = """
BAS and the swarms use a single number: the distance of the tip from its target. Three trackers that use more are
compared with them here. `BroydenBAS` measures *where* the tip is, still without a model: it treats the difference of
two measurements as a secant of the Jacobian, and keeps the estimate from step to step. The pseudo-inverse, which the
paper sets out to replace, and the library's default know the model. With a model, or with a sensor that measures a
direction, there is no reason to search at random.
"""


@dataclass(frozen=True)
class Point:
    """Accuracy of a tracker, and its cost."""

    error: float
    """Mean error over the second half (m)."""
    evaluations: float
    """Evaluations of a step, on average."""
    time: float
    """Time of a step, on average (s)."""


def accuracy(context: Context) -> Part:
    """Compares error and evaluations of all trackers, and checks the paper's claim about the pseudo-inverse."""
    bands = context.pick(full=_BANDS, short=_BANDS_SHORT)
    curves = {
        name: [_point(run(band)) for band in bands]
        for name, run in context.each("cheng2020: what accuracy costs", list(_CURVES.items()))
    }
    curves[_INVERSE] = [_point(_pseudo_inverse())]
    figure = Figure(
        name="accuracy",
        title="What accuracy costs: iiwa 14, start on the circle",
        drawing=_draw(curves),
        caption="Each point of a line is an error band, from 1 mm to 1 nm; lower left is better.",
    )
    section = Section(TITLE, [_TEXT, figure, _table(curves)])
    return section, [pseudo_inverse_claim({name: curves[name] for name in _BEETLES}, curves[_INVERSE][0])]


def pseudo_inverse_claim(beetles: Mapping[str, list[Point]], inverse: Point) -> Claim:
    """Judges the paper's reason for avoiding the Jacobian."""
    near = {name: min(points, key=lambda point: abs(point.error - inverse.error)) for name, points in beetles.items()}
    return Claim.judged(
        "BAS saves the computation that methods based on the pseudo-inverse of the Jacobian need.",
        source="Abstract and section I",
        rule="For the same error BAS needs less time or fewer evaluations than the pseudo-inverse.",
        measured="; ".join(
            f"{name}: {number(point.error, 2)} m with {number(point.evaluations, 3)} evaluations and "
            f"{number(1e6 * point.time, 2)} µs a step"
            for name, point in {_INVERSE: inverse, **near}.items()
        ),
        holds={
            name: point.time < inverse.time or point.evaluations < inverse.evaluations for name, point in near.items()
        },
        reason="The pseudo-inverse keeps the velocity limit as well: it is solved in the same box as BAS.",
        section=TITLE,
    )


def _pseudo_inverse() -> bik.TrackResult:
    return bik.track(
        IIWA.robot,
        IIWA.circle,
        IIWA.on_path,
        dt=DT,
        solver=bik.WeightedPseudoInverse(gain=_GAIN, integrator="rk4"),
        limits=IIWA.limits,
        limit_at="start",
    )


def _with_solver(solver: bik.papers.BAS | None) -> Callable[[float], Run]:
    return lambda band: track(IIWA, solver, seed=0, band=band)


def _broyden(band: float) -> Run:
    return bik.track_model_free(
        bik.KinematicPlant(IIWA.robot),
        IIWA.circle,
        IIWA.on_path,
        dt=DT,
        controller=bik.BroydenBAS(),
        limits=IIWA.limits,
        position_tolerance=band,
    )


_CURVES: dict[str, Callable[[float], Run]] = {
    _CHAIN: _with_solver(bik.papers.BAS(variant="chain")),
    _GREEDY: _with_solver(bik.papers.BAS(variant="greedy")),
    "BroydenBAS": _broyden,
    "model-based": _with_solver(None),
}


def _point(result: Run) -> Point:
    return Point(steady_error(result), evaluations_a_step(result), result.elapsed / STEPS)


def _table(curves: dict[str, list[Point]]) -> Table:
    return Table(
        name="accuracy_costs",
        title="Numbers: what accuracy costs",
        columns=[
            Column(name="method"),
            Column(name="mean error, second half", unit="m"),
            Column(name="evaluations a step"),
        ],
        rows=[[name, point.error, point.evaluations] for name, points in curves.items() for point in points],
        folded=True,
    )


def _draw(curves: dict[str, list[Point]]) -> Drawing:
    with drawing(3.8) as figure:
        axes = figure.subplots()
        for i, (name, points) in enumerate(curves.items()):
            evaluations, errors = zip(*((point.evaluations, point.error) for point in points), strict=True)
            axes.plot(evaluations, errors, marker="o", markersize=4, label=name, **line(i))
        axes.set(xscale="log", yscale="log", xlabel="evaluations a step", ylabel="mean error, second half [m]")
        axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure
