"""Robots with two hands, and the libraries that take both at once."""

# ruff: noqa: ARG002, D101, D102, D107

from __future__ import annotations

import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pinocchio as pin

import beetle_ik as bik

from .local import MAX_STEPS
from .stepping import DAMPING, LM_DAMPING, QUADRATIC_PROGRAM, Stepping

TOLERANCE = 1e-6  # m, rad
Poses = dict[str, np.ndarray]  # (4, 4) by the name of the tip


@dataclass(frozen=True)
class TwoHands:
    """Robot with only the joints on the way to two tips free: no meshes, and masses for simulators."""

    name: str
    text: str
    tips: tuple[str, str]

    @cached_property
    def model(self) -> pin.Model:
        return pin.buildModelFromXML(self.text)

    @cached_property
    def _data(self) -> pin.Data:
        return self.model.createData()

    @cached_property
    def joints(self) -> list[str]:
        """Joints in the order of Pinocchio's q."""
        return [str(name) for name in self.model.names][1:]

    def poses(self, q: np.ndarray) -> Poses:
        pin.framesForwardKinematics(self.model, self._data, q)
        return {tip: self._data.oMf[self.model.getFrameId(tip)].homogeneous.copy() for tip in self.tips}

    def is_met(self, q: np.ndarray, wanted: Poses) -> bool:
        """Whether q is inside the limits, and each tip within the tolerance (and rounding)."""
        inside = (q >= self.model.lowerPositionLimit - 1e-9) & (q <= self.model.upperPositionLimit + 1e-9)
        return bool(inside.all()) and all(
            self._error(pose, wanted[tip]) <= 1.001 * TOLERANCE for tip, pose in self.poses(q).items()
        )

    @staticmethod
    def _error(pose: np.ndarray, wanted: np.ndarray) -> float:
        turn = pin.log3(wanted[:3, :3].T @ pose[:3, :3])
        return max(np.linalg.norm(pose[:3, 3] - wanted[:3, 3]), np.linalg.norm(turn))


def reduced(name: str, urdf: Path | str, tips: tuple[str, str]) -> TwoHands:
    """Robot of a file or text, reduced to the links that move its tips."""
    robot = ET.fromstring(urdf) if isinstance(urdf, str) else ET.parse(urdf).getroot()
    above = {child(joint): joint for joint in robot.iter("joint") if joint.find("child") is not None}
    moving = {id(joint) for tip in tips for joint in way(tip, above)}
    for joint in above.values():
        if id(joint) not in moving:
            joint.set("type", "fixed")
        for extra in ("mimic", "safety_controller", "dynamics", "calibration"):
            for found in joint.findall(extra):
                joint.remove(found)
    names = {element.get("link") for joint in above.values() for element in joint if element.get("link")}
    for link in robot.findall("link"):
        robot.remove(link)
    for link in sorted(names):
        body = ET.SubElement(ET.SubElement(robot, "link", name=link), "inertial")
        ET.SubElement(body, "mass", value="1")
        ET.SubElement(body, "inertia", ixx="1", iyy="1", izz="1", ixy="0", ixz="0", iyz="0")
    for other in [e for e in robot if e.tag not in ("link", "joint")]:
        robot.remove(other)
    return TwoHands(name, ET.tostring(robot, encoding="unicode"), tips)


def child(joint: ET.Element) -> str:
    """Link that a joint carries."""
    found = joint.find("child")
    return "" if found is None else found.get("link", "")


def way(tip: str, above: dict[str, ET.Element]) -> Iterator[ET.Element]:
    """Joints from a link to the root."""
    while tip in above:
        joint = above[tip]
        yield joint
        parent = joint.find("parent")
        tip = "" if parent is None else parent.get("link", "")


def two_arms_on_a_torso(arm: Path) -> str:
    """Two arms of a file on a torso that turns and lifts, with links and joints named `left_` and `right_`."""
    robot = ET.Element("robot", name="two arms")
    ET.SubElement(robot, "link", name="floor")
    for name, kind, parent, axis, upper in (
        ("turn", "revolute", "floor", "0 0 1", "1.5"),
        ("lift", "prismatic", "column", "0 0 1", "0.4"),
    ):
        link = {"turn": "column", "lift": "torso"}[name]
        ET.SubElement(robot, "link", name=link)
        joint = ET.SubElement(robot, "joint", name=name, type=kind)
        ET.SubElement(joint, "parent", link=parent)
        ET.SubElement(joint, "child", link=link)
        ET.SubElement(joint, "axis", xyz=axis)
        ET.SubElement(joint, "limit", lower="-1.5" if name == "turn" else "0", upper=upper, velocity="1", effort="1")
    for side, y, roll in (("left", 0.2, -0.8), ("right", -0.2, 0.8)):
        own = ET.parse(arm).getroot()
        root = own.find("link")
        for element in own.iter():
            for key in ("link", "name"):
                if element.tag in ("link", "joint", "parent", "child") and element.get(key):
                    element.set(key, f"{side}_{element.get(key)}")
        robot.extend([e for e in own if e.tag in ("link", "joint")])
        mount = ET.SubElement(robot, "joint", name=f"{side}_mount", type="fixed")
        ET.SubElement(mount, "parent", link="torso")
        ET.SubElement(mount, "child", link="" if root is None else str(root.get("name")))
        ET.SubElement(mount, "origin", xyz=f"0 {y} 0.6", rpy=f"{roll} 0 0")
    return ET.tostring(robot, encoding="unicode")


class Library:
    """One library on one robot, from the same start for every target."""

    name: ClassVar[str]
    settings: ClassVar[str]

    def __init__(self, rig: TwoHands, start: np.ndarray) -> None:
        raise NotImplementedError

    def solve(self, wanted: Poses) -> np.ndarray | None:
        """Joint values in Pinocchio's order, or None for a failure."""
        raise NotImplementedError


class BeetleIk(Library):
    name = "beetle-ik"
    settings = "solve(robot, {tip: pose}) without a start"

    def __init__(self, rig: TwoHands, start: np.ndarray) -> None:
        self.robot = bik.Robot.from_urdf(rig.text, tip=list(rig.tips))
        self._order = [self.robot.joint_names.index(name) for name in rig.joints]
        self._options: dict[str, Any] = {}

    def solve(self, wanted: Poses) -> np.ndarray | None:
        found = bik.solve(
            self.robot, wanted, position_tolerance=TOLERANCE, rotation_tolerance=TOLERANCE, **self._options
        )
        return found.q[self._order] if found.success else None


class FromStart(BeetleIk):
    name = "beetle-ik, one descent"
    settings = "solve(robot, {tip: pose}, start_q=middle, solver=LevenbergMarquardt()): no restarts"

    def __init__(self, rig: TwoHands, start: np.ndarray) -> None:
        super().__init__(rig, start)
        own = np.empty(len(start))
        own[self._order] = start
        self._options = {"start_q": own, "solver": bik.LevenbergMarquardt()}


class OneAfterTheOther(Library):
    name = "beetle-ik, each arm alone"
    settings = "two calls of solve, on robots of one tip each: what one hand does to the other's torso is not regarded"

    def __init__(self, rig: TwoHands, start: np.ndarray) -> None:
        self._arms = {tip: bik.Robot.from_urdf(rig.text, tip=tip) for tip in rig.tips}

    def solve(self, wanted: Poses) -> np.ndarray | None:
        for tip, arm in self._arms.items():
            bik.solve(arm, wanted[tip], position_tolerance=TOLERANCE, rotation_tolerance=TOLERANCE)
        return None


class Iterated(Library, Stepping):
    """Library whose call is one step by a quadratic program."""

    _tolerance = TOLERANCE
    _no_step = Exception  # each library has its own for a program without a solution

    def solve(self, wanted: Poses) -> np.ndarray | None:
        self._aim(wanted)
        return self._descend()

    def _aim(self, wanted: Poses) -> None:
        raise NotImplementedError


class FrameTasks(Iterated):
    """Base of mink and pink."""

    settings = f"one task a hand, {QUADRATIC_PROGRAM}, {MAX_STEPS} steps"
    _library: Any
    _state: Any
    _limits: list[Any]
    _tasks: dict[str, Any]

    def _error(self) -> float:
        errors = [task.compute_error(self._state) for task in self._tasks.values()]
        return max(max(np.linalg.norm(error[:3]), np.linalg.norm(error[3:])) for error in errors)

    def _step(self) -> None:
        tasks = list(self._tasks.values())
        velocity = self._library.solve_ik(self._state, tasks, 1.0, solver="daqp", damping=DAMPING, limits=self._limits)
        self._state.integrate_inplace(velocity, 1.0)


class Mink(FrameTasks):
    name = "mink"

    def __init__(self, rig: TwoHands, start: np.ndarray) -> None:
        import mink
        import mujoco

        robot = ET.fromstring(rig.text)
        ET.SubElement(ET.SubElement(robot, "mujoco"), "compiler", fusestatic="false")
        model = mujoco.MjModel.from_xml_string(ET.tostring(robot, encoding="unicode"))
        names = [model.joint(j).name for j in range(model.njnt)]
        self._order = [names.index(name) for name in rig.joints]
        self._start = np.empty(len(start))
        self._start[self._order] = start
        self._library, self._state = mink, mink.Configuration(model)
        self._limits = [mink.ConfigurationLimit(model, gain=0.95)]
        costs = {"position_cost": 1.0, "orientation_cost": 1.0, "lm_damping": LM_DAMPING}
        self._tasks = {tip: mink.FrameTask(tip, "body", **costs) for tip in rig.tips}

    def _aim(self, wanted: Poses) -> None:
        self._state.update(self._start)
        for tip, task in self._tasks.items():
            task.set_target(self._library.SE3.from_matrix(wanted[tip]))

    def _configuration(self) -> np.ndarray:
        return self._state.q[self._order]


class Pink(FrameTasks):
    name = "pink"

    def __init__(self, rig: TwoHands, start: np.ndarray) -> None:
        import pink

        self._library, self._start = pink, start
        self._state = pink.Configuration(rig.model, rig.model.createData(), start)
        self._limits = [pink.limits.ConfigurationLimit(rig.model, config_limit_gain=0.95)]
        costs = {"position_cost": 1.0, "orientation_cost": 1.0, "lm_damping": LM_DAMPING}
        self._tasks = {tip: pink.tasks.FrameTask(tip, **costs) for tip in rig.tips}

    def _aim(self, wanted: Poses) -> None:
        self._state.update(self._start)
        for tip, task in self._tasks.items():
            task.set_target(pin.SE3(wanted[tip]))

    def _configuration(self) -> np.ndarray:
        return self._state.q.copy()


class Placo(Iterated):
    name = "placo"
    settings = f"KinematicsSolver with joint limits, one soft frame task a hand, {MAX_STEPS} steps"

    def __init__(self, rig: TwoHands, start: np.ndarray) -> None:
        import placo

        with tempfile.TemporaryDirectory() as folder:
            urdf = Path(folder) / "robot.urdf"
            urdf.write_text(rig.text)
            self._robot = placo.RobotWrapper(str(urdf), placo.Flags.ignore_collisions)
        self._base, self._start = np.array(self._robot.state.q)[:7], start
        self._solver = placo.KinematicsSolver(self._robot)
        self._solver.mask_fbase(True)
        self._solver.enable_joint_limits(True)
        self._tasks = {tip: self._solver.add_frame_task(tip, np.eye(4)) for tip in rig.tips}
        for tip, task in self._tasks.items():
            task.configure(tip, "soft", 1.0, 1.0)

    def _aim(self, wanted: Poses) -> None:
        self._robot.state.q = np.concatenate([self._base, self._start])
        self._robot.update_kinematics()
        for tip, task in self._tasks.items():
            task.T_world_frame = wanted[tip]

    def _error(self) -> float:
        parts = [part for task in self._tasks.values() for part in (task.position(), task.orientation())]
        for part in parts:
            part.update()  # otherwise the error is that before the last step
        return max(part.error_norm() for part in parts)

    def _step(self) -> None:
        self._solver.solve(True)
        self._robot.update_kinematics()

    def _configuration(self) -> np.ndarray:
        state = self._robot.state  # outlives the view of its joints
        return state.q[7:].copy()
