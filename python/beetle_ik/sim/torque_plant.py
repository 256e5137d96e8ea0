"""An arm in MuJoCo with the masses of its robot, whose motors take torques."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element, SubElement, tostring

import numpy as np

from .._core import InvalidInputError, Plan, Robot, Trajectory
from ..calls.arguments import require, require_one_tip
from ..calls.text import exact
from .chain import joints_of, mujoco_library

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .._core import Inertia

    Array = NDArray[np.float64]

_LEAST_MASS = 1e-9  # kg, kg m^2: MuJoCo moves no body without mass, and no point mass
_SAME = 1e-6  # difference between the simulated arm and the robot: of mass matrices, relative; of tips (m)
_SAMPLES = 3  # configurations at which they are compared


@dataclass(frozen=True)
class Followed:
    """Motion of an arm that was to follow another one.

    Attributes:
        t: times (k,) (s).
        q: joint positions (k, n) (rad, m).
        reference: joint positions of the motion (k, n) (rad, m).
        torques: torques of the motors (k, n) (N m, N), which act from each time to the next.
        error: distances of the tip from that of the motion (k,) (m).
    """

    t: Array
    q: Array
    reference: Array
    torques: Array
    error: Array


class TorquePlant:
    """An arm in MuJoCo with masses, payloads, friction, rotors and gravity of a robot, whose motors take torques.

    Torques beyond `Robot.torque_limit` are cut off. Nothing collides.

    Args:
        robot: the arm as it is, which may carry a payload that a controller does not know. It has dynamics and one tip.
        timestep: time for which torques stay the same (s).

    Raises:
        BeetleIkError: MuJoCo is not installed.
        InvalidInputError: a robot without dynamics, with several tips or with mimic joints; a number out of range.
    """

    def __init__(self, robot: Robot, *, timestep: float = 1e-3) -> None:
        """Starts at rest at q = 0, or at the limits nearest to it."""
        if not (np.isfinite(timestep) and timestep > 0.0):
            raise InvalidInputError(f"timestep must be positive and finite, got {timestep}")
        require_one_tip("TorquePlant", robot)
        zero = np.zeros(robot.dof)
        robot.torques(zero)  # names what is missing
        self._mujoco = mujoco_library()
        self.robot = robot
        self.timestep = float(timestep)
        self._model = self._mujoco.MjModel.from_xml_string(_description(robot, timestep))
        self._data = self._mujoco.MjData(self._model)
        self._add_friction_and_rotors()
        self.reset(robot.clip(zero))

    def reset(self, q: ArrayLike) -> None:
        """Places the arm at rest at `q` (n,)."""
        self._mujoco.mj_resetData(self._model, self._data)
        self._data.qpos[:] = self._row("q", q)
        self._mujoco.mj_forward(self._model, self._data)

    def step(self, torques: ArrayLike) -> None:
        """Applies the torques (n,) (N m, N) for one time step, as far as the limits of the motors allow."""
        limit = self.robot.torque_limit
        self._data.qfrc_applied[:] = np.clip(self._row("torques", torques), -limit, limit)
        self._mujoco.mj_step(self._model, self._data)

    @property
    def q(self) -> Array:
        """Joint positions (n,) (rad, m)."""
        return np.array(self._data.qpos)

    @property
    def qd(self) -> Array:
        """Joint velocities (n,) (rad/s, m/s)."""
        return np.array(self._data.qvel)

    @property
    def time(self) -> float:
        """Simulated time (s) since the last reset."""
        return float(self._data.time)

    def follow(
        self, motion: Plan | Trajectory, *, model: Robot | None = None, bandwidth: float = 20.0, hold: float = 0.0
    ) -> Followed:
        """Follows a motion from rest at its start, by computed torques with feedback.

        The torques are those of the motion by `model`, plus its mass matrix times w^2 e + 2 w de/dt, where e is the
        reference less q and w the bandwidth. Where the model is right, the feedback has next to nothing to do.

        Args:
            motion: a plan, or a trajectory of all joints.
            model: the robot as the controller knows it; None: as it is.
            bandwidth: w (rad/s); 0: the torques of the motion alone.
            hold: time for which the arm is held at the end (s).

        Returns:
            What the arm did, step by step.

        Raises:
            InvalidInputError: a motion of other joints, a number out of range, a model without dynamics.
        """
        require("motion", motion, Plan, Trajectory)
        known = self.robot if model is None else model
        for name, value in (("bandwidth", bandwidth), ("hold", hold)):
            if not (np.isfinite(value) and value >= 0.0):
                raise InvalidInputError(f"{name} must be zero or more and finite, got {value}")
        trajectory = motion.trajectory if isinstance(motion, Plan) else motion
        for what, dof in (("motion", len(trajectory.joint_names)), ("model", known.dof)):
            if dof != self.robot.dof:
                raise InvalidInputError(f"{what} has {dof} joints, and robot '{self.robot.name}' has {self.robot.dof}")
        steps = int(np.ceil((trajectory.duration + hold) / self.timestep))
        t: Array = self.timestep * np.arange(steps + 1, dtype=np.float64)
        reference, rate, change = trajectory.at(np.minimum(t, trajectory.duration))
        rate[t > trajectory.duration] = change[t > trajectory.duration] = 0.0
        self.reset(reference[0])
        q, torques = np.empty_like(reference), np.empty_like(reference)
        for i in range(len(t)):
            q[i] = self.q
            correction = bandwidth**2 * (reference[i] - q[i]) + 2.0 * bandwidth * (rate[i] - self.qd)
            self.step(known.torques(reference[i], rate[i], change[i] + correction))
            torques[i] = self._data.qfrc_applied
        places, wanted = (self.robot.fk(row)[:, :3, 3] for row in (q, reference))
        return Followed(t, q, reference, torques, np.sqrt(np.sum((places - wanted) ** 2, axis=1)))

    def _row(self, what: str, values: ArrayLike) -> Array:
        row = np.asarray(values, dtype=float)
        if row.shape != (self.robot.dof,):
            raise InvalidInputError(f"{what} of the plant: expected shape ({self.robot.dof},), got {row.shape}")
        if not np.isfinite(row).all():
            raise InvalidInputError(f"{what} of the plant must be finite, got {row.tolist()}")
        return row

    def _add_friction_and_rotors(self) -> None:
        """Gives the joints the friction and the rotors of the robot.

        What MuJoCo has without them differs from the robot in the diagonal of the mass matrix alone, which checks all
        masses.
        """
        n, robot = self.robot.dof, self.robot
        rotors = np.zeros(n)
        for i, q in enumerate(robot.random_configurations(_SAMPLES, seed=1)):
            self.reset(q)
            simulated, own = np.zeros((n, n)), robot.mass_matrix(q)
            self._mujoco.mj_fullM(self._model, self._data, simulated)
            if i == 0:
                rotors = np.maximum(np.diag(own - simulated), 0.0)
            off = np.abs(own - simulated - np.diag(rotors)).max() / np.abs(own).max()
            away = np.linalg.norm(self._data.site_xpos[0] - robot.fk(q)[:3, 3])
            if off > _SAME or away > _SAME:
                raise InvalidInputError(f"robot '{robot.name}' has mimic joints, which cannot be simulated")
        # Friction is what changes its sign with the velocity.
        places, speeds = np.zeros((n, n)), np.eye(n)
        slow, fast = (
            0.5 * np.diag(robot.torques(places, v * speeds) - robot.torques(places, -v * speeds)) for v in (1.0, 2.0)
        )
        damping = fast - slow
        dry = slow - damping
        self._model.dof_armature[:] = np.where(rotors > _SAME * rotors.max(initial=0.0), rotors, 0.0)
        self._model.dof_damping[:] = np.maximum(damping, 0.0)
        self._model.dof_frictionloss[:] = np.where(dry > 1e-12, dry, 0.0)


def _description(robot: Robot, timestep: float) -> str:
    """Writes the robot as MJCF: a body for each joint, in which the links that it moves are fixed."""
    kinds, axes, anchors, tip = joints_of(robot)
    root = Element("mujoco", model=robot.name)
    SubElement(root, "compiler", angle="radian", boundmass=str(_LEAST_MASS), boundinertia=str(_LEAST_MASS))
    gravity = exact(robot.gravity)
    SubElement(root, "option", timestep=repr(float(timestep)), gravity=gravity, integrator="RK4")
    body = SubElement(root, "worldbody")
    bodies, origin = [], np.zeros(3)
    for i, (kind, axis, anchor) in enumerate(zip(kinds, axes, anchors, strict=True)):
        body = SubElement(body, "body", pos=exact(anchor - origin))
        origin = anchor
        SubElement(body, "joint", name=f"joint_{i}", type="slide" if kind == "prismatic" else "hinge", axis=exact(axis))
        bodies.append(body)
    SubElement(body, "site", name="tip", pos=exact(tip - origin), size="0.01")
    zero = np.zeros(robot.dof)
    for inertia in (*robot.inertias, *robot.payloads):
        moving = np.flatnonzero(np.abs(robot.jacobian(zero, link=inertia.link)).max(axis=0) > 0.0)
        if len(moving) and (inertia.mass > 0.0 or np.any(inertia.matrix)):
            carrier = int(moving[-1])
            _add_body(bodies[carrier], anchors[carrier], robot.fk(zero, link=inertia.link), inertia)
    return tostring(root, encoding="unicode")


def _add_body(parent: Element, anchor: Array, frame: Array, inertia: Inertia) -> None:
    turn = frame[:3, :3]
    center, matrix = turn @ inertia.center + frame[:3, 3], turn @ inertia.matrix @ turn.T
    matrix = matrix + _LEAST_MASS * np.eye(3)
    fixed = SubElement(parent, "body", pos=exact(center - anchor))
    entries = [matrix[0, 0], matrix[1, 1], matrix[2, 2], matrix[0, 1], matrix[0, 2], matrix[1, 2]]
    SubElement(
        fixed, "inertial", pos="0 0 0", mass=repr(max(float(inertia.mass), _LEAST_MASS)),
        fullinertia=exact(np.array(entries)),
    )  # fmt: skip
