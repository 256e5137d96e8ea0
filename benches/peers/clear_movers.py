"""Movers among obstacles: this library's `Tracker`, and one quadratic program a tick of mink, pink and placo.

All get the same capsules, pairs of links, boxes and sphere, and the same velocity limit. None of the others takes the
velocity of an obstacle: they get the sphere where it will be at the end of the tick.
"""

# ruff: noqa: ARG002, D101, D102, D107

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, ClassVar

import coal
import numpy as np

import beetle_ik as bik

from .clear_streams import DT, MARGIN, Scene, Thing, pose_of_capsule
from .clear_urdf import urdf
from .stepping import DAMPING, LM_DAMPING

VELOCITY, ACCELERATION, JERK = 1.5, 5.0, 50.0  # rad/s, rad/s^2, rad/s^3
SEEN = 0.05  # m: farther pairs are no constraint
GAIN = 0.85  # share of the distance that a tick may use up: mink's own default


class ClearMover:
    """One library moving one arm in one scene; without obstacles if not `among`."""

    name: ClassVar[str]
    slow: ClassVar[bool] = True
    limits: ClassVar[tuple[float, ...]] = (VELOCITY,)  # of velocity, acceleration, jerk, as far as there are any
    infeasible = 0  # ticks in which the program had no solution
    held = 0  # ticks that were said to be held by an obstacle

    def __init__(self, scene: Scene, scratch: Path, *, among: bool) -> None:
        raise NotImplementedError

    def step(self, target: np.ndarray, time: float) -> np.ndarray:
        """Returns the configuration to command at the end of the tick that begins at `time` (s)."""
        raise NotImplementedError


class Ours(ClearMover):
    name = "beetle-ik, velocity limits"
    slow = False

    def __init__(self, scene: Scene, scratch: Path, *, among: bool) -> None:
        fields = dict(zip(("velocity", "acceleration", "jerk"), self.limits, strict=False))
        obstacles = {"obstacles": [], "margin": MARGIN} if among else {}
        self._tracker = bik.Tracker(scene.robot, scene.start, dt=DT, limits=bik.Limits(**fields), **obstacles)
        self._still = [thing.obstacle(0.0) for thing in scene.things if not thing.moves]
        self._moving = [thing for thing in scene.things if thing.moves]
        self._among = among
        if among:
            self._tracker.obstacles = self._still

    def step(self, target: np.ndarray, time: float) -> np.ndarray:
        if self._among and self._moving:
            moving = [bik.obstacles.Moving(thing.obstacle(time), thing.velocity) for thing in self._moving]
            self._tracker.obstacles = [*self._still, *moving]
        step = self._tracker.step(target)
        self.held += step.status == bik.Status.HELD_BY_OBSTACLE
        return step.q


class OursSmooth(Ours):
    name = "beetle-ik, acceleration limits"
    limits = (VELOCITY, ACCELERATION)


class OursSmoother(Ours):
    name = "beetle-ik, jerk limits"
    limits = (VELOCITY, ACCELERATION, JERK)


class Mink(ClearMover):
    """Limit `CollisionAvoidanceLimit`. Its displacement bound is divided by dt: the default gain acts at the margin."""

    name = "mink, default gain"
    gain = GAIN

    def __init__(self, scene: Scene, scratch: Path, *, among: bool) -> None:
        import mink
        import mujoco

        specification, kinds = mujoco.MjSpec.from_string(urdf(scene.robot, VELOCITY, for_mujoco=True)), mujoco.mjtGeom
        of_links: dict[str, list[str]] = {}
        for number, (link, a, b, radius) in enumerate(scene.robot.capsules):
            name = f"capsule{number}"
            of_links.setdefault(link, []).append(name)
            ends = np.concatenate([a, b])
            specification.body(link).add_geom(
                name=name, type=kinds.mjGEOM_CAPSULE, fromto=ends, size=[radius, 0.0, 0.0]
            )
        things = []
        for number, thing in enumerate(scene.things):
            body = specification.worldbody.add_body(name=f"thing{number}", mocap=True, **place_for_mujoco(thing))
            if thing.moves:
                size, kind = [thing.shape.radius, 0.0, 0.0], kinds.mjGEOM_SPHERE
            else:
                size, kind = thing.shape.halfSide, kinds.mjGEOM_BOX
            things.append(f"geom{number}")
            body.add_geom(name=things[-1], type=kind, size=size)
        model = specification.compile()
        model.geom_contype[:], model.geom_conaffinity[:] = 1, 1
        self._moving = [(k, thing) for k, thing in enumerate(scene.things) if thing.moves]
        self._library, self._state, self._no_step = mink, mink.Configuration(model), mink.NoSolutionFound
        self._state.update(scene.start)
        pairs = [(of_links[a], of_links[b]) for a, b in scene.robot.collision_pairs]
        pairs.append(([name for names in of_links.values() for name in names], things))
        self._limits = [
            mink.ConfigurationLimit(model),
            mink.VelocityLimit(model, dict.fromkeys(scene.robot.joint_names, VELOCITY)),
        ]
        if among:
            self._limits.append(mink.CollisionAvoidanceLimit(model, pairs, self.gain, MARGIN, SEEN))
        self._task = mink.FrameTask("tip", "body", position_cost=1.0, orientation_cost=1.0, lm_damping=LM_DAMPING)

    def step(self, target: np.ndarray, time: float) -> np.ndarray:
        for number, thing in self._moving:
            self._state.data.mocap_pos[number] = thing.center(time + DT)
        self._state.update(self._state.q)
        self._task.set_target(self._library.SE3.from_matrix(target))
        try:
            velocity = self._solve()
        except self._no_step:
            self.infeasible += 1
        else:
            self._state.integrate_inplace(velocity, DT)
        return self._state.q.copy()

    def _solve(self) -> np.ndarray:
        return self._library.solve_ik(
            self._state, [self._task], DT, solver="daqp", damping=DAMPING, limits=self._limits
        )


class SlowingMink(Mink):
    name = "mink, gain 0.85 dt"
    gain = GAIN * DT


class Pink(Mink):
    """Barrier `SelfCollisionBarrier`; its gain is per second."""

    name = "pink, gain 0.85 / dt"

    def __init__(self, scene: Scene, scratch: Path, *, among: bool) -> None:
        import pink
        import pinocchio as pin

        model = pin.buildModelFromXML(urdf(scene.robot, VELOCITY))
        model.velocityLimit = np.full(model.nv, VELOCITY)
        geometry, of_links = pin.GeometryModel(), {}
        for number, (link, a, b, radius) in enumerate(scene.robot.capsules):
            frame = model.frames[model.getFrameId(link)]
            at = frame.placement * pin.SE3(pose_of_capsule(a, b))
            body = pin.GeometryObject(
                f"capsule{number}", frame.parentJoint, at, coal.Capsule(radius, float(np.linalg.norm(b - a)))
            )
            of_links.setdefault(link, []).append(geometry.addGeometryObject(body))
        things = [
            geometry.addGeometryObject(pin.GeometryObject(f"thing{number}", 0, pin.SE3(thing.at), thing.shape))
            for number, thing in enumerate(scene.things)
        ]
        bodies = [i for group in of_links.values() for i in group]
        pairs = [(i, j) for a, b in scene.robot.collision_pairs for i in of_links[a] for j in of_links[b]]
        for i, j in [*pairs, *((i, j) for i in bodies for j in things)]:
            geometry.addCollisionPair(pin.CollisionPair(i, j))
        self._geometry = geometry
        self._moving = [(k, thing) for k, thing in zip(things, scene.things, strict=True) if thing.moves]
        self._library, self._no_step = pink, (pink.exceptions.NoSolutionFound, pink.exceptions.PinkError)
        self._limits = [pink.limits.ConfigurationLimit(model), pink.limits.VelocityLimit(model)]
        count = min(30, len(geometry.collisionPairs))
        barrier = pink.barriers.SelfCollisionBarrier(count, gain=GAIN / DT, safe_displacement_gain=0.0, d_min=MARGIN)
        self._barriers = [barrier] if among else []
        self._task = pink.tasks.FrameTask("tip", position_cost=1.0, orientation_cost=1.0, lm_damping=LM_DAMPING)
        known = {"collision_model": geometry, "collision_data": pin.GeometryData(geometry)} if among else {}
        self._state = pink.Configuration(model, model.createData(), scene.start, **known)
        self._se3 = pin.SE3

    def step(self, target: np.ndarray, time: float) -> np.ndarray:
        for number, thing in self._moving:
            self._geometry.geometryObjects[number].placement.translation = thing.center(time + DT)
        self._state.update(self._state.q)
        self._task.set_target(self._se3(target))
        try:
            velocity = self._solve()
        except self._no_step:
            self.infeasible += 1
        else:
            self._state.integrate_inplace(velocity, DT)
        return self._state.q.copy()

    def _solve(self) -> np.ndarray:
        return self._library.solve_ik(
            self._state,
            [self._task],
            DT,
            solver="daqp",
            damping=DAMPING,
            limits=self._limits,
            barriers=self._barriers,
            safety_break=False,
        )


class Placo(ClearMover):
    """`AvoidSelfCollisionsKinematicsConstraint`: the obstacles are links, the sphere has three sliding joints."""

    name = "placo"

    def __init__(self, scene: Scene, scratch: Path, *, among: bool) -> None:
        import placo

        file, list_of_pairs = scratch / "placo.urdf", scratch / "pairs.json"
        file.write_text(urdf(scene.robot, VELOCITY, scene.things), encoding="utf-8")
        bodies = dict.fromkeys(link for link, *_ in scene.robot.capsules)
        things = [f"thing{number}" for number in range(len(scene.things))]
        pairs = [*scene.robot.collision_pairs, *((a, b) for a in bodies for b in things)]
        list_of_pairs.write_text(json.dumps(pairs), encoding="utf-8")
        self._robot = placo.RobotWrapper(str(file))
        self._robot.load_collision_pairs(str(list_of_pairs))
        self._robot.set_velocity_limits(VELOCITY)
        self._solver = placo.KinematicsSolver(self._robot)
        self._solver.mask_fbase(True)
        self._solver.enable_joint_limits(True)
        self._solver.enable_velocity_limits(True)
        self._solver.dt = DT
        if among:
            apart = self._solver.add_avoid_self_collisions_constraint()
            apart.configure("apart", "hard")
            apart.self_collisions_margin, apart.self_collisions_trigger = MARGIN, SEEN
        self._task = self._solver.add_frame_task("tip", np.eye(4))
        self._task.configure("pose", "soft", 1.0, 1.0)
        self._moving = [(k, thing) for k, thing in enumerate(scene.things) if thing.moves]
        for number, _ in self._moving:
            for axis in "xyz":
                self._solver.mask_dof(f"thing{number}_{axis}")
        self._names, self._q = scene.robot.joint_names, scene.start
        for name, angle in zip(self._names, scene.start, strict=True):
            self._robot.set_joint(name, angle)

    def step(self, target: np.ndarray, time: float) -> np.ndarray:
        for number, thing in self._moving:
            for axis, value in zip("xyz", thing.center(time + DT), strict=True):
                self._robot.set_joint(f"thing{number}_{axis}", value)
        self._robot.update_kinematics()
        self._task.T_world_frame = target
        try:
            self._solver.solve(True)
        except RuntimeError:
            self.infeasible += 1
        self._robot.update_kinematics()
        return np.array([self._robot.get_joint(name) for name in self._names])


def place_for_mujoco(thing: Thing) -> dict[str, Any]:
    """Pose of a thing as keywords of MuJoCo."""
    import pinocchio as pin

    return {"pos": thing.at[:3, 3], "quat": np.roll(pin.Quaternion(thing.at[:3, :3]).coeffs(), 1)}


MOVERS: tuple[type[ClearMover], ...] = (Ours, OursSmooth, OursSmoother, Mink, SlowingMink, Pink, Placo)
