"""Secondary objectives for redundant arms, optimised in the null space of the task."""

from ._core import Centring, Clearance, Goal, LinkManipulability, Manipulability, Posture

__all__ = ["Centring", "Clearance", "Goal", "LinkManipulability", "Manipulability", "Posture"]
