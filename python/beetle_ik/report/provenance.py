"""Where a report comes from."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Provenance:
    """What was run to make a report, and where."""

    name: str
    title: str
    paper: str
    command: str
    short: bool
    seed: int
    made: str
    """Date and time."""
    elapsed: float
    """Seconds."""
    machine: str
    """Versions and processor."""
