"""Khan et al. 2022: ZNNBAS, tracking without a model."""

from ...report import Report
from ..experiment import Context, Experiment
from .antennae import antennae
from .constants import constants
from .figures import figures
from .obstacle import obstacle
from .orientation import orientation
from .other_methods import other_methods
from .repetition import repetition
from .sensor import sensor
from .servo_arm import servo_arm
from .theorem import theorem

_SUMMARY = """
ZNNBAS works without a model, as the paper claims: it needs one measured position per tick. Its state converges to both
of the paper's paths, from home and from every start that we tried, and an arm that differs from its drawing makes no
difference. **Some of the other claims do not hold.** The M passes through points that this arm cannot reach within its
limits. The star as printed is no star. The gain as printed diverges. The objective does not fall monotonically, since
the proof of Theorem 1 is about a different algorithm, and with a constant antenna it never reaches zero. **Many cannot
be decided**, because the paper leaves two things open. It does not say whether it means the state or the arm: every
command is a random antenna away from the state, and there the tool shakes by centimetres. And it does not give the time
step, the unit of α, or what counts as reached.

An error of 10⁻⁵ needs a tenfold gain, with either antenna. At equal gain the antenna of eq. (16) is better if its c₁,
which the paper does not give, is near 1.

We also run the methods that section 1 compares it with, the pseudo-inverse and the dual neural network. They need a
model; the pseudo-inverse is then a thousand times as accurate, for microseconds per tick. `BroydenBAS`, which uses the
same measurements as secants instead of signs, tracks to nanometres, and its joint motion repeats. On an arm with servos
ZNNBAS needs long ticks, eq. (16) and a slow path.
"""


def run(context: Context) -> Report:
    """Runs all experiments of the paper."""
    parts = [
        part(context)
        for part in (
            figures,
            antennae,
            constants,
            theorem,
            other_methods,
            repetition,
            sensor,
            orientation,
            servo_arm,
            obstacle,
        )
    ]
    return Report.of(_SUMMARY, parts)


EXPERIMENT = Experiment(
    name="khan2022",
    title="One random antenna per tick controls an arm without a model",
    paper=(
        "A. T. Khan et al., “Evolutionary Computation Based Real-time Robot Arm Path-planning Using Beetle Antennae "
        "Search”, *EAI Transactions on AI and Robotics*, 2022"
    ),
    run=run,
    extras=("sim",),
)
