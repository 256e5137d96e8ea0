"""Motion planning for ManiSkill and SAPIEN: the calls and results of mplib.

    import beetle_ik.interop.maniskill as mplib
    from beetle_ik.interop.maniskill import Pose

Neither mplib nor SAPIEN need be installed; poses and shapes of both are taken.

planner          the planner: calls for motions and configurations
world_calls      its calls that change the world, or ask what touches what
motions          its motions, clear of obstacles or along a screw
articulation     its robot: joints in the order of a simulator
world            what it keeps clear of
configurations   configurations for a pose
screw            screw motions
results          motions as dicts of arrays
fcl              collision shapes
poses            poses
"""

from . import fcl
from .planner import Planner
from .poses import Pose
from .world import WorldCollisionResult

__all__ = ["Planner", "Pose", "WorldCollisionResult", "fcl"]
