"""Libraries that follow one descent from the start, without restarts: each iterates to the tolerance or 200 steps."""

# Methods are described in adapter.py.
# ruff: noqa: D101, D102, D107

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np

from .adapter import Adapter
from .chain import Chain

MAX_STEPS = 200


class PinocchioClik(Adapter):
    name = "pinocchio CLIK"
    distribution = "pin"
    settings = f"damped Newton on log6 (damping 1e-6, full step), clamped, {MAX_STEPS} steps"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import pinocchio as pin

        self._pin, self._model, self._data = pin, chain.model, chain.model.createData()
        self._tip, self._tolerance = chain.tip_frame, tolerance
        self._damping = 1e-6 * np.eye(6)

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        pin, model, data, q = self._pin, self._model, self._data, start
        goal = pin.SE3(target)
        for _ in range(MAX_STEPS):
            pin.framesForwardKinematics(model, data, q)
            tip_to_goal = data.oMf[self._tip].actInv(goal)
            error = pin.log6(tip_to_goal).vector
            if np.linalg.norm(error) <= self._tolerance:
                return q
            jacobian = pin.Jlog6(tip_to_goal.inverse()) @ pin.computeFrameJacobian(model, data, q, self._tip)
            step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + self._damping, error)
            q = np.clip(q + step, model.lowerPositionLimit, model.upperPositionLimit)
        return None

    def fk(self, q: np.ndarray) -> np.ndarray:
        self._pin.framesForwardKinematics(self._model, self._data, q)
        return self._data.oMf[self._tip].homogeneous

    def fk_and_jacobian(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        frame = self._pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        self._pin.computeJointJacobians(self._model, self._data, q)
        pose = self._pin.updateFramePlacement(self._model, self._data, self._tip).homogeneous
        return pose, self._pin.getFrameJacobian(self._model, self._data, self._tip, frame)


class Klampt(Adapter):
    name = "klampt"
    distribution = "Klampt"
    settings = f"IKSolver with joint limits, tolerance/2 (it bounds each component), {MAX_STEPS} steps"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import klampt

        self._objective, self._world = klampt.IKObjective, klampt.WorldModel()
        self._robot = self._world.loadRobot(str(chain.urdf))
        self._tip = self._robot.link(chain.tip).getIndex()
        drivers = [self._robot.driver(i) for i in range(self._robot.numDrivers())]
        self._moving = [driver.getAffectedLink() for driver in drivers]  # its fixed joints count as links too
        self._all = self._robot.getConfig()
        self._solver = klampt.IKSolver(self._robot)
        self._solver.setActiveDofs(self._moving)
        self._solver.setMaxIters(MAX_STEPS)
        self._solver.setTolerance(tolerance / 2)

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        objective = self._objective()
        objective.setFixedTransform(self._tip, target[:3, :3].T.ravel().tolist(), target[:3, 3].tolist())
        return self._reach(objective, start)

    def solve_position(self, point: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        objective = self._objective()
        objective.setFixedPoint(self._tip, [0.0, 0.0, 0.0], point.tolist())
        return self._reach(objective, start)

    def _reach(self, objective: object, start: np.ndarray) -> np.ndarray | None:
        for link, value in zip(self._moving, start.tolist(), strict=True):
            self._all[link] = value
        self._robot.setConfig(self._all)
        self._solver.clear()
        self._solver.add(objective)
        if not self._solver.solve():
            return None
        return np.array(self._robot.getConfig())[self._moving]


class PyBullet(Adapter):
    name = "pybullet"
    distribution = "pybullet"
    settings = (
        "resetJointState, calculateInverseKinematics(jointDamping=1e-4, which doubles or triples what it solves, "
        f"residualThreshold=tolerance), {MAX_STEPS} steps; joints beyond a limit taken back by whole turns"
    )

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import pinocchio as pin
        import pybullet

        self._bullet, self._quaternion, self._unwound = pybullet, pin.Quaternion, chain.unwound
        client = pybullet.connect(pybullet.DIRECT)
        self._body = pybullet.loadURDF(str(chain.urdf), useFixedBase=True, physicsClientId=client)
        joints = range(pybullet.getNumJoints(self._body, physicsClientId=client))
        kinds = [pybullet.getJointInfo(self._body, joint, physicsClientId=client)[2] for joint in joints]
        self._moving = [joint for joint, kind in zip(joints, kinds, strict=True) if kind != pybullet.JOINT_FIXED]
        self._tip, self._client = joints[-1], client
        self._options = {
            "jointDamping": [1e-4] * chain.dof,
            "maxNumIterations": MAX_STEPS,
            "residualThreshold": tolerance,
            "physicsClientId": client,
        }

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._reach(start, target[:3, 3].tolist(), self._quaternion(target[:3, :3]).coeffs().tolist())

    def solve_position(self, point: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._reach(start, point.tolist())

    def _reach(self, start: np.ndarray, *target: list[float]) -> np.ndarray:
        for joint, value in zip(self._moving, start.tolist(), strict=True):
            self._bullet.resetJointState(self._body, joint, value, physicsClientId=self._client)
        q = self._bullet.calculateInverseKinematics(self._body, self._tip, *target, **self._options)
        return self._unwound(np.array(q))


class IkPy(Adapter):
    name = "ikpy"
    distribution = "ikpy"
    settings = f'inverse_kinematics_frame(orientation_mode="all", tol=tolerance²), {MAX_STEPS} evaluations'

    def __init__(self, chain: Chain, tolerance: float) -> None:
        from ikpy.chain import Chain as Links

        joints = ET.parse(chain.urdf).getroot().iter("joint")
        moving = [False, *(joint.get("type") != "fixed" for joint in joints)]  # the base counts as a link
        self._links = Links.from_urdf_file(str(chain.urdf), base_elements=[chain.base], active_links_mask=moving)
        self._options = {"tol": tolerance**2, "optimizer_budget": MAX_STEPS}
        self._moving, self._all = np.flatnonzero(moving), np.zeros(len(moving))

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._reach(target, start, "all")

    def solve_position(self, point: np.ndarray, start: np.ndarray) -> np.ndarray:
        target = np.eye(4)
        target[:3, 3] = point
        return self._reach(target, start, None)

    def _reach(self, target: np.ndarray, start: np.ndarray, orientation: str | None) -> np.ndarray:
        self._all[self._moving] = start
        q = self._links.inverse_kinematics_frame(
            target, initial_position=self._all, orientation_mode=orientation, **self._options
        )
        return np.asarray(q)[self._moving]
