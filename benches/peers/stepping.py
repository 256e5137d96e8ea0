"""Libraries of differential kinematics: a call is one step by a quadratic program, iterated to the tolerance."""

# Methods are described in adapter.py.
# ruff: noqa: D101, D102, D107

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np

from .adapter import Adapter
from .chain import Chain
from .local import MAX_STEPS

DAMPING, LM_DAMPING = 1e-6, 1e-3  # the most dependable of those tried
QUADRATIC_PROGRAM = (
    f"FrameTask(lm_damping={LM_DAMPING:g}), ConfigurationLimit(gain 0.95), solve_ik(solver=daqp, damping={DAMPING:g})"
)


class Stepping(Adapter):
    """Loop that such a library leaves to its user."""

    _tolerance: float
    _no_step: type[Exception]  # what the library raises where the program has no solution

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        self._place(start)
        self._aim_at_pose(target)
        return self._descend()

    def solve_position(self, point: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        self._place(start)
        self._aim_at_point(point)
        return self._descend()

    def _descend(self) -> np.ndarray | None:
        for _ in range(MAX_STEPS):
            if self._error() <= self._tolerance:
                return self._configuration()
            try:
                self._step()
            except self._no_step:
                return None
        return None

    def _place(self, q: np.ndarray) -> None:
        raise NotImplementedError

    def _aim_at_pose(self, target: np.ndarray) -> None:
        raise NotImplementedError

    def _aim_at_point(self, point: np.ndarray) -> None:
        raise NotImplementedError

    def _error(self) -> float:
        """Larger of the errors of position (m) and rotation (rad), if both are required."""
        raise NotImplementedError

    def _step(self) -> None:
        raise NotImplementedError

    def _configuration(self) -> np.ndarray:
        raise NotImplementedError


class Placo(Stepping):
    name = "placo"
    distribution = "placo"
    settings = f"KinematicsSolver with joint limits, soft frame or position task, {MAX_STEPS} steps"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import placo

        self._robot = placo.RobotWrapper(str(chain.urdf), placo.Flags.ignore_collisions)
        self._tolerance, self._no_step = tolerance, RuntimeError
        self._q = np.array(self._robot.state.q)  # a pose of the base, then the joints

        def solver() -> Any:
            made = placo.KinematicsSolver(self._robot)
            made.mask_fbase(True)
            made.enable_joint_limits(True)
            return made

        self._for_poses, self._for_points = solver(), solver()
        self._frame = self._for_poses.add_frame_task(chain.tip, np.eye(4))
        self._frame.configure("pose", "soft", 1.0, 1.0)
        self._point = self._for_points.add_position_task(chain.tip, np.zeros(3))
        self._point.configure("position", "soft", 1.0)

    def _place(self, q: np.ndarray) -> None:
        self._q[7:] = q
        self._robot.state.q = self._q
        self._robot.update_kinematics()

    def _aim_at_pose(self, target: np.ndarray) -> None:
        self._frame.T_world_frame = target
        self._solver, self._tasks = self._for_poses, (self._frame.position(), self._frame.orientation())

    def _aim_at_point(self, point: np.ndarray) -> None:
        self._point.target_world = point
        self._solver, self._tasks = self._for_points, (self._point,)

    def _error(self) -> float:
        for task in self._tasks:
            task.update()  # otherwise the error is that before the last step
        return max(task.error_norm() for task in self._tasks)

    def _step(self) -> None:
        self._solver.solve(True)
        self._robot.update_kinematics()

    def _configuration(self) -> np.ndarray:
        state = self._robot.state  # outlives the view of its joints
        return state.q[7:].copy()


class FrameTasks(Stepping):
    """Base of mink and pink."""

    _library: Any
    _state: Any
    _limits: list[Any]

    def _place(self, q: np.ndarray) -> None:
        self._state.update(q)

    def _error(self) -> float:
        error = self._task.compute_error(self._state)
        rotation = np.linalg.norm(error[3:]) if self._task is self._pose else 0.0
        return max(np.linalg.norm(error[:3]), rotation)

    def _step(self) -> None:
        velocity = self._library.solve_ik(
            self._state, [self._task], 1.0, solver="daqp", damping=DAMPING, limits=self._limits
        )
        self._state.integrate_inplace(velocity, 1.0)

    def _configuration(self) -> np.ndarray:
        return self._state.q.copy()


class Mink(FrameTasks):
    name = "mink"
    distribution = "mink"
    settings = f"{QUADRATIC_PROGRAM}, {MAX_STEPS} steps"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import mink
        import mujoco

        model = mujoco.MjModel.from_xml_string(for_mujoco(chain.urdf))
        self._library, self._state = mink, mink.Configuration(model)
        self._limits = [mink.ConfigurationLimit(model, gain=0.95)]
        self._pose = mink.FrameTask(chain.tip, "body", position_cost=1.0, orientation_cost=1.0, lm_damping=LM_DAMPING)
        self._point = mink.FrameTask(chain.tip, "body", position_cost=1.0, orientation_cost=0.0)
        self._tip, self._tolerance, self._no_step = chain.tip, tolerance, mink.NoSolutionFound

    def _aim_at_pose(self, target: np.ndarray) -> None:
        self._task = self._pose
        self._task.set_target(self._library.SE3.from_matrix(target))

    def _aim_at_point(self, point: np.ndarray) -> None:
        here = self._state.get_transform_frame_to_world(self._tip, "body")
        self._task = self._point
        self._task.set_target(self._library.SE3.from_rotation_and_translation(here.rotation(), point))


def for_mujoco(urdf: Path) -> str:
    """URDF text for MuJoCo, with fixed frames kept apart."""
    robot = ET.parse(urdf).getroot()
    extension = ET.SubElement(robot, "mujoco")
    ET.SubElement(extension, "compiler", fusestatic="false")
    return ET.tostring(robot, encoding="unicode")


class Pink(FrameTasks):
    name = "pink"
    distribution = "pin-pink"
    settings = f"{QUADRATIC_PROGRAM}, {MAX_STEPS} steps"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import pink
        import pinocchio as pin

        self._library, self._se3 = pink, pin.SE3
        self._state = pink.Configuration(chain.model, chain.model.createData(), pin.neutral(chain.model))
        self._limits = [pink.limits.ConfigurationLimit(chain.model, config_limit_gain=0.95)]
        self._pose = pink.tasks.FrameTask(chain.tip, position_cost=1.0, orientation_cost=1.0, lm_damping=LM_DAMPING)
        self._point = pink.tasks.FrameTask(chain.tip, position_cost=1.0, orientation_cost=0.0)
        self._tip, self._tolerance, self._no_step = chain.tip, tolerance, pink.exceptions.NoSolutionFound

    def _aim_at_pose(self, target: np.ndarray) -> None:
        self._task = self._pose
        self._task.set_target(self._se3(target))

    def _aim_at_point(self, point: np.ndarray) -> None:
        here = self._state.get_transform_frame_to_world(self._tip)
        self._task = self._point
        self._task.set_target(self._se3(here.rotation, point))
