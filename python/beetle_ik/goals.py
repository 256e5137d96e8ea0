"""Secondary objectives for redundant arms, optimised in the null space of the task."""

from ._core import Centring, Clearance, Goal, LeastTorque, LinkManipulability, Manipulability, Posture

__all__ = ["Centring", "Clearance", "Goal", "LeastTorque", "LinkManipulability", "Manipulability", "Posture"]
