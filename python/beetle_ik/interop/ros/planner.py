"""Plans to poses among obstacles that markers show."""

from typing import Any

from ..._core import Limits, Obstacle, Plan, Robot, plan_point_to_point
from .reading import Array, marked, pose_of


class Planner:
    """Motions from where the arm is to poses, from rest to rest.

    Args:
        robot: the arm.
        limits: its limits.
    """

    def __init__(self, robot: Robot, limits: Limits) -> None:
        """Begins without obstacles."""
        self.robot, self.limits = robot, limits
        self.marked: dict[tuple[str, int], Obstacle] = {}

    def markers(self, message: Any) -> None:
        """Adds and removes obstacles."""
        self.marked = marked(self.robot, message, self.marked)

    def plan(self, q: Array, message: Any) -> Plan:
        """Plans from q (n,) to a `geometry_msgs/PoseStamped`; a plan that failed says why.

        Raises:
            InvalidInputError: another frame, no pose, or obstacles and a robot without bodies.
        """
        end = pose_of(self.robot, message)
        around = list(self.marked.values()) or None
        return plan_point_to_point(self.robot, start_q=q, end=end, limits=self.limits, obstacles=around)
