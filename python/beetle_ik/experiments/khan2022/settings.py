"""Settings from the paper, and our choices where it gives none.

The paper states the paths, 50 s, lambda = 0.1, k = -10, alpha = 10 and the home position as the start. It does not
state the time step, the times of the strokes of the M, the radii of the star, or c1.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

Array = NDArray[np.float64]

IIWA = bik.Robot.named("iiwa14")
HOME = np.zeros(7)
DURATION = 50.0  # s, section 4
DT = 1e-3  # s
LATE = 0.8  # fraction of a run after which the paper quotes its error: from 40 to 50 s
ARRIVED = (1e-2, 1e-3)  # m^2: possible thresholds of "approaches zero", 10 cm or 3 cm off; runs begin over a metre off

PUBLISHED = bik.papers.ZNNBAS(
    gain=10.0, antenna_length=0.1, delay_steps=10
)  # Algorithm 1, its gain with the sign of eq. (14)
ADAPTIVE = bik.papers.ZNNBAS(gain=100.0, c1=0.3)  # eq. (16)
FAST = bik.papers.ZNNBAS(gain=300.0, c1=0.3)

POSITION_LIMITS = bik.Limits(lower=IIWA.lower, upper=IIWA.upper)
NO_LIMITS = bik.Limits(lower=-np.inf, upper=np.inf)

STROKE = 0.4  # m


def letter(duration: float) -> bik.Path:
    """Returns the letter M of eq. (19), with strokes of equal time."""
    return bik.paths.letter_m((0.1, 0.4, 0.3), duration, width=STROKE, height=STROKE)


M = letter(DURATION)
VERTICES = np.array([[0.1, 0.2, 0.1], [0.1, 0.2, 0.5], [0.1, 0.4, 0.3], [0.1, 0.6, 0.5], [0.1, 0.6, 0.1]])
_CENTER = (0.1, 0.3, 0.2)  # centre of the star, eq. (20)
_LARGE = (0.10, 0.06, 0.10)  # R, r and d (m) of a star that is easy to see
_SMALL = (0.04, 0.024, 0.04)  # R, r and d (m) of a star that the arm can follow within its limits


def _star(radii: tuple[float, float, float]) -> bik.Path:
    outer, inner, distance = radii
    return bik.paths.hypotrochoid(_CENTER, DURATION, outer_radius=outer, inner_radius=inner, distance=distance)


STAR = _star(_LARGE)
SMALL_STAR = _star(_SMALL)


def circle(duration: float) -> bik.Path:
    """Returns the circle of Cheng et al. 2020, which the arm follows within its limits."""
    return bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=duration)


ON_CIRCLE = np.array([0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.617944106, 0.0])


def star_as_printed(t: float) -> Array:
    """Returns a point of eq. (20) to the letter: with a = (0, 1, 0) and b = (0, 0, 1), b_y and a_z are zero."""
    outer, inner, distance = _LARGE
    arm, u = outer - inner, 6.0 * np.pi * t / DURATION
    x, y, z = _CENTER
    return np.array([x, y + arm * np.cos(u), z - distance * np.sin(arm / inner * u)])


@dataclass(frozen=True, kw_only=True)
class Run:
    """A track by a model-free controller, evaluated with the model."""

    result: bik.ModelFreeResult

    @property
    def time(self) -> Array:
        """Times (s)."""
        return self.result.time

    @cached_property
    def tip(self) -> Array:
        """Tip positions at theta (k, 3) (m), which the paper's figures must show."""
        return np.asarray(IIWA.fk(self.result.q)[:, :3, 3])

    @cached_property
    def h(self) -> Array:
        """Objective h of eq. (12) at theta (k,) (m^2)."""
        return np.asarray(((self.tip - self.result.reference) ** 2).sum(axis=1))

    @property
    def sent_h(self) -> Array:
        """Objective h at theta', the commanded configurations of the arm (k,) (m^2)."""
        return self.result.position_error**2

    @property
    def late(self) -> slice:
        """Rows of the last fifth: 40 to 50 s."""
        return slice(int(LATE * len(self.time)), None)

    @property
    def late_h(self) -> float:
        """Mean h at theta from 40 to 50 s (m^2)."""
        return float(self.h[self.late].mean())

    @property
    def late_sent_h(self) -> float:
        """Mean h at theta' from 40 to 50 s (m^2)."""
        return float(self.sent_h[self.late].mean())

    def arrival(self, h: float) -> float:
        """Returns the time at which the objective first falls below `h` (s); infinite if it never does."""
        below = np.flatnonzero(self.h < h)
        return float(self.time[below[0]]) if len(below) else np.inf


def follow(
    path: bik.Path,
    controller: bik.papers.ZNNBAS,
    *,
    seed: int,
    start: Array = HOME,
    limits: bik.Limits | None = None,
    dt: float = DT,
) -> Run:
    """Follows `path` from `start` on the exact arm: the plant is the arm itself, which the controller does not know."""
    plant = bik.KinematicPlant(IIWA)
    return Run(result=bik.track_model_free(plant, path, start, dt=dt, controller=controller, limits=limits, seed=seed))


def rms(squares: Array) -> float:
    """Returns the root of the mean of `squares`."""
    return float(np.sqrt(np.mean(squares)))
