"""The robots of the package example-robot-data, and the table of their tips."""

import csv
import sysconfig
from dataclasses import dataclass
from pathlib import Path

import pytest

ROBOTS = Path(sysconfig.get_path("purelib"), "cmeel.prefix", "share", "example-robot-data", "robots")


@dataclass(frozen=True)
class Entry:
    """A URDF, its path in the package, and the tip of the chain; None: the only leaf."""

    urdf: str
    tip: str | None

    @property
    def path(self) -> Path:
        return ROBOTS / self.urdf


def table() -> list[Entry]:
    """The entries of `robots.csv`."""
    with Path(__file__).with_name("robots.csv").open(newline="") as file:
        return [Entry(row["urdf"], row["tip"] or None) for row in csv.DictReader(file)]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    if not ROBOTS.is_dir():
        absent = pytest.mark.skip(reason="example-robot-data is not installed: make zoo installs it")
        for item in items:
            item.add_marker(absent)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "entry" in metafunc.fixturenames:
        metafunc.parametrize("entry", table(), ids=lambda entry: Path(entry.urdf).stem)
