"""Noise-tolerant tracking: both model-free controllers with an imperfect sensor."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

import beetle_ik as bik

from ...report import BLUE, GREEN, ORANGE, VERMILION, Check, Column, Figure, Part, Section, Table, drawing, number
from ..experiment import Context
from .settings import ADAPTIVE, DT, IIWA, ON_CIRCLE, PUBLISHED, Array, circle, rms

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "A sensor that errs"
_DURATION = 20.0  # s
_NOISE = (1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2)  # m, standard deviation on each axis
_BIAS = (1e-4, 1e-3, 1e-2, 5e-2)  # m
_DRIFT = (1e-5, 1e-4, 1e-3, 5e-3)  # m/s
_ALONG = np.array([1.0, 1.0, 1.0]) / np.sqrt(3.0)
_FACTOR = 3.0  # multiple of the sensor's noise over three axes
_UP_TO = 1e-3  # m

_CONTROLLERS: dict[str, bik.papers.ZNNBAS | bik.BroydenBAS] = {
    "ZNNBAS, printed constants": PUBLISHED,
    "ZNNBAS, eq. (16), k = 100": ADAPTIVE,
    "BroydenBAS": bik.BroydenBAS(max_evaluations_per_step=1),
}

_TEXT = """
Both controllers trust their sensor: a bias or drift of the sensor shifts the tool by as much. Noise acts differently.
The error of `BroydenBAS` is close to the noise of its sensor, until the noise hides the steps that it learns from:
between 1 and 3 mm ZNNBAS with the antenna of eq. (16) becomes the more accurate of the two, and at 1 cm `BroydenBAS`
loses the path. ZNNBAS with the printed constants tolerates noise smaller than the motion of its antennae: 1 cm hardly
affects its state θ. But the arm is never at θ; where it is sent, it is 6 cm off even with a perfect sensor.
"""


class Sensor:
    """The exact arm behind a sensor whose bias (m) and drift (m/s) point in one direction."""

    def __init__(self, bias: float, drift: float) -> None:
        """Starts at time zero."""
        self._bias, self._drift, self._ticks = bias, drift, 0

    def move(self, q: Array) -> Array:
        """Returns the measured position of the tool (3,)."""
        self._ticks += 1
        return np.asarray(IIWA.fk(q)[:3, 3] + _ALONG * (self._bias + self._drift * DT * self._ticks))


def sensor(context: Context) -> Part:
    """Runs over growing noise, bias and drift."""
    noise, bias, drift = (context.pick(full=over, short=over[1::3]) for over in (_NOISE, _BIAS, _DRIFT))
    plants: list[tuple[str, Sequence[float], Callable[[float], Any]]] = [
        ("noise [m]", noise, lambda size: bik.KinematicPlant(IIWA, noise=size, seed=context.seed)),
        ("bias [m]", bias, lambda size: Sensor(size, 0.0).move),
        ("drift [m/s]", drift, lambda size: Sensor(0.0, size).move),
    ]
    found = {
        what: {
            name: np.array([_errors(plant(size), controller, context.seed) for size in sizes])
            for name, controller in _CONTROLLERS.items()
        }
        for what, sizes, plant in context.each("khan2022: sensor", plants)
    }
    sizes = {what: values for what, values, _ in plants}
    section = Section(
        TITLE,
        [
            _TEXT,
            Figure(
                name="sensor",
                title="True error over noise, bias and drift of the sensor",
                drawing=_draw(sizes, found),
                caption="The circle in 20 s, ticks of 1 ms, one measurement each; rms of the second half. Solid: where "
                "the arm is sent; dotted: at the state θ of ZNNBAS, where the arm never is.",
            ),
            _table(sizes, found),
        ],
    )
    quiet = dict(zip(noise, found["noise [m]"]["BroydenBAS"][:, 0], strict=True))
    return section, [averages({size: float(error) for size, error in quiet.items() if size <= _UP_TO})]


def averages(errors: dict[float, float]) -> Check:
    """Checks true rms errors of BroydenBAS (m) by standard deviation of the sensor (m)."""
    factors = {size: error / (size * np.sqrt(3.0)) for size, error in errors.items()}
    return Check(
        statement="`BroydenBAS` keeps within a few times the noise of its sensor.",
        rule=f"Up to {number(1e3 * _UP_TO, 1)} mm on each axis the true error is at most {_FACTOR:g} times the "
        "noise (rms).",
        measured="; ".join(f"{number(1e3 * size)} mm: {number(factor)} times" for size, factor in factors.items()),
        holds=bool(max(factors.values()) <= _FACTOR),
        section=TITLE,
    )


def _errors(plant: Any, controller: bik.papers.ZNNBAS | bik.BroydenBAS, seed: int) -> tuple[float, float]:
    """Returns true rms errors (m) in the second half, at the commanded and at the accepted configurations."""
    result = bik.track_model_free(plant, circle(_DURATION), ON_CIRCLE, dt=DT, controller=controller, seed=seed)
    half = slice(len(result.time) // 2, None)
    sent, accepted = (
        rms(((IIWA.fk(q[half])[:, :3, 3] - result.reference[half]) ** 2).sum(axis=1))
        for q in (result.command, result.q)
    )
    return sent, accepted


def _table(sizes: dict[str, Sequence[float]], found: dict[str, dict[str, Array]]) -> Table:
    return Table(
        name="sensor_errors",
        title="The numbers behind the figure: true rms error where the arm is sent",
        columns=[
            Column(name="sensor"),
            Column(name="size"),
            *(Column(name=name, unit="mm", digits=4) for name in _CONTROLLERS),
        ],
        rows=[
            [what, size, *(1e3 * float(by_method[name][i, 0]) for name in _CONTROLLERS)]
            for what, by_method in found.items()
            for i, size in enumerate(sizes[what])
        ],
        folded=True,
    )


def _draw(sizes: dict[str, Sequence[float]], found: dict[str, dict[str, Array]]) -> Drawing:
    colours = (ORANGE, VERMILION, BLUE)
    with drawing(4.2) as figure:
        panels = figure.subplots(1, 3, sharey=True)
        for axes, (what, by_method) in zip(panels, found.items(), strict=True):
            for (name, errors), colour in zip(by_method.items(), colours, strict=True):
                axes.loglog(sizes[what], errors[:, 0], color=colour, marker="o", markersize=4.0, label=name)
                if name.startswith("ZNNBAS"):
                    axes.loglog(sizes[what], errors[:, 1], color=colour, linestyle=":")
            if what == "drift [m/s]":
                taken = [size * 0.75 * _DURATION for size in sizes[what]]
            else:
                taken = [size * (np.sqrt(3.0) if what == "noise [m]" else 1.0) for size in sizes[what]]
            axes.loglog(sizes[what], taken, color=GREEN, linestyle="--", linewidth=1.0, label="the sensor's own error")
            axes.set_xlabel(f"{what}")
        panels[0].set_ylabel("true error of the tool [m], rms")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=2, fontsize="small")
    return figure
