"""ROS 2: trajectories as messages, and the logic of a node, with or without a ROS installation.

joint_trajectory   a `Trajectory` as `trajectory_msgs/JointTrajectory`
reading            messages as values of this library; any objects with the fields of the messages
servo              follows poses and twists with one command per tick
planner            plans to poses among markers
messages           the message types for cyclonedds, which it imports
dds                topics, types and qualities of service of ROS 2 in DDS
node               the node of `beetle-ik ros`: `servo` and `planner` on `dds`
"""

from .joint_trajectory import to_ros, to_ros_yaml

__all__ = ["to_ros", "to_ros_yaml"]
