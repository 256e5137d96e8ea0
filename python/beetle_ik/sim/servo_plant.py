"""An arm in MuJoCo with position servos, gravity and a sensor at the tip.

Every link is simulated as a rod, so that a description needs no masses or meshes.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import Element, SubElement, tostring

import numpy as np

from .._core import InvalidInputError, Robot, pose
from ..calls.arguments import require_one_tip
from ..calls.text import exact
from .chain import joints_of, mujoco_library

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_TIMESTEP = 1e-3  # s, of the simulation
_RADIUS = 0.035  # m, of the rods
_SHORTEST = 1e-3  # m, least length of a rod
_SAME = 1e-9  # m, tolerance between the tips of the simulated arm and of the robot
_COLOURS = ("0.90 0.62 0.00 1", "0.75 0.75 0.78 1")


class MujocoPlant:
    """An arm in MuJoCo with position servos and a sensor that measures its tip.

    The servos yield under gravity, so the arm settles beside the commanded configuration. A model-free controller must
    compensate for this deflection, as for errors of the model.

    Args:
        robot: the arm as built, which may differ from the model that a controller uses.
        dt: time from a command to its measurement (s).
        stiffness: stiffness of the servos (N m/rad, N/m).
        mass: mass of the arm (kg), distributed over the links by length.
        gravity: gravity, downwards (m/s^2).
        noise: standard deviation of the measured position on each axis (m).
        rotation_noise: standard deviation of the measured orientation about each axis (rad); 0 measures it exactly.
            None: the sensor measures positions only.
        seed: seed of the noise.

    Raises:
        BeetleIkError: MuJoCo is not installed.
        InvalidInputError: a number out of range, or a robot with mimic joints.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        dt: float = 0.2,
        stiffness: float = 2e4,
        mass: float = 20.0,
        gravity: float = 9.81,
        noise: float = 0.0,
        rotation_noise: float | None = None,
        seed: int = 0,
    ) -> None:
        """Starts at rest at q = 0, or at the limits nearest to it."""
        for name, value in (("dt", dt), ("stiffness", stiffness), ("mass", mass)):
            if not (np.isfinite(value) and value > 0.0):
                raise InvalidInputError(f"{name} must be positive and finite, got {value}")
        for name, value in (("noise", noise), ("rotation_noise", rotation_noise or 0.0)):
            if not (np.isfinite(value) and value >= 0.0):
                raise InvalidInputError(f"{name} must be zero or more and finite, got {value}")
        require_one_tip("MujocoPlant", robot)
        self._mujoco = mujoco_library()
        self.robot = robot
        self.dt = dt
        self.noise = noise
        self.rotation_noise = rotation_noise
        self._random = np.random.default_rng(seed)
        self._model = self._mujoco.MjModel.from_xml_string(_description(robot, stiffness, mass, gravity))
        self._data = self._mujoco.MjData(self._model)
        self._tool = robot.fk(np.zeros(robot.dof))[:3, :3]  # simulated frames are parallel to the base at zero
        self._check()

    @classmethod
    def from_urdf(
        cls,
        path_or_xml: str | os.PathLike[str],
        *,
        base: str | None = None,
        tip: str | None = None,
        trusted: bool = False,
        **options: Any,
    ) -> MujocoPlant:
        """Makes a plant from a URDF; meshes are ignored.

        Args:
            path_or_xml: file, or text that contains "<".
            base: link whose frame is the reference frame; None: the root.
            tip: link at the end of the chain; None: the only leaf.
            trusted: whether a xacro file may execute code and read any file.
            **options: the options of the class.
        """
        return cls(Robot.from_urdf(path_or_xml, base=base, tip=tip, trusted=trusted), **options)

    def reset(self, q: ArrayLike) -> None:
        """Places the arm at rest at `q` (n,) and lets it settle under gravity."""
        command = self._command(q)
        self._mujoco.mj_resetData(self._model, self._data)
        self._data.qpos[:] = command
        self._data.ctrl[:] = command
        self._run(2.0)

    def move(self, q: ArrayLike) -> NDArray[np.float64]:
        """Commands the servos to `q` (n,), waits for `dt`, and measures the tip: position (3,) (m) or pose (4, 4)."""
        self._data.ctrl[:] = self._command(q)
        self._run(self.dt)
        position = self.tip + self.noise * self._random.standard_normal(3)
        if self.rotation_noise is None:
            return position
        turn = pose((0.0, 0.0, 0.0), rotvec=self.rotation_noise * self._random.standard_normal(3))[:3, :3]
        return pose(position, matrix=turn @ self.orientation)

    @property
    def tip(self) -> NDArray[np.float64]:
        """Position of the tip (3,) (m), without noise."""
        return np.array(self._data.site_xpos[0])

    @property
    def orientation(self) -> NDArray[np.float64]:
        """Rotation matrix of the tip (3, 3), without noise."""
        return np.array(self._data.site_xmat[0]).reshape(3, 3) @ self._tool

    @property
    def q(self) -> NDArray[np.float64]:
        """Actual joint positions (n,) (rad, m), which differ from the command by the deflection of the servos."""
        return np.array(self._data.qpos)

    @property
    def time(self) -> float:
        """Simulated time (s) since the last reset."""
        return float(self._data.time)

    def picture(
        self,
        *,
        width: int = 640,
        height: int = 480,
        azimuth: float = -40.0,
        elevation: float = -35.0,
        distance: float | None = None,
        look_at: ArrayLike | None = None,
        trail: ArrayLike = (),
        target: ArrayLike = (),
    ) -> NDArray[np.uint8]:
        """Renders the arm off screen as an image (height, width, 3).

        Args:
            width: width in pixels.
            height: height in pixels.
            azimuth: viewing direction about the vertical (degrees).
            elevation: viewing direction above the horizontal (degrees); negative looks down.
            distance: distance of the camera (m); None: far enough to see the whole arm.
            look_at: the point in the centre of the image (3,) (m); None: the centre of the arm.
            trail: past tip positions (k, 3), drawn in blue.
            target: points (k, 3) of the reference path, drawn in red.
        """
        mujoco = self._mujoco
        camera = mujoco.MjvCamera()
        camera.azimuth, camera.elevation = azimuth, elevation
        reach = np.linalg.norm(self._model.body_pos, axis=1).sum() + np.linalg.norm(self._model.site_pos[0])
        camera.distance = 1.5 * reach if distance is None else distance
        camera.lookat[:] = self._data.xpos[1:].mean(axis=0) if look_at is None else np.asarray(look_at, dtype=float)
        with mujoco.Renderer(self._model, height, width) as renderer:
            renderer.update_scene(self._data, camera)
            for points, colour in ((target, (0.84, 0.37, 0.0, 1.0)), (trail, (0.0, 0.45, 0.7, 1.0))):
                for point in np.asarray(points, dtype=float).reshape(-1, 3):
                    self._draw_point(renderer.scene, point, colour)
            pixels: NDArray[np.uint8] = renderer.render()
        return pixels

    def _draw_point(self, scene: Any, point: NDArray[np.float64], colour: tuple[float, ...]) -> None:
        if scene.ngeom >= scene.maxgeom:
            return
        sphere = self._mujoco.mjtGeom.mjGEOM_SPHERE
        size, turn = np.full(3, 0.008), np.eye(3).ravel()
        self._mujoco.mjv_initGeom(scene.geoms[scene.ngeom], sphere, size, point, turn, np.array(colour, np.float32))
        scene.ngeom += 1

    def _command(self, q: ArrayLike) -> NDArray[np.float64]:
        command = np.asarray(q, dtype=float)
        if command.shape != (self.robot.dof,):
            raise InvalidInputError(f"q of the plant: expected shape ({self.robot.dof},), got {command.shape}")
        return command

    def _run(self, seconds: float) -> None:
        self._mujoco.mj_step(self._model, self._data, max(1, round(seconds / _TIMESTEP)))
        # Updates the kinematics, which mj_step leaves one step behind the joints.
        self._mujoco.mj_kinematics(self._model, self._data)

    def _check(self) -> None:
        """Checks at two random configurations that the simulated chain has the robot's kinematics."""
        for q in self.robot.random_configurations(2, seed=1):
            self._data.qpos[:] = q
            self._mujoco.mj_kinematics(self._model, self._data)
            simulated = np.column_stack([self.orientation, self.tip])
            if not np.allclose(simulated, self.robot.fk(q)[:3], rtol=0.0, atol=_SAME):
                raise InvalidInputError(f"robot '{self.robot.name}' has mimic joints, which cannot be simulated")
        self.reset(np.clip(np.zeros(self.robot.dof), self.robot.lower, self.robot.upper))


def _description(robot: Robot, stiffness: float, mass: float, gravity: float) -> str:
    """Writes the robot as MJCF: a rod from each joint to the next, all frames parallel to the base at q = 0."""
    kinds, axes, anchors, tip = joints_of(robot)
    ends = [*anchors[1:], tip]
    lengths = [max(float(np.linalg.norm(end - start)), _SHORTEST) for start, end in zip(anchors, ends, strict=True)]
    root = Element("mujoco", model=robot.name)
    SubElement(root, "compiler", angle="radian")
    SubElement(root, "option", timestep=str(_TIMESTEP), gravity=f"0 0 {-gravity}", integrator="implicitfast")
    visual = SubElement(root, "visual")
    SubElement(visual, "global", offwidth="1920", offheight="1080")
    SubElement(visual, "map", znear="0.02", zfar="12")
    SubElement(visual, "headlight", ambient="0.45 0.45 0.45", diffuse="0.5 0.5 0.5")
    _add_scene(root)
    body = _add_world(root, anchors[0])
    actuators = SubElement(root, "actuator")
    origin = np.zeros(3)
    for i, (kind, axis, anchor, end) in enumerate(zip(kinds, axes, anchors, ends, strict=True)):
        body = SubElement(body, "body", pos=exact(anchor - origin))
        origin = anchor
        # Adds reflected inertia of the gears, and critical damping, so that the servo does not overshoot.
        inertia = 0.1
        lever = float(np.linalg.norm(tip - anchor)) + 0.1
        critical = 2.0 * np.sqrt(stiffness * (inertia + mass * lever**2 / 3.0))
        SubElement(
            body, "joint", name=f"joint_{i}", type="slide" if kind == "prismatic" else "hinge", axis=exact(axis),
            armature=str(inertia), damping=str(critical),
        )  # fmt: skip
        share = mass * lengths[i] / sum(lengths)
        _add_rod(body, end - anchor, share, _COLOURS[i % 2])
        SubElement(actuators, "position", joint=f"joint_{i}", kp=str(stiffness))
    SubElement(body, "site", name="tip", pos=exact(tip - origin), size="0.012", rgba="0.84 0.37 0 1")
    return tostring(root, encoding="unicode")


def _add_scene(root: Element) -> None:
    assets = SubElement(root, "asset")
    SubElement(assets, "texture", type="skybox", builtin="gradient", rgb1="0.95 0.97 1", rgb2="0.75 0.8 0.88",
               width="64", height="64")  # fmt: skip
    SubElement(assets, "texture", name="floor", type="2d", builtin="checker", rgb1="0.86 0.86 0.86",
               rgb2="0.78 0.78 0.78", width="128", height="128")  # fmt: skip
    SubElement(assets, "material", name="floor", texture="floor", texrepeat="8 8")


def _add_world(root: Element, first: NDArray[np.float64]) -> Element:
    world = SubElement(root, "worldbody")
    SubElement(world, "light", pos="1 1 3", dir="-0.3 -0.3 -1", directional="true", castshadow="false")
    SubElement(world, "geom", type="plane", size="2 2 0.1", material="floor", contype="0", conaffinity="0")
    if np.linalg.norm(first) > _SHORTEST:
        _add_rod(world, first, 1.0, _COLOURS[1])
    return world


def _add_rod(body: Element, end: NDArray[np.float64], mass: float, colour: str) -> None:
    reach = end if np.linalg.norm(end) >= _SHORTEST else np.array([0.0, 0.0, _SHORTEST])
    SubElement(
        body, "geom", type="capsule", size=str(_RADIUS), fromto=f"0 0 0 {exact(reach)}", mass=str(max(mass, 0.05)),
        contype="0", conaffinity="0", rgba=colour,
    )  # fmt: skip
