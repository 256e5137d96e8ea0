"""The measurements as CSV, Markdown and a picture."""

# ruff: noqa: D103

from __future__ import annotations

import csv
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from .measure import Times
from .tracking import STEPS, Followed

REFERENCE = "beetle-ik"


@dataclass(frozen=True)
class Row:
    """One line of the table: a library on a robot and task; `times` None with a note where it was not measured."""

    task: str
    order: str
    robot: str
    library: str
    times: Times | None
    note: str = ""


def write_csv(rows: list[Row], path: Path) -> None:
    with path.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(
            ["task", "order", "robot", "library", "solved_percent", "median_us", "mean_us", "p99_us", "note"]
        )
        for row in rows:
            figures = [f"{x:.4g}" for x in asdict(row.times).values()] if row.times else [""] * 4
            table.writerow([row.task, row.order, row.robot, row.library, *figures, row.note])


def times_section(task: str, order: str, rows: list[Row]) -> str:
    """Success, median, mean and p99 of each library on each robot, and what the library takes beside beetle-ik."""
    cells = {(row.library, row.robot): row for row in rows if (row.task, row.order) == (task, order)}
    libraries = list(dict.fromkeys(library for library, _ in cells))
    robots = list(dict.fromkeys(robot for _, robot in cells))
    lines = [f"## {task}, {order}", "", "Solved % / median / mean / p99 in µs.", ""]
    lines += _header(["library", *robots, f"mean ÷ {REFERENCE}", f"p99 ÷ {REFERENCE}"])
    for library in libraries:
        of_library = [cells.get((library, robot)) for robot in robots]
        ratios = [_ratio(cells, library, robots, figure) for figure in ("mean", "p99")]
        lines.append(_line([library, *map(_cell, of_library), *ratios]))
    notes = dict.fromkeys(f"- {row.library}, {row.robot}: {row.note}" for row in cells.values() if row.note)
    return "\n".join([*lines, "", *(["Not measured:", "", *notes, ""] if notes else [])])


def _cell(row: Row | None) -> str:
    if row is None or row.times is None:
        return "-"
    times = row.times
    return f"{times.solved:.1f} / {times.median:.3g} / {times.mean:.3g} / {times.p99:.3g}"


def _ratio(cells: dict[tuple[str, str], Row], library: str, robots: list[str], figure: str) -> str:
    """Geometric mean of the ratios on the robots that both have."""
    logs = []
    for robot in robots:
        row, reference = cells.get((library, robot)), cells.get((REFERENCE, robot))
        if row and reference and row.times and reference.times:
            logs.append(np.log(getattr(row.times, figure) / getattr(reference.times, figure)))
    return f"{np.exp(np.mean(logs)):.2f} ({len(logs)} robots)" if logs else "-"


def tracking_section(followed: list[Followed]) -> str:
    """Time and largest error of each library round the circle, and its time beside the reference's."""
    cells = {(row.library, row.steps): row for row in followed}
    libraries = list(dict.fromkeys(row.library for row in followed))
    columns = ["library"]
    for steps in STEPS:
        columns += [f"{steps} steps, ms", "largest error, m (points missed)", f"÷ {libraries[0]}"]
    lines = []
    for library in libraries:
        lines.append([library])
        for steps in STEPS:
            row, reference = cells[library, steps], cells[libraries[0], steps]
            ratio = row.milliseconds / reference.milliseconds
            missed = f" ({row.missed})" if row.missed else ""
            lines[-1] += [f"{row.milliseconds:.3g}", f"{row.largest_error:.1e}{missed}", f"{ratio:.3g}"]
    return plain_section("Tracking: a circle of 0.2 m, iiwa14, position, warm-started", columns, lines)


def plain_section(title: str, columns: list[str], lines: list[list[str]]) -> str:
    return "\n".join([f"## {title}", "", *_header(columns), *map(_line, lines), ""])


def _header(columns: list[str]) -> list[str]:
    return [_line(columns), "|---" * len(columns) + "|"]


def _line(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def plot(rows: list[Row], task: str, order: str, title: str, path: Path) -> None:
    """Success against mean time: one colour a library, one point a robot, its geometric mean ringed."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    measured = [row for row in rows if (row.task, row.order) == (task, order) and row.times]
    libraries = list(dict.fromkeys(row.library for row in measured))
    figure, axes = plt.subplots(figsize=(9.0, 5.0), layout="constrained")
    for library, colour in zip(libraries, plt.get_cmap("tab20")(np.arange(len(libraries))), strict=True):
        times = [row.times for row in measured if row.library == library]
        means, solved = np.array([t.mean for t in times]), np.array([t.solved for t in times])
        axes.scatter(means, solved, color=colour, s=22, alpha=0.7)
        axes.scatter(
            np.exp(np.log(means).mean()), solved.mean(), color=colour, s=110, edgecolor="black", label=library, zorder=3
        )
    axes.set(xscale="log", xlabel="mean time a target [µs]", ylabel="solved [%]", ylim=(-3, 103), title=title)
    axes.grid(alpha=0.3, which="both")
    axes.legend(title="ringed: mean over robots", fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.savefig(path, dpi=150)
