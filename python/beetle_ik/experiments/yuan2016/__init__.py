"""Yuan et al. 2016: inverse kinematics by back-propagation (APPS) on a KUKA KR 210."""

from ...report import Report
from ..experiment import Context, Experiment
from .comparison import comparison
from .motions import motions, replay
from .rates import rates, reach
from .singularities import singularities
from .typos import typos

_SUMMARY = """
The seven motions are reproduced **to the last iteration**: {counts}, with the printed angles and positions, once two
gaps are filled: the printed learning rate and threshold belong to an error 20 times as large as that of eq. (11), and
the search makes one more update after its error has fallen to the threshold. **The comparison with Newton-Raphson is
contradicted**: the textbook method does not fail on these motions. It solves each in a handful of iterations, more
accurately and in less time. APPS is plain gradient descent. It needs no inverse, but it does need a good start: from
random starts the paper's learning rate reaches a third of random targets. A rate taken from the gradients themselves
reaches most of them.
"""


def run(context: Context) -> Report:
    """Runs all experiments of the paper."""
    runs = replay()
    parts = [
        motions(runs),
        comparison(context, runs),
        singularities(context, runs),
        rates(runs),
        reach(context),
        typos(runs),
    ]
    counts = [str(motion.solution.iterations) for motion in runs]
    return Report.of(_SUMMARY.format(counts=", ".join(counts)), parts)


EXPERIMENT = Experiment(
    name="yuan2016",
    title="Seven motions of a KUKA by gradient descent, to the last iteration",
    paper=(
        "P. Yuan et al., “Autonomous path planning solution for industrial robot manipulator using backpropagation "
        "algorithm”, *Advances in Mechanical Engineering*, 2016"
    ),
    run=run,
)
