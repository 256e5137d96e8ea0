"""Follows poses with joint commands at a fixed rate: a loop round `Tracker`."""

import rclpy
from arm import configuration, limits_of, pose_of, refusal, robot_of
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger

import beetle_ik as bik

SILENCE = 0.2  # s without a target after which the arm stops


class Servo(Node):
    """Publishes a configuration each 1 / rate seconds, once joint states arrive."""

    def __init__(self) -> None:
        """Finds the arm and its limits; the joint states say later where it is."""
        super().__init__("beetle_servo")
        self.robot = robot_of(self)
        self.limits = limits_of(self)
        self.dt = 1.0 / self.declare_parameter("rate", 500.0).value
        self.tracker: bik.Tracker | None = None
        self.target: PoseStamped | None = None
        self.held = ""
        self.commands = self.create_publisher(Float64MultiArray, "~/commands", 1)
        self.create_subscription(JointState, "joint_states", self.on_state, 1)
        self.create_subscription(PoseStamped, "~/target", self.on_target, 1)
        self.create_service(Trigger, "~/stop", self.on_stop)
        self.create_timer(self.dt, self.tick)

    def on_state(self, message: JointState) -> None:
        """Starts the tracker where the arm is.

        Later states are not fed back: the drives follow the commands.
        """
        q = configuration(self.robot, message)
        if self.tracker is None and q is not None:
            self.tracker = bik.Tracker(
                self.robot, q, dt=self.dt, limits=self.limits, timeout=SILENCE
            )
            self.get_logger().info(f"starts at {q.round(3).tolist()}")

    def on_target(self, message: PoseStamped) -> None:
        """Keeps the newest pose for the next tick."""
        problem = refusal(self.robot, message)
        if problem:
            self.get_logger().error(problem)
        else:
            self.target = message

    def on_stop(
        self, request: Trigger.Request, response: Trigger.Response
    ) -> Trigger.Response:
        """Brakes inside all limits; the next target starts the arm again."""
        del request
        self.target = None
        response.success = self.tracker is not None
        response.message = (
            f"stops within {self.tracker.stop():.3f} s"
            if self.tracker
            else "the arm has not started"
        )
        return response

    def tick(self) -> None:
        """One command."""
        if self.tracker is None:
            return
        target, self.target = self.target, None
        try:
            step = (
                self.tracker.step(None)
                if target is None
                else self.follow(self.tracker, target)
            )
        # no pose: the tracker is as before
        except bik.InvalidInputError as problem:
            self.get_logger().error(str(problem))
            step = self.tracker.step(None)
        self.commands.publish(Float64MultiArray(data=step.q.tolist()))
        self.report(step)

    def follow(self, tracker: bik.Tracker, target: PoseStamped) -> bik.Step:
        """Returns a tick towards the target; a stamp of zero means now."""
        seen = Time.from_msg(target.header.stamp)
        if seen.nanoseconds == 0:
            return tracker.step(pose_of(target))
        age = (self.get_clock().now() - seen).nanoseconds * 1e-9
        return tracker.step(pose_of(target), stamp=tracker.time + tracker.dt - age)

    def report(self, step: bik.Step) -> None:
        """Logs why the tip is not where it should be, once for each reason."""
        reason = "" if step.success else step.status.name
        if reason and reason != self.held:
            self.get_logger().warning(step.message)
        self.held = reason


def main() -> None:
    """Runs the node until Ctrl-C."""
    rclpy.init()
    try:
        rclpy.spin(Servo())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
