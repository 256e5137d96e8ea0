"""Settings from the paper, and our choices where it gives none.

The paper states the circles, the velocity limits, T and Ts. It states neither c1, c2, n and the error band nor the
link lengths and the start; ours are chosen so that its sentences about Figures 2 to 6 come true.
"""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

from ...report import Printed

Solver: TypeAlias = bik.papers.BAS | bik.papers.Firefly | bik.papers.Genetic | bik.papers.PSO | bik.papers.QPSO
Run: TypeAlias = bik.TrackResult | bik.ModelFreeResult

DURATION = 30.0  # s, section IV-A
DT = 0.2  # s, section IV-A
STEPS = round(DURATION / DT)
STEADY = slice(STEPS // 2 + 1, None)  # rows of the second half, when the approach is over
ROUNDING = 1e-12  # rad/s, by which a velocity may exceed its limit
_RIPPLE = 0.004  # rad/s, W of eq. (7); omega is 1 rad/s


# Settings on which the paper's sentences depend, and its values.
PARAMETERS: dict[str, float | Printed] = {
    "T [s]": DURATION,
    "Ts [s]": DT,
    "c₁": Printed.NOT_IN_COPY,  # Figure 5 may give the compared values
    "c₂": Printed.NOT_IN_COPY,  # Figure 6
    "n": Printed.NOT_IN_COPY,  # Figure 4
    "error band": Printed.NOT_STATED,
    "link lengths of the planar arm": Printed.NOT_STATED,
    "start": Printed.NOT_STATED,
    "pₘᵢₙ and pₘₐₓ": Printed.NOT_STATED,
    "options of the swarms": Printed.NOT_STATED,
    "evaluations in 15 s": Printed.NOT_STATED,
}


@dataclass(frozen=True, kw_only=True)
class Task:
    """An arm that follows a circle."""

    name: str
    robot: bik.Robot
    circle: bik.Path
    velocity: float
    """H of eq. (7) in rad/s."""
    on_path: NDArray[np.float64]
    """A start on the circle."""
    off_path: NDArray[np.float64]
    """A start off the circle, from which there is an approach."""

    @property
    def limits(self) -> bik.Limits:
        """Limits by eq. (7), H + W sin(t), with the robot's position limits."""
        return bik.Limits(velocity=bik.Sinusoid(mean=self.velocity, amplitude=_RIPPLE, angular_frequency=1.0))

    def velocity_limit(self, time: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns the limit of eq. (7) (rad/s) at these times (s)."""
        limit: NDArray[np.float64] = self.velocity + _RIPPLE * np.sin(time)
        return limit

    def track(
        self,
        solver: Solver | None,
        *,
        band: float,
        seed: int = 0,
        start: NDArray[np.float64] | None = None,
        limits: bik.Limits | None = None,
        task: bik.tasks.Position | None = None,
    ) -> bik.TrackResult:
        """Follows the circle, by default from a start off it and under the paper's limits.

        The limit of a tick is the limit at its start, as in the paper.
        """
        return bik.track(
            self.robot,
            self.circle,
            self.off_path if start is None else start,
            dt=DT,
            solver=solver,
            limits=self.limits if limits is None else limits,
            position_tolerance=band,
            seed=seed,
            limit_at="start",
            task=task,
        )


_PLANAR_ON_PATH = np.array([0.6697427192, -0.3400667941, -0.2474717864, -0.2588906663, 0.3263813181])
FIVE_LINK = Task(
    name="five-link arm",
    robot=bik.Robot.planar([1.0] * 5, lower=-np.pi, upper=np.pi),
    circle=bik.paths.circle((4.0, 1.0, 0.0), diameter=1.4, duration=DURATION),
    velocity=0.2,
    on_path=_PLANAR_ON_PATH,
    off_path=_PLANAR_ON_PATH + np.array([0.05, 0.05, 0.05, -0.05, 0.05]),
)

_IIWA_ON_PATH = np.array([0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.6179441060, 0.0])
IIWA = Task(
    name="iiwa 14",
    robot=bik.Robot.named("iiwa14"),
    circle=bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=DURATION),
    velocity=2.0,
    on_path=_IIWA_ON_PATH,
    off_path=_IIWA_ON_PATH + 0.1,
)


@dataclass(frozen=True, kw_only=True)
class Setting:
    """Options of the beetle, and the error band within which it rests."""

    walk: Literal["star", "chain"]
    c1: float
    c2: float = 1.0
    explorations: int
    band: float
    """Error band (m)."""

    @property
    def solver(self) -> bik.papers.BAS:
        """Beetle antennae search with these options."""
        return bik.papers.BAS(variant=self.walk, c1=self.c1, c2=self.c2, explorations=self.explorations)


# Literal reading: all explorations of a pass start from the same point, eq. (8), (9) and (11).
STAR = {
    FIVE_LINK.name: Setting(walk="star", c1=1.0, explorations=50, band=4e-5),
    IIWA.name: Setting(walk="star", c1=3.0, explorations=50, band=1.7e-5),
}
# Original beetle: each exploration starts where the last one ended (step vii of Algorithm 1).
CHAIN = {
    FIVE_LINK.name: Setting(walk="chain", c1=0.3, explorations=30, band=5e-5),
    IIWA.name: Setting(walk="chain", c1=1.0, explorations=30, band=2.2e-5),
}
WALKS = {"star": STAR, "chain": CHAIN}


def steady_error(result: Run) -> float:
    """Returns the mean error over the second half (m)."""
    return float(result.position_error[STEADY].mean())


def worst_error(result: bik.TrackResult) -> float:
    """Returns the largest error over the second half (m)."""
    return float(result.position_error[STEADY].max())


def roughness(result: bik.TrackResult) -> float:
    """Returns the oscillation of the joint velocities: rms change from step to step over the second half (rad/s)."""
    return float(np.sqrt(np.mean(np.diff(result.qd[STEADY], axis=0) ** 2)))


def steps_to_band(result: bik.TrackResult) -> int:
    """Returns the steps until the error is first in its band; the number of all steps if it never is."""
    within = result.position_error <= result.position_tolerance
    return int(within.argmax()) if within.any() else len(within) - 1


def excess_velocity(result: bik.TrackResult) -> float:
    """Returns the largest excess of a joint speed over its limit (rad/s); negative if all are slower."""
    return float(np.max(np.abs(result.qd[1:]) - result.velocity_limit[1:]))
