"""Cheng et al. 2020: beetle antennae search under a variable joint velocity limit."""

from ...report import Report
from ..experiment import Context, Experiment
from .motion import motion
from .trends import trends


def run(context: Context) -> Report:
    """Run all of it."""
    parts = [part(context) for part in (motion, trends)]
    return Report(
        summary="...",
        sections=[section for section, _ in parts],
        claims=[claim for _, claims in parts for claim in claims],
    )


EXPERIMENT = Experiment(
    name="cheng2020",
    title="A beetle moves a redundant arm within its velocity limits",
    paper=(
        "Y. Cheng et al., “Motion Planning of Redundant Manipulator With Variable Joint Velocity Limit Based on "
        "Beetle Antennae Search Algorithm”, *IEEE Access* 8, 2020"
    ),
    run=run,
)
