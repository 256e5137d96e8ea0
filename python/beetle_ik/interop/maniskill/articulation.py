"""The robot of a planner: its joints in the order of a simulator, and the present state."""

import os
import warnings
from collections.abc import Sequence
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from ..._core import InvalidInputError, Obstacle, Robot, UnknownNameError, UrdfError
from ...calls.text import listed
from ..joint_entries import JointEntries
from ..urdf_joints import moving_joints
from .poses import Array, Pose, matrix_of


class Articulation:
    """A robot with all its joints, those of the gripper included, in an order of the user's.

    Args:
        urdf: the URDF file.
        move_group: link at the end of the chain.
        srdf: an SRDF, or None.
        package_dir: folder that stands for `package://`, or None.
        joint_names: all joints of `qpos`, in order; empty: all of the file.
        link_names: links in the order of their numbers; empty: all.
        collision: as of `Robot.from_urdf`.
    """

    def __init__(
        self,
        urdf: str | os.PathLike[str],
        move_group: str,
        *,
        srdf: str | os.PathLike[str] | None,
        package_dir: str | None,
        joint_names: Sequence[str],
        link_names: Sequence[str],
        collision: Any,
    ) -> None:
        """Loads the robot and puts it at rest at zero, or at the limit nearest to it."""
        try:
            arm = Robot.from_urdf(urdf, tip=move_group, srdf=srdf, collision=collision, package_dirs=package_dir)
        except UrdfError as error:
            raise UrdfError(str(error).replace("package_dirs", "new_package_keyword")) from None
        if arm.unread_collision_shapes:
            warnings.warn(
                f'not checked for collisions: {listed(arm.unread_collision_shapes)}; collision="hulls" reads meshes',
                stacklevel=3,
            )
        self._arm = arm
        bounds = moving_joints(urdf)
        self.joints = JointEntries(
            arm, bounds, list(joint_names) or list(bounds), argument="user_joint_names", degrees=False
        )
        self.joint_limits = np.array([bounds[name] for name in self.joints.names])
        self.link_names = list(link_names) or arm.all_link_names
        for link in (*self.link_names, move_group):
            if link not in arm.all_link_names:
                raise UnknownNameError(f"user_link_names: no link '{link}'; links: {listed(arm.all_link_names)}")
        self._base = np.eye(4)
        self._qpos = np.clip(np.zeros(len(self.joint_limits)), *self.joint_limits.T)
        self.attached: dict[str, tuple[str, Obstacle, list[str]]] = {}
        self._made: tuple[Any, Robot] | None = None

    def full(self, name: str, values: ArrayLike) -> Array:
        """Returns all joint positions; of the move group alone, the others are those of the present state."""
        if np.shape(values) == (len(self.joints.at),) != self._qpos.shape:
            full = self._qpos.copy()
            full[self.joints.at] = values
            values = full
        elif np.shape(values) not in ((), self._qpos.shape):
            raise InvalidInputError(
                f"{name}: expected {len(self._qpos)} joints, or the {len(self.joints.at)} of the move group, "
                f"got shape {np.shape(values)}"
            )
        return self.joints.read(name, values)

    def arm_at(self, qpos: Array, *, attached: bool = True) -> Robot:
        """Returns the robot on its base, with the joints beside the chain at their positions of `qpos`."""
        names = self.joints.names
        held = {name: names.index(name) for name in self._arm.held_joints if name in names}
        values = {name: float(np.clip(qpos[i], *self.joint_limits[i])) for name, i in held.items()}
        carried = self.attached if attached else {}
        key = (self._base.tobytes(), tuple(values.items()), tuple(carried.items()))
        if self._made is None or self._made[0] != key:
            robot = self._arm.with_base(self._base).with_held(values)
            for name, (link, shape, touch) in carried.items():
                robot = robot.with_attached(link, shape, touch=touch, name=name)
            self._made = key, robot
        return self._made[1]

    @property
    def has_bodies(self) -> bool:
        """Whether anything of the robot, or that it carries, can touch something."""
        return bool(self._arm.bodies or self.attached)

    def link(self, number: int) -> str:
        """Returns the name of a link; -1 is the one that moves."""
        return self._arm.tips[0] if number == -1 else self.link_names[number]

    # The calls of mplib's ArticulatedModel.

    def get_name(self) -> str:
        """Returns the name of the robot."""
        return self._arm.name

    def get_qpos(self) -> Array:
        """Returns all joint positions."""
        return np.array(self._qpos)

    def set_qpos(self, qpos: ArrayLike, full: bool = False) -> None:
        """Sets all joint positions, or those of the move group alone."""
        del full  # the length says it
        self._qpos = self.full("qpos", qpos)

    def get_base_pose(self) -> Pose:
        """Returns the pose of the base in the world."""
        return Pose(self._base)

    def set_base_pose(self, pose: Any) -> None:
        """Places the base in the world."""
        self._base = matrix_of("pose", pose)

    def get_pinocchio_model(self) -> NoReturn:
        """Says what stands in for the model of Pinocchio, which is not here."""
        raise AttributeError("there is no Pinocchio model: use arm_at(qpos), whose fk and jacobian take the move group")

    def get_user_joint_names(self) -> list[str]:
        """Returns the names of all joints, in order."""
        return list(self.joints.names)

    def get_user_link_names(self) -> list[str]:
        """Returns the names of the links, in order."""
        return list(self.link_names)

    def get_move_group_joint_names(self) -> list[str]:
        """Returns the names of the joints that are planned."""
        return [self.joints.names[i] for i in self.joints.at]

    def get_move_group_joint_indices(self) -> list[int]:
        """Returns where the joints that are planned are in `qpos`."""
        return list(self.joints.at)

    def get_move_group_qpos_dim(self) -> int:
        """Returns the number of joints that are planned."""
        return len(self.joints.at)
