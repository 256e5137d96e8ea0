"""Converts trajectories and robots to and from other libraries, which are imported when a function needs them.

Poses need no conversion: every function that takes a pose also takes Pinocchio's `SE3`, spatialmath's `SE3` and scipy's
`RigidTransform`; every function that takes a rotation matrix also takes scipy's `Rotation`.

| to and from | functions |
|---|---|
| ROS 2 `trajectory_msgs/JointTrajectory` | `to_ros`, `to_ros_yaml` |
| bags of ROS 2 (MCAP) | `to_rosbag` |
| MoveIt `moveit_msgs/RobotTrajectory` | `to_moveit` |
| episodes of LeRobot datasets | `to_lerobot` |
| pandas | `to_dataframe` |
| Pinocchio | `from_pinocchio`, `to_pinocchio` |
| Robotics Toolbox for Python | `from_roboticstoolbox`, `to_roboticstoolbox` |
| MuJoCo (MJCF) | `from_mujoco` |

Modules of their own, imported by name, as in `from beetle_ik.interop import jax`:

| for | module |
|---|---|
| JAX: kinematics with derivatives | `jax` |
| PyTorch: the same | `torch` |

Doors have the calls of another library, `interop.lerobot` and `interop.maniskill`, or take what sensors of humans give:
`interop.teleop` velocities of a joystick, `interop.retarget` points of a hand or body.
"""

from . import jax as jax
from . import lerobot as lerobot
from . import maniskill as maniskill
from . import retarget as retarget
from . import teleop as teleop
from . import torch as torch
from .episodes import to_lerobot
from .moveit import to_moveit
from .mujoco import from_mujoco
from .pinocchio import from_pinocchio, to_pinocchio
from .roboticstoolbox import from_roboticstoolbox, to_roboticstoolbox
from .ros import to_ros, to_ros_yaml
from .rosbag import to_rosbag
from .table import to_dataframe

__all__ = [
    "from_mujoco",
    "from_pinocchio",
    "from_roboticstoolbox",
    "to_dataframe",
    "to_lerobot",
    "to_moveit",
    "to_pinocchio",
    "to_roboticstoolbox",
    "to_ros",
    "to_ros_yaml",
    "to_rosbag",
]
