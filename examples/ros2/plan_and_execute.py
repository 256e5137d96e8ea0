"""Plans to each pose that arrives; a joint_trajectory_controller executes it.

The logic is that of `beetle-ik ros`; this file connects it to rclpy.
"""

import rclpy
from action_msgs.msg import GoalStatus
from arm import limits_of, robot_of, say_by
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import PoseStamped
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.task import Future
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from visualization_msgs.msg import MarkerArray

import beetle_ik as bik
from beetle_ik.interop.ros.planner import Planner
from beetle_ik.interop.ros.reading import States
from beetle_ik.interop.ros.servo import answered


class PlannerNode(Node):
    """One motion at a time: a goal that arrives during a motion is refused."""

    def __init__(self) -> None:
        """Finds the arm and the controller."""
        super().__init__("beetle_planner")
        robot, self.say = robot_of(self), say_by(self)
        self.states, self.planner = States(robot), Planner(robot, limits_of(self))
        self.busy = False
        action = self.declare_parameter(
            "action", "joint_trajectory_controller/follow_joint_trajectory"
        ).value
        self.client = ActionClient(self, FollowJointTrajectory, action)
        for kind, topic, handle in (
            (JointState, "joint_states", self.states.read),
            (MarkerArray, "~/obstacles", self.planner.markers),
            (PoseStamped, "~/goal", self.on_goal),
        ):
            self.hear(kind, topic, handle)

    def hear(self, kind, topic, handle) -> None:
        """Subscribes; a message that cannot be used is answered by a log line."""
        self.create_subscription(
            kind, topic, lambda given: answered(self.say, topic, handle, given), 1
        )

    def on_goal(self, message: PoseStamped) -> None:
        """Plans from rest where the arm is, and sends the motion."""
        problem = self.obstacle_to()
        if problem:
            raise bik.InvalidInputError(problem)
        plan = self.planner.plan(self.states.require(), message)
        if not plan.success:
            raise bik.InvalidInputError(plan.message)
        self.busy = True
        goal = FollowJointTrajectory.Goal(trajectory=message_of(plan.trajectory))
        self.client.send_goal_async(goal).add_done_callback(self.on_answer)

    def obstacle_to(self) -> str | None:
        """Why no motion can begin now."""
        if self.busy:
            return "a motion is under way: send the goal when it has ended"
        if not self.client.server_is_ready():
            return (
                "the controller's action server is not there: "
                "is the controller active?"
            )
        return None

    def on_answer(self, future: Future) -> None:
        """Waits for the result of an accepted motion."""
        handle = future.result()
        if handle.accepted:
            handle.get_result_async().add_done_callback(self.on_result)
        else:
            self.busy = False
            self.get_logger().error("the controller rejected the trajectory")

    def on_result(self, future: Future) -> None:
        """Says how the motion ended."""
        self.busy = False
        outcome = future.result()
        if outcome.status == GoalStatus.STATUS_SUCCEEDED:
            self.get_logger().info("arrived")
        else:
            result = outcome.result
            self.get_logger().error(
                f"the motion ended with error code {result.error_code}: "
                f"{result.error_string}"
            )


def message_of(trajectory: bik.Trajectory) -> JointTrajectory:
    """The trajectory every 10 ms, with velocities and accelerations."""
    fields = bik.interop.to_ros(trajectory, dt=0.01)
    points = [
        JointTrajectoryPoint(
            **point | {"time_from_start": Duration(**point["time_from_start"])}
        )
        for point in fields["points"]
    ]
    return JointTrajectory(joint_names=fields["joint_names"], points=points)


def main() -> None:
    """Runs the node until Ctrl-C."""
    rclpy.init()
    try:
        rclpy.spin(PlannerNode())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
