"""What a campaign has tried: one row for each attack and kind of case, as CSV."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from .attack import Attack, Verdict, is_hard

KINDS = ("easy", "hard")


@dataclass
class Row:
    """Counts of one attack. An input is what the promise speaks of: a pose, a tick, a file; a case may have many."""

    attack: str
    kind: str
    promise: str
    page: str
    cases: int = 0
    inputs: int = 0
    refused: int = 0  # cases that ended in an error that the promise allows
    failures: int = 0
    seconds: float = 0.0

    def add(self, other: Row) -> None:
        """Adds the counts of another row."""
        for name in ("cases", "inputs", "refused", "failures", "seconds"):
            setattr(self, name, getattr(self, name) + getattr(other, name))


class Ledger:
    """The rows of all attacks."""

    def __init__(self, attacks: Iterable[Attack]) -> None:
        self.rows = {
            (attack.name, kind): Row(attack.name, kind, attack.promise, attack.page)
            for attack in attacks
            for kind in KINDS
        }

    def count(self, attack: str, index: int, verdict: Verdict, seconds: float) -> None:
        """Counts a case."""
        failed, refused = verdict.failure is not None, verdict.refused
        one = Row(attack, KINDS[is_hard(index)], "", "", 1, verdict.inputs, refused, failed, seconds)
        self.rows[attack, one.kind].add(one)

    def failures(self) -> int:
        """Returns the number of failing cases."""
        return sum(row.failures for row in self.rows.values())

    def write(self, file: Path) -> None:
        """Writes the rows; the file is whole at any time."""
        unfinished = file.with_suffix(".part")
        with unfinished.open("w", newline="", encoding="utf-8") as stream:
            table = csv.DictWriter(stream, [field.name for field in fields(Row)], lineterminator="\n")
            table.writeheader()
            table.writerows(asdict(row) | {"seconds": f"{row.seconds:.1f}"} for row in self.rows.values())
        os.replace(unfinished, file)  # noqa: PTH105  atomic


def read(files: Iterable[Path]) -> list[Row]:
    """Returns the rows of several files, the counts of equal attacks added."""
    rows: dict[tuple[str, str], Row] = {}
    for file in files:
        with file.open(newline="", encoding="utf-8") as stream:
            for line in csv.DictReader(stream):
                counts = {name: int(line[name]) for name in ("cases", "inputs", "refused", "failures")}
                row = Row(*(line[name] for name in ("attack", "kind", "promise", "page")), **counts)
                row.seconds = float(line["seconds"])
                if (row.attack, row.kind) in rows:
                    rows[row.attack, row.kind].add(row)
                else:
                    rows[row.attack, row.kind] = row
    return list(rows.values())


def markdown(rows: list[Row]) -> str:
    """Returns the table of `docs/reliability.md`: promise, attack, inputs easy and hard, failures."""
    lines = ["| promise | attack | inputs, easy | inputs, hard | refused | failures |", "|---|---|---|---|---|---|"]
    by_attack: dict[str, dict[str, Row]] = {}
    for row in rows:
        by_attack.setdefault(row.attack, {})[row.kind] = row
    for name, kinds in by_attack.items():
        easy, hard = (kinds.get(kind, Row(name, kind, "", "")) for kind in KINDS)
        first = next(iter(kinds.values()))
        refused, failures = easy.refused + hard.refused, easy.failures + hard.failures
        lines.append(
            f"| {first.promise} ([{first.page}]({first.page}.md)) | `{name}` | {easy.inputs:,} | {hard.inputs:,} "
            f"| {refused:,} | {failures:,} |"
        )
    return "\n".join(lines)
