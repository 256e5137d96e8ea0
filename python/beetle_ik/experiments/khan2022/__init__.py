"""Khan et al. 2022: ZNNBAS, tracking without a model."""

from ...report import Report
from ..experiment import Context, Experiment
from .antennae import antennae
from .constants import constants
from .figures import figures
from .other_methods import other_methods
from .repetition import repetition
from .sensor import sensor
from .servo_arm import servo_arm
from .theorem import theorem

_SUMMARY = """
ZNNBAS is what the paper says it is: a controller that sees one measured position a tick and no model, and it does
bring the tool of an iiwa onto both of the paper's paths. But not on the paper's terms. The M passes points that this
arm cannot reach, so its runs cannot have kept the arm's limits; the star as printed is no star; the published error
of 10⁻⁵ is reached with the antenna of eq. (16) and not with the constant one of the listing; the gain of the listing
has the wrong sign for the paper's own equation; Theorem 1 holds for another algorithm than the one that is given; and
the antennae shake the tool by centimetres, because the measured error is that of a point where the arm never stands.
`BroydenBAS`, which takes the same measurements as secants instead of signs, tracks to nanometres.
"""


def run(context: Context) -> Report:
    """Run all of it."""
    parts = [
        part(context) for part in (figures, antennae, constants, theorem, other_methods, repetition, sensor, servo_arm)
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
