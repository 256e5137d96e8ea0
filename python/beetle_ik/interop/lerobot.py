"""Kinematics for LeRobot: the calls of `lerobot.model.kinematics.RobotKinematics`, in degrees, and streams of poses.

    from beetle_ik.interop.lerobot import RobotKinematics

LeRobot and placo need not be installed.
"""

import os
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import tasks
from .._core import InvalidInputError, Limits, Robot, Solution, Status, Step, Tracker, solve
from .joint_entries import JointEntries
from .urdf_joints import moving_joints

Array: TypeAlias = NDArray[np.float64]
_FIRST = 10.0  # ratio of the weights from which one part of the pose comes first
_SETTLED = 1e-8  # rad, m: a step that moves no joint farther is the last
_STEPS = 20
_SAME_PLACE = 1e-2  # rad, m: largest difference of a joint between two results that count as one
_STEP_OF_A_STREAM = 0.2  # rad, m: after shorter motions no configuration elsewhere is sought if the leading part is met
_MUCH_NEARER = (1e-3, 0.5)  # m, rad: what a configuration elsewhere must gain
_GENTLE_SPEED, _GENTLE_ACCELERATION = 180.0, 720.0  # deg/s, deg/s^2: within what servos of hobby arms can do


class RobotKinematics:
    """Forward and inverse kinematics of one frame of a robot, in degrees, as LeRobot calls them.

    Args:
        urdf_path: a URDF file, or its text.
        target_frame_name: the link that is brought to a pose.
        joint_names: the joints of every array, in its order; None: the joints that move the frame, then the others.
            Joints that do not move the frame, such as a gripper's, are passed through, and so are entries beyond these.

    Joints that turn are in degrees, joints that slide in m.

    Raises:
        UrdfError: the file is not a URDF.
        UnknownNameError: no link of that name, or no joint of a name; the message lists them.
        InvalidInputError: a joint that moves the frame is missing in `joint_names`, or a name is there twice.
    """

    def __init__(
        self,
        urdf_path: str | os.PathLike[str],
        target_frame_name: str = "gripper_frame_link",
        joint_names: Sequence[str] | None = None,
    ) -> None:
        """Loads the robot."""
        self.robot = Robot.from_urdf(urdf_path, tip=target_frame_name, collision=None)
        self.target_frame_name = target_frame_name
        joints = moving_joints(urdf_path)
        beside = [joint for joint in joints if joint not in self.robot.joint_names]
        names = [*self.robot.joint_names, *beside] if joint_names is None else joint_names
        self._entries = JointEntries(self.robot, joints, names, argument="joint_names", degrees=True)
        self.joint_names = self._entries.names
        self.result: Solution | Step | None = None
        """Result of the last `inverse_kinematics`, with `success`, `status`, `message`, `position_error` (m) and
        `rotation_error` (rad); None before the first call."""
        self._given: tuple[object, object] = (None, None)  # weights, as they were given last

    def forward_kinematics(self, joint_pos_deg: ArrayLike) -> Array:
        """Returns the pose (4, 4) of the frame in the frame of the robot's root (m).

        Args:
            joint_pos_deg: joint positions in the order of `joint_names`; further entries are ignored.

        Raises:
            InvalidInputError: fewer entries than joints, or NaN.
        """
        return self.robot.fk(self._entries.q("joint_pos_deg", joint_pos_deg))

    def inverse_kinematics(
        self,
        current_joint_pos: ArrayLike,
        desired_ee_pose: ArrayLike,
        position_weight: float = 1.0,
        orientation_weight: float = 0.01,
    ) -> Array:
        """Returns joint positions inside the limits that bring the frame to a pose, or as near as possible.

        A pose out of reach is no error: the nearest configuration is returned, and `result` says so. The search
        begins at `current_joint_pos` and stays nearby. A configuration elsewhere is taken only if it meets the pose
        and the one nearby does not, or comes nearer by 1 mm or 0.5 rad; never after a motion of less than 0.2 rad
        that has met the leading part of the pose.

        Args:
            current_joint_pos: the present joint positions, with those of the gripper, which are returned as they are.
            desired_ee_pose: pose (4, 4) of the frame (m).
            position_weight: weight of the squared distance (m). Weights count where the whole pose cannot be met, as
                with five joints: a part whose weight is at least ten times the other's, as by default, is met
                exactly, and the other as near as that allows; in between, the weighted sum of squared errors is
                least. 0 leaves the position free.
            orientation_weight: weight of the squared angle (rad), likewise; 0 leaves the orientation free.

        Raises:
            InvalidInputError: fewer entries than joints, NaN, a matrix that is no pose, a negative weight, or two
                weights of zero.
        """
        start = self._entries.inside("current_joint_pos", current_joint_pos)
        if (position_weight, orientation_weight) != self._given:
            self._weigh(position_weight, orientation_weight, start)
        near = self._nearby(start, desired_ee_pose)
        self.result = result = near if _suffices(near, start) else self._better(near, desired_ee_pose)
        return self._entries.placed(result.q, current_joint_pos)

    def tracker(
        self,
        current_joint_pos: ArrayLike,
        *,
        dt: float,
        velocity: ArrayLike | None = None,
        acceleration: ArrayLike | None = _GENTLE_ACCELERATION,
        jerk: ArrayLike | None = None,
        position_weight: float = 1.0,
        orientation_weight: float = 0.01,
        timeout: float | None = None,
    ) -> "PoseTracker":
        """Returns a tracker of a stream of poses: commands inside all limits, from which the arm can stop at any time.

        Args:
            current_joint_pos: joint positions at the start, in the order of `joint_names`.
            dt: time from one command to the next (s).
            velocity: velocity limits (deg/s; m/s), a number or one per joint that moves the frame; None: those of the
                file, at most 180 deg/s.
            acceleration: acceleration limits (deg/s^2; m/s^2), likewise; None: none.
            jerk: jerk limits (deg/s^3; m/s^3), likewise; None: none.
            position_weight: as for `inverse_kinematics`.
            orientation_weight: as for `inverse_kinematics`.
            timeout: time without a pose after which the arm stops (s); None: it follows the motion of the last poses
                for two of their intervals, and then stops.

        Raises:
            InvalidInputError: fewer entries than joints, NaN, limits of a wrong length, or a weight that is negative.
            LimitError: a joint that starts more than 5 degrees (5 mm) outside its position limits.
        """
        limit = self._entries.limit
        gentle = np.minimum(self.robot.velocity_limit, self._entries.most(_GENTLE_SPEED))
        tracker = Tracker(
            self.robot,
            self._entries.q("current_joint_pos", current_joint_pos),
            dt=dt,
            task=_task(*_checked(position_weight, orientation_weight)),
            limits=Limits(
                velocity=gentle if velocity is None else limit("velocity", velocity),
                acceleration=None if acceleration is None else limit("acceleration", acceleration),
                jerk=None if jerk is None else limit("jerk", jerk),
            ),
            timeout=timeout,
        )
        return PoseTracker(tracker, self._entries, self._entries.read("current_joint_pos", current_joint_pos))

    def _weigh(self, position: float, orientation: float, q: Array) -> None:
        """Makes the tracker that descends, by ticks without velocity limits."""
        self._weights = _checked(position, orientation)
        self._task = _task(*self._weights)
        unlimited = Limits(velocity=np.inf)
        self._local = Tracker(self.robot, q, dt=1.0, task=self._task, limits=unlimited, recover=False)
        self._given = (position, orientation)

    def _nearby(self, q: Array, target: ArrayLike) -> Step:
        """Descends from q."""
        self._local.reset(q)
        for _ in range(_STEPS):
            step = self._local.step(target)
            if _suffices(step, q) or _largest(step.qd) < _SETTLED:
                break
        return step

    def _better(self, near: Step, target: ArrayLike) -> Solution | Step:
        """Returns the solution of a search where that is much nearer to the target, or at the same place."""
        found = solve(self.robot, target, task=self._task, start_q=near.q)
        if found.success or np.abs(found.q - near.q).max() < _SAME_PLACE:
            return found
        gains = np.array([near.position_error - found.position_error, near.rotation_error - found.rotation_error])
        leading, other = np.nan_to_num(gains / _MUCH_NEARER)[:: 1 if self._weights[0] >= self._weights[1] else -1]
        return found if leading > 1.0 or (leading > -1.0 and other > 1.0) else near


class PoseTracker:
    """A stream of poses as a stream of commands in degrees; made by `RobotKinematics.tracker`."""

    def __init__(self, tracker: Tracker, entries: JointEntries, start: Array) -> None:
        """Wraps a tracker at its start."""
        self.tracker = tracker
        self._entries = entries
        self._last = start
        self.result: Step | None = None
        """Result of the last step, with `success`, `status` and `message`; None before the first."""

    def step(
        self,
        desired_ee_pose: ArrayLike | None,
        current_joint_pos: ArrayLike | None = None,
        *,
        stamp: float | None = None,
    ) -> Array:
        """Returns the joint positions to command at the end of this tick.

        Args:
            desired_ee_pose: pose (4, 4) of the frame (m); None: no new pose in this tick.
            current_joint_pos: entries to pass through, such as that of the gripper; those of joints that move the frame
                are not read. None: those of the last call.
            stamp: time at which the pose was measured (s), on the clock `time`; None: the end of the tick.

        Raises:
            InvalidInputError: fewer entries than joints, NaN, or a matrix that is no pose; nothing has then changed.
        """
        entries = (
            self._last if current_joint_pos is None else self._entries.read("current_joint_pos", current_joint_pos)
        )
        self.result = self.tracker.step(desired_ee_pose, stamp=stamp)
        self._last = self._entries.placed(self.result.q, entries)
        return self._last.copy()

    def stop(self) -> float:
        """Begins the fastest stop, and returns its duration (s); each following `step(None)` is a tick of it."""
        return self.tracker.stop()

    def reset(self, current_joint_pos: ArrayLike) -> None:
        """Begins again at these joint positions, at rest."""
        self.tracker.reset(self._entries.q("current_joint_pos", current_joint_pos))
        self._last = self._entries.read("current_joint_pos", current_joint_pos)

    @property
    def time(self) -> float:
        """Time of the last command (s)."""
        return self.tracker.time


def _suffices(step: Step, start: Array) -> bool:
    """Whether a step met the pose, or its leading part by a motion as short as those of a stream."""
    if step.success:
        return True
    given_up = step.status in (Status.ROTATION_GIVEN_UP, Status.POSITION_GIVEN_UP)
    return given_up and _largest(step.q - start) < _STEP_OF_A_STREAM


def _largest(values: Array) -> float:
    return float(np.abs(values).max())


def _checked(position_weight: float, orientation_weight: float) -> tuple[float, float]:
    for name, weight in (("position_weight", position_weight), ("orientation_weight", orientation_weight)):
        if not (isinstance(weight, float | int | np.number) and 0.0 <= weight < np.inf):
            raise InvalidInputError(f"{name} must be a number, zero or more, got {weight!r:.60}")
    if position_weight == orientation_weight == 0:
        raise InvalidInputError("position_weight and orientation_weight are both 0: nothing is left to reach")
    return float(position_weight), float(orientation_weight)


def _task(position: float, orientation: float) -> tasks.Task:
    """Returns the task of two weights."""
    if orientation == 0.0:
        return tasks.Position()
    if position == 0.0:
        return tasks.Orientation()
    if max(position, orientation) >= _FIRST * min(position, orientation):
        return tasks.Pose(first="position" if position > orientation else "orientation")
    # Weights of a task multiply the errors, not their squares; only their ratio counts, but weights of 1 count as none.
    return tasks.Pose(weights=np.sqrt(np.repeat([0.5, 0.5 * orientation / position], 3)))
