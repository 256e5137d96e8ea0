"""Tasks: the part of a target that counts (pose, position, orientation, pointing axis), with weights and tolerances."""

from ._core import Orientation, Pointing, Pose, Position, Task

__all__ = ["Orientation", "Pointing", "Pose", "Position", "Task"]
