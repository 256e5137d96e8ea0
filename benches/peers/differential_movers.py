"""Differential inverse kinematics, one quadratic program a tick: velocity limits, and none on acceleration or jerk."""

# Methods are described in mover.py.
# ruff: noqa: D101, D102, D107

from __future__ import annotations

from typing import Any

import numpy as np

from .chain import Chain
from .mover import Mover, Setting
from .stepping import DAMPING, LM_DAMPING, for_mujoco


class FrameTasks(Mover):
    """Base of mink and pink."""

    gain = 1.0
    _library: Any
    _state: Any
    _limits: list[Any]
    _task: Any
    _no_step: type[Exception]  # what the library raises where the program has no solution
    _dt: float

    def begin(self, q: np.ndarray) -> None:
        self._state.update(q)

    def step(self, target: np.ndarray) -> np.ndarray:
        self._aim(target)
        try:
            velocity = self._library.solve_ik(
                self._state, [self._task], self._dt, solver="daqp", damping=DAMPING, limits=self._limits
            )
        except self._no_step:
            return self._state.q.copy()  # stands still
        self._state.integrate_inplace(velocity, self._dt)
        return self._state.q.copy()

    def _aim(self, target: np.ndarray) -> None:
        raise NotImplementedError


class Mink(FrameTasks):
    name = "mink"
    distribution = "mink"
    settings = "FrameTask(gain=1), ConfigurationLimit, VelocityLimit, one solve_ik(solver=daqp) a tick"

    def __init__(self, chain: Chain, setting: Setting) -> None:
        import mink
        import mujoco

        model = mujoco.MjModel.from_xml_string(for_mujoco(chain.urdf))
        joints = [model.joint(i).name for i in range(model.njnt)]
        self._library, self._state, self._dt = mink, mink.Configuration(model), setting.dt
        self._no_step = mink.NoSolutionFound
        self._limits = [
            mink.ConfigurationLimit(model),
            mink.VelocityLimit(model, dict.fromkeys(joints, setting.velocity)),
        ]
        self._task = mink.FrameTask(
            chain.tip, "body", position_cost=1.0, orientation_cost=1.0, gain=self.gain, lm_damping=LM_DAMPING
        )

    def _aim(self, target: np.ndarray) -> None:
        self._task.set_target(self._library.SE3.from_matrix(target))


class SlowMink(Mink):
    name = "mink, gain 0.1"
    settings = "as mink, FrameTask(gain=0.1)"
    gain = 0.1


class Pink(FrameTasks):
    name = "pink"
    distribution = "pin-pink"
    settings = "FrameTask(gain=1), ConfigurationLimit, VelocityLimit, one solve_ik(solver=daqp) a tick"

    def __init__(self, chain: Chain, setting: Setting) -> None:
        import pink
        import pinocchio as pin

        model = pin.buildModelFromUrdf(str(chain.urdf))
        model.velocityLimit = np.full(model.nv, setting.velocity)
        self._library, self._se3, self._dt = pink, pin.SE3, setting.dt
        self._state = pink.Configuration(model, model.createData(), pin.neutral(model))
        self._no_step = pink.exceptions.NoSolutionFound
        self._limits = [pink.limits.ConfigurationLimit(model), pink.limits.VelocityLimit(model)]
        self._task = pink.tasks.FrameTask(
            chain.tip, position_cost=1.0, orientation_cost=1.0, gain=self.gain, lm_damping=LM_DAMPING
        )

    def _aim(self, target: np.ndarray) -> None:
        self._task.set_target(self._se3(target))


class Placo(Mover):
    name = "placo"
    distribution = "placo"
    settings = "KinematicsSolver with joint and velocity limits, soft frame task, one solve a tick"

    def __init__(self, chain: Chain, setting: Setting) -> None:
        import placo

        self._robot = placo.RobotWrapper(str(chain.urdf), placo.Flags.ignore_collisions)
        self._robot.set_velocity_limits(setting.velocity)
        self._solver = placo.KinematicsSolver(self._robot)
        self._solver.mask_fbase(True)
        self._solver.enable_joint_limits(True)
        self._solver.enable_velocity_limits(True)
        self._solver.dt = setting.dt
        self._task = self._solver.add_frame_task(chain.tip, np.eye(4))
        self._task.configure("pose", "soft", 1.0, 1.0)
        self._q = np.array(self._robot.state.q)  # a pose of the base, then the joints

    def begin(self, q: np.ndarray) -> None:
        self._q[7:] = q
        self._robot.state.q = self._q
        self._robot.update_kinematics()

    def step(self, target: np.ndarray) -> np.ndarray:
        self._task.T_world_frame = target
        self._solver.solve(True)
        self._robot.update_kinematics()
        state = self._robot.state  # outlives the view of its joints
        return state.q[7:].copy()
