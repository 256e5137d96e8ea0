"""Judge of calibrations: forward kinematics, Jacobian and bounds in numpy, which share no code with the library."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import beetle_ik as bik

Array = NDArray[np.float64]


def transform(translation: Array, rotation_vector: Array) -> Array:
    """A pose (4, 4)."""
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_rotvec(rotation_vector).as_matrix()
    pose[:3, 3] = translation
    return pose


class Arm:
    """Chain of a robot as plain numbers: constant transforms, and the joints between them."""

    def __init__(self, robot: bik.Robot) -> None:
        """Reads the chain."""
        base, elements, tool = robot._chain()
        self.fixed: list[Array] = [np.array(base)]
        self.joints: list[tuple[Array, bool, int, float, float]] = []
        for kind, *content in elements:
            if kind == "fixed":
                self.fixed[-1] = self.fixed[-1] @ content[0]
            elif kind == "moving":
                joint, turns, axis, scale, offset = content
                self.joints.append((np.array(axis), turns, joint, scale, offset))
                self.fixed.append(np.eye(4))
        self.fixed[-1] = self.fixed[-1] @ tool
        self.robot = robot

    @property
    def parameters(self) -> int:
        """Six for each transform, and a zero for each joint."""
        return 6 * len(self.fixed) + self.robot.dof

    def changed(self, parameters: Array) -> "Arm":
        """The arm with small changes of all parameters."""
        arm = object.__new__(Arm)
        arm.robot = self.robot
        twists = parameters[: 6 * len(self.fixed)].reshape(-1, 6)
        zeros = parameters[6 * len(self.fixed) :]
        arm.fixed = [fixed @ transform(twist[:3], twist[3:]) for fixed, twist in zip(self.fixed, twists, strict=True)]
        arm.joints = [(a, turns, j, scale, offset + scale * zeros[j]) for a, turns, j, scale, offset in self.joints]
        return arm

    def tips(self, q: Array) -> Array:
        """Poses (m, 4, 4) at q (m, n)."""
        reached = np.broadcast_to(self.fixed[0], (len(q), 4, 4))
        for (axis, turns, joint, scale, offset), fixed in zip(self.joints, self.fixed[1:], strict=True):
            value = scale * q[:, joint] + offset
            moved = np.tile(np.eye(4), (len(q), 1, 1))
            if turns:
                moved[:, :3, :3] = Rotation.from_rotvec(value[:, None] * axis).as_matrix()
            else:
                moved[:, :3, 3] = value[:, None] * axis
            reached = reached @ moved @ fixed
        return reached

    def jacobian(self, q: Array, rotations: bool, step: float = 1e-6) -> Array:
        """Derivatives (m, 3 or 6, p) of positions, and rotations, by central differences."""
        columns = []
        for k in range(self.parameters):
            change = np.zeros(self.parameters)
            change[k] = step
            after, before = self.changed(change).tips(q), self.changed(-change).tips(q)
            column = after[:, :3, 3] - before[:, :3, 3]
            if rotations:
                turn = Rotation.from_matrix(after[:, :3, :3] @ before[:, :3, :3].transpose(0, 2, 1)).as_rotvec()
                column = np.concatenate([column, turn], axis=1)
            columns.append(column / (2 * step))
        return np.stack(columns, axis=-1)


def built(model: bik.Robot, rng: np.random.Generator, length: float, angle: float) -> bik.Robot:
    """The arm as it is built: each transform is off by up to `length` along and `angle` about each axis."""
    base, elements, tool = model._chain()

    def off(pose: Array) -> Array:
        return pose @ transform(rng.uniform(-length, length, 3), rng.uniform(-angle, angle, 3))

    changed = []
    for element in elements[1:]:
        if element[0] == "fixed":
            changed.append(("fixed", off(element[1])))
        elif element[0] == "moving":
            changed.append((*element[:5], element[5] + rng.uniform(-1, 1) * (angle if element[2] else length)))
        else:
            changed.append(element)
    joints = list(zip(model.joint_names, model.joint_kinds, model.lower, model.upper, [1.0] * model.dof, strict=True))
    arm = bik.Robot._from_chain(model.name, elements[0][1], joints, changed)
    return arm.with_base(off(base)).with_tool(off(tool))


def rank(jacobian: Array) -> int:
    """Rank of stacked derivatives, by singular values above the noise of differences."""
    values = np.linalg.svd(jacobian.reshape(-1, jacobian.shape[-1]), compute_uv=False)
    return int((values > 1e-6 * values[0]).sum())


def bound(arm: Arm, q: Array, new: Array, sigma: float) -> float:
    """Cramér-Rao bound on the rms error of positions at `new`, after positions at `q` with noise `sigma`."""
    information = arm.jacobian(q, rotations=False).reshape(-1, arm.parameters)
    covariance = sigma**2 * np.linalg.pinv(information.T @ information, rcond=1e-11, hermitian=True)
    slopes = arm.jacobian(new, rotations=False)
    return float(np.sqrt(np.einsum("mij,jk,mik->m", slopes, covariance, slopes).mean()))
