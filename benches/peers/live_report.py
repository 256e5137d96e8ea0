"""Results of `noisy_targets.py` in one table and one picture."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

import numpy as np

Row = dict[str, str]

SHAKEN_BY = 1e-4  # m and rad: the noise for which the table shows the acceleration at rest
DRAWN_TICK = "2"  # ms
SUMMARY_COLUMNS = [
    *("library", "jerk limit, rad/s³", "settles, s", "with noise, times as long: median", "at worst"),
    *("off the straight way, mm", "acceleration at rest, rad/s² rms", "lag, ms", "a tick, µs"),
]


def rows(columns: list[str], lines: list[list[str]]) -> list[Row]:
    """Lines of a table by the names of its columns."""
    return [dict(zip(columns, line, strict=True)) for line in lines]


def summary_lines(jumps: list[Row], smooth: list[Row]) -> list[list[str]]:
    """One line per library and jerk limit: medians over arms and ticks."""
    lines = []
    for library, jerk in dict.fromkeys((row["library"], row["jerk_limit"]) for row in jumps):
        mine = [row for row in jumps if (row["library"], row["jerk_limit"]) == (library, jerk)]
        quiet = [row for row in mine if float(row["noise_sd_m"]) == 0.0]
        shaken = [row for row in mine if float(row["noise_sd_m"]) == SHAKEN_BY]
        late = [row for row in smooth if (row["library"], row["jerk_limit"]) == (library, jerk)]
        ratios = _settling_ratios(mine, quiet)
        figures = [
            _median(_values(quiet, "settling_s")),
            _median(ratios),
            max(ratios, default=np.nan),
            _median(_values(quiet, "off_the_line_mm")),
            _median(_values(shaken, "rest_acceleration_rms")),
            _median(_values(late, "lag_ms")),
            _median(_values(mine, "tick_median_in_a_row_us")),
        ]
        lines.append([library, jerk, *map(_cell, figures)])
    return lines


def _settling_ratios(noisy: Iterable[Row], quiet: Iterable[Row]) -> list[float]:
    """Settling times with noise relative to those without, per arm and tick; infinite where it never settled."""
    without = {(row["robot"], row["tick_ms"]): float(row["settling_s"]) for row in quiet if row["settling_s"] != "-"}
    return [
        (np.inf if row["settling_s"] == "-" else float(row["settling_s"])) / without[row["robot"], row["tick_ms"]]
        for row in noisy
        if float(row["noise_sd_m"]) > 0.0 and (row["robot"], row["tick_ms"]) in without
    ]


def _values(some: Iterable[Row], column: str) -> list[float]:
    return [np.inf if row[column] == "-" else float(row[column]) for row in some]


def _median(values: list[float]) -> float:
    return float(np.median(values)) if values else np.nan


def _cell(value: float) -> str:
    if np.isnan(value):
        return "not measured"
    return f"{value:.3g}" if np.isfinite(value) else "never"


STREAM_SUMMARY_COLUMNS = [
    *("library", "jerk limit, rad/s³", "lag, ms", "error, mm rms", "without its lag, mm rms"),
    *("acceleration, rad/s² rms", "jerk, rad/s³ rms"),
]


def stream_summary_lines(stream: list[Row]) -> list[list[str]]:
    """One line per library and jerk limit: means over the arms."""
    columns = ["lag_ms", "error_rms_mm", "error_without_lag_rms_mm", "acceleration_rms", "jerk_rms"]
    lines = []
    for library, jerk in dict.fromkeys((row["library"], row["jerk_limit"]) for row in stream):
        mine = [row for row in stream if (row["library"], row["jerk_limit"]) == (library, jerk)]
        lines.append([library, jerk, *(f"{np.mean(_values(mine, column)):.3g}" for column in columns)])
    return lines


OVER_NOISE_COLUMNS = ["library", "jerk_limit", "noise_sd_m", "settling_s", "rest_acceleration_rms"]


def over_noise_lines(jumps: list[Row]) -> list[list[str]]:
    """Means over the arms with ticks of 2 ms; a dash where some arm did not settle."""
    cells: dict[tuple[str, str, str], list[Row]] = defaultdict(list)
    for row in jumps:
        if row["tick_ms"] == DRAWN_TICK:
            cells[row["library"], row["jerk_limit"], row["noise_sd_m"]].append(row)
    return [[*key, *(_mean(_values(mine, column)) for column in OVER_NOISE_COLUMNS[3:])] for key, mine in cells.items()]


def _mean(values: list[float]) -> str:
    return f"{np.mean(values):.4g}" if np.isfinite(values).all() else "-"


def plot_over_noise(lines: list[list[str]], path: Path) -> None:
    """Settling time and shaking at rest over noise: one colour a library, dashed with a jerk limit."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    curves: dict[tuple[str, str], list[list[float]]] = defaultdict(list)
    for library, jerk, *figures in lines:
        curves[library, jerk].append([np.nan if cell == "-" else float(cell) for cell in figures])
    libraries = list(dict.fromkeys(library for library, _ in curves))
    figure, panels = plt.subplots(1, 2, figsize=(10.0, 4.2), layout="constrained")
    for (library, jerk), points in curves.items():
        noise, *values = np.array(points).T
        for axes, value in zip(panels, values, strict=True):
            axes.plot(
                np.maximum(noise, 1e-7),
                value,
                "-" if jerk == "none" else "--",
                marker=".",
                color=f"C{libraries.index(library)}",
                label=f"{library}, jerk limit {jerk}",
            )
    for axes, label in zip(panels, ("settling time [s]", "acceleration at rest, rms [rad/s²]"), strict=True):
        axes.set(xscale="log", ylabel=label, xlabel="standard deviation of the noise [m, rad] (leftmost: none)")
        axes.set(ylim=(0.0, None))
        axes.grid(alpha=0.3)
    panels[1].set_yscale("symlog", linthresh=1e-2)
    panels[0].legend(fontsize="x-small", loc="upper left")
    figure.savefig(path, dpi=150)
    plt.close(figure)
