"""What the joints should do where the task leaves them free."""

from ._core import Centring, Goal, LinkManipulability, Manipulability, Posture

__all__ = ["Centring", "Goal", "LinkManipulability", "Manipulability", "Posture"]
