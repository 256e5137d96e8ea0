"""Khan et al. 2022: ZNNBAS, tracking without a model."""

from ...report import Report
from ..experiment import Context, Experiment
from .antennae import antennae
from .constants import constants
from .figures import figures
from .orientation import orientation
from .other_methods import other_methods
from .repetition import repetition
from .sensor import sensor
from .servo_arm import servo_arm
from .theorem import theorem

_SUMMARY = """
ZNNBAS is what the paper says it is: a controller that sees one measured position a tick and no model. Its state comes
onto both of the paper's paths, from home and from anywhere we tried, and an arm built otherwise than drawn does not
trouble it. **Much of the rest does not stand.** The state is not where the arm is: every command is a random antenna
away from it, and the tool shakes by centimetres. The M passes points that this arm cannot reach within its limits. The
star as printed is no star. The gain as printed diverges. The objective does not fall monotonically, since the proof of
Theorem 1 is about another algorithm, and with a constant antenna it never gets to zero. α, “the core
hyper-parameter”, matters least of the three.

An error of 10⁻⁵ comes with a tenfold gain, with either antenna. At equal gain that of eq. (16) is better where its
c₁, which the paper does not give, is near 1.

The methods that section 1 sets it against, the pseudo-inverse and the dual neural network, are run beside it. They need
a model; the pseudo-inverse is then a thousand times as exact, for microseconds a tick. `BroydenBAS`, which takes the
same measurements as secants instead of signs, tracks to nanometres, and its joints repeat. On an arm with servos
ZNNBAS needs long ticks, eq. (16) and a slow path.
"""


def run(context: Context) -> Report:
    """Run all of it."""
    parts = [
        part(context)
        for part in (figures, antennae, constants, theorem, other_methods, repetition, sensor, orientation, servo_arm)
    ]
    return Report.of(_SUMMARY, parts)


EXPERIMENT = Experiment(
    name="khan2022",
    title="One random antenna a tick steers an arm that nobody has a model of",
    paper=(
        "A. T. Khan et al., “Evolutionary Computation Based Real-time Robot Arm Path-planning Using Beetle Antennae "
        "Search”, *EAI Transactions on AI and Robotics*, 2022"
    ),
    run=run,
    extras=("sim",),
)
