"""Planners of straight lines of the tip behind one interface, each with its settings as the table prints them."""

# ruff: noqa: D102, D107, ARG002

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol
from xml.etree import ElementTree

import numpy as np
from scipy.interpolate import CubicHermiteSpline

INSTANTS = 2000  # at which motions are judged


@dataclass(frozen=True)
class LineArm:
    """Arm and its limits as every planner gets them."""

    name: str
    urdf: str
    base: str
    tip: str
    joints: list[str]
    velocity: np.ndarray  # rad/s, from the URDF
    acceleration: float  # rad/s^2, of every joint


@dataclass(frozen=True)
class LineMotion:
    """Motion, with joint positions and velocities (m, n) at times (m,)."""

    knots: np.ndarray  # s: instants at which the library itself gives the motion
    at: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


class LineMover(Protocol):
    """A library with settings. `plan` is timed."""

    name: str
    takes_speed: bool  # whether a speed of the tip can be asked for

    def plan(self, start: np.ndarray, poses: list[np.ndarray], speed: float) -> Any | None:
        """Plans from rest at `start` along straight lines through `poses` (4, 4) to rest; None without a plan."""

    def motion(self, found: Any) -> LineMotion:
        """Motion of a result of `plan`."""


class BeetleLines:
    """Calls `plan_moves` with lines."""

    takes_speed = True

    def __init__(self, arm: LineArm, blend: float) -> None:
        import beetle_ik as bik

        self.bik, self.blend = bik, blend
        self.robot = bik.Robot.from_urdf(arm.urdf, base=arm.base, tip=arm.tip)
        self.limits = bik.Limits(acceleration=arm.acceleration)
        self.name = f"beetle-ik, blend={1e3 * blend:g} mm" if blend else "beetle-ik"

    def plan(self, start: np.ndarray, poses: list[np.ndarray], speed: float) -> Any | None:
        lines = [self.bik.moves.Line(pose, speed=speed, blend=self.blend) for pose in poses]
        try:
            return self.bik.plan_moves(self.robot, lines, start_q=start, limits=self.limits)
        except self.bik.InvalidInputError:
            return None

    def motion(self, found: Any) -> LineMotion:
        instants = np.linspace(0.0, found.trajectory.duration, INSTANTS)
        return LineMotion(instants, lambda t: found.trajectory.at(t)[:2])


class RoboplanLines:
    """Calls `CartesianPathPlanner` in the mode that bounds the speed of the tip; samples are joined by cubics.

    The limits of turning and of the tip's acceleration are set so high that the speed alone binds.
    """

    takes_speed = True
    group = "arm"

    def __init__(self, arm: LineArm, **options: Any) -> None:
        from roboplan import cartesian_planning, core

        self.arm, self.core = arm, core
        self.scene = core.Scene(arm.name, core.loadUrdfSceneDescription(arm.urdf))
        self.scene.addGroup(self.group, arm.joints)
        self._limit()
        self.planning, self.options = cartesian_planning, options
        named = [f"{key}={value:g}" for key, value in options.items()]
        self.name = ", ".join(["roboplan 0.7.0", *named])

    def _limit(self) -> None:
        rows = "".join(f"\n  {joint}:\n    max_acceleration: [{self.arm.acceleration}]" for joint in self.arm.joints)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "limits.yaml"
            file.write_text(f"joint_limits:{rows}\n", encoding="utf-8")
            self.scene.importJointLimitsFromConfig(self.core.loadJointLimitsConfig(file))

    def plan(self, start: np.ndarray, poses: list[np.ndarray], speed: float) -> Any | None:
        options = self.planning.CartesianPlannerOptions(
            group_name=self.group,
            max_linear_speed=speed,
            max_linear_acceleration=10.0,
            max_angular_speed=10.0,
            max_angular_acceleration=100.0,
            **self.options,
        )
        here = self.core.JointConfiguration()
        here.positions = start
        first = self.scene.forwardKinematics(start, self.arm.tip, self.arm.base)
        path = self.core.CartesianPath([self.arm.base], [self.arm.tip], [[first, *poses]])
        try:
            return self.planning.CartesianPathPlanner(self.scene, options).plan(path, here)
        except RuntimeError:
            return None

    def motion(self, found: Any) -> LineMotion:
        return joined(*(np.asarray(rows) for rows in (found.times, found.positions, found.velocities)))


class TesseractLines:
    """Interpolates lines, meets their poses by TrajOpt and times the result; collision checks are off.

    It takes limits of the joints, but no speed of the tip.
    """

    takes_speed = False
    group, planner = "manipulator", "TrajOpt"

    def __init__(self, arm: LineArm, step: float) -> None:
        from tesseract_robotics import (
            tesseract_command_language,
            tesseract_common,
            tesseract_environment,
            tesseract_motion_planners,
            tesseract_motion_planners_simple,
            tesseract_motion_planners_trajopt,
            tesseract_time_parameterization,
        )

        self.common, self.language = tesseract_common, tesseract_command_language
        self.planners, self.simple = tesseract_motion_planners, tesseract_motion_planners_simple
        self.trajopt, self.timing = tesseract_motion_planners_trajopt, tesseract_time_parameterization
        self.arm, self.step = arm, step
        self.locator = tesseract_common.GeneralResourceLocator()
        self.scene = tesseract_environment.Environment()
        self._load()
        self.profiles = self._profiles()
        self.name = f"tesseract-robotics 0.5.1, TrajOpt every {1e3 * step:g} mm"

    def _load(self) -> None:
        urdf = Path(self.arm.urdf).read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory() as folder:
            plugins = Path(folder) / "plugins.yaml"
            plugins.write_text(tesseract_kinematics(self.arm, self.group), encoding="utf-8")
            srdf = f"""<robot name="{ElementTree.fromstring(urdf).get("name")}" version="1.0.0">
                <group name="{self.group}"><chain base_link="{self.arm.base}" tip_link="{self.arm.tip}"/></group>
                <kinematics_plugin_config filename="file://{plugins}"/></robot>"""
            if not self.scene.init(urdf, srdf, self.locator):
                raise ValueError("tesseract does not load the robot")

    def _profiles(self) -> Any:
        points, whole = self.trajopt.TrajOptDefaultPlanProfile(), self.trajopt.TrajOptDefaultCompositeProfile()
        whole.collision_cost_config.enabled = whole.collision_constraint_config.enabled = False
        profiles = self.language.ProfileDictionary()
        profiles.addProfile(self.planner, "DEFAULT", points)
        profiles.addProfile(self.planner, "DEFAULT", whole)
        return profiles

    def _program(self, start: np.ndarray, poses: list[np.ndarray]) -> Any:
        words = self.language
        manipulator = self.common.ManipulatorInfo()
        manipulator.tcp_frame, manipulator.manipulator = self.arm.tip, self.group
        manipulator.working_frame = self.arm.base
        program = words.CompositeInstruction("DEFAULT")
        program.setManipulatorInfo(manipulator)
        waypoints = [words.StateWaypointPoly_wrap_StateWaypoint(words.StateWaypoint(self.arm.joints, start))]
        for pose in poses:
            waypoint = words.CartesianWaypoint(self.common.Isometry3d(pose))
            waypoints.append(words.CartesianWaypointPoly_wrap_CartesianWaypoint(waypoint))
        for waypoint in waypoints:
            move = words.MoveInstruction(waypoint, words.MoveInstructionType_LINEAR, "DEFAULT")
            program.appendMoveInstruction(words.MoveInstructionPoly_wrap_MoveInstruction(move))
        return program

    def plan(self, start: np.ndarray, poses: list[np.ndarray], speed: float) -> Any | None:
        self.scene.setState(self.arm.joints, start)
        request = self.planners.PlannerRequest()
        program = self._program(start, poses)
        request.instructions = self.simple.generateInterpolatedProgram(program, self.scene, 3.14, self.step, 0.1, 1)
        request.env, request.profiles = self.scene, self.profiles
        found = self.trajopt.TrajOptMotionPlanner(self.planner).solve(request)
        if not found.successful:
            return None
        rows = self.timing.InstructionsTrajectory(found.results)
        velocity = np.column_stack([-self.arm.velocity, self.arm.velocity])
        acceleration = self.arm.acceleration * np.array([[-1.0, 1.0]] * len(self.arm.joints))
        timing = self.timing.TimeOptimalTrajectoryGeneration()
        return found if timing.compute(rows, velocity, acceleration, acceleration) else None

    def motion(self, found: Any) -> LineMotion:
        # Every object has a name, because those of this library do not keep what they are made from.
        t, q, qd = [], [], []
        rows = found.results.flatten()
        for index in range(len(rows)):
            instruction = rows[index]
            move = self.language.InstructionPoly_as_MoveInstructionPoly(instruction)
            waypoint = move.getWaypoint()
            state = self.language.WaypointPoly_as_StateWaypointPoly(waypoint)
            t.append(state.getTime())
            q.append(np.array(state.getPosition()).ravel())
            qd.append(np.array(state.getVelocity()).ravel())
        return joined(np.array(t), np.array(q), np.array(qd))


def tesseract_kinematics(arm: LineArm, group: str) -> str:
    """Configuration of tesseract's kinematics, by KDL."""
    chain = f"config: {{base_link: {arm.base}, tip_link: {arm.tip}}}"
    solvers = {"fwd_kin_plugins": "KDLFwdKinChain", "inv_kin_plugins": "KDLInvKinChainLMA"}
    lines = ["kinematic_plugins:", "  search_libraries: [tesseract_kinematics_kdl_factories]"]
    for kind, solver in solvers.items():
        lines += [f"  {kind}:", f"    {group}:", f"      default: {solver}", "      plugins:", f"        {solver}:"]
        lines += [f"          class: {solver}Factory", f"          {chain}"]
    return "\n".join(lines)


def joined(t: np.ndarray, q: np.ndarray, qd: np.ndarray) -> LineMotion:
    """Motion through samples of positions and velocities, by cubics."""
    spline = CubicHermiteSpline(t, q, qd)
    return LineMotion(t, lambda at: (spline(at), spline(at, 1)))
