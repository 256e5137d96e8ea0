"""Figures 2 and 3: the letter M and the star."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

import beetle_ik as bik

from ...report import (
    BLUE,
    GREEN,
    ORANGE,
    SKY,
    VERMILION,
    Block,
    Claim,
    Column,
    Figure,
    Part,
    Section,
    Spread,
    Table,
    drawing,
    line,
    number,
)
from ..experiment import Context
from .settings import (
    ADAPTIVE,
    ARRIVED,
    FAST,
    IIWA,
    POSITION_LIMITS,
    PUBLISHED,
    SMALL_STAR,
    STAR,
    VERTICES,
    M,
    Run,
    follow,
    star_as_printed,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "Figures 2 and 3: the M and the star"
_SEEDS, _SEEDS_SHORT = 20, 2
_EVERY = 50  # rows of 1 ms between points that are drawn

_TEXT = """
All runs start in the home position, with the arm erect, and make exactly one measurement a millisecond: 50,000 in 50
s. Two errors have to be told apart. The controller sends the arm to θ′ = θ + λb, a random antenna away from its state
θ, and measures there; the arm never stands at θ. The paper's 10⁻⁵ can only be h(θ).
"""
_TEXT_LIMITS = """
**The M cannot be drawn within the limits of the arm.** Its vertex (0.1, 0.2, 0.5) is {residual} m out of reach: with
joints 4 and 6 within 120 degrees the tool comes no nearer to the shoulder. Most of the first stroke, which takes the
first 12.5 s, lies beyond. So a run that reaches the path in under ten seconds, as the paper's does, cannot have kept
the limits of eq. (7).
"""
_TEXT_STAR = """
Nor is the star a star as printed. Eq. (20) multiplies its terms by a_y, b_y, a_z and b_z; with a = (0, 1, 0) and b =
(0, 0, 1) two of the four vanish, and what is left is the Lissajous curve on the left. We take the hypotrochoid that
must be meant. R, r and d are not stated: we use 0.10, 0.06 and 0.10 m without limits, and 0.04, 0.024 and 0.04 m
within them.
"""


@dataclass(frozen=True, kw_only=True, eq=False)  # told apart by identity: a path has no hash
class Case:
    """A path with constants of the controller, with limits or without."""

    path: bik.Path
    path_name: str
    controller: bik.ZNNBAS
    constants: str
    limits: bik.Limits | None = None


_M_PUBLISHED = Case(path=M, path_name="M", controller=PUBLISHED, constants="published")
_M_ADAPTIVE = Case(path=M, path_name="M", controller=ADAPTIVE, constants="k = 100, eq. (16)")
_M_FAST = Case(path=M, path_name="M", controller=FAST, constants="k = 300, eq. (16)")
_M_LIMITED = replace(_M_PUBLISHED, limits=POSITION_LIMITS)
_STAR_PUBLISHED = Case(path=STAR, path_name="star", controller=PUBLISHED, constants="published")
_STAR_ADAPTIVE = Case(path=STAR, path_name="star", controller=ADAPTIVE, constants="k = 100, eq. (16)")
_SMALL_STAR = replace(_STAR_PUBLISHED, path=SMALL_STAR, path_name="small star", limits=POSITION_LIMITS)
_CASES = (_M_PUBLISHED, _M_ADAPTIVE, _M_FAST, _M_LIMITED, _STAR_PUBLISHED, _STAR_ADAPTIVE, _SMALL_STAR)


@dataclass(frozen=True)
class Runs:
    """A case over several seeds. What stays of a run is a few numbers: only the first is kept whole."""

    first: Run
    late_h: Spread
    """h at theta from 40 to 50 s (m^2)."""
    late_sent_h: Spread
    """The same at theta', where the arm is."""
    latest: float
    """When h first fell below 1e-3 m^2, at the latest (s)."""


def figures(context: Context) -> Part:
    """Both paths, with the published antenna and with that of eq. (16), with limits and without."""
    seeds = context.seeds(context.pick(full=_SEEDS, short=_SEEDS_SHORT))
    found = {case: _run(case, seeds) for case in context.each("khan2022: Figures 2 and 3", _CASES)}
    residual = bik.solve(IIWA, VERTICES[1]).position_error
    blocks: list[Block] = [
        _TEXT,
        Figure(
            name="figure_2",
            title="Figure 2: the M without limits, published constants",
            drawing=_draw_run(found[_M_PUBLISHED].first),
            caption="Blue is θ, where the arm never stands; sky-blue the commanded tool, which shakes about it by "
            f"{number(_shaking(found[_M_PUBLISHED].first.late_sent_h), 2)} cm (rms).",
        ),
        _TEXT_LIMITS.format(residual=number(residual, 3)),
        Figure(
            name="figure_2_limits",
            title="The same within the position limits of the arm",
            drawing=_draw_run(found[_M_LIMITED].first),
            caption="Until the second stroke leads away from the shoulder, the error cannot go to zero.",
        ),
        _TEXT_STAR,
        Figure(
            name="figure_3_paths",
            title="Eq. (20) as printed, and as it must be meant",
            drawing=_draw_stars(),
            caption="Both with R = 0.10, r = 0.06 and d = 0.10 m, seen along x.",
        ),
        Figure(
            name="figure_3",
            title="Figure 3: the star without limits, antenna of eq. (16), k = 100",
            drawing=_draw_run(found[_STAR_ADAPTIVE].first),
            caption="With an antenna that shrinks with the error the commanded tool hardly shakes.",
        ),
        _table(found, len(seeds)),
    ]
    return Section(TITLE, blocks), [*_error_claims(found), _noise_claim(found)]


def _run(case: Case, seeds: range) -> Runs:
    runs = [follow(case.path, case.controller, seed=seed, limits=case.limits) for seed in seeds]
    return Runs(
        runs[0],
        Spread.of([run.late_h for run in runs]),
        Spread.of([run.late_sent_h for run in runs]),
        max(run.arrival for run in runs),
    )


def _shaking(sent_h: float) -> float:
    """How far the commanded tool is off its path (cm, rms)."""
    return 100.0 * float(np.sqrt(sent_h))


def _table(found: dict[Case, Runs], seeds: int) -> Table:
    return Table(
        name="figures_2_and_3",
        title=f"Errors from 40 to 50 s, and arrival, over {seeds} seeds",
        columns=[
            Column(name="path"),
            Column(name="constants"),
            Column(name="limits"),
            Column(name="h(θ), 40 to 50 s", unit="m²"),
            Column(name="h(θ′), where the arm is", unit="m²"),
            Column(name="h below 10⁻³, latest", unit="s"),
        ],
        rows=[
            [
                case.path_name,
                case.constants,
                "none" if case.limits is None else "positions",
                runs.late_h,
                runs.late_sent_h,
                runs.latest,
            ]
            for case, runs in found.items()
        ],
        caption="Published: λ = 0.1, k = 10, α = 10 ticks, with a time step of 1 ms.",
    )


def _error_claims(found: dict[Case, Runs]) -> list[Claim]:
    free, adaptive, star = found[_M_PUBLISHED], found[_M_ADAPTIVE], found[_STAR_ADAPTIVE]
    return [
        Claim.judged(
            "On the M the objective approaches zero in less than 10 s.",
            source="Section 4, Figure 2(d)",
            rule=f"h is below {number(ARRIVED, 1)} m² after at most 8 s, in every run.",
            measured=f"h first below {number(ARRIVED, 1)} m² after {number(free.latest)} s at the latest (8 s)",
            holds=free.latest <= 8.0,
            reading=f"without the arm's limits; within them it takes {number(found[_M_LIMITED].latest)} s, because the "
            "first stroke is out of reach",
            section=TITLE,
        ),
        Claim.judged(
            "Between 40 and 50 s the error on the M goes down to 10⁻⁵.",
            source="Section 4, Figure 2(d)",
            rule="The mean of h from 40 to 50 s is at most 2 × 10⁻⁵.",
            measured=f"mean h(θ) {number(adaptive.late_h.mean)} m² (at most 2 × 10⁻⁵)",
            holds=adaptive.late_h.mean <= 2e-5,
            reading="with the antenna of eq. (16), c1 = 0.3 and k = 100; the published constants give "
            f"{number(free.late_h.mean, 2)} m²",
            section=TITLE,
        ),
        Claim.judged(
            "On the star the objective approaches zero in less than 3 s.",
            source="Section 4, Figure 3(d)",
            rule=f"h is below {number(ARRIVED, 1)} m² after at most 3 s, in every run.",
            measured=f"{number(star.latest)} s at the latest (3 s)",
            holds=star.latest <= 3.0,
            reading="with the antenna of eq. (16) and k = 100; the published constants take "
            f"{number(found[_STAR_PUBLISHED].latest)} s",
            section=TITLE,
        ),
    ]


def _noise_claim(found: dict[Case, Runs]) -> Claim:
    return Claim.judged(
        "It optimises “without showing any spikes of noise or undesirable behavior of manipulator”.",
        source="Section 4",
        rule="Not stated.",
        measured="with the published constants the commanded tool is "
        f"{number(_shaking(found[_M_PUBLISHED].late_sent_h.mean), 2)} cm (rms) off its path",
        reason="every command is a random antenna away from the state whose error is reported, and λ = 0.1 rad "
        "moves the tool by centimetres a millisecond",
        holds=None,
        section=TITLE,
    )


def _draw_run(run: Run) -> Drawing:
    """Path in space, coordinates, joints, objective, errors: the paper's panels (a) to (e)."""
    rows = slice(None, None, _EVERY)
    time, tip, reference = run.time[rows], run.tip[rows], run.result.reference[rows]
    with drawing(6.6) as figure:
        grid = figure.add_gridspec(3, 2, width_ratios=[1.0, 1.2])
        space: Any = figure.add_subplot(grid[:2, 0], projection="3d")
        space.plot(*run.result.position[rows].T, color=SKY, linewidth=0.4, label="commanded tool")
        space.plot(*reference.T, color=VERMILION, linewidth=4.0, alpha=0.45, label="path")
        space.plot(*tip.T, color=BLUE, label="at θ")
        space.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
        space.locator_params(nbins=4)
        space.zaxis.labelpad = -2.0  # beside its numbers, not beside the next panel
        space.view_init(elev=18.0, azim=-25.0)
        space.legend(loc="upper left", bbox_to_anchor=(-0.1, 1.08))
        coordinates, joints, errors = (figure.add_subplot(grid[row, 1]) for row in range(3))
        objective = figure.add_subplot(grid[2, 0])
        for k, (name, colour) in enumerate(zip("xyz", (BLUE, GREEN, ORANGE), strict=True)):
            coordinates.plot(time, reference[:, k], color=colour, linewidth=4.0, alpha=0.3)
            coordinates.plot(time, tip[:, k], color=colour, label=name)
            errors.plot(time, tip[:, k] - reference[:, k], color=colour, label=name)
        for j, q in enumerate(run.result.q[rows].T):
            joints.plot(time, q, label=f"{j + 1}", **line(j))
        objective.semilogy(time, run.sent_h[rows], color=SKY, linewidth=0.4, label="h(θ′), commanded")
        objective.semilogy(time, run.h[rows], color=BLUE, label="h(θ)")
        errors.set_ylim(-0.1, 0.1)
        coordinates.set_ylabel("position [m]")
        joints.set_ylabel("joints [rad]")
        errors.set_ylabel("error at θ [m]")
        objective.set_ylabel("objective [m²]")
        for axes in (coordinates, joints, errors):
            axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        objective.legend(loc="upper right")
        for axes in (coordinates, joints, errors, objective):
            axes.set(xlim=(0.0, run.time[-1]), xlabel="time [s]")
    return figure


def _draw_stars() -> Drawing:
    time = np.linspace(0.0, 50.0, 1001)
    curves = (
        ("as printed", np.array([star_as_printed(t) for t in time])),
        ("as it must be meant", STAR.position(time)),
    )
    with drawing(3.0) as figure:
        panels = figure.subplots(1, 2, sharex=True, sharey=True)
        for axes, (name, points) in zip(panels, curves, strict=True):
            axes.plot(points[:, 1], points[:, 2], color=BLUE)
            axes.set(title=name, xlabel="y [m]", aspect="equal")
        panels[0].set_ylabel("z [m]")
    return figure
