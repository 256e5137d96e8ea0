"""Libraries of differential kinematics with obstacles as constraints of their quadratic program, and random starts.

Each gets the same spheres, obstacles and pairs of links. Models of scenes are built before the clock starts.
"""

# ruff: noqa: D102, D107

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from .clear import ARMS, CoalScene, MotionBenchArm, boxes_of, cylinders_of
from .stepping import DAMPING, LM_DAMPING

STEPS = 100  # from each start
SECONDS = 2.0  # for each pose
PATIENCE = 10  # steps without a hundredth of progress, after which another start is better
TOLERANCE = 5e-6  # m and rad
KEPT = 1e-4  # m: with less, a step of finite length enters an obstacle
SEEN = 0.05  # m: farther pairs are no constraint
GAIN = 0.85  # of a barrier: mink's own default
SETTINGS = (
    f"random starts that coal calls clear, at most {STEPS} steps each, {PATIENCE} without progress, until coal calls "
    f"an answer clear, for {SECONDS:g} s; "
    f"distance kept {KEPT:g} m, constraints below {SEEN:g} m, barrier gain {GAIN:g}"
)


class Barriers:
    """Loop that such a library leaves to its user: starts, steps, and a check of the answer."""

    name: str
    slow = True
    _no_step: type[Exception] | tuple[type[Exception], ...]  # what it raises where the program has no solution

    def __init__(self, arm: MotionBenchArm, problem: dict[str, Any], scratch: Path) -> None:
        raise NotImplementedError

    def solve(self, target: np.ndarray, judge: CoalScene, lower: np.ndarray, upper: np.ndarray) -> np.ndarray | None:
        """Returns a clear configuration at the pose, or None when the time is up."""
        random, end = np.random.default_rng(0), process_time() + SECONDS
        self._aim(target)
        while process_time() < end:
            start = random.uniform(lower, upper)
            if judge.is_clear(start):
                q = self._descend(start, end)
                if q is not None and judge.is_clear(q):
                    return q
        return None

    def _descend(self, start: np.ndarray, end: float) -> np.ndarray | None:
        self._place(start)
        best, best_step = np.inf, 0
        for step in range(STEPS):
            error = self._error()
            if error < TOLERANCE:
                return self._configuration()
            if error < 0.99 * best:
                best, best_step = error, step
            if step - best_step > PATIENCE or process_time() > end:
                break
            try:
                self._step()
            except self._no_step:
                break
        return None

    def _aim(self, target: np.ndarray) -> None:
        raise NotImplementedError

    def _place(self, q: np.ndarray) -> None:
        raise NotImplementedError

    def _error(self) -> float:
        raise NotImplementedError

    def _step(self) -> None:
        raise NotImplementedError

    def _configuration(self) -> np.ndarray:
        raise NotImplementedError


class Mink(Barriers):
    """Barrier `CollisionAvoidanceLimit`, distances by MuJoCo."""

    name = "mink, CollisionAvoidanceLimit"

    def __init__(self, arm: MotionBenchArm, problem: dict[str, Any], scratch: Path) -> None:  # noqa: ARG002
        import mink
        import mujoco

        specification = mujoco.MjSpec.from_string(held(arm, for_mujoco=True))
        world, kinds = specification.worldbody, mujoco.mjtGeom
        for number, (at, size) in enumerate(boxes_of(problem)):
            world.add_geom(name=f"box{number}", type=kinds.mjGEOM_BOX, size=size / 2, **placed(at))
        for number, (at, radius, length) in enumerate(cylinders_of(problem)):
            size = [radius, length / 2, 0]
            world.add_geom(name=f"cylinder{number}", type=kinds.mjGEOM_CYLINDER, size=size, **placed(at))
        model = specification.compile()
        model.geom_contype[:], model.geom_conaffinity[:] = 1, 1
        bodies = [model.body(model.geom_bodyid[geom]).name for geom in range(model.ngeom)]
        links = set(arm.robot.all_link_names)
        geoms: dict[str, list[int]] = {}
        for geom, body in enumerate(bodies):
            geoms.setdefault(body if body in links else "world", []).append(geom)
        things = geoms.pop("world")
        pairs = [(geoms[a], geoms[b]) for a, b in arm.robot.collision_pairs if a in geoms and b in geoms]
        pairs.append(([geom for group in geoms.values() for geom in group], things))
        self._library, self._state = mink, mink.Configuration(model)
        self._limits = [
            mink.ConfigurationLimit(model, gain=0.95),
            mink.CollisionAvoidanceLimit(model, pairs, GAIN, KEPT, SEEN),
        ]
        tip = ARMS[arm.name]
        self._task = mink.FrameTask(tip, "body", position_cost=1.0, orientation_cost=1.0, lm_damping=LM_DAMPING)
        self._no_step = mink.NoSolutionFound

    def _aim(self, target: np.ndarray) -> None:
        self._task.set_target(self._library.SE3.from_matrix(target))

    def _place(self, q: np.ndarray) -> None:
        self._state.update(q)

    def _error(self) -> float:
        error = self._task.compute_error(self._state)
        return max(np.linalg.norm(error[:3]), np.linalg.norm(error[3:]))

    def _step(self) -> None:
        velocity = self._library.solve_ik(
            self._state, [self._task], 1.0, solver="daqp", damping=DAMPING, limits=self._limits
        )
        self._state.integrate_inplace(velocity, 1.0)

    def _configuration(self) -> np.ndarray:
        return self._state.q.copy()


class Pink(Mink):
    """Barrier `SelfCollisionBarrier`, distances by Pinocchio and coal; the obstacles are geometry of the base."""

    name = "pink, SelfCollisionBarrier"

    def __init__(self, arm: MotionBenchArm, problem: dict[str, Any], scratch: Path) -> None:  # noqa: ARG002
        import coal
        import pink
        import pinocchio as pin

        urdf = held(arm)
        model = pin.buildModelFromXML(urdf)
        geometry = pin.buildGeomFromUrdfString(model, urdf, pin.GeometryType.COLLISION)
        links: dict[str, list[int]] = {}
        for number, body in enumerate(geometry.geometryObjects):
            links.setdefault(model.frames[body.parentFrame].name, []).append(number)
        things = [
            geometry.addGeometryObject(pin.GeometryObject(f"thing{number}", 0, pin.SE3(at), shape))
            for number, (at, shape) in enumerate(
                [
                    *((at, coal.Box(*size)) for at, size in boxes_of(problem)),
                    *((at, coal.Cylinder(radius, length)) for at, radius, length in cylinders_of(problem)),
                ]
            )
        ]
        of_links = [(i, j) for a, b in arm.robot.collision_pairs for i in links[a] for j in links[b]]
        moving = [i for group in links.values() for i in group if geometry.geometryObjects[i].parentJoint]
        for i, j in [*of_links, *((i, j) for i in moving for j in things)]:
            geometry.addCollisionPair(pin.CollisionPair(i, j))
        self._library, self._se3 = pink, pin.SE3
        start = pin.neutral(model)
        self._state = pink.Configuration(
            model, model.createData(), start, collision_model=geometry, collision_data=pin.GeometryData(geometry)
        )
        self._limits = [pink.limits.ConfigurationLimit(model, config_limit_gain=0.95)]
        self._barriers = [
            pink.barriers.SelfCollisionBarrier(BARRIERS_OF_PINK, gain=GAIN, safe_displacement_gain=0.0, d_min=KEPT)
        ]
        tip = ARMS[arm.name]
        self._task = pink.tasks.FrameTask(tip, position_cost=1.0, orientation_cost=1.0, lm_damping=LM_DAMPING)
        self._no_step = (pink.exceptions.NoSolutionFound, pink.exceptions.PinkError)

    def _aim(self, target: np.ndarray) -> None:
        self._task.set_target(self._se3(target))

    def _step(self) -> None:
        velocity = self._library.solve_ik(
            self._state,
            [self._task],
            1.0,
            solver="daqp",
            damping=DAMPING,
            limits=self._limits,
            barriers=self._barriers,
            safety_break=False,
        )
        self._state.integrate_inplace(velocity, 1.0)


BARRIERS_OF_PINK = 30  # its nearest pairs


class Placo(Barriers):
    """Barrier `AvoidSelfCollisionsKinematicsConstraint`; the obstacles are links fixed to the base."""

    name = "placo, AvoidSelfCollisions"

    def __init__(self, arm: MotionBenchArm, problem: dict[str, Any], scratch: Path) -> None:
        import placo

        urdf, things = with_things(held(arm), problem)
        bodies = dict.fromkeys(link for link, *_ in arm.robot.capsules)
        base = {arm.robot.all_link_names[0]}
        pairs = [*arm.robot.collision_pairs, *((a, b) for a in bodies if a not in base for b in things)]
        file, list_of_pairs = scratch / "with_things.urdf", scratch / "pairs.json"
        file.write_text(urdf, encoding="utf-8")
        list_of_pairs.write_text(json.dumps(pairs), encoding="utf-8")
        self._robot = placo.RobotWrapper(str(file))
        self._robot.load_collision_pairs(str(list_of_pairs))
        self._solver = placo.KinematicsSolver(self._robot)
        self._solver.mask_fbase(True)
        self._solver.enable_joint_limits(True)
        apart = self._solver.add_avoid_self_collisions_constraint()
        apart.configure("apart", "hard")  # soft by default
        apart.self_collisions_margin, apart.self_collisions_trigger = KEPT, SEEN
        self._frame = self._solver.add_frame_task(ARMS[arm.name], np.eye(4))
        self._frame.configure("pose", "soft", 1.0, 1.0)
        self._q, self._no_step = np.array(self._robot.state.q), RuntimeError  # a pose of the base, then the joints

    def _aim(self, target: np.ndarray) -> None:
        self._frame.T_world_frame = target

    def _place(self, q: np.ndarray) -> None:
        self._q[7:] = q
        self._robot.state.q = self._q
        self._robot.update_kinematics()

    def _error(self) -> float:
        tasks = self._frame.position(), self._frame.orientation()
        for task in tasks:
            task.update()  # otherwise the error is that before the last step
        return max(task.error_norm() for task in tasks)

    def _step(self) -> None:
        self._solver.solve(True)
        self._robot.update_kinematics()

    def _configuration(self) -> np.ndarray:
        state = self._robot.state  # outlives the view of its joints
        return state.q[7:].copy()


class RoboticsToolbox(Barriers):
    """Solver `ets.ik_LM` from random starts of its own, each answer tested by coal."""

    name = "rejection: roboticstoolbox and coal"
    slow = False

    def __init__(self, arm: MotionBenchArm, problem: dict[str, Any], scratch: Path) -> None:  # noqa: ARG002
        import roboticstoolbox

        file = scratch / f"{arm.name}_held.urdf"
        file.write_text(held(arm), encoding="utf-8")
        self._ets = roboticstoolbox.Robot.URDF(str(file)).ets(end=ARMS[arm.name])

    def solve(self, target: np.ndarray, judge: CoalScene, lower: np.ndarray, upper: np.ndarray) -> np.ndarray | None:
        random, end = np.random.default_rng(0), process_time() + SECONDS
        while process_time() < end:
            start = random.uniform(lower, upper)
            found = self._ets.ik_LM(target, q0=start, tol=TOLERANCE**2 / 2, k=0.1, method="chan", slimit=1)
            if found.success and judge.is_clear(found.q):
                return found.q
        return None


def placed(at: np.ndarray) -> dict[str, Any]:
    """Pose as keywords of MuJoCo."""
    import pinocchio as pin

    return {"pos": at[:3, 3], "quat": np.roll(pin.Quaternion(at[:3, :3]).coeffs(), 1)}


def held(arm: MotionBenchArm, *, for_mujoco: bool = False) -> str:
    """Removes the visuals from the arm's file, and fixes joints off the chain."""
    robot = ET.parse(arm.urdf).getroot()
    moving = set(arm.robot.joint_names)
    for link in robot.iter("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
    for joint in robot.iter("joint"):
        if joint.get("name") not in moving:
            joint.set("type", "fixed")
            for child in joint.findall("mimic"):
                joint.remove(child)
    for other in robot.findall("transmission") + robot.findall("gazebo"):
        robot.remove(other)
    if for_mujoco:
        extension = ET.SubElement(robot, "mujoco")
        ET.SubElement(extension, "compiler", fusestatic="false")
    return ET.tostring(robot, encoding="unicode")


def with_things(urdf: str, problem: dict[str, Any]) -> tuple[str, list[str]]:
    """Adds a link for each obstacle to the file, fixed to the root; returns the names too."""
    import pinocchio as pin

    robot = ET.fromstring(urdf)
    children = {joint.find("child").get("link") for joint in robot.iter("joint")}
    root = next(link.get("name") for link in robot.iter("link") if link.get("name") not in children)
    shapes = [(at, "box", {"size": " ".join(map(repr, map(float, size)))}) for at, size in boxes_of(problem)]
    for at, radius, length in cylinders_of(problem):
        shapes.append((at, "cylinder", {"radius": repr(radius), "length": repr(length)}))
    names = [f"thing{number}" for number in range(len(shapes))]
    for name, (at, kind, sizes) in zip(names, shapes, strict=True):
        link = ET.SubElement(robot, "link", name=name)
        ET.SubElement(ET.SubElement(ET.SubElement(link, "collision"), "geometry"), kind, sizes)
        joint = ET.SubElement(robot, "joint", name=f"{name}_joint", type="fixed")
        ET.SubElement(joint, "parent", link=root)
        ET.SubElement(joint, "child", link=name)
        turn = pin.rpy.matrixToRpy(np.ascontiguousarray(at[:3, :3]))
        xyz, rpy = (" ".join(repr(float(x)) for x in values) for values in (at[:3, 3], turn))
        ET.SubElement(joint, "origin", xyz=xyz, rpy=rpy)
    return ET.tostring(robot, encoding="unicode"), names


BARRIERS: tuple[type[Barriers], ...] = (Mink, Pink, Placo, RoboticsToolbox)
