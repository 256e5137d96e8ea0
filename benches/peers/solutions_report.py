"""Times and counts of `all_solutions.py` in one short table."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

Row = dict[str, str]

SUMMARY_COLUMNS = [
    *("arms", "library", "a pose in a row, µs", "time over ours in a row", "alternating"),
    *("solutions a pose", "poses with more than ours"),
]
CLOSED = ("spherical", "axes")  # beginnings of `closed_form` for arms solved without a search along a joint


def summary_lines(times: list[Row]) -> list[list[str]]:
    """Lines of the table, one per kind of arm and library: range of times, geometric mean of ratios, mean of counts."""
    groups: dict[tuple[str, str], list[Row]] = defaultdict(list)
    for row in times:
        groups[_kind(row), row["library"]].append(row)
    lines = []
    for (kind, library), mine in groups.items():
        in_a_row = [row for row in mine if row["order"] == "in a row"]
        alternating = [row for row in mine if row["order"] == "alternating"]
        medians = sorted(float(row["median_us"]) for row in in_a_row)
        lines.append(
            [
                f"{len(in_a_row)} {kind}",
                library,
                f"{medians[0]:.3g} to {medians[-1]:.3g}",
                _ratio(in_a_row),
                _ratio(alternating),
                f"{np.mean([float(row['solutions_a_pose']) for row in in_a_row]):.3g}",
                str(sum(int(row["poses_with_more_than_ours"]) for row in in_a_row)),
            ]
        )
    return lines


def _kind(row: Row) -> str:
    joints = f"{row['joints']} joints"
    return (
        f"of {joints}, three axes parallel or meeting" if row["structure"].startswith(CLOSED) else f"other of {joints}"
    )


def _ratio(rows: list[Row]) -> str:
    return f"{np.exp(np.mean([np.log(float(row['time_over_ours'])) for row in rows])):.2g}"
