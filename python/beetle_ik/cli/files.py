"""Output files of a command: trajectory, summary and figures."""

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from .. import InvalidInputError, Trajectory
from ..files.whole import whole_file, whole_folder
from .show import to_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def results_folder(out: Path | None) -> AbstractContextManager[Path | None]:
    """Returns the folder of `--out`, written completely or not at all; None if the option was not given."""
    return nullcontext() if out is None else whole_folder(out, option="--out")


def write_files(
    folder: Path, trajectory: Trajectory, summary: dict[str, Any], figures: Mapping[str, Callable[[], "Figure"]]
) -> None:
    """Writes trajectory, summary and, if matplotlib is installed, the figures under their names."""
    trajectory.to_csv(folder / "trajectory.csv")
    trajectory.to_npz(folder / "trajectory.npz")
    with whole_file(folder / "summary.json") as stream:
        stream.write(to_json(summary).encode() + b"\n")
    if can_draw():
        for name, figure in figures.items():
            figure().savefig(folder / name)


def require_picture(option: str, file: Path) -> None:
    """Checks that a picture can be drawn and written.

    Raises:
        InvalidInputError: matplotlib is not installed, or writes no picture of that ending.
    """
    if not can_draw():
        raise InvalidInputError(f"{option} needs matplotlib: pip install 'beetle-ik[plot]'")
    from matplotlib.backend_bases import FigureCanvasBase

    endings = sorted(FigureCanvasBase.filetypes)
    if file.suffix[1:].lower() not in endings:
        raise InvalidInputError(f"{option}: '{file}' must end in .png or another of {', '.join(endings)}")


def write_picture(file: Path, figure: "Figure") -> None:
    """Writes a figure, whole or not at all; the ending of the name says in which form."""
    with whole_file(file) as stream:
        figure.savefig(stream, format=file.suffix[1:].lower())


def print_files(out: Path | None) -> None:
    """Prints the folder of the files, and the reason for a missing figure."""
    if out is not None:
        figure = "" if can_draw() else ", without a figure: drawing needs `pip install beetle-ik[plot]`"
        typer.echo(f"Files in {out}/{figure}")


def can_draw() -> bool:
    """Whether matplotlib, which the extra `plot` brings, is installed."""
    return find_spec("matplotlib") is not None
