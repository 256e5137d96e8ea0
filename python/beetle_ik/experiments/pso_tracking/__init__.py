"""Trajectory tracking of redundant manipulators by PSO: postures, tracking, and the arm in a picture."""

from ...report import Report
from ..experiment import Context, Experiment
from .picture import picture
from .postures import postures
from .tracking import tracking

_SUMMARY = """
A redundant arm can hold its tip in one place in many postures. The paper looks for the one in which it moves most
easily, by a particle swarm over joint points on circles, and tracks with the weighted pseudo-inverse.

**The methods work; the numbers cannot be met.** Ten generations of five particles find the best posture, and ellipses
of the whole arm make better postures than that of the tip alone. The printed optima fit no length of the links, and
the plant and the gains of the controllers that the method is compared with are not given: ours stand in for them. The
printed tracking error lies between those of 1 ms and 10 ms steps, once a closed loop is added that the paper lacks.
"""


def run(context: Context) -> Report:
    """Run all of it."""
    parts = (postures(context), tracking(context), picture(context))
    return Report.of(_SUMMARY, parts)


EXPERIMENT = Experiment(
    name="pso-tracking",
    title="Postures in which a redundant arm moves easily, and tracking with them",
    paper="“Trajectory Tracking of Redundant Manipulator Based on PSO Algorithm Optimization”",
    run=run,
    extras=("vision",),
)
