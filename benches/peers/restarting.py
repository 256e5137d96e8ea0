"""Numerical libraries that restart until they reach the target."""

# Methods are described in adapter.py.
# ruff: noqa: ARG002, D101, D102, D107

from __future__ import annotations

import numpy as np

from .adapter import Adapter
from .chain import Chain


class BeetleIk(Adapter):
    name = "beetle-ik"
    distribution = "beetle-ik"
    settings = "defaults, no start given"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import beetle_ik

        self._bik, self._solve = beetle_ik, beetle_ik.solve
        self._tolerance = tolerance
        self.robot = beetle_ik.Robot.from_urdf(chain.urdf, base=chain.base, tip=chain.tip)
        self._solve(self.robot, chain.pose(chain.lower))  # builds the index, once a robot

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        tolerance = self._tolerance
        return self._solve(self.robot, target, position_tolerance=tolerance, rotation_tolerance=tolerance).q

    def solve_position(self, point: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._solve(self.robot, point, position_tolerance=self._tolerance).q

    def solve_all(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._bik.solve_all(self.robot, target).q

    def fk(self, q: np.ndarray) -> np.ndarray:
        return self.robot.fk(q)

    def fk_and_jacobian(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.robot.fk(q), self.robot.jacobian(q)


class BeetleIkFromStart(BeetleIk):
    name = "beetle-ik, start given"
    settings = "defaults, start_q= the random start that the other libraries get"
    solve_all = Adapter.solve_all  # as above
    fk = Adapter.fk
    fk_and_jacobian = Adapter.fk_and_jacobian

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        tolerance = self._tolerance
        return self._solve(
            self.robot, target, start_q=start, position_tolerance=tolerance, rotation_tolerance=tolerance
        ).q

    def solve_position(self, point: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._solve(self.robot, point, start_q=start, position_tolerance=self._tolerance).q


class RoboticsToolbox(Adapter):
    name = "roboticstoolbox"
    distribution = "roboticstoolbox-python"
    settings = 'ets.ik_LM(method="chan", k=0.1, tol=tolerance²/2, mask=(1, 1, 1, 0, 0, 0) for positions)'

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import roboticstoolbox

        self._ets = roboticstoolbox.Robot.URDF(str(chain.urdf)).ets(start=chain.base, end=chain.tip)
        self._tolerance = tolerance**2 / 2  # on half the squared norm of the error
        self._position_mask = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        solution = self._ets.ik_LM(target, q0=start, tol=self._tolerance, k=0.1, method="chan")
        return solution.q if solution.success else None

    def solve_position(self, point: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        target = np.eye(4)
        target[:3, 3] = point
        solution = self._ets.ik_LM(
            target, q0=start, tol=self._tolerance, k=0.1, method="chan", mask=self._position_mask
        )
        return solution.q if solution.success else None

    def fk(self, q: np.ndarray) -> np.ndarray:
        return self._ets.eval(q)

    def fk_and_jacobian(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self._ets.eval(q), self._ets.jacob0(q)


class OptIk(Adapter):
    name = "optik"
    distribution = "optik-py"
    settings = "speed mode, max_time 5 ms, tol_f=tolerance²/2, angular_weight=0 for positions, one thread"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import optik

        self._robot = optik.Robot.from_urdf_file(str(chain.urdf), chain.base, chain.tip)
        self._robot.set_parallelism(1)
        budget = {"max_time": 5e-3, "max_restarts": 10**9, "tol_f": tolerance**2 / 2}
        self._pose = optik.SolverConfig(**budget)
        self._position = optik.SolverConfig(**budget, angular_weight=[0.0, 0.0, 0.0])

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        solution = self._robot.ik(self._pose, target, start)
        return solution and np.array(solution[0])

    def solve_position(self, point: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        target = np.eye(4)
        target[:3, 3] = point
        solution = self._robot.ik(self._position, target, start)
        return solution and np.array(solution[0])

    def fk(self, q: np.ndarray) -> list[list[float]]:
        return self._robot.fk(q)

    def fk_and_jacobian(self, q: np.ndarray) -> tuple[list[list[float]], list[list[float]]]:
        return self._robot.fk(q), self._robot.joint_jacobian(q)


class TracIk(Adapter):
    name = "pytracik"
    distribution = "pytracik"
    settings = "Speed, timeout 5 ms, epsilon=tolerance/2 (it bounds each component); runs two threads of its own"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        from trac_ik import TracIK

        self._solver = TracIK(chain.base, chain.tip, str(chain.urdf), timeout=5e-3, epsilon=tolerance / 2)

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        return self._solver.ik(target[:3, 3], target[:3, :3], start)

    def fk(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self._solver.fk(q)
