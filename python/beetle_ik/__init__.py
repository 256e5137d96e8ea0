"""Inverse kinematics and trajectory tracking for robot manipulators.

SI units, radians and numpy float64 throughout. Poses are 4x4 homogeneous matrices in the frame of the robot's base.
Every result says whether it succeeded (`success`, `status`) and, in a sentence, what happened and what to try
(`message`).

    import beetle_ik as bik

    robot = bik.Robot.named("iiwa14")
    circle = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=30.0)
    result = bik.track(robot, circle, dt=0.2, solver=bik.BAS())
    result.trajectory.to_csv("trajectory.csv")
"""

from . import goals, paths, plot, tasks
from ._core import (
    BAS,
    BatchSolution,
    BeetleIkError,
    CircleSwarm,
    InvalidInputError,
    LevenbergMarquardt,
    LimitError,
    Limits,
    MultiStart,
    Path,
    PlanarPosture,
    Robot,
    Sinusoid,
    Solution,
    SolutionSet,
    Status,
    Step,
    Stop,
    Tracker,
    TrackResult,
    Trajectory,
    UnknownNameError,
    UnsupportedLimit,
    UrdfError,
    VelocityEllipsoid,
    WeightedPseudoInverse,
    __version__,
    planar_posture,
    pose,
    solve,
    solve_all,
    solve_batch,
    track,
)

__all__ = [
    "BAS",
    "BatchSolution",
    "BeetleIkError",
    "CircleSwarm",
    "InvalidInputError",
    "LevenbergMarquardt",
    "LimitError",
    "Limits",
    "MultiStart",
    "Path",
    "PlanarPosture",
    "Robot",
    "Sinusoid",
    "Solution",
    "SolutionSet",
    "Status",
    "Step",
    "Stop",
    "TrackResult",
    "Tracker",
    "Trajectory",
    "UnknownNameError",
    "UnsupportedLimit",
    "UrdfError",
    "VelocityEllipsoid",
    "WeightedPseudoInverse",
    "__version__",
    "goals",
    "paths",
    "planar_posture",
    "plot",
    "pose",
    "solve",
    "solve_all",
    "solve_batch",
    "tasks",
    "track",
]
