"""Misprints of the paper, each with its evidence."""

import numpy as np

import beetle_ik as bik

from ...report import Check, Claim, Column, Part, Section, Table, number
from .published import DH_A, DH_ALPHA, DH_D, MISPRINTED_X, POSITION_2, R1, R1_CORRECTED, R2, START, TARGETS
from .task import ROBOT, Motion, home, reach, target

TITLE = "Misprints, and what shows them"
_HALF_DIGIT = 5e-6  # m, of Table 4


def typos(runs: list[Motion]) -> Part:
    """Tabulates the misprints, with numbers of this run."""
    section = Section(
        TITLE,
        [
            "The numbers of the paper contradict each other in the places below; everything else agrees with Table 1, "
            "read as Craig's modified Denavit-Hartenberg parameters without offsets.",
            Table(
                name="misprints",
                title="Misprints",
                columns=[Column(name="where"), Column(name="printed"), Column(name="correct"), Column(name="evidence")],
                rows=_rows(runs),
            ),
        ],
    )
    table_1 = bik.Robot.from_dh(a=DH_A, alpha=DH_ALPHA, d=DH_D, convention="modified")
    positions = np.array([table_1.fk(q)[:3, 3] for q in np.radians(R2)])
    off = float(np.abs(positions - POSITION_2).max())
    same = float(np.abs(table_1.fk(np.radians(START)) - home()).max())
    return section, [robot_claim(off), _robot_check(same)]


def robot_claim(off: float) -> Claim:
    """Judges the distance of Table 1's robot from the printed positions at the printed angles (m)."""
    return Claim.judged(
        "Table 1 and eq. (1) describe the robot of the experiment.",
        source="Tables 1, 3 and 4",
        rule=f"At the printed R₂ the tip is within {_HALF_DIGIT * 1e6:g} µm, half a last digit, of the printed place.",
        measured=f"within {number(off * 1e6, 2)} µm",
        holds=off <= _HALF_DIGIT,
        section=TITLE,
    )


def _robot_check(difference: float) -> Check:
    return Check(
        statement="The built-in robot `kr210_yuan2016` is that of Table 1.",
        rule="Entries of the tip's pose at motion 0 differ by less than 10⁻¹².",
        measured=number(difference, 1),
        holds=difference < 1e-12,
        section=TITLE,
    )


def _rows(runs: list[Motion]) -> list[list[str]]:
    first, last_but_one = (_count_with_x(runs[i], i) for i in (0, 5))
    rotation = home()[:3, :3]
    tilt = float(np.degrees(np.arccos((np.trace(target(0)[:3, :3].T @ rotation) - 1) / 2)))
    y = float(ROBOT.fk(runs[-1].solution.q)[1, 3])
    misprinted = [ROBOT.fk(np.radians(angles))[1, 3] for angles in (R1[0], R1_CORRECTED[0])]
    fourth = float(np.degrees(runs[-1].solution.q[3] + 2 * np.pi - runs[-1].start[3]))
    sixth = float(np.degrees(runs[3].solution.q[5] - runs[3].start[5]))
    return [
        [
            "Table 2, X of P₁ and P₆",
            f"{MISPRINTED_X} m",
            f"{TARGETS[0, 0]} m",
            f"Table 4 has the latter; with the former motions I-1 and 5-6 take {first} and {last_but_one} iterations, "
            "not 438 and 233.",
        ],
        ["Table 2, first and last column", "P₁", "P_I", "Its numbers are the tip's position in motion 0."],
        [
            "Parameters: η, E₀",
            "0.01, 10⁻⁸",
            "0.2, 5 × 10⁻¹⁰ in the scale of eq. (11)",
            "This pair gives all seven counts; both values differ from the printed ones by the factor 20.",
        ],
        [
            "Table 3, I-1, θ₁ and θ₆ of R₁",
            "-20.0995°, -147.3760°",
            "-20.0955°, -147.3756°",
            f"Table 3's own R₂, and Table 4's y of 0.63421 m: the printed angles give {misprinted[0]:.5f} m, the "
            f"corrected ones {misprinted[1]:.5f} m.",
        ],
        [
            "Eq. (22)",
            "for all targets",
            "not for P_I",
            f"At motion 0 the tip is turned by {tilt:.0f}° against eq. (22), and motion 6-I returns to its angles.",
        ],
        ["Table 4, 6-I, y of R₁", "0", f"{y:.5f} m", "Explains MAE₁ = 0 and MAE₂ = 0.05 mm of Table 5."],
        ["Eq. (20), last case", "θ", "θ + dθ", "As printed no step is ever made below one degree: nothing converges."],
        ["Table 6", "Motion I-2", "Motion 1-2", "As in the other tables."],
        [
            "Text on Table 6",
            "Newton-Raphson FALSE in 3-4 and 6-I",
            "in I-1 and 5-6",
            "Table 6 itself, and the next sentence of the text, which gives errors for 3-4 and 6-I.",
        ],
        ["Text, change of θ₆ in 3-4", "-86.6430°", f"{sixth:.4f}°", "R₁ of 3-4 minus R₂ of 2-3."],
        [
            "Text, change of θ₄ in 6-I",
            "142.4315°",
            f"{fourth:.4f}°",
            "No misprint: it is the change before eq. (12) removes a whole turn, and shows that it did.",
        ],
    ]


def _count_with_x(run: Motion, motion: int) -> int:
    """Counts the iterations of a motion to the x printed in Table 2."""
    goal = target(motion, [MISPRINTED_X, *TARGETS[motion, 1:]])
    return reach(goal, run.start, bik.papers.APPS.paper()).iterations
