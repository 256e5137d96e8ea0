"""`beetle-ik reproduce`: repeats a paper's experiments."""

from collections import Counter
from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from .. import experiments
from ..calls.progress import Bar
from ..calls.text import counted
from ..report import Provenance, Report, Verdict, described
from .options import AsJson, Seed
from .show import print_json, print_table


def reproduce(
    name: Annotated[str, typer.Argument(help=f"One of {', '.join(experiments.names())}, or all.")],
    *,
    out: Annotated[
        Path, typer.Option(help="Folder for the report, its tables and figures; an earlier report is replaced.")
    ],
    short: Annotated[bool, typer.Option("--short", help="A quick pass with fewer runs.")] = False,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Repeat a paper's experiments: each table next to the printed one, each figure, and a verdict on each claim.

    The exit status is 1 if a check of the library itself fails. A contradicted claim of a paper is a finding, not an
    error.
    """
    with closing(Bar()) as bar:
        done = experiments.reproduce(name, out, short=short, seed=seed, progress=bar.show, option="--out")
    if as_json:
        described_reports = [described(report, made) for report, made in done]
        print_json(described_reports if name == experiments.ALL else described_reports[0])
    else:
        _show(done, out / ("index.html" if name == experiments.ALL else "report.html"))
    raise typer.Exit(1 if any(report.failed for report, _ in done) else 0)


def _show(done: list[tuple[Report, Provenance]], page: Path) -> None:
    rows = [(made.name, _verdicts(report), _checks(report), f"{made.elapsed:.1f}") for report, made in done]
    print_table("Claims by verdict", ("experiment", "claims of the paper", "checks", "time [s]"), rows)
    for report, made in done:
        for check in report.failed:
            typer.echo(f"{made.name}: check failed: {check.statement} Rule: {check.rule} Measured: {check.measured}")
    typer.echo(f"{counted(len(done), 'report')}: {page}")


def _verdicts(report: Report) -> str:
    counts = Counter(claim.verdict for claim in report.claims)
    return "\n".join(f"{counts[verdict]} {verdict}" for verdict in Verdict if counts[verdict])


def _checks(report: Report) -> str:
    return f"{len(report.checks) - len(report.failed)} of {len(report.checks)} passed"
