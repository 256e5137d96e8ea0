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
The planner works as published, once its gaps are filled.
"""


def run(context: Context) -> Report:
    """Run all of it."""
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
