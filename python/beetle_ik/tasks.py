"""What of a target matters: its pose, position or orientation, or where an axis points; weights, tolerances, tools."""

from ._core import Orientation, Pointing, Pose, Position, Task

__all__ = ["Orientation", "Pointing", "Pose", "Position", "Task"]
