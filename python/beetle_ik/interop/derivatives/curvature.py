"""The second derivative of the tip's motion by the joints, from the Jacobian alone."""

import numpy as np

from ..._core import InvalidInputError, Robot
from ...calls.arguments import require_one_tip
from .rows import Rows


def require_single_joints(robot: Robot, link: str | None) -> None:
    """Checks that each entry of q moves one joint, and that joints move one after another.

    Raises:
        InvalidInputError: a robot with several tips, with mimic joints, or on a floating base; a link beside the chain.
    """
    require_one_tip("a second derivative", robot)
    if link is not None and link not in robot.link_names:
        raise InvalidInputError(
            f"link '{link}' is beside the chain of robot '{robot.name}': it has first derivatives alone"
        )
    moving = [joint for kind, joint, *_ in robot._chain()[1] if kind == "moving"]
    for joint in moving:
        if moving.count(joint) > 1:
            name = robot.joint_names[joint]
            raise InvalidInputError(
                f"joint '{name}' of robot '{robot.name}' has mimic joints: it has first derivatives alone"
            )


def curvature(robot: Robot, link: str | None, q: Rows) -> Rows:
    """Returns the derivatives of the Jacobian (m, 6, n) by each joint, (m, 6, n, n), the joint last.

    A joint turns the columns of all joints behind it, and the tip that joints before it move: for columns (v, w),
    d(v_i)/dq_j is w_j x v_i for j <= i and w_i x v_j for j > i; d(w_i)/dq_j is w_j x w_i for j < i, else zero.
    """
    columns = np.swapaxes(robot.jacobian(q, link=link), 1, 2)
    linear, angular = columns[..., :3], columns[..., 3:]
    first = np.cross(angular[:, None, :], linear[:, :, None])  # [m, i, j] = w_j x v_i
    behind = np.tri(robot.dof, dtype=bool)[..., None]  # j <= i
    moved = np.where(behind, first, np.swapaxes(first, 1, 2))
    turned = np.where(behind, np.cross(angular[:, None, :], angular[:, :, None]), 0.0)
    return np.moveaxis(np.concatenate((moved, turned), axis=-1), -1, 1)
