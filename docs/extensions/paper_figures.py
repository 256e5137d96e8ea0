"""Draws the figures of the papers' pages: quick passes of `beetle-ik reproduce`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import beetle_ik
from beetle_ik import experiments

if TYPE_CHECKING:
    from sphinx.application import Sphinx

FOLDER = Path(__file__).parents[1] / "papers" / "figures"
FIGURES = {
    "cheng2020": ("figure_2", "search_box", "equation_5"),
    "khan2022": (
        "figure_2_limits",
        "antennae",
        "theorem_1_still",
        "repetition",
        "obstacle",
    ),
    "pso-tracking": ("figure_6", "over_length", "figure_9"),
    "wang2019": ("figure_10", "figure_13"),
    "yuan2016": ("figure_6", "reach"),
}


def setup(app: Sphinx) -> dict[str, bool]:
    """Registers the Sphinx extension."""
    app.connect("builder-inited", lambda _app: draw_all())
    return {"parallel_read_safe": True}


def draw_all() -> None:
    """Draws figures that are missing or older than the package."""
    package = Path(beetle_ik.__file__).parent
    changed = max(file.stat().st_mtime for file in package.rglob("*") if file.suffix in (".py", ".so", ".pyd"))
    FOLDER.mkdir(exist_ok=True)
    for experiment, names in FIGURES.items():
        files = {name: FOLDER / f"{experiment}_{name}.png" for name in names}
        if all(file.is_file() and file.stat().st_mtime > changed for file in files.values()):
            continue
        report = experiments.experiment(experiment).run(experiments.Context(short=True))
        for figure in report.figures:
            if figure.name in files:
                figure.drawing.savefig(files[figure.name], dpi=120, transparent=True)
