"""Cheng et al. 2020: beetle antennae search under a variable joint velocity limit."""

from ...report import Report
from ..experiment import Context, Experiment
from .motion import motion
from .rivals import compare, rivals
from .search_box import search_box
from .tip_box import tip_box
from .trends import trends

_SUMMARY = """
A beetle feels its way: it compares the error at the ends of two antennae and steps towards the smaller. Cheng et al.
move redundant arms with it, without a Jacobian and without breaking a velocity limit that varies over time.

**The method works as they say**, once it is read so that it can be run: errors of 2 × 10⁻⁵ m and 1 × 10⁻⁵ m, trends
with n, c₁ and c₂, no limit broken, the first place among five methods. **Two conclusions do not carry over.**
The published errors are the error band that was chosen. And the published lead over the swarms is the size of the box
in which they search: in a small one they keep up with the beetle. Where more than the size of the error is known,
there are trackers that need one to four evaluations a step for what takes the beetle hundreds.
"""


def run(context: Context) -> Report:
    """Run all of it."""
    comparison = compare(context)
    parts = (
        motion(context),
        tip_box(context),
        trends(context),
        rivals(comparison),
        search_box(context, comparison.precise),
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
)
