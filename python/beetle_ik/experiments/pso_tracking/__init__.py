"""Trajectory tracking of redundant manipulators by PSO: postures, tracking, and the arm in a picture."""

from ...report import Report
from ..experiment import Context, Experiment
from .picture import picture
from .postures import postures
from .tracking import tracking

_SUMMARY = """
A redundant arm can hold its tip in one place in many postures. The paper looks for the posture in which it moves most
easily, by a particle swarm over joint points on circles. It tracks with the weighted pseudo-inverse, and finds the arm
in a picture by an active contour.

**The methods work; a third of the claims about them do not hold, and most of the others cannot be decided.** Ten
generations of five particles find the best posture, whatever the length of the links, and the active contour finds the
arm, though a plain threshold is more reliable. But no length gives both printed optima, q₂ is not small where the paper
says it is, and an arm with q₂ = 0 is not singular. Which posture is “balanced” depends on the length of the links,
which is not given. The printed tracking error lies between those of 1 ms and 10 ms steps, once a closed loop is added
that the paper lacks. The order of its rivals depends on how each is tuned: a PID tuned on a plain grid is as good as
the bee colony's, and on the same servos the pseudo-inverse does not beat all of them.
"""


def run(context: Context) -> Report:
    """Runs all experiments of the paper."""
    parts = (postures(context), tracking(context), picture(context))
    return Report.of(_SUMMARY, parts)


EXPERIMENT = Experiment(
    name="pso-tracking",
    title="Postures in which a redundant arm moves easily, and tracking with them",
    paper="“Trajectory Tracking of Redundant Manipulator Based on PSO Algorithm Optimization”",
    run=run,
    extras=("vision",),
)
