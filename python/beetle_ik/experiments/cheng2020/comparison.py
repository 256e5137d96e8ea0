"""A compared method with all its runs, and its statistics for the tables."""

from dataclasses import dataclass

import numpy as np

import beetle_ik as bik

from ...report import Spread
from .boxes import evaluations_a_step, missed_steps
from .methods import Method
from .settings import STEADY, excess_velocity, roughness, steady_error


@dataclass(frozen=True)
class Compared:
    """A method with its runs, one for each seed."""

    method: Method
    results: list[bik.TrackResult]

    @property
    def name(self) -> str:
        """Name of the method."""
        return self.method.name

    @property
    def evaluations(self) -> Spread:
        """Evaluations of a step."""
        return Spread.of([evaluations_a_step(result) for result in self.results])

    @property
    def time(self) -> Spread:
        """Time of all steps of a run (s)."""
        return Spread.of([result.elapsed for result in self.results])

    @property
    def error(self) -> Spread:
        """Mean error over the second half (m)."""
        return Spread.of([steady_error(result) for result in self.results])

    @property
    def axis_errors(self) -> list[float]:
        """Mean error along x, y and z over the second half of all runs (m)."""
        away = np.array([np.abs(result.position - result.reference)[STEADY] for result in self.results])
        return [float(error) for error in away.mean(axis=(0, 1))]

    @property
    def roughness(self) -> Spread:
        """Rms change of joint velocity from step to step (rad/s)."""
        return Spread.of([roughness(result) for result in self.results])

    @property
    def missed(self) -> int:
        """Steps of all runs that ended outside the band."""
        return sum(missed_steps(result) for result in self.results)

    @property
    def excess(self) -> float:
        """Largest excess over the velocity limit (rad/s)."""
        return max(excess_velocity(result) for result in self.results)
