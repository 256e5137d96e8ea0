"""Provenance of a report."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Provenance:
    """Command, time and machine of a report."""

    name: str
    title: str
    paper: str
    command: str
    short: bool
    seed: int
    made: str
    """Date and time of the run."""
    elapsed: float
    """Duration of the run (s)."""
    machine: str
    """Versions and processor."""
