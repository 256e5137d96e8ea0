"""Tables 3 to 5, Figures 6 and 7: the seven motions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

import beetle_ik as bik

from ...report import (
    VERMILION,
    Claim,
    Column,
    Figure,
    Part,
    Section,
    Table,
    draw_arm_in_space,
    drawing,
    line,
    number,
    scale_alike,
)
from .published import ERRORS, ITERATIONS, MOTIONS, POSITION_1, POSITION_2, R1, R1_CORRECTED, R2, TARGETS, Array
from .task import ROBOT, Motion, run_all

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "Seven motions, to the last iteration"
_ANGLES = 2e-4  # degrees
_POSITIONS = 1e-5  # m
_MEAN_ERROR = 0.0115  # mm

_TEXT = """
The tip goes from its initial point through six target points and back. For each, APPS descends the gradient of E, half
the sum of squared differences between the entries of the target matrix and the tip's (eq. 11), by steps of at most one
degree per joint (eq. 20). The result R₁ is rounded to 0.01°, which gives R₂. The robot moves to R₂, and the next motion
starts there.

With the printed η = 0.01 and E₀ = 10⁻⁸ nothing agrees: no motion ends within the 1000 iterations allowed. **Everything
agrees, to the last iteration, if they belong to an E 20 times that of eq. (11)**; in the scale of eq. (11), that is η =
0.2 and E₀ = 5 × 10⁻¹⁰, the values of `APPS.paper()`. One factor corrects both numbers; the paper does not explain it.
The dead zone of eq. (20) as printed (no step at all below one degree) must be a misprint too: its last case lacks the
step.
"""
_TEXT_TABLES = """
E is evaluated first, then the angles change, then that E is compared with E₀. **The printed counts need this one update
after the threshold**, which the paper does not mention: a search that ends at the threshold itself makes one update
less in each motion. So R₁ is one update better than the E that ended the search, and iterations are updates. The fourth
joint of the last motion passes 360° on its way and is brought back by eq. (12).
"""


def replay() -> list[Motion]:
    """Repeats the motions with the paper's parameters."""
    return run_all(bik.papers.APPS.paper())


def motions(runs: list[Motion]) -> Part:
    """Compares angles, positions and errors of the seven motions."""
    angles = np.array([np.degrees(run.solution.q) for run in runs])
    first, second = (
        _positions([run.solution.q for run in runs]),
        _positions([np.radians(run.rounded) for run in runs]),
    )
    measured = np.array([run.rounded for run in runs])
    errors = _mean_errors(first, second)
    section = Section(
        TITLE,
        [
            _TEXT,
            Figure(
                name="figure_6",
                title="Figure 6: the path, and the robot at its initial point",
                drawing=_draw_path(runs),
                caption="Red: the order in which the tip visits its points. Faint: the robot at P₃ and P₄.",
            ),
            _TEXT_TABLES,
            _angle_table("table_3_r1", "Table 3, R₁: what APPS finds", R1, angles, decimals=4),
            _angle_table("table_3_r2", "Table 3, R₂: where the robot goes", R2, measured, decimals=2),
            _position_table(first, second),
            _error_table(errors),
            Figure(
                name="figure_7",
                title="Figure 7: mean absolute errors of the tip's position",
                drawing=_draw_errors(errors),
                caption="Rounding the angles to 0.01° adds up to ten times the error that APPS leaves.",
            ),
        ],
    )
    return section, _claims(runs, angles, first, measured, errors)


def _positions(configurations: list[Array]) -> Array:
    return np.array([ROBOT.fk(q)[:3, 3] for q in configurations])


def _mean_errors(first: Array, second: Array) -> Array:
    """Returns MAE_1, MAE_2 and MAE_S (mm), of positions rounded to 5 decimals as in the paper."""
    first, second = np.round(first, 5), np.round(second, 5)
    one = np.abs(TARGETS - first).mean(axis=1) * 1e3
    two = np.abs(first - second).mean(axis=1) * 1e3
    return np.column_stack([one, two, np.round(one, 2) + np.round(two, 2)])


def _angle_table(name: str, title: str, printed: Array, measured: Array, *, decimals: int) -> Table:
    return Table(
        name=name,
        title=title,
        columns=[Column(name="motion"), *(Column(name=f"θ{j + 1}", unit="°", compared=True) for j in range(6))],
        rows=[
            [motion, *((f"{p:.{decimals}f}", f"{m:.{decimals}f}") for p, m in zip(*pair, strict=True))]
            for motion, *pair in zip(MOTIONS, printed, measured, strict=True)
        ],
        caption="θ1 and θ6 of the first motion are misprinted: see the last section." if decimals == 4 else "",
    )


def _position_table(first: Array, second: Array) -> Table:
    def pairs(printed: Array, measured: Array) -> list[tuple[str, str]]:
        return [(f"{p:.5f}", f"{m:.5f}") for p, m in zip(printed, measured + 0.0, strict=True)]

    return Table(
        name="table_4",
        title="Table 4: position of the tip at R₁ and at R₂",
        columns=[
            Column(name="motion"),
            *(Column(name=f"{axis} of {of}", unit="m", compared=True) for of in ("R₁", "R₂") for axis in "xyz"),
        ],
        rows=[
            [motion, *pairs(POSITION_1[i], first[i]), *pairs(POSITION_2[i], second[i])]
            for i, motion in enumerate(MOTIONS)
        ],
    )


def _error_table(errors: Array) -> Table:
    names = ("APPS: MAE₁", "rounding: MAE₂", "both: MAE_S")
    return Table(
        name="table_5",
        title="Table 5: mean absolute error of the tip's position",
        columns=[Column(name="motion"), *(Column(name=name, unit="mm", compared=True) for name in names)],
        rows=[
            [motion, *((f"{p:.2f}", f"{m:.2f}") for p, m in zip(*pair, strict=True))]
            for motion, *pair in zip(MOTIONS, ERRORS, errors, strict=True)
        ],
        caption=(
            "The last motion's 0 and 0.05 follow from the y of R₁ that the paper rounds to 0 where it is 0.00002 m: "
            "with it they are 0.01 and 0.04."
        ),
    )


_FACTOR = (
    "η and E₀ belong to an E that is 20 times that of eq. (11); eq. (20) is mended; the search ends one update after E "
    "has fallen to E₀."
)


def _claims(runs: list[Motion], angles: Array, positions: Array, rounded: Array, errors: Array) -> list[Claim]:
    corrected = POSITION_1.copy()
    corrected[-1, 1] = 0.00002
    return [
        counts_claim([run.solution.iterations for run in runs], solved=all(run.solution.success for run in runs)),
        angles_claim(float(np.abs(angles - R1_CORRECTED).max()), int((rounded == R2).sum())),
        positions_claim(
            float(np.abs(np.round(positions, 5) - corrected).max()),
            float(np.abs(positions - TARGETS).mean(axis=1).max() * 1e3),
        ),
        system_error_claim(errors[:, 2]),
        _robot_claim(),
    ]


def counts_claim(counts: Sequence[int], *, solved: bool) -> Claim:
    """Judges the iterations of the seven motions."""
    return Claim.judged(
        "APPS needs 438, 256, 316, 618, 278, 233 and 281 iterations.",
        source="Table 6",
        rule="All seven counts are the printed ones, and all motions are solved to 10⁻⁴ m and rad.",
        measured=f"{', '.join(map(str, counts))}, {'all' if solved else 'not all'} solved",
        holds=tuple(counts) == ITERATIONS and solved,
        reading=_FACTOR,
        section=TITLE,
    )


def angles_claim(off: float, equal: int) -> Claim:
    """Judges the largest difference from R₁ (degrees), and the number of rounded angles that equal R₂."""
    return Claim.judged(
        "It ends at the angles R₁, and rounded, at R₂.",
        source="Table 3",
        rule=f"R₁ to {number(_ANGLES, 1)}°, all {R2.size} angles of R₂ exactly.",
        measured=f"largest difference {number(off, 2)}°; {equal} of {R2.size} rounded angles equal",
        holds=off <= _ANGLES and equal == R2.size,
        reading=f"{_FACTOR} Two angles of the first motion are misprinted.",
        section=TITLE,
    )


def positions_claim(off: float, mean_error: float) -> Claim:
    """Judges the largest difference from Table 4 (m), and the largest MAE₁ (mm)."""
    return Claim.judged(
        "It brings the tip to the positions of Table 4, to 0.01 mm.",
        source="Tables 4 and 5",
        rule=f"Positions differ by at most {number(_POSITIONS, 1)} m, and MAE₁ is at most {_MEAN_ERROR} mm.",
        measured=f"largest difference {number(off, 1)} m, MAE₁ {number(mean_error, 3)} mm at most",
        holds=off <= _POSITIONS and mean_error <= _MEAN_ERROR,
        reading=f"{_FACTOR} One coordinate of 0.00002 m is printed as 0.",
        section=TITLE,
    )


def system_error_claim(measured: Array) -> Claim:
    """Judges MAE_S (mm) of the seven motions."""
    off = float(np.abs(np.round(measured, 2) - ERRORS[:, 2]).max())
    return Claim.judged(
        "The error of the whole system is tiny: MAE_S of 0.12, 0.08, 0.02, 0.02, 0.09, 0.12 and 0.05 mm.",
        source="Table 5, Figure 7",
        rule="Rounded to 0.01 mm, all seven are the printed ones.",
        measured=f"{', '.join(f'{error:.2f}' for error in measured)} mm",
        holds=off < 0.005,
        reading=f"{_FACTOR} Errors are of positions rounded to 5 decimals, as in Table 4.",
        section=TITLE,
    )


def _robot_claim() -> Claim:
    return Claim.judged(
        "The physical robot tracks the path by APPS.",
        source="Section “Experiment validation”",
        rule="The robot's tip is where Table 4 has it for R₂.",
        measured="",
        holds=None,
        reason="We have no KUKA. R₂, what is sent to the robot, is computed; where the robot went is not printed.",
        section=TITLE,
    )


def _draw_path(runs: list[Motion]) -> Drawing:
    start = runs[0].start
    points = np.vstack([ROBOT.fk(start)[:3, 3], TARGETS])
    with drawing(7.2) as figure:
        axes: Any = figure.add_subplot(projection="3d")
        for run in (runs[2], runs[3]):
            draw_arm_in_space(axes, ROBOT, run.solution.q, alpha=0.25)
        draw_arm_in_space(axes, ROBOT, start)
        axes.plot(*points.T, color=VERMILION, marker="o", markersize=5, linewidth=1.5, zorder=5)
        for name, point in zip(["I", *"123456"], points, strict=False):
            beside = [-0.02, 0.0, -0.16] if name == "I" else [0.07, 0.0, 0.03]
            axes.text(*(point + beside), f"$P_{name}$", color=VERMILION, zorder=6)
        axes.set_zlim(0.0, None)
        axes.view_init(elev=28, azim=-58)
        scale_alike(axes)
    return figure


def _draw_errors(errors: Array) -> Drawing:
    names = ("MAE₁: left by APPS", "MAE₂: by rounding to 0.01°", "MAE_S: both")
    with drawing(2.8) as figure:
        axes = figure.subplots()
        place = np.arange(len(MOTIONS))
        for i, name in enumerate(names):
            axes.bar(
                place + 0.26 * (i - 1), errors[:, i], width=0.24, color=line(i)["color"], label=f"{name}, measured"
            )
            label = "printed" if i == 2 else None
            axes.plot(place + 0.26 * (i - 1), ERRORS[:, i], "k_", markersize=11, markeredgewidth=1.6, label=label)
        axes.set_xticks(place, MOTIONS)
        axes.set(xlabel="motion", ylabel="mean absolute error [mm]")
        axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
        axes.grid(visible=False, axis="x")
    return figure
