"""The picture of `noisy_targets.py`."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import numpy as np

TICK = "2"  # ms


def plot_jumps(lines: list[list[str]], columns: list[str], path: Path) -> None:
    """Settling time and shaking at rest over noise, means over the arms; dashed with a jerk limit."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    rows = [dict(zip(columns, line, strict=True)) for line in lines]
    rows = [row for row in rows if row["tick_ms"] == TICK]
    colours = dict(zip(dict.fromkeys(row["library"] for row in rows), plt.get_cmap("tab10").colors, strict=False))
    figure, panels = plt.subplots(1, 2, figsize=(10.0, 4.2), layout="constrained")
    asked = [("settling_s", "settling time [s]"), ("rest_acceleration_rms", "acceleration at rest, rms [rad/s²]")]
    for axes, (column, label) in zip(panels, asked, strict=True):
        for (library, jerk), means in _over_noise(rows, column).items():
            noises, values = np.array(sorted(means.items())).T
            style = "-" if jerk == "none" else "--"
            axes.plot(
                np.maximum(noises, 1e-7),
                values,
                style,
                marker=".",
                color=colours[library],
                label=f"{library}, jerk {jerk}",
            )
        axes.set(xscale="log", xlabel="noise of the target, standard deviation [m, rad] (leftmost: none)", ylabel=label)
        axes.grid(alpha=0.3)
    panels[1].set(yscale="log")
    panels[1].legend(fontsize="x-small")
    figure.savefig(path, dpi=150)
    plt.close(figure)


def _over_noise(rows: list[dict[str, str]], column: str) -> dict[tuple[str, str], dict[float, float]]:
    """Means over the arms by library and jerk limit, then by noise; without points where some arm has no figure."""
    cells = defaultdict(lambda: defaultdict(list))
    for row in rows:
        value = np.nan if row[column] == "-" else float(row[column])
        cells[row["library"], row["jerk_limit"]][float(row["noise_sd_m"])].append(value)
    return {key: {noise: float(np.mean(values)) for noise, values in by.items()} for key, by in cells.items()}
