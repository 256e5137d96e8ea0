"""Reports: text, figures, tables of printed and measured values, claims with verdicts, and checks.

    from beetle_ik.report import Claim, Column, Figure, Report, Section, Table, drawing

    with drawing(height=3.0) as figure:
        axes = figure.subplots()
        axes.plot([0.0, 1.0], [0.0, 1.0])
        axes.set(xlabel="time [s]", ylabel="position [m]")
    motion = Figure(name="motion", title="A motion", drawing=figure)
    report = Report(summary="It moves.", sections=[Section("Motion", ["Watch:", motion])])

`beetle_ik.experiments` makes them; `write_report` writes one as a self-contained HTML page beside CSV and PNG files.
"""

from ..figures.style import BLACK, BLUE, FORBIDDEN, GREEN, ORANGE, PALETTE, PURPLE, SKY, VERMILION, line
from .claim import Check, Claim, Printed, Verdict, not_given
from .content import Block, CarriedOver, Cell, Column, Figure, Part, Report, Section, Spread, Table, Value
from .drawing import draw_arm_in_space, draw_error, draw_velocities, draw_velocities_by_joint, drawing, scale_alike
from .folder import report_folder
from .needs import check_installed
from .numbers import number
from .provenance import Provenance
from .write import described, write_index, write_report

__all__ = [
    "BLACK",
    "BLUE",
    "FORBIDDEN",
    "GREEN",
    "ORANGE",
    "PALETTE",
    "PURPLE",
    "SKY",
    "VERMILION",
    "Block",
    "CarriedOver",
    "Cell",
    "Check",
    "Claim",
    "Column",
    "Figure",
    "Part",
    "Printed",
    "Provenance",
    "Report",
    "Section",
    "Spread",
    "Table",
    "Value",
    "Verdict",
    "check_installed",
    "described",
    "draw_arm_in_space",
    "draw_error",
    "draw_velocities",
    "draw_velocities_by_joint",
    "drawing",
    "line",
    "not_given",
    "number",
    "report_folder",
    "scale_alike",
    "write_index",
    "write_report",
]
