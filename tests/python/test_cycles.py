"""Reference cycles through this library's objects, which Python's garbage collector must find and free."""

import gc
import weakref
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from iiwa_circle import IIWA, START

import beetle_ik as bik

PLANAR = bik.Robot.planar([1, 1, 1])
LINE = bik.paths.polyline([(0.3, 0.3, 1.0), (0.3, 0.31, 1.0)], duration=0.2)


class Owner:
    """Holds what was made from its methods: a cycle."""

    made: Any

    def speed(self, t: float) -> float:
        return 2.0 + 0.0 * t

    def position(self, t: float) -> tuple[float, float, float]:
        return 0.3, 0.3 + 0.01 * t, 1.0

    def rotation(self, t: float) -> np.ndarray:
        return np.eye(3) + 0.0 * t

    def failing(self, q: np.ndarray) -> tuple[float, ...]:
        if hasattr(self, "measured"):
            raise RuntimeError(self)
        self.measured = True
        return tuple(q[:3])

    def limits(self) -> bik.Limits:
        return bik.Limits(velocity=self.speed)


def plan() -> bik.Plan:
    limits = bik.Limits(velocity=1.0, acceleration=2.0)
    return bik.plan_point_to_point(PLANAR, start_q=[0, 0.5, 0], end_q=[0.1, 0.6, 0.1], limits=limits)


def restored(result: Any, owner: Owner) -> Any:
    """The result with limits that lead to the owner; the methods that made it take no functions of time."""
    restore, arguments = result.__reduce__()
    return restore(*(owner.limits() if isinstance(each, bik.Limits) else each for each in arguments))


def holding(plan: bik.Plan) -> bik.BatchPlan:
    restore, _ = bik.plan_batch(PLANAR, []).__reduce__()
    return restore((plan,), (None,), [0], 0.0)


HOLDERS: dict[str, Callable[[Owner], Any]] = {
    "Limits": lambda owner: owner.limits(),
    "Path of a function": lambda owner: bik.paths.from_function(owner.position, 1.0),
    "Path with an orientation": lambda owner: LINE.with_orientation(owner.rotation),
    "TrackResult": lambda owner: bik.track(IIWA, LINE, START, dt=0.1, limits=owner.limits()),
    "ModelFreeResult": lambda owner: bik.track_model_free(owner.failing, LINE, START, dt=0.1),
    "Plan": lambda owner: restored(plan(), owner),
    "BatchPlan": lambda owner: holding(restored(plan(), owner)),
    "Solution": lambda owner: bik.solve(IIWA, (0.3, 0.3, 1.0), limits=owner.limits()),
    "SolutionSet": lambda owner: bik.solve_all(IIWA, (0.3, 0.3, 1.0), limit=1, limits=owner.limits()),
    "BatchSolution": lambda owner: bik.solve_batch(IIWA, [(0.3, 0.3, 1.0)], threads=1, limits=owner.limits()),
    "Minimum": lambda owner: restored(
        bik.minimize(np.sum, [0.0], [1.0], solver=bik.papers.PSO(), stop=bik.Stop(max_evaluations=100)), owner
    ),
    "PlanarPosture": lambda owner: restored(bik.papers.planar_posture(PLANAR, (1, 1, 0)), owner),
    "Step": lambda owner: restored(bik.Tracker(IIWA, START, dt=0.1).step((0.3, 0.3, 1.0)), owner),
}


@pytest.mark.parametrize("name", HOLDERS)
def test_a_cycle_is_freed(name: str) -> None:
    owner = Owner()
    owner.made = HOLDERS[name](owner)
    watched = weakref.ref(owner)
    gc.collect()
    assert watched() is owner
    del owner
    gc.collect()
    assert watched() is None, f"{name} keeps its cycle alive"


def test_holders_show_the_collector_what_they_hold() -> None:
    tracker = bik.Tracker(IIWA, START, dt=0.1)
    assert {type(held) for held in gc.get_referents(tracker)} >= {bik.Robot, bik.Limits}
    plant = bik.KinematicPlant(IIWA)
    assert IIWA in gc.get_referents(plant)
    session = bik.BroydenBAS().session(START, dt=0.1)
    assert session.limits in gc.get_referents(session)
