"""Inverse kinematics and then a planned motion in every tick, as users combine two libraries; and servo-py."""

# Methods are described in mover.py.
# ruff: noqa: D101, D102, D107

from __future__ import annotations

import numpy as np

from .adapter import Adapter
from .chain import Chain
from .mover import Mover, Setting
from .restarting import RoboticsToolbox
from .stepping import Placo

IK_TOLERANCE = 1e-6  # m and rad


class ThenRuckig(Mover):
    """Solver and Ruckig: in each tick, joint angles of the target, solved from the last ones, and a motion to them."""

    distribution = "ruckig"
    library: type[Adapter]

    def __init__(self, chain: Chain, setting: Setting) -> None:
        import ruckig

        self._ik = self.library(chain, IK_TOLERANCE)
        self._ruckig = ruckig
        self._setting, self._dof = setting, chain.dof
        self._planner = ruckig.Ruckig(chain.dof, setting.dt)

    def begin(self, q: np.ndarray) -> None:
        self._planner.reset()
        asked = self._ruckig.InputParameter(self._dof)
        asked.current_position = q.tolist()
        asked.max_velocity = [self._setting.velocity] * self._dof
        asked.max_acceleration = [self._setting.acceleration] * self._dof
        if self._setting.jerk is not None:
            asked.max_jerk = [self._setting.jerk] * self._dof
        self._asked, self._planned, self._goal = asked, self._ruckig.OutputParameter(self._dof), q

    def step(self, target: np.ndarray) -> np.ndarray:
        goal = self._ik.solve_pose(target, self._goal)
        if goal is not None:  # otherwise it moves on to the last one
            self._goal = goal
        self._asked.target_position = self._goal
        self._planner.update(self._asked, self._planned)
        self._planned.pass_to_input(self._asked)
        return np.array(self._planned.new_position)


class ToolboxThenRuckig(ThenRuckig):
    name = "roboticstoolbox, ruckig"
    settings = (
        f"{RoboticsToolbox.settings}, tolerance {IK_TOLERANCE:g}, from the answer before; Ruckig.update, defaults"
    )
    library = RoboticsToolbox


class PlacoThenRuckig(ThenRuckig):
    name = "placo, ruckig"
    settings = f"{Placo.settings}, tolerance {IK_TOLERANCE:g}, from the answer before; Ruckig.update, defaults"
    library = Placo


class ServoPy(Mover):
    name = "servo-py"
    distribution = "servo-py"
    settings = (
        "PoseCommand, the reference as the measured state, max_linear_speed=max_angular_speed=10, "
        "position_gain=orientation_gain=8, with a jerk limit 5 (they settle soonest) and RuckigSmoothing"
    )

    def __init__(self, chain: Chain, setting: Setting) -> None:
        import servo_py

        self._servo_py, self._setting, self._dof = servo_py, setting, chain.dof
        self._model = servo_py.load_urdf(
            chain.urdf, base=chain.base, tip=chain.tip, acceleration_limits=[setting.acceleration] * chain.dof
        )
        self._limits = servo_py.JointLimits(
            chain.lower,
            chain.upper,
            np.full(chain.dof, setting.velocity),
            np.full(chain.dof, setting.acceleration),
            margin=0.0,
        )
        gain = 8.0 if setting.jerk is None else 5.0
        self._config = servo_py.ServoConfig(
            position_gain=gain, orientation_gain=gain, max_linear_speed=10.0, max_angular_speed=10.0
        )

    def begin(self, q: np.ndarray) -> None:
        library, jerk = self._servo_py, self._setting.jerk
        smoothing = None if jerk is None else library.RuckigSmoothing(jerk)
        self._servo = library.Servo(self._model, self._config, self._limits, motion_generator=smoothing)
        self._q, self._qd, self._now = q, np.zeros(self._dof), 0

    def step(self, target: np.ndarray) -> np.ndarray:
        library, now = self._servo_py, self._now
        state, command = library.JointState(self._q, self._qd, now), library.PoseCommand(target, now)
        answer = self._servo.step(state, command, dt=self._setting.dt, now_ns=now)
        if answer.reference is not None:  # otherwise it rejects this state or target, and stands still
            self._q, self._qd = answer.reference.q, answer.reference.dq
        self._now += round(self._setting.dt * 1e9)
        return self._q
