"""Measurements as CSV, Markdown and a picture."""

# ruff: noqa: D103

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from .measure import Times
from .tracking import STEPS, BeetleIkTrack, BeetleIkTracker, Followed

REFERENCE = "beetle-ik"
Cells = dict[tuple[str, str], "Row"]  # by library and robot


@dataclass(frozen=True)
class Row:
    """Line of the table: a library on a robot and task; `times` None with a note if it was not measured."""

    task: str
    order: str
    robot: str
    library: str
    times: Times | None
    note: str = ""


def write_table(path: Path, columns: list[str], lines: list[list[str]]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([columns, *lines])


ROW_COLUMNS = ["task", "order", "robot", "library", "solved", "calls", "median_us", "mean_us", "p99_us", "note"]


def row_line(row: Row) -> list[str]:
    figures = [f"{x:.4g}" for x in asdict(row.times).values()] if row.times else [""] * 5
    return [row.task, row.order, row.robot, row.library, *figures, row.note]


def summary_columns(orders: Iterable[str]) -> list[str]:
    return ["library", "arms", "calls solved on an arm", *(f"time over ours, {order}" for order in orders)]


def summary_lines(rows: list[Row], task: str, orders: Iterable[str], versions: dict[str, str]) -> list[list[str]]:
    """Lines of the summary, one a library, over all arms that it supports."""
    measured = [row for row in rows if row.task == task and row.times]
    lines = []
    for library in dict.fromkeys(row.library for row in rows if row.task == task):
        mine = [row for row in measured if row.library == library]
        if not mine:
            continue
        lines.append([f"{library} ({versions[library]})", str(len({row.robot for row in mine})), _solved(mine)])
        for order in orders:
            cells = {(row.library, row.robot): row for row in measured if row.order == order}
            lines[-1].append(_rounded(_geometric_mean(_ratios(cells, library, "mean"))))
    return lines


def _solved(rows: list[Row]) -> str:
    """Fewest and most calls solved on an arm, of how many: "599 to 600 of 600"."""
    times = [row.times for row in rows if row.times]
    lowest, highest = min(each.solved for each in times), max(each.solved for each in times)
    return f"{lowest if lowest == highest else f'{lowest} to {highest}'} of {times[0].calls}"


def times_section(task: str, order: str, rows: list[Row]) -> str:
    """Success, median, mean and p99 of each library on each robot, and its time relative to beetle-ik."""
    cells = {(row.library, row.robot): row for row in rows if (row.task, row.order) == (task, order)}
    libraries = list(dict.fromkeys(library for library, _ in cells))
    robots = list(dict.fromkeys(robot for _, robot in cells))
    lines = [f"## {task}, {order}", "", "Calls solved / median / mean / p99 in µs.", ""]
    lines += _header(["library", *robots, f"mean ÷ {REFERENCE}", f"p99 ÷ {REFERENCE}"])
    for library in libraries:
        of_library = [cells.get((library, robot)) for robot in robots]
        ratios = [_ratio(cells, library, figure) for figure in ("mean", "p99")]
        lines.append(_line([library, *map(_cell, of_library), *ratios]))
    notes = dict.fromkeys(f"- {row.library}, {row.robot}: {row.note}" for row in cells.values() if row.note)
    return "\n".join([*lines, "", *(["Not measured:", "", *notes, ""] if notes else [])])


def _cell(row: Row | None) -> str:
    if row is None or row.times is None:
        return "-"
    times = row.times
    return f"{times.solved} of {times.calls} / {times.median:.3g} / {times.mean:.3g} / {times.p99:.3g}"


def _ratio(cells: Cells, library: str, figure: str) -> str:
    ratios = _ratios(cells, library, figure)
    return f"{_geometric_mean(ratios):.2f} ({len(ratios)} robots)" if ratios else "-"


def _ratios(cells: Cells, library: str, figure: str) -> list[float]:
    """Ratio of times to those of beetle-ik, on the robots that both have."""
    pairs = [(row.times, cells[REFERENCE, robot].times) for (name, robot), row in cells.items() if name == library]
    return [getattr(its, figure) / getattr(ours, figure) for its, ours in pairs if its and ours]


def _rounded(value: float) -> str:
    """Formats two digits, without an exponent."""
    return f"{float(f'{value:.2g}'):g}"


def _geometric_mean(values: list[float]) -> float:
    return float(np.exp(np.mean(np.log(values))))


TRACKING_COLUMNS = ["library"]
for _steps in STEPS:
    TRACKING_COLUMNS += [f"{_steps} steps [ms]", "largest error [m]", "over Tracker.step", "over track"]


def tracking_lines(followed: list[Followed]) -> list[list[str]]:
    """Time and largest error of each library round the circle, and its time over that of both of ours.

    `Tracker.step` is called once a point, as the other libraries are; `track` once for the whole path.
    """
    cells = {(row.library, row.steps): row for row in followed}
    libraries = list(dict.fromkeys(row.library for row in followed))
    if not {BeetleIkTracker.name, BeetleIkTrack.name} <= set(libraries):
        return []  # nothing to compare with: --only left ours out
    lines = []
    for library in libraries:
        lines.append([library])
        for steps in STEPS:
            row = cells[library, steps]
            missed = f" ({row.missed} missed)" if row.missed else ""
            ratios = [
                row.milliseconds / cells[ours.name, steps].milliseconds for ours in (BeetleIkTracker, BeetleIkTrack)
            ]
            lines[-1] += [_rounded(row.milliseconds), f"{row.largest_error:.0e}{missed}", *map(_rounded, ratios)]
    return lines


def plain_section(title: str, columns: list[str], lines: list[list[str]]) -> str:
    return "\n".join([f"## {title}", "", *plain_table(columns, lines), ""])


def plain_table(columns: list[str], lines: list[list[str]]) -> list[str]:
    return [*_header(columns), *map(_line, lines)]


def _header(columns: list[str]) -> list[str]:
    return [_line(columns), "|---" * len(columns) + "|"]


def _line(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def plot(rows: list[Row], task: str, order: str, title: str, path: Path) -> None:
    """Plots success against mean time: one colour a library, one point a robot, its geometric mean ringed."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    measured = [row for row in rows if (row.task, row.order) == (task, order) and row.times]
    libraries = list(dict.fromkeys(row.library for row in measured))
    figure, axes = plt.subplots(figsize=(9.0, 5.0), layout="constrained")
    for library, colour in zip(libraries, plt.get_cmap("tab20")(np.arange(len(libraries))), strict=True):
        times = [row.times for row in measured if row.library == library]
        means, solved = np.array([t.mean for t in times]), np.array([100.0 * t.solved / t.calls for t in times])
        axes.scatter(means, solved, color=colour, s=22, alpha=0.7)
        axes.scatter(
            np.exp(np.log(means).mean()), solved.mean(), color=colour, s=110, edgecolor="black", label=library, zorder=3
        )
    axes.set(xscale="log", xlabel="mean time a target [µs]", ylabel="solved [%]", ylim=(-3, 103), title=title)
    axes.grid(alpha=0.3, which="both")
    axes.legend(title="ringed: mean over robots", fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.savefig(path, dpi=150)
    plt.close(figure)
