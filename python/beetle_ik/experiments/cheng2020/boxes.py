"""Search boxes of a step, and the cost of a method in each."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

from .methods import PATIENCE
from .settings import DT, FIVE_LINK, IIWA, STEPS, Run, Solver, Task


@dataclass(frozen=True, kw_only=True)
class ErrorBox:
    """A solver in a box as wide as the error, drawn anew after a few generations about the best point so far.

    Its search contracts with the error, like BAS by eq. (12).
    """

    solver: Solver
    """Solver in each box; its generations are those of one box."""
    reach: float
    """Ratio of half the box's width to the error (rad/m), like c1 of eq. (12)."""


Setting: TypeAlias = Solver | ErrorBox


@dataclass(frozen=True)
class Cost:
    """Cost of a run within its error band."""

    evaluations: float
    """Evaluations of a step, on average."""
    missed: int
    """Steps that ended outside the band."""


@dataclass(frozen=True, kw_only=True)
class Box:
    """An arm that starts on its circle, and the search region of a step."""

    name: str
    run: Callable[[Setting, int, float], Cost]
    """Follows the circle with a setting, a seed and a band (m)."""


def track(
    task: Task, solver: Solver | None, *, seed: int, band: float, limits: bik.Limits | None = None
) -> bik.TrackResult:
    """Follows the circle from a start on it."""
    return task.track(solver, band=band, seed=seed, start=task.on_path, limits=limits)


def evaluations_a_step(result: Run) -> float:
    """Returns the evaluations of a step, on average."""
    return result.evaluations / (len(result.time) - 1)


def missed_steps(result: bik.TrackResult) -> int:
    """Counts the steps that ended outside the band."""
    return int((result.position_error[1:] > result.position_tolerance).sum())


def _within(task: Task, limits: bik.Limits | None = None) -> Callable[[Setting, int, float], Cost]:
    def run(setting: Setting, seed: int, band: float) -> Cost:
        if isinstance(setting, ErrorBox):
            followed = follow_in_error_boxes(task, setting, seed=seed, band=band, most=PATIENCE)
            return Cost(followed.evaluations / STEPS, int((followed.errors > band).sum()))
        result = track(task, setting, seed=seed, band=band, limits=limits)
        return Cost(evaluations_a_step(result), missed_steps(result))

    return run


@dataclass(frozen=True)
class Followed:
    """The circle, followed step by step in boxes as long as the error."""

    q: NDArray[np.float64]
    """Configurations (STEPS + 1, n), start included."""
    errors: NDArray[np.float64]
    """Errors (STEPS,) (m)."""
    evaluations: int

    @property
    def error(self) -> float:
        """Mean over the second half (m)."""
        return float(self.errors[STEPS // 2 :].mean())

    @property
    def roughness(self) -> float:
        """Rms change of joint velocity from step to step over the second half (rad/s)."""
        changes = np.diff(np.diff(self.q, axis=0)[STEPS // 2 :] / DT, axis=0)
        return float(np.sqrt(np.mean(changes**2)))


def follow_in_error_boxes(task: Task, setting: ErrorBox, *, seed: int, band: float, most: int) -> Followed:
    """Follows the circle with about `most` evaluations a step at most."""
    random = np.random.default_rng(seed)
    joints, errors, evaluations = [task.on_path], [], 0
    for target in task.circle.position(np.arange(1, STEPS + 1) * DT):
        q, error, spent = _step(task, setting, joints[-1], target, band, most, random)
        joints.append(q)
        errors.append(error)
        evaluations += spent
    return Followed(np.array(joints), np.array(errors), evaluations)


def _step(
    task: Task,
    setting: ErrorBox,
    start: NDArray[np.float64],
    target: NDArray[np.float64],
    band: float,
    most: int,
    random: np.random.Generator,
) -> tuple[NDArray[np.float64], float, int]:
    """Searches boxes until the error is within the band; returns configuration, error and evaluations."""
    lower = np.maximum(start - DT * task.velocity, task.robot.lower)
    upper = np.minimum(start + DT * task.velocity, task.robot.upper)
    q, error, spent = start, float(np.linalg.norm(task.robot.fk(start)[:3, 3] - target)), 1
    while error > band and spent < most:
        half = setting.reach * error
        found = bik.solve(
            task.robot,
            target,
            task=bik.tasks.Position(),
            start_q=q,
            solver=setting.solver,
            limits=bik.Limits(lower=np.maximum(q - half, lower), upper=np.minimum(q + half, upper)),
            position_tolerance=band,
            seed=int(random.integers(2**31)),
        )
        q, error = found.q, found.position_error
        spent += found.evaluations - 1  # the error where a box begins is known
    return q, error, spent


WHOLE = Box(name="whole box", run=_within(IIWA))
# The circle needs at most 0.02 rad a step.
TRUST = Box(name="trust box", run=_within(IIWA, bik.Limits(velocity=0.1)))
SCALED = Box(name="box as long as the error", run=_within(IIWA))
PLANAR = Box(name="five-link arm", run=_within(FIVE_LINK))
BANDS = (1e-3, 1e-4, 1e-5)  # m
BOXES = (WHOLE, TRUST, SCALED, PLANAR)
