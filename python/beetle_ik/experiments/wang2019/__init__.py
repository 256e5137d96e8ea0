"""Wang et al. 2019: trajectory planning by a beetle swarm."""

from ...report import Report
from ..experiment import Context, Experiment
from .along_path import along_path
from .complexity import complexity
from .obstacle import obstacle
from .point_to_point import point_to_point
from .table_1 import table_1

_SUMMARY = """
The planner works as published, once its gaps are filled: the swarm plans all motions of the paper, and every limit is
kept *exactly*, since the extremes of the polynomials are computed and not sampled. That the beetle swarm is the best
search is not what we find: it beats neither a particle swarm nor differential evolution that may spend as many
evaluations. And no search helps as much as the right question: the ends' configurations that lie nearest to each
other, joined by one polynomial, are quicker than what any swarm finds, within milliseconds.
"""


def run(context: Context) -> Report:
    """Run all of it."""
    parts = [part(context) for part in (point_to_point, obstacle, along_path, table_1, complexity)]
    return Report.of(_SUMMARY, parts)


EXPERIMENT = Experiment(
    name="wang2019",
    title="A beetle swarm plans trajectories of planar arms",
    paper=(
        "L. Wang et al., “A New Trajectory-Planning Beetle Swarm Optimization Algorithm for Trajectory Planning of "
        "Robot Manipulators”, *IEEE Access* 7, 2019"
    ),
    run=run,
)
