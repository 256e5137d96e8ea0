"""What the joints should do where the task leaves them free."""

from ._core import Centring, Goal, Manipulability, Posture

__all__ = ["Centring", "Goal", "Manipulability", "Posture"]
