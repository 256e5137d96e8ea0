"""Wang et al. 2019: trajectory planning by a beetle swarm."""

from ...report import Report
from ..experiment import Context, Experiment
from .along_path import along_path
from .comparison import comparison
from .complexity import complexity
from .equations import equations
from .freedom import freedom
from .motions import plan_motions
from .obstacle import obstacle
from .point_to_point import point_to_point
from .table_1 import table_1

_SUMMARY = """
The planner works as published, once the gaps in its description are filled: the swarm plans all motions of the paper,
and every limit is kept *exactly*, because the extremes of the polynomials are computed instead of sampled. **Whether
the beetle swarm is the best search depends on what is held equal.** At equal iterations, where it spends three times
the evaluations, neither PSO nor GA beats it; with equal evaluations PSO does, with equal tuning both do, and
differential evolution does best. Link lengths, limits and constants are ours, since the paper gives none; with them the
swarm stalls as links are added. With the same freedom for all, the nearest configurations of the ends, joined by one
polynomial, are faster than the mean of every search for 3 to 5 links, and within 2 % of the best mean for 2 links.
"""


def run(context: Context) -> Report:
    """Runs all experiments of the paper."""
    motions = plan_motions(context)
    of_motions = [part(context, motions) for part in (point_to_point, comparison, freedom)]
    others = [part(context) for part in (obstacle, along_path, table_1, complexity, equations)]
    return Report.of(_SUMMARY, [*of_motions, *others])


EXPERIMENT = Experiment(
    name="wang2019",
    title="A beetle swarm plans trajectories of planar arms",
    paper=(
        "L. Wang et al., “A New Trajectory-Planning Beetle Swarm Optimization Algorithm for Trajectory Planning of "
        "Robot Manipulators”, *IEEE Access* 7, 2019"
    ),
    run=run,
)
