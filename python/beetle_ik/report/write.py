"""A report as a folder: the page, a CSV file for each table, a PNG file for each figure, and all of it as JSON."""

import base64
import csv
import io
import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from .claim import Check, Claim
from .content import Figure, Report
from .folder import MANIFEST, files_in
from .page import index_page, report_page
from .picture import gif, png
from .provenance import Provenance
from .tables import to_csv

_DPI = 150
_DPI_SHORT = 75
_DPI_MOVING = 80


def write_report(folder: Path, report: Report, provenance: Provenance) -> None:
    """Writes the page, its JSON, `claims.csv`, `checks.csv`, tables (CSV) and figures (PNG, GIF) into `folder`."""
    dpi = _DPI_SHORT if provenance.short else _DPI
    for kind in ("tables", "figures"):
        (folder / kind).mkdir()
    for table in report.tables:
        (folder / "tables" / f"{table.name}.csv").write_text(to_csv(table), encoding="utf-8")
    embedded = {figure.name: _picture(figure, folder / "figures", dpi) for figure in report.figures}
    (folder / "claims.csv").write_text(_claims_csv(report.claims), encoding="utf-8")
    (folder / "checks.csv").write_text(_checks_csv(report.checks), encoding="utf-8")
    (folder / "report.html").write_text(report_page(report, provenance, embedded), encoding="utf-8")
    _write_manifest(folder, described(report, provenance))


def write_index(folder: Path, reports: list[tuple[Report, Provenance]]) -> None:
    """Writes the page over several reports, which are in folders of their names within `folder`."""
    (folder / "index.html").write_text(index_page(reports), encoding="utf-8")
    _write_manifest(folder, {"reports": [described(report, provenance) for report, provenance in reports]})


def described(report: Report, provenance: Provenance) -> dict[str, Any]:
    """Returns a report as data: its provenance, its contents, each claim."""
    return {
        **asdict(provenance),
        "success": not report.failed,
        "summary": report.summary,
        "carried_over": report.carried_over,
        "claims": [{**asdict(claim), "verdict": claim.verdict} for claim in report.claims],
        "checks": [asdict(check) for check in report.checks],
    }


def _write_manifest(folder: Path, content: dict[str, Any]) -> None:
    content = {**content, "files": [*files_in(folder), MANIFEST]}
    (folder / MANIFEST).write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def _picture(figure: Figure, folder: Path, dpi: int) -> str:
    """Writes a figure into `folder`, and returns it as a data address for the page."""
    if figure.frames is None:
        kind, content = "png", png(figure.drawing, dpi)
    else:
        kind, content = "gif", gif(figure.drawing, figure.frames, _DPI_MOVING)
    (folder / f"{figure.name}.{kind}").write_bytes(content)
    return f"data:image/{kind};base64,{base64.b64encode(content).decode()}"


def _claims_csv(claims: Sequence[Claim]) -> str:
    columns = ["statement", "source", "rule", "measured", "verdict", "notes"]
    return _csv(
        columns, [{**vars(claim), "verdict": claim.verdict, "notes": " ".join(claim.notes)} for claim in claims]
    )


def _checks_csv(checks: Sequence[Check]) -> str:
    return _csv(["statement", "rule", "measured", "holds"], [vars(check) for check in checks])


def _csv(columns: list[str], rows: list[dict[str, Any]]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()
