"""Cheng et al. 2020: beetle antennae search under a variable joint velocity limit."""

from ..report import Claim, Column, Figure, Printed, Report, Section, Spread, Table, drawing, line
from .experiment import Context, Experiment


def run(context: Context) -> Report:
    """Run it."""
    with drawing(3.0) as figure:
        axes = figure.subplots()
        for i in range(3):
            axes.plot([0, 1], [i, 0], label=f"a{i}", **line(i))
        axes.legend()
    for _ in context.each("x", range(3)):
        pass
    table = Table(
        name="table_2",
        title="Table 2: time",
        columns=[Column(name="method"), Column(name="time", unit="s", compared=True), Column(name="evaluations")],
        rows=[
            ["BAS", (Spread(0.53, 0.04), Spread(1.234e-6, 3e-8)), 12345],
            ["GA", (Printed.NOT_IN_COPY, 1.234e-6), None],
        ],
    )
    return Report(
        summary="A **summary** with `code`.",
        sections=[Section("One", ["Text.\n\n- a\n- b *c*", table, Figure(name="f", title="F", drawing=figure)])],
        claims=[Claim.checked("It is.", source="S 1", measured="1 m", holds=True, section="One")],
    )


EXPERIMENT = Experiment(name="cheng2020", title="T", paper="P", run=run)
