"""Planners among obstacles behind one interface. Each is made and called in a process of its own (`plan_worker.py`).

This file is read by the interpreters of the other libraries too: it imports nothing but numpy until a planner is made.
"""

# ruff: noqa: D101, D102, D107

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from .sphere_arm import SphereArm
from .sphere_judge import turn

MARGIN = 1e-3  # m: the default of beetle-ik
SECONDS = 5.0  # that the other libraries get for a problem


@dataclass(frozen=True)
class Arm:
    """Description of an arm for planners: files for all, and spheres for one that reads fewer of them."""

    name: str
    urdf: str  # spheres as collision shapes, all joints off the chain fixed
    srdf: str  # leaves out every pair of links that may touch
    tip: str
    joints: list[str]
    velocity: np.ndarray  # rad/s, from the URDF
    acceleration: float  # rad/s^2, of every joint
    pairs: list[tuple[str, str]]  # links that must not touch
    capsules: list[
        tuple[str, list[float], list[float], float]
    ]  # fewer bodies that hold the spheres, at most 4 mm larger


@dataclass(frozen=True)
class Planned:
    """Properties of a motion before it is sampled."""

    duration: float  # s
    spacing: float  # s, see `sphere_judge.Motion`


class Planner:
    """One library on one arm. Scenes are prepared before the clock starts."""

    name: ClassVar[str]
    settings: ClassVar[str]  # as a reader would need them to repeat the run
    margin_0 = False  # whether the margin had to be 0 in this scene

    def __init__(self, arm: Arm) -> None:
        raise NotImplementedError

    def prepare(self, problem: dict[str, Any]) -> None:
        """Loads the obstacles of a problem of MotionBenchMaker."""
        raise NotImplementedError

    def plan(self, start: np.ndarray, goal: np.ndarray) -> object | None:
        """Plans, and returns the library's solution; None without one. This call is timed."""
        raise NotImplementedError

    def planned(self, found: object) -> Planned:
        """Prepares the result of `plan` for sampling."""
        raise NotImplementedError

    def at(self, times: np.ndarray) -> np.ndarray:
        """Configurations (m, n) of that motion at times (m,)."""
        raise NotImplementedError


class BeetleIk(Planner):
    """Planner `plan_point_to_point`, called with `options` too."""

    name = "beetle-ik"
    settings = "margin 1 mm (0 where an end is nearer), limits of the URDF and 5 rad/s² (all planners)"
    options: ClassVar[dict[str, Any]] = {}
    reserve = 0.0  # m: kept beyond the margin

    def __init__(self, arm: Arm) -> None:
        import beetle_ik as bik

        self.bik = bik
        self.robot = self._robot(arm)
        self.call = {"limits": bik.Limits(acceleration=arm.acceleration), **self._options()}

    def _robot(self, arm: Arm) -> Any:
        robot = self.bik.Robot.from_urdf(arm.urdf, tip=arm.tip, srdf=arm.srdf)
        return robot.with_collision_pairs(arm.pairs)

    def _options(self) -> dict[str, Any]:
        return dict(self.options)

    def prepare(self, problem: dict[str, Any]) -> None:
        self.obstacles = self._obstacles(problem)
        ends = [problem["start"], problem["goal"]]
        near = min(self.bik.obstacles.clearance(self.robot, end, self.obstacles) for end in ends)
        self.margin_0 = near < MARGIN + self.reserve
        self.margin = 0.0 if self.margin_0 else None

    def _obstacles(self, problem: dict[str, Any]) -> Any:
        shapes = self.bik.obstacles
        boxes = [
            shapes.Box(box["position"], 2.0 * np.asarray(box["half_extents"]), turn(box["xyzw"]))
            for box in problem["boxes"]
        ]
        cylinders = [
            shapes.Cylinder(each["position"], turn(each["xyzw"])[:, 2], each["radius"], each["length"])
            for each in problem["cylinders"]
        ]
        return self.bik.Scene([*boxes, *cylinders])

    def plan(self, start: np.ndarray, goal: np.ndarray) -> object | None:
        try:
            plan = self.bik.plan_point_to_point(
                self.robot, start_q=start, end_q=goal, obstacles=self.obstacles, margin=self.margin, **self.call
            )
        except self.bik.BeetleIkError:
            return None
        return plan if plan.success else None

    def planned(self, found: Any) -> Planned:
        self.trajectory = found.trajectory
        return Planned(self.trajectory.duration, 1e-3)

    def at(self, times: np.ndarray) -> np.ndarray:
        return self.trajectory.at(times)[0]


class BeetleIkTravel(BeetleIk):
    name = 'beetle-ik, objective="joint_travel"'
    options: ClassVar[dict[str, Any]] = {"objective": "joint_travel"}


class Within(BeetleIk):
    """Planner with a budget of time."""

    seconds: ClassVar[float]

    def _options(self) -> dict[str, Any]:
        return {"stop": self.bik.Stop(max_time=self.seconds)}


class Within5Milliseconds(Within):
    name = "beetle-ik, max_time=0.005"
    seconds = 0.005


class TravelWithin100Milliseconds(Within):
    name = 'beetle-ik, objective="joint_travel", max_time=0.1'
    seconds = 0.1  # less than the first planner takes

    def _options(self) -> dict[str, Any]:
        return {"objective": "joint_travel", **super()._options()}


class Within1Second(Within):
    name = "beetle-ik, max_time=1"
    seconds = 1.0


class Within5Seconds(Within):
    name = "beetle-ik, max_time=5"
    seconds = 5.0


class Old(BeetleIk):
    """Earlier planner: spheres are capsules without length on links of the chain, cylinders are prisms."""

    name = "beetle-ik, commit c1eaf41"
    settings = "as beetle-ik; cylinders are prisms of 24 sides around them, and it chooses the pairs of links itself"
    reserve = 5e-5

    def _robot(self, arm: Arm) -> Any:
        robot = self.bik.Robot.from_urdf(arm.urdf, tip=arm.tip)
        spheres = SphereArm(arm.urdf, arm.srdf, arm.joints)
        turns, places = spheres.poses(np.zeros((1, len(arm.joints))))
        last, capsules = robot.link_names[-1], []
        for link, center, radius in zip(spheres.links, spheres.local, spheres.radii, strict=True):
            if link not in robot.link_names:  # fixed to the tip
                center = turns[last][0].T @ (turns[link][0] @ center + places[link][0] - places[last][0])
                link = last
            capsules.append((link, center, center, radius))
        return robot.with_capsules(capsules)

    def _obstacles(self, problem: dict[str, Any]) -> Any:
        boxes = [
            self.bik.obstacles.Box(box["position"], 2.0 * np.asarray(box["half_extents"]), turn(box["xyzw"]))
            for box in problem["boxes"]
        ]
        return boxes + [self.bik.obstacles.ConvexMesh(prism(cylinder)) for cylinder in problem["cylinders"]]


class OldCapsules(Old):
    name = "beetle-ik, commit c1eaf41, capsules"
    settings = "29 and 16 capsules that hold the spheres, at most 4 mm larger"

    def _robot(self, arm: Arm) -> Any:
        return self.bik.Robot.from_urdf(arm.urdf, tip=arm.tip).with_capsules(arm.capsules)


def prism(cylinder: dict[str, Any], sides: int = 24) -> np.ndarray:
    """Corners (2 sides, 3) of a prism around a cylinder."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    wide = cylinder["radius"] / np.cos(np.pi / sides)
    ring = np.column_stack([wide * np.cos(angle), wide * np.sin(angle), np.full(sides, 0.5 * cylinder["length"])])
    return np.vstack([ring, ring * [1, 1, -1]]) @ turn(cylinder["xyzw"]).T + cylinder["position"]


class Sampled(Planner):
    """Planner whose motion is a list of positions and velocities, joined by cubics."""

    step = 0.01  # s

    def _sampled(self, times: np.ndarray, q: np.ndarray, qd: np.ndarray) -> Planned:
        self.samples = np.asarray(times), np.asarray(q), np.asarray(qd)
        return Planned(float(times[-1]), self.step)

    def at(self, times: np.ndarray) -> np.ndarray:
        knots, q, qd = self.samples
        i = np.clip(np.searchsorted(knots, times, side="right") - 1, 0, len(knots) - 2)
        width = knots[i + 1] - knots[i]
        s = (times - knots[i]) / width
        s, width = s[:, None], width[:, None]
        ends = (1 + 2 * s) * (1 - s) ** 2 * q[i] + s**2 * (3 - 2 * s) * q[i + 1]
        return ends + width * (s * (1 - s) ** 2 * qd[i] - s**2 * (1 - s) * qd[i + 1])


class RoboPlan(Sampled):
    """Planner RRT-Connect, shortcuts and TOPP-RA, as in its examples."""

    name = "roboplan 0.7.0"
    settings = (
        f"`RRT` with rrt_connect=True, max_nodes=100000, at most {SECONDS:g} s, `PathShortcutter` and "
        "`PathParameterizerTOPPRA`, all else as by default"
    )
    group = "judged"

    def __init__(self, arm: Arm) -> None:
        from roboplan import core, rrt, toppra

        self.core, self.rrt, self.toppra = core, rrt, toppra
        self.scene = core.Scene(arm.name, core.loadUrdfSceneDescription(arm.urdf))
        self.scene.importSrdf(Path(arm.srdf).read_text(encoding="utf-8"))
        self.scene.addGroup(self.group, arm.joints)
        limits = "".join(f"\n  {name}:\n    max_acceleration: [{arm.acceleration}]" for name in arm.joints)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "limits.yaml"
            file.write_text(f"joint_limits:{limits}\n", encoding="utf-8")
            self.scene.importJointLimitsFromConfig(core.loadJointLimitsConfig(file))
        if list(self.scene.getJointNames()) != arm.joints:
            raise ValueError(f"roboplan has the joints {self.scene.getJointNames()}, not {arm.joints}")
        self.root = SphereArm(arm.urdf, arm.srdf, arm.joints).root
        self.things: list[str] = []
        self.options = rrt.RRTOptions(
            group_name=self.group, max_nodes=100_000, max_planning_time=SECONDS, rrt_connect=True
        )
        self.shortcuts = core.PathShortcuttingOptions(group_name=self.group)

    def prepare(self, problem: dict[str, Any]) -> None:
        for name in self.things:
            self.scene.removeGeometry(name)
        self.things = []
        shapes = [(box, self.core.Box(*(2.0 * np.array(box["half_extents"])))) for box in problem["boxes"]]
        shapes += [(each, self.core.Cylinder(each["radius"], each["length"])) for each in problem["cylinders"]]
        for number, (thing, shape) in enumerate(shapes):
            add = self.scene.addBoxGeometry if isinstance(shape, self.core.Box) else self.scene.addCylinderGeometry
            self.things.append(f"thing{number}")
            add(self.things[-1], self.root, shape, np.asfortranarray(placed(thing)), np.ones(4))
        self.scene.setCollisions(list(combinations(self.things, 2)), False)  # things that stand on each other
        self.planner = self.rrt.RRT(self.scene, self.options)
        self.planner.setRngSeed(0)
        self.shortcutter = self.core.PathShortcutter(self.scene, self.shortcuts)
        self.timing = self.toppra.PathParameterizerTOPPRA(self.scene, self.group)

    def plan(self, start: np.ndarray, goal: np.ndarray) -> object | None:
        ends = [self.core.JointConfiguration() for _ in range(2)]
        for end, q in zip(ends, (start, goal), strict=True):
            end.positions = q
        try:
            path = self.shortcutter.shortcut(self.planner.plan(*ends))
            return self.timing.generate(path, self.toppra.TOPPRAOptions(dt=self.step))
        except RuntimeError:
            return None

    def planned(self, found: Any) -> Planned:
        return self._sampled(found.times, found.positions, found.velocities)


class MpLib(Sampled):
    """Planner `plan_qpos`: OMPL's RRT-Connect, simplified, and toppra along a spline through its points."""

    name = "mplib 0.2.1"
    settings = f"`plan_qpos` with planning_time={SECONDS:g} and time_step=0.01, all else as by default"

    def __init__(self, arm: Arm) -> None:
        import mplib

        self.library = mplib
        self.planner = mplib.Planner(
            arm.urdf,
            arm.tip,
            srdf=arm.srdf,
            joint_vel_limits=arm.velocity,
            joint_acc_limits=np.full(len(arm.joints), arm.acceleration),
        )
        if list(self.planner.user_joint_names) != arm.joints:
            raise ValueError(f"mplib has the joints {self.planner.user_joint_names}, not {arm.joints}")

    def prepare(self, problem: dict[str, Any]) -> None:
        fcl, world = self.library.collision_detection.fcl, self.planner.planning_world
        for name in world.get_object_names():
            world.remove_object(name)
        shapes = [(box, fcl.Box(2.0 * np.array(box["half_extents"]))) for box in problem["boxes"]]
        shapes += [(each, fcl.Cylinder(each["radius"], each["length"])) for each in problem["cylinders"]]
        for number, (thing, shape) in enumerate(shapes):
            world.add_object(f"thing{number}", fcl.CollisionObject(shape, self.library.Pose(placed(thing))))
        self.library.set_global_seed(0)

    def plan(self, start: np.ndarray, goal: np.ndarray) -> object | None:
        try:
            found = self.planner.plan_qpos([goal], start, planning_time=SECONDS, time_step=self.step)
        except RuntimeError:
            return None
        return found if found["status"] == "Success" else None

    def planned(self, found: Any) -> Planned:
        return self._sampled(found["time"], found["position"], found["velocity"])


def placed(thing: dict[str, Any]) -> np.ndarray:
    """Pose (4, 4) of a box or cylinder of a problem."""
    at = np.eye(4)
    at[:3, :3], at[:3, 3] = turn(thing["xyzw"]), thing["position"]
    return at
