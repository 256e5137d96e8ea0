"""Pages: templates filled with a report."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from .claim import Verdict
from .content import CarriedOver, Figure, Report, Table
from .markup import inline, paragraphs, slug
from .tables import shown_rows

if TYPE_CHECKING:
    from jinja2 import Environment

    from .provenance import Provenance

_INCHES = 96  # pixels an inch of a page


def report_page(report: Report, provenance: Provenance, pictures: dict[str, str]) -> str:
    """Returns the page of one report; `pictures` are the figures by name, as data addresses."""
    page = _templates().get_template("report.html")
    return page.render(report=report, made=provenance, pictures=pictures, counts=_counts([report]))


def index_page(reports: list[tuple[Report, Provenance]]) -> str:
    """Returns the page over several reports, with all their claims."""
    page = _templates().get_template("index.html")
    return page.render(reports=reports, counts=_counts([report for report, _ in reports]))


def _counts(reports: list[Report]) -> list[tuple[Verdict, int]]:
    """Counts the claims of each verdict, zero included: every verdict is explained."""
    counts = Counter(claim.verdict for report in reports for claim in report.claims)
    return [(verdict, counts[verdict]) for verdict in Verdict]


def _templates() -> Environment:
    from jinja2 import Environment, PackageLoader, StrictUndefined
    from markupsafe import Markup

    templates = Environment(
        loader=PackageLoader("beetle_ik.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    tests: dict[str, Any] = {
        "table": lambda block: isinstance(block, Table),
        "figure": lambda block: isinstance(block, Figure),
        "carried_over": lambda block: isinstance(block, CarriedOver),
    }
    templates.tests.update(tests)
    templates.filters.update(
        paragraphs=lambda text: Markup(paragraphs(text)),  # both functions escape their text
        inline=lambda text: Markup(inline(text)),
        slug=slug,
        rows=shown_rows,
        breadth=lambda table: sum(2 if column.compared else 1 for column in table.columns),
        pixels=lambda inches: round(inches * _INCHES),
        kind=lambda verdict: verdict.name.lower().replace("_", "-"),
    )
    return templates
