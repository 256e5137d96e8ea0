"""Methods of the papers that the project reproduces, beetle antennae search first, and the methods compared with them.

    robot = bik.Robot.named("iiwa14")
    solution = bik.solve(robot, [0.4, 0.3, 0.8], solver=bik.papers.BAS(), position_tolerance=1e-3)

For most tasks the defaults of `solve`, `track` and `plan_point_to_point` are faster and more reliable.
"""

from ._core import (
    APPS,
    BAS,
    PSO,
    QPSO,
    TPBSO,
    ZNNBAS,
    BeeColony,
    BeetleSwarm,
    CircleSwarm,
    Firefly,
    Genetic,
    PlanarPosture,
    planar_posture,
)

__all__ = [
    "APPS",
    "BAS",
    "PSO",
    "QPSO",
    "TPBSO",
    "ZNNBAS",
    "BeeColony",
    "BeetleSwarm",
    "CircleSwarm",
    "Firefly",
    "Genetic",
    "PlanarPosture",
    "planar_posture",
]

# Pickles contain the module name of a class.
for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = __name__
