"""Tasks: which part of a target counts (pose, position, orientation or pointing axis), with weights and tolerances."""

from ._core import Orientation, Pointing, Pose, Position, Task

__all__ = ["Orientation", "Pointing", "Pose", "Position", "Task"]
