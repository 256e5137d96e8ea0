"""The files of a tracked path."""

from importlib.util import find_spec
from pathlib import Path
from typing import Any

from .. import TrackResult
from .._files import whole_file
from .show import to_json


def write_files(result: TrackResult, summary: dict[str, Any], folder: Path) -> None:
    """Write trajectory, figure and summary; the figure only where matplotlib is installed."""
    result.trajectory.to_csv(folder / "trajectory.csv")
    result.trajectory.to_npz(folder / "trajectory.npz")
    with whole_file(folder / "summary.json") as stream:
        stream.write(to_json(summary).encode() + b"\n")
    if can_draw():
        result.plot().savefig(folder / "track.png")


def can_draw() -> bool:
    """Whether matplotlib is there: it comes with the extra `plot`."""
    return find_spec("matplotlib") is not None
