"""Follows poses and twists with joint commands at a fixed rate.

The logic is that of `beetle-ik ros`; this file connects it to rclpy.
"""

import rclpy
from arm import limits_of, robot_of, say_by
from geometry_msgs.msg import PoseStamped, TwistStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger

from beetle_ik.interop.ros.reading import States
from beetle_ik.interop.ros.servo import Servo, answered


class ServoNode(Node):
    """Publishes a configuration each 1 / rate seconds, once joint states arrive."""

    def __init__(self) -> None:
        """Finds the arm and its limits; the joint states say later where it is."""
        super().__init__("beetle_servo")
        robot, limits, self.say = robot_of(self), limits_of(self), say_by(self)
        dt = 1.0 / self.declare_parameter("rate", 500.0).value
        self.states = States(robot)
        self.servo = Servo(robot, limits, dt, self.say)
        self.commands = self.create_publisher(Float64MultiArray, "~/commands", 1)
        for kind, topic, handle in (
            (JointState, "joint_states", self.on_state),
            (PoseStamped, "~/target", self.servo.pose),
            (TwistStamped, "~/twist", self.servo.move),
        ):
            self.hear(kind, topic, handle)
        self.create_service(Trigger, "~/stop", self.on_stop)
        self.create_timer(dt, self.tick)

    def hear(self, kind, topic, handle) -> None:
        """Subscribes; a message that cannot be used is answered by a log line."""
        self.create_subscription(
            kind, topic, lambda given: answered(self.say, topic, handle, given), 1
        )

    def on_state(self, message: JointState) -> None:
        """Starts where the arm is; later the drives follow the commands."""
        self.states.read(message)
        if self.servo.jog is None and self.states.q is not None:
            self.servo.start(self.states.q)

    def on_stop(
        self, request: Trigger.Request, response: Trigger.Response
    ) -> Trigger.Response:
        """Brakes inside all limits; the next target starts the arm again."""
        del request
        takes = self.servo.stop()
        response.success = takes is not None
        response.message = (
            "the arm has not started"
            if takes is None
            else f"stops within {takes:.3f} s"
        )
        return response

    def tick(self) -> None:
        """One command."""
        step = self.servo.tick(self.get_clock().now().nanoseconds)
        if step is not None:
            self.commands.publish(Float64MultiArray(data=step.q.tolist()))


def main() -> None:
    """Runs the node until Ctrl-C."""
    rclpy.init()
    try:
        rclpy.spin(ServoNode())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
