"""Movers among obstacles: this library's `Tracker`, and one quadratic program a tick of mink, pink and placo.

All get the same capsules, pairs of links, boxes and sphere, and the same velocity limit. None of the others takes the
velocity of an obstacle: they get the sphere where it will be at the end of the tick.
"""

# ruff: noqa: ARG002, D101, D102, D107

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any, ClassVar

import coal
import numpy as np

import beetle_ik as bik

from .chain import some_mass
from .clear_streams import DT, MARGIN, Scene, Thing, pose_of_capsule
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
        """The configuration to command at the end of the tick that begins at `time` (s)."""
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
    """`CollisionAvoidanceLimit`. It divides its bound on a displacement by dt: with its default gain it acts only where the
    margin is reached.
    """

    name = "mink, default gain"
    gain = GAIN

    def __init__(self, scene: Scene, scratch: Path, *, among: bool) -> None:
        import mink
        import mujoco

        specification, kinds = mujoco.MjSpec.from_string(urdf(scene.robot, for_mujoco=True)), mujoco.mjtGeom
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
    """`SelfCollisionBarrier`; its gain is per second."""

    name = "pink, gain 0.85 / dt"

    def __init__(self, scene: Scene, scratch: Path, *, among: bool) -> None:
        import pink
        import pinocchio as pin

        model = pin.buildModelFromXML(urdf(scene.robot))
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
    """`AvoidSelfCollisionsKinematicsConstraint`; the obstacles are links, and the sphere has three sliding joints."""

    name = "placo"

    def __init__(self, scene: Scene, scratch: Path, *, among: bool) -> None:
        import placo

        file, list_of_pairs = scratch / "placo.urdf", scratch / "pairs.json"
        file.write_text(urdf(scene.robot, scene.things), encoding="utf-8")
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
    """The pose of a thing as keywords of MuJoCo."""
    import pinocchio as pin

    return {"pos": thing.at[:3, 3], "quat": np.roll(pin.Quaternion(thing.at[:3, :3]).coeffs(), 1)}


def urdf(robot: bik.Robot, things: list[Thing] | None = None, *, for_mujoco: bool = False) -> str:
    """The arm as URDF text, with a link "tip"; with `things`, also the bodies of all, as links of their own.

    Joints turn about axes as they are at zero, all frames of moved links being parallel to the base there.
    """
    import pinocchio as pin

    zero = np.zeros(robot.dof)
    axes, poses = robot.jacobian(zero)[3:].T, dict(zip(robot.link_names, robot.link_poses(zero), strict=True))
    root, parent, here = ET.Element("robot", name="arm"), robot.link_names[0], np.zeros(3)
    ET.SubElement(root, "link", name=parent)
    for j, name in enumerate(robot.joint_names):
        link = robot.link_names[j + 1]
        place = poses[link]
        xyz = place[:3, 3] - here
        joint = add_joint(root, name, "revolute", parent, f"moved_{j}", xyz)
        ET.SubElement(joint, "axis", xyz=text(axes[j]))
        low, high = repr(float(robot.lower[j])), repr(float(robot.upper[j]))
        ET.SubElement(joint, "limit", lower=low, upper=high, velocity=repr(VELOCITY), effort="0")
        turn = pin.rpy.matrixToRpy(np.ascontiguousarray(place[:3, :3]))
        add_joint(root, f"{link}_fixed", "fixed", f"moved_{j}", link, np.zeros(3), turn)
        parent, here = f"moved_{j}", place[:3, 3]
    tip = robot.fk(zero)
    turn = pin.rpy.matrixToRpy(np.ascontiguousarray(tip[:3, :3]))
    add_joint(root, "tip_fixed", "fixed", parent, "tip", tip[:3, 3] - here, turn)
    if things is not None:
        add_bodies(root, robot, things)
    if for_mujoco:
        ET.SubElement(ET.SubElement(root, "mujoco"), "compiler", fusestatic="false")
    written = ET.tostring(root, encoding="unicode")
    check(written, robot)
    return written


def add_bodies(root: ET.Element, robot: bik.Robot, things: list[Thing]) -> None:
    """Adds the capsules of the arm, and each thing as a link, the sphere on three sliding joints."""
    import pinocchio as pin

    links = {link.get("name"): link for link in root.iter("link")}
    base = robot.link_names[0]
    for number, (link, a, b, radius) in enumerate(robot.capsules):
        at = pose_of_capsule(a, b)
        collision = ET.SubElement(links[link], "collision", name=f"capsule{number}")
        turn = pin.rpy.matrixToRpy(np.ascontiguousarray(at[:3, :3]))
        ET.SubElement(collision, "origin", xyz=text(at[:3, 3]), rpy=text(turn))
        length = repr(float(np.linalg.norm(b - a)))
        ET.SubElement(ET.SubElement(collision, "geometry"), "cylinder", radius=repr(radius), length=length)
        # How Pinocchio is told that a cylinder is a capsule.
        ET.SubElement(ET.SubElement(links[link], "collision_checking"), "capsule", name=f"capsule{number}")
    for number, thing in enumerate(things):
        name, parent = f"thing{number}", base
        if thing.moves:
            for axis, vector in zip("xyz", np.eye(3), strict=True):
                child = name if axis == "z" else f"{name}_on_{axis}"
                joint = add_joint(root, f"{name}_{axis}", "prismatic", parent, child, np.zeros(3))
                ET.SubElement(joint, "axis", xyz=text(vector))
                ET.SubElement(joint, "limit", lower="-10", upper="10", velocity="10", effort="0")
                parent = child
            shape, sizes = "sphere", {"radius": repr(thing.shape.radius)}
        else:
            turn = pin.rpy.matrixToRpy(np.ascontiguousarray(thing.at[:3, :3]))
            add_joint(root, f"{name}_fixed", "fixed", parent, name, thing.at[:3, 3], turn)
            shape, sizes = "box", {"size": text(2.0 * thing.shape.halfSide)}
        link = next(link for link in root.iter("link") if link.get("name") == name)
        ET.SubElement(ET.SubElement(ET.SubElement(link, "collision"), "geometry"), shape, sizes)


def add_joint(
    root: ET.Element, name: str, kind: str, parent: str, child: str, xyz: np.ndarray, rpy: np.ndarray | None = None
) -> ET.Element:
    """A joint and the link that it carries, with the mass that simulators insist on."""
    joint = ET.SubElement(root, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    ET.SubElement(joint, "origin", xyz=text(xyz), rpy=text(np.zeros(3) if rpy is None else rpy))
    ET.SubElement(root, "link", name=child).append(some_mass())
    return joint


def check(written: str, robot: bik.Robot) -> None:
    """Refuses a file whose tip is not that of the robot."""
    import pinocchio as pin

    model = pin.buildModelFromXML(written)
    data, tip = model.createData(), model.getFrameId("tip")
    q = robot.random_configurations(1, seed=0)[0]
    pin.framesForwardKinematics(model, data, np.concatenate([q, np.zeros(model.nq - robot.dof)]))
    if np.abs(data.oMf[tip].homogeneous - robot.fk(q)).max() > 1e-9:
        raise ValueError(f"the URDF file of {robot.name} is another arm")


def text(vector: np.ndarray) -> str:
    """Numbers as URDF has them."""
    return " ".join(repr(float(value)) for value in vector)


MOVERS: tuple[type[ClearMover], ...] = (Ours, OursSmooth, OursSmoother, Mink, SlowingMink, Pink, Placo)
