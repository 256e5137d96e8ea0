"""Messages of ROS 2 as values of this library. They may be rclpy's or those of `messages`: only their fields count."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import obstacles
from ..._core import InvalidInputError, Obstacle, Robot, pose
from ...calls.text import listed

Array = NDArray[np.float64]
_ADD, _DELETE, _DELETE_ALL = 0, 2, 3  # actions of visualization_msgs/Marker
_CUBE, _SPHERE, _CYLINDER = 1, 2, 3  # its types


class States:
    """The newest positions by name, from messages `sensor_msgs/JointState` in any order; several may share the joints.

    Args:
        robot: the arm; joints of others are passed over.
    """

    def __init__(self, robot: Robot) -> None:
        """Begins without positions."""
        self.robot = robot
        self.known: dict[str, float] = {}

    def read(self, message: Any) -> None:
        """Keeps the positions of a message.

        Raises:
            InvalidInputError: lists of unequal lengths, a joint that is there twice, or positions that are not finite;
                nothing of the message is kept.
        """
        names, values = list(message.name), [float(value) for value in message.position]
        if len(names) != len(values):
            raise InvalidInputError(f"{len(names)} names, but {len(values)} positions")
        ours = {name: value for name, value in zip(names, values, strict=True) if name in self.robot.joint_names}
        for name, value in ours.items():
            if names.count(name) > 1:
                raise InvalidInputError(f"joint '{name}' is there twice")
            if not np.isfinite(value):
                raise InvalidInputError(f"joint '{name}' is at {value}")
        self.known |= ours

    @property
    def q(self) -> Array | None:
        """The configuration (n,); None until each joint has been heard of."""
        return None if self.missing else np.array([self.known[name] for name in self.robot.joint_names])

    @property
    def missing(self) -> list[str]:
        """Joints that no message has named."""
        return [name for name in self.robot.joint_names if name not in self.known]

    def require(self) -> Array:
        """Returns the configuration (n,).

        Raises:
            InvalidInputError: joints that no message has named.
        """
        if not self.known:
            raise InvalidInputError("no joint states have arrived yet")
        if self.missing:
            raise InvalidInputError(f"no joint states have arrived yet for {listed(self.missing)}")
        return np.array([self.known[name] for name in self.robot.joint_names])


def pose_of(robot: Robot, message: Any) -> Array:
    """Returns the pose (4, 4) of a `geometry_msgs/PoseStamped` in the frame of the base.

    Raises:
        InvalidInputError: another frame, or numbers that are no pose.
    """
    frame = _frame(message)
    if frame not in ("", robot.link_names[0]):
        raise _refused("pose", frame, f"'{robot.link_names[0]}'")
    return _pose(message.pose)


def twist_of(robot: Robot, message: Any) -> tuple[Array, bool]:
    """Returns the twist (6,) (m/s, rad/s) of a `geometry_msgs/TwistStamped`, and whether its axes are the tip's.

    Raises:
        InvalidInputError: a frame other than the base or the tip, or numbers that are not finite.
    """
    frame = _frame(message)
    if frame not in ("", robot.link_names[0], robot.tips[0]):
        raise _refused("twist", frame, f"'{robot.link_names[0]}' or '{robot.tips[0]}'")
    parts = (message.twist.linear, message.twist.angular)
    twist = np.array([[part.x, part.y, part.z] for part in parts], dtype=float).ravel()
    if not np.isfinite(twist).all():
        raise InvalidInputError(f"the twist must be finite, got {twist.tolist()}")
    return twist, frame == robot.tips[0]


def marked(robot: Robot, message: Any, known: dict[tuple[str, int], Obstacle]) -> dict[tuple[str, int], Obstacle]:
    """Returns obstacles by namespace and id after a `visualization_msgs/MarkerArray` of cubes, spheres and cylinders.

    Raises:
        InvalidInputError: a marker of another type, action or frame, or a size that is not positive; `known` stays.
    """
    result = dict(known)
    for marker in message.markers:
        name = (str(marker.ns), int(marker.id))
        if marker.action == _DELETE_ALL:
            result.clear()
        elif marker.action == _DELETE:
            result.pop(name, None)
        elif marker.action == _ADD:
            result[name] = _obstacle(robot, marker, f"marker {name[0]}/{name[1]}")
        else:
            raise InvalidInputError(f"marker {name[0]}/{name[1]}: action {marker.action}; expected 0, 2 or 3")
    return result


def _obstacle(robot: Robot, marker: Any, what: str) -> Obstacle:
    frame = _frame(marker)
    if frame not in ("", robot.link_names[0]):
        raise _refused(what, frame, f"'{robot.link_names[0]}'")
    at, size = _pose(marker.pose), np.array([marker.scale.x, marker.scale.y, marker.scale.z], dtype=float)
    if marker.type == _CUBE:
        return obstacles.Box(at[:3, 3], size, at[:3, :3])
    if marker.type == _SPHERE and np.ptp(size) == 0.0:
        return obstacles.Sphere(at[:3, 3], 0.5 * size[0])
    if marker.type == _SPHERE:
        return obstacles.Ellipsoid(at[:3, 3], 0.5 * size, at[:3, :3])
    if marker.type == _CYLINDER:
        return obstacles.Cylinder(at[:3, 3], at[:3, 2], 0.5 * max(size[0], size[1]), size[2])
    raise InvalidInputError(f"{what}: type {marker.type}; expected a cube (1), sphere (2) or cylinder (3)")


def _pose(message: Any) -> Array:
    place, turn = message.position, message.orientation
    return pose([place.x, place.y, place.z], xyzw=[turn.x, turn.y, turn.z, turn.w])


def _frame(message: Any) -> str:
    return str(message.header.frame_id).removeprefix("/")


def _refused(what: str, frame: str, taken: str) -> InvalidInputError:
    return InvalidInputError(f"the {what} is given in frame '{frame}', and this node takes those in {taken}")
