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
A beetle compares the error at the ends of two antennae and steps towards the smaller. Cheng et al. move redundant arms
this way, without a Jacobian and without violating velocity limits that vary in time.

**The method works**, once the gaps in its description are filled: both arms follow their circles, and no limit is
violated. **Its errors and its lead are another matter.** The published errors are a share of the error band, about half
of it with our c₁ and c₂; the paper gives no band, and our copy neither constant. The lead over the swarms depends on
the box that each step searches. In all that the limit allows, swarms need several times the evaluations of the beetle.
In a small fixed box they need fewer, but the more the finer the accuracy. In a box that shrinks with the error, as the
beetle's antennae do, they need about as many as the beetle. Trackers that use more than the size of the error need one
to four evaluations per step where the beetle needs hundreds.
"""


def run(context: Context) -> Report:
    """Runs all experiments of the paper."""
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
