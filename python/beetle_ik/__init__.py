"""Inverse kinematics, trajectory tracking and planning for robot manipulators.

SI units, radians and numpy float64 throughout. Poses are 4x4 homogeneous matrices in the frame of the robot's base.
Every result has `success`, `status` and `message`: a sentence that says what happened and what to try.

    import beetle_ik as bik

    robot = bik.Robot.named("iiwa14")
    circle = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=30.0)
    result = bik.track(robot, circle, dt=0.02)
    result.trajectory.to_csv("trajectory.csv")
"""

import logging
import warnings
from importlib import import_module
from typing import TYPE_CHECKING, Any

from . import filters, goals, moves, obstacles, papers, paths, tasks
from ._core import (
    BatchPlan,
    BatchSolution,
    BeetleIkError,
    Body,
    Break,
    BroydenBAS,
    Calibration,
    CallError,
    ControlSession,
    DifferentialEvolution,
    Identifiability,
    Inertia,
    InfeasibleError,
    InvalidInputError,
    JacobianTranspose,
    Keep,
    KinematicPlant,
    LevenbergMarquardt,
    LimitError,
    Limits,
    Minimum,
    ModelFreeResult,
    MoveReport,
    MultiStart,
    NewtonRaphson,
    Path,
    Plan,
    Robot,
    SelfMotion,
    Sinusoid,
    Solution,
    SolutionSet,
    SpeedBound,
    Status,
    Step,
    Stop,
    StraightLine,
    Tracker,
    TrackResult,
    Trajectory,
    UnitsWarning,
    UnknownNameError,
    UnsupportedLimit,
    UrdfError,
    VelocityEllipsoid,
    Violation,
    WeightedPseudoInverse,
    __version__,
    calibrate,
    minimize,
    plan_along_path,
    plan_batch,
    plan_moves,
    plan_point_to_point,
    pose,
    self_motion,
    solve,
    solve_all,
    solve_batch,
    state_to_state,
    time_optimal,
    track,
    track_model_free,
    upright,
)
from .calls.attributes import hint_at_attributes
from .scenes import Scene

if TYPE_CHECKING:
    from . import interop, plot, vision
    from .installed.versions import show_versions
    from .mapping import BasePlacement, InverseReachabilityMap, ReachabilityMap, best_base, reachability
    from .viewing import Viewer, view

# Not Robot and Tracker, whose methods are called at every tick: each call would take 80 ns more.
hint_at_attributes(
    *(BatchPlan, BatchSolution, Calibration, ControlSession, Limits, Minimum, ModelFreeResult, MoveReport, Path, Plan),
    *(SelfMotion, Solution, SolutionSet, Step, TrackResult, Trajectory),
)

# Keeps logging silent unless the application configures it.
logging.getLogger(__name__).addHandler(logging.NullHandler())

__all__ = [
    "BasePlacement",
    "BatchPlan",
    "BatchSolution",
    "BeetleIkError",
    "Body",
    "Break",
    "BroydenBAS",
    "Calibration",
    "CallError",
    "ControlSession",
    "DifferentialEvolution",
    "Identifiability",
    "Inertia",
    "InfeasibleError",
    "InvalidInputError",
    "InverseReachabilityMap",
    "JacobianTranspose",
    "Keep",
    "KinematicPlant",
    "LevenbergMarquardt",
    "LimitError",
    "Limits",
    "Minimum",
    "ModelFreeResult",
    "MoveReport",
    "MultiStart",
    "NewtonRaphson",
    "Path",
    "Plan",
    "ReachabilityMap",
    "Robot",
    "Scene",
    "SelfMotion",
    "Sinusoid",
    "Solution",
    "SolutionSet",
    "SpeedBound",
    "Status",
    "Step",
    "Stop",
    "StraightLine",
    "TrackResult",
    "Tracker",
    "Trajectory",
    "UnitsWarning",
    "UnknownNameError",
    "UnsupportedLimit",
    "UrdfError",
    "VelocityEllipsoid",
    "Viewer",
    "Violation",
    "WeightedPseudoInverse",
    "__version__",
    "best_base",
    "calibrate",
    "filters",
    "goals",
    "interop",
    "minimize",
    "moves",
    "obstacles",
    "papers",
    "paths",
    "plan_along_path",
    "plan_batch",
    "plan_moves",
    "plan_point_to_point",
    "plot",
    "pose",
    "reachability",
    "self_motion",
    "show_versions",
    "solve",
    "solve_all",
    "solve_batch",
    "state_to_state",
    "tasks",
    "time_optimal",
    "track",
    "track_model_free",
    "upright",
    "view",
    "vision",
]

# Names imported at their first use, with their modules: `import beetle_ik` stays quick.
_LATER = {
    "interop": "interop",
    "plot": "plot",
    "vision": "vision",
    "show_versions": "installed.versions",
    "BasePlacement": "mapping",
    "InverseReachabilityMap": "mapping",
    "ReachabilityMap": "mapping",
    "best_base": "mapping",
    "reachability": "mapping",
    "Viewer": "viewing",
    "view": "viewing",
}

# Classes of results, which users never construct themselves.
_MADE_BY_CALLS = frozenset(
    {
        "BasePlacement",
        "BatchPlan",
        "BatchSolution",
        "Body",
        "Break",
        "Calibration",
        "ControlSession",
        "Identifiability",
        "InverseReachabilityMap",
        "Minimum",
        "ModelFreeResult",
        "MoveReport",
        "Plan",
        "SelfMotion",
        "Solution",
        "SolutionSet",
        "SpeedBound",
        "Step",
        "TrackResult",
        "VelocityEllipsoid",
        "Viewer",
        "Violation",
    }
)


def __dir__() -> list[str]:
    """Returns the names that a completion offers: public names except the classes of results."""
    return sorted(set(__all__) - _MADE_BY_CALLS)


if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Imports a name at its first use, or returns a method of the papers under its old name."""
        if name in _LATER:
            module = import_module(f".{_LATER[name]}", __name__)
            value = module if name == _LATER[name] else getattr(module, name)
            globals()[name] = value
            return value
        if name in papers.__all__:
            warnings.warn(
                f"beetle_ik.{name} is now beetle_ik.papers.{name}; the old name goes in 0.3",
                DeprecationWarning,
                stacklevel=2,
            )
            return getattr(papers, name)
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'", name=name, obj=import_module(__name__))
