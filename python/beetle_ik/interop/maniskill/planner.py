"""A planner with the calls of mplib."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from ..._core import InvalidInputError, Keep, Limits, Obstacle, time_optimal
from .articulation import Articulation
from .configurations import configurations
from .motions import along_screw, planned
from .poses import Array, matrix_of
from .results import Result
from .world import World
from .world_calls import WorldCalls

_REFUSED = {
    "pinocchio_model": "use planner.robot.arm_at(qpos), whose fk and jacobian take the joints of the move group",
    "planner": "use plan_qpos or plan_pose",
    "acm": "give an SRDF, or touch= of an obstacle",
}


class Planner(WorldCalls):
    """Plans motions of one robot among obstacles, with the calls and results of `mplib.Planner`.

    Args:
        urdf: the URDF file.
        move_group: link that poses are for, usually of the hand.
        srdf: pairs of links that are not tested against each other; None: the file beside the URDF if there is one,
            else pairs found by sampling.
        new_package_keyword: folder that stands for `package://`; empty: that of the file, and those above it.
        use_convex: taken, and without effect: meshes are tested as their convex hulls.
        user_link_names: links in the order of their numbers; empty: all.
        user_joint_names: all joints of `qpos`, in order, those of the gripper included; empty: all that move.
        joint_vel_limits: velocity limits of the joints that are planned (rad/s, m/s); None: 1.
        joint_acc_limits: acceleration limits of these (rad/s^2, m/s^2); None: 1.
        objects: objects of mplib, or pairs (name, obstacle).
        verbose: taken, and without effect.
        collision: treatment of collision shapes, as of `Robot.from_urdf`.

    Poses are those of mplib or SAPIEN, 7-vectors (x, y, z, qw, qx, qy, qz) or matrices. Configurations are of all
    joints, or of those of the move group.

    Raises:
        UrdfError: not a URDF.
        UnknownNameError: no link or joint of a name; the message lists them.
        InvalidInputError: a joint of the move group that is missing in `user_joint_names`; limits of a wrong length.
    """

    def __init__(
        self,
        urdf: str | os.PathLike[str],
        move_group: str,
        *,
        srdf: str | os.PathLike[str] | None = None,
        new_package_keyword: str = "",
        use_convex: bool = False,
        user_link_names: Sequence[str] = (),
        user_joint_names: Sequence[str] = (),
        joint_vel_limits: ArrayLike | None = None,
        joint_acc_limits: ArrayLike | None = None,
        objects: Sequence[Any] = (),
        verbose: bool = False,
        collision: Literal["primitives", "fit", "hulls"] | None = "hulls",
    ) -> None:
        """Loads the robot."""
        del use_convex, verbose
        self.urdf = urdf
        self.srdf = srdf or _beside(urdf)
        self.robot = Articulation(
            urdf,
            move_group,
            srdf=self.srdf,
            package_dir=new_package_keyword or None,
            joint_names=user_joint_names,
            link_names=user_link_names,
            collision=collision,
        )
        self.move_group = move_group
        self.user_joint_names, self.user_link_names = self.robot.joints.names, self.robot.link_names
        self.joint_name_2_idx = {name: i for i, name in enumerate(self.user_joint_names)}
        self.link_name_2_idx = {name: i for i, name in enumerate(self.user_link_names)}
        self.move_group_link_id = self.link_name_2_idx.get(move_group, -1)
        self.move_group_joint_indices = self.robot.joints.at
        self.joint_limits = self.robot.joint_limits
        self.joint_vel_limits = _rates("joint_vel_limits", joint_vel_limits, len(self.robot.joints.at))
        self.joint_acc_limits = _rates("joint_acc_limits", joint_acc_limits, len(self.robot.joints.at))
        self.planning_world = World(self.robot, list(objects))

    def __getattr__(self, name: str) -> NoReturn:
        """Says what stands in for parts of mplib that are not here."""
        hint = f": {_REFUSED[name]}" if name in _REFUSED else ""
        raise AttributeError(f"the Planner of beetle_ik has no '{name}'{hint}", name=name, obj=self)

    def plan_pose(
        self,
        goal_pose: Any,
        current_qpos: ArrayLike,
        mask: ArrayLike | None = None,
        *,
        time_step: float = 0.1,
        rrt_range: float = 0.1,
        planning_time: float = 1.0,
        fix_joint_limits: bool = True,
        wrt_world: bool = True,
        simplify: bool = True,
        constraint_function: Any = None,
        constraint_jacobian: Any = None,
        constraint_tolerance: float = 1e-3,
        verbose: bool = False,
        use_point_cloud: bool = True,
        use_attach: bool = True,
        keep: Keep | Sequence[Keep] | None = None,
    ) -> Result:
        """Plans a motion from joint positions to a pose of the move group, clear of everything.

        Args:
            goal_pose: the pose.
            current_qpos: joint positions at the start, of all joints or of the move group.
            mask: True for each joint that the goal may not use: it ends where it starts.
            time_step: time between two rows of the result (s).
            rrt_range: as `planning_time`.
            planning_time: taken, and without effect: a plan takes milliseconds, and a search ends by its own budget.
            fix_joint_limits: whether positions outside their limits are first moved to the limits.
            wrt_world: whether the pose is in the frame of the world, not of the base.
            simplify: taken, and without effect: paths are always shortened.
            constraint_function: refused: give `keep`.
            constraint_jacobian: refused: give `keep`.
            constraint_tolerance: as `simplify`, without a constraint.
            verbose: taken, and without effect.
            use_point_cloud: whether obstacles count.
            use_attach: whether carried objects count.
            keep: what holds at every instant, such as `beetle_ik.upright(robot, tilt=0.1)` of
                `planner.robot.arm_at(qpos)`.

        Returns:
            A dict: "status" is "Success", or says what failed; then "time" (k,) (s), "position", "velocity" and
            "acceleration" (k, n) of the move group, "duration" (s), and "plan", the `Plan`.

        Raises:
            InvalidInputError: wrong shape, NaN, no pose, or a constraint function.
        """
        del rrt_range, planning_time, simplify, constraint_tolerance, verbose
        self._refuse_constraint(constraint_function, constraint_jacobian)
        qpos = self._start(current_qpos, fix_joint_limits)
        target = self._in_world(goal_pose, wrt_world)
        around = self._around(use_point_cloud)
        if mask is not None and np.any(mask):
            status, goals = self._goals(target, qpos, mask, 20, 1e-3, around)
            return (
                {"status": status}
                if goals is None
                else self._plan(qpos, {"end_q": self._arm(goals)}, time_step, around, use_attach, keep)
            )
        result = self._plan(qpos, {"end": target}, time_step, around, use_attach, keep)
        if result["status"] != "Success":
            status, _ = self._goals(target, qpos, None, 20, 1e-3, around)
            return result if status == "Success" else {"status": status}
        return result

    def plan_qpos(
        self,
        goal_qposes: Sequence[ArrayLike],
        current_qpos: ArrayLike,
        *,
        time_step: float = 0.1,
        rrt_range: float = 0.1,
        planning_time: float = 1.0,
        fix_joint_limits: bool = True,
        fixed_joint_indices: Sequence[int] | None = None,
        simplify: bool = True,
        constraint_function: Any = None,
        constraint_jacobian: Any = None,
        constraint_tolerance: float = 1e-3,
        verbose: bool = False,
        use_point_cloud: bool = True,
        use_attach: bool = True,
        keep: Keep | Sequence[Keep] | None = None,
    ) -> Result:
        """Plans a motion from joint positions to the nearest of several, clear of everything.

        Args:
            goal_qposes: joint positions, of which one is to be reached.
            current_qpos: as of `plan_pose`, and so are all others but one.
            time_step: time between two rows of the result (s).
            rrt_range: taken, and without effect.
            planning_time: taken, and without effect.
            fix_joint_limits: whether positions outside their limits are first moved to the limits.
            fixed_joint_indices: joints of `qpos` that stay where they are.
            simplify: taken, and without effect.
            constraint_function: refused: give `keep`.
            constraint_jacobian: refused: give `keep`.
            constraint_tolerance: taken, and without effect.
            verbose: taken, and without effect.
            use_point_cloud: whether obstacles count.
            use_attach: whether carried objects count.
            keep: what holds at every instant.

        Returns:
            A dict, as of `plan_pose`.

        Raises:
            InvalidInputError: wrong shape, NaN, no goal, or a constraint function.
        """
        del rrt_range, planning_time, simplify, constraint_tolerance, verbose
        self._refuse_constraint(constraint_function, constraint_jacobian)
        qpos = self._start(current_qpos, fix_joint_limits)
        given: list[Any] = list(goal_qposes)
        if not given:
            raise InvalidInputError("goal_qposes: at least one is needed, got none")
        several = given if np.ndim(given[0]) > 0 else [given]
        goals = np.array([self.robot.full("goal_qposes", goal) for goal in several])
        fixed = [] if fixed_joint_indices is None else [int(i) for i in fixed_joint_indices]
        goals[:, fixed] = qpos[fixed]
        around = self._around(use_point_cloud)
        return self._plan(qpos, {"end_q": self._arm(goals)}, time_step, around, use_attach, keep, fixed)

    plan_qpos_to_pose = plan_pose  # the names of mplib 0.1, which ManiSkill uses
    plan_qpos_to_qpos = plan_qpos

    def plan_screw(
        self,
        goal_pose: Any,
        current_qpos: ArrayLike,
        *,
        qpos_step: float = 0.1,
        time_step: float = 0.1,
        wrt_world: bool = True,
        verbose: bool = False,
        use_point_cloud: bool = True,
        use_attach: bool = True,
    ) -> Result:
        """Moves the move group to a pose along a screw: straight, and turning uniformly about one axis.

        The motion goes around nothing: it fails where something is in the way, or a joint meets its limit. It is
        tested for collisions every 1 cm and 0.03 rad of the screw.

        Args:
            goal_pose: the pose.
            current_qpos: joint positions at the start.
            qpos_step: taken, and without effect.
            time_step: time between two rows of the result (s).
            wrt_world: whether the pose is in the frame of the world, not of the base.
            verbose: taken, and without effect.
            use_point_cloud: whether obstacles count.
            use_attach: whether carried objects count.

        Returns:
            A dict, as of `plan_pose`, without "plan".

        Raises:
            InvalidInputError: wrong shape, NaN, or no pose.
        """
        del qpos_step, verbose
        qpos = self._start(current_qpos, True)
        robot, q = self.robot.arm_at(qpos, attached=use_attach), qpos[self.robot.joints.at]
        goal, obstacles = self._in_world(goal_pose, wrt_world), self._around(use_point_cloud)
        return along_screw(robot, q, goal, self._limits(), obstacles, time_step, self.planning_world.named)

    def IK(  # noqa: N802 -- the name of mplib
        self,
        goal_pose: Any,
        start_qpos: ArrayLike,
        mask: ArrayLike | None = None,
        *,
        n_init_qpos: int = 20,
        threshold: float = 1e-3,
        return_closest: bool = False,
        verbose: bool = False,
    ) -> tuple[str, Any]:
        """Returns ("Success", configurations of all joints) for a pose in the frame of the base, clear of everything.

        Args:
            goal_pose: the pose, in the frame of the base.
            start_qpos: joint positions; the configurations are sorted by their distance from it.
            mask: True for each joint that stays where it is.
            n_init_qpos: for a redundant arm, number of values of its parameter; with a mask, number of starts.
            threshold: largest error (m, rad).
            return_closest: whether to return only the nearest, as an array.
            verbose: taken, and without effect.

        Returns:
            (status, list of configurations), or (reason, None).

        Raises:
            InvalidInputError: wrong shape, NaN, or no pose.
        """
        del verbose
        qpos = self._start(start_qpos, True)
        target = self._in_world(goal_pose, False)
        status, goals = self._goals(target, qpos, mask, n_init_qpos, threshold, self._around(True))
        return status, goals if goals is None or not return_closest else goals[0]

    def TOPP(  # noqa: N802
        self, path: ArrayLike, step: float = 0.1, verbose: bool = False
    ) -> tuple[Array, Array, Array, Array, float]:
        """Times a path (k, n) of the move group as fast as the limits allow.

        Args:
            path: waypoints, through which a spline is laid.
            step: time between two rows of the result (s).
            verbose: taken, and without effect.

        Returns:
            (times (m,), positions (m, n), velocities, accelerations, duration (s)).

        Raises:
            InvalidInputError: wrong shape, NaN, or fewer than two waypoints that differ.
        """
        del verbose
        motion = time_optimal(path, self._limits())
        return (*motion.sample(step), motion.duration)

    def _plan(
        self,
        qpos: Array,
        end: dict[str, Array],
        time_step: float,
        obstacles: list[Obstacle] | None,
        attached: bool,
        keep: Any,
        fixed: Sequence[int] = (),
    ) -> Result:
        """Plans to a pose, "end", or to the nearest of configurations of the move group, "end_q"."""
        robot, q = self.robot.arm_at(qpos, attached=attached), qpos[self.robot.joints.at]
        limits, named = self._limits(q, fixed), self.planning_world.named
        return planned(robot, q, end, limits, obstacles, keep, time_step, named)

    def _goals(
        self,
        target: Array,
        qpos: Array,
        mask: ArrayLike | None,
        count: int,
        threshold: float,
        obstacles: list[Obstacle] | None,
    ) -> tuple[str, list[Array] | None]:
        """Returns configurations of all joints for a pose in the world, nearest first."""
        robot, q = self.robot.arm_at(qpos), qpos[self.robot.joints.at]
        held = None if mask is None or not np.any(mask) else np.asarray(mask, dtype=bool)[self.robot.joints.at]
        found, message = configurations(
            robot,
            target,
            q,
            held,
            count=count,
            tolerance=threshold / 2.0,
            obstacles=obstacles,
        )
        if not found:
            return f"IK Failed! {self.planning_world.named(message)}", None
        return "Success", [self._with_arm(qpos, one) for one in found]

    def _limits(self, q: Array | None = None, fixed: Sequence[int] = ()) -> Limits:
        lower = upper = None
        if q is not None and len(fixed):
            held = np.isin(self.robot.joints.at, fixed)
            lower, upper = (np.where(held, q, bound) for bound in self.joint_limits[self.robot.joints.at].T)
        return Limits(lower=lower, upper=upper, velocity=self.joint_vel_limits, acceleration=self.joint_acc_limits)

    def _start(self, qpos: ArrayLike, clip: bool) -> Array:
        full = self.robot.full("current_qpos", qpos)
        return np.clip(full, *self.joint_limits.T) if clip else full

    def _in_world(self, pose: Any, wrt_world: bool) -> Array:
        matrix = matrix_of("goal_pose", pose)
        return matrix if wrt_world else self.robot.get_base_pose().to_transformation_matrix() @ matrix

    def _arm(self, goals: Any) -> Array:
        return np.array(goals)[:, self.robot.joints.at]

    def _with_arm(self, qpos: Array, q: Array) -> Array:
        full = qpos.copy()
        full[self.robot.joints.at] = q
        return full

    @staticmethod
    def _refuse_constraint(*functions: Any) -> None:
        if any(function is not None for function in functions):
            raise InvalidInputError(
                "constraint_function: functions of one's own are not taken; give keep=, "
                "such as beetle_ik.upright(robot, tilt=0.1)"
            )


def _beside(urdf: str | os.PathLike[str]) -> Path | None:
    """Returns the SRDF beside a URDF file, if there is one."""
    if isinstance(urdf, str) and "<" in urdf:
        return None
    file = Path(urdf)
    found = (file.with_suffix(".srdf"), file.with_name(f"{file.stem}_mplib.srdf"))
    return next((one for one in found if one.is_file()), None)


def _rates(name: str, values: ArrayLike | None, count: int) -> Array:
    rates = np.ones(count) if values is None or np.size(values) == 0 else np.array(values, dtype=float)
    if rates.shape != (count,):
        raise InvalidInputError(f"{name}: expected {count}, one per joint of the move group, got shape {rates.shape}")
    return rates
