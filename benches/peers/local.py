"""Libraries that follow one descent from the start, without restarts: each iterates to the tolerance or 200 steps."""

# The methods are described in adapter.py.
# ruff: noqa: D101, D102, D107

from __future__ import annotations

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
