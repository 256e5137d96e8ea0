"""Cheng et al. 2020: beetle antennae search under a variable joint velocity limit."""

from ...report import Report
from ..experiment import Context, Experiment
from .accuracy import accuracy
from .hardware import hardware
from .motion import motion
from .resources import resources
from .rivals import compare, rivals
from .search_box import Spent, search_box
from .tip_box import tip_box
from .trends import trends

_SUMMARY = """
A beetle feels its way: it compares the error at the ends of two antennae and steps towards the smaller. Cheng et al.
move redundant arms with it, without a Jacobian and without breaking a velocity limit that varies over time.

**The method works**, once it is read so that it can be run: both arms follow their circles and no limit is broken.
**Its errors and its lead are another matter.** The published errors are the error band that was chosen, which the
paper does not give. The lead over the swarms is how far a step is searched: swarms need several times the evaluations
where they are drawn anew in all that the limit allows, less in a small box and the more of them the finer the
accuracy, and about as many in a box that shrinks with the error as the beetle's antennae do. Where more than the size
of the error is known, trackers need one to four evaluations a step for what takes the beetle hundreds.
"""


def run(context: Context) -> Report:
    """Run all of it."""
    comparison = compare(context)
    whole = {one.name: Spent(one.evaluations, one.missed) for one in comparison.precise}
    parts = (
        motion(context),
        tip_box(context),
        trends(context),
        rivals(comparison),
        search_box(context, whole),
        accuracy(context),
        resources(context, comparison.precise),
        hardware(context),
    )
    return Report.of(_SUMMARY, parts)


EXPERIMENT = Experiment(
    name="cheng2020",
    title="A beetle moves a redundant arm within its velocity limits",
    paper=(
        "Y. Cheng et al., “Motion Planning of Redundant Manipulator With Variable Joint Velocity Limit Based on "
        "Beetle Antennae Search Algorithm”, *IEEE Access* 8, 2020"
    ),
    run=run,
    extras=("sim",),
)
