"""The state that a viewer shows, without drawing and threads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from .. import tasks
from .._core import Limits, Obstacle, Robot, Solution, Status, Step, Stop, Tracker, clearance, nearest, solve

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .._core import Nearest, Task

    Array = NDArray[np.float64]
    Targets = dict[str, Array]

Follow = Literal["track", "solve", "off"]
Part = Literal["pose", "position", "pointing"]
FOLLOWS: tuple[Follow, ...] = get_args(Follow)
PARTS: tuple[Part, ...] = get_args(Part)

DT = 1.0 / 60.0  # s: one tick
QUICKLY = Stop(max_time=0.1)  # the viewer ends within this time
_MARGIN = 1e-3  # m: margin of the solvers
_REACHED: dict[str, Any] = {"position_tolerance": 1e-4, "rotation_tolerance": 1e-3}  # m, rad: visible differences
_ACCELERATION = 20.0  # rad/s^2, m/s^2: reaches full speed within about a tenth of a second
_STILL = 1e-3  # rad, m: an arm that moves less within `_PAUSE` has arrived,
_HUNTING = 0.05  # rad, m: and so has an arm that moves less than this and gains less than
_NEARER = 1e-4  # m, rad: towards its target
_PAUSE = 30  # ticks


class Arm:
    """A robot, its configuration, targets of its tips, obstacles around it, and the mode of following the targets.

    Attributes:
        q: the configuration (n,). Set it by `put`.
        outcome: the last `Step` or `Solution` on the way to the target; None after `put`.
        rates: velocities and accelerations (n,) of the motion that is shown; empty at rest.
        moves: whether the arm is moving to the target.
        stays: whether the arm stays in place because the last solution would collide.
    """

    def __init__(self, robot: Robot, q: Array, obstacles: list[Obstacle]) -> None:
        """Starts at rest at `q` (n,)."""
        self.robot = robot
        self.q = q
        self.outcome: Step | Solution | None = None
        self.rates: tuple[Array, ...] = ()
        self.moves = self.stays = False
        self._targets = self.tips_at(q)
        self._obstacles = obstacles
        self._follow: Follow = "track"
        self._part: Part = "pose" if robot.dof >= 6 * len(robot.tips) else "position"
        self._keeps_clear = True
        self._tracker: Tracker | None = None
        self._escapes = False
        self._anchor, self._error, self._ticks, self._tries_again = q, np.inf, 0, True

    def tips_at(self, q: Array) -> Targets:
        """Returns the pose (4, 4) of each tip at `q` (n,), by its name."""
        return dict(zip(self.robot.tips, self.robot.fk(q).reshape(-1, 4, 4), strict=True))

    @property
    def targets(self) -> Targets:
        """Target pose (4, 4) of each tip, by its name; a new dict after each change."""
        return self._targets

    @targets.setter
    def targets(self, targets: Targets) -> None:
        self._targets = targets
        self._set_off()

    def aim(self, tip: str, target: Array) -> None:
        """Gives one tip another target (4, 4)."""
        self.targets = self._targets | {tip: target}

    @property
    def obstacles(self) -> list[Obstacle]:
        """The obstacles, in the frame of the robot's base."""
        return self._obstacles

    @obstacles.setter
    def obstacles(self, obstacles: list[Obstacle]) -> None:
        self._obstacles = obstacles
        self._set_off()
        if self._tracker is not None:
            self._tracker.obstacles = self.avoided

    @property
    def follow(self) -> Follow:
        """Mode of following the target."""
        return self._follow

    @follow.setter
    def follow(self, follow: Follow) -> None:
        self._follow = follow
        self._restart()

    @property
    def part(self) -> Part:
        """The part of the target that counts."""
        return self._part

    @part.setter
    def part(self, part: Part) -> None:
        self._part = part
        self._restart()

    @property
    def keeps_clear(self) -> bool:
        """Whether the arm keeps clear of the obstacles and of itself."""
        return self._keeps_clear

    @keeps_clear.setter
    def keeps_clear(self, keeps_clear: bool) -> None:
        self._keeps_clear = keeps_clear
        self._restart()

    @property
    def goal(self) -> Any:
        """Target for the solvers: for each tip a position (3,) if the orientation is free, otherwise a pose (4, 4).

        For a single tip it is not a dict.
        """
        goals = {tip: each[:3, 3] if self._part == "position" else each for tip, each in self._targets.items()}
        return goals if len(goals) > 1 else goals[self.robot.tips[0]]

    @property
    def task(self) -> Task | None:
        """Task that belongs to `goal`."""
        return tasks.Pointing() if self._part == "pointing" else None

    @property
    def inside(self) -> Array:
        """Configuration clipped to the limits, where solvers start; a motion that was shown may have left them."""
        return self.robot.clip(self.q)

    @property
    def nearest(self) -> Nearest | None:
        """The nearest two bodies, whether the arm keeps clear of them or not."""
        return nearest(self.robot, self.q, self._obstacles)

    def put(self, q: Array, *rates: Array) -> None:
        """Puts the arm at `q` (n,), to rest there, or as part of a motion with these velocities and accelerations (n,).

        Targets move along with the tips, if the arm follows them.
        """
        self.q, self.rates, self.outcome = q, rates, None
        if self._follow != "off":
            self._targets = self.tips_at(q)
        self._tracker, self.moves = None, False

    def advance(self) -> bool:
        """Moves towards the target for one tick, unless the arm was put somewhere; returns whether it still moves."""
        if not self.moves:
            return False
        if self._follow == "solve":
            self.solve()
            return False
        # A new tracker begins at rest, whatever motion was shown before.
        before = self.rates[0] if self.rates and self._tracker is not None else np.zeros(self.robot.dof)
        self.outcome = self._track()
        self.q, velocity = self.outcome.q, self.outcome.qd
        self.rates = (velocity, (velocity - before) / DT)
        moved, error = np.abs(self.q - self._anchor).max(), _error(self.outcome)
        if moved > _HUNTING or (moved > _STILL and error < self._error - _NEARER):
            self._anchor, self._error, self._ticks = self.q, error, 0
        self._ticks += 1
        if self._ticks == _PAUSE:
            if self._tries_again and not self.outcome.success:
                # Starts a new tracker: the old one takes a shaky hand for noise and averages, the new one sees the hand
                # at rest.
                self._tracker, self._tries_again, self._ticks = None, False, 0
            else:
                self.moves, self.rates = False, ()
        return self.moves

    def solve(self) -> None:
        """Puts the arm at a solution, or as near to the target as it gets, unless it would collide there."""
        found = solve(self.robot, self.goal, task=self.task, start_q=self.inside, obstacles=self.avoided, stop=QUICKLY)
        self.outcome, self.rates = found, ()
        self._tracker, self.moves = None, False
        # Tests the solution: a target out of reach is approached regardless of obstacles.
        self.stays = self._keeps_clear and clearance(self.robot, found.q, self._obstacles) < _MARGIN
        if not self.stays:
            self.q = found.q

    @property
    def avoided(self) -> list[Obstacle] | None:
        """Obstacles for the solvers."""
        return self._obstacles if self._keeps_clear else None

    def _track(self) -> Step:
        """Returns a step of the tracker.

        Under acceleration limits an arm follows smoothly and comes to rest beside an obstacle; without them it moves
        out of an obstacle that was moved into it.
        """
        if self._tracker is None:
            limits = None if self._escapes else Limits(acceleration=_ACCELERATION)
            self._tracker = Tracker(
                self.robot, self.inside, dt=DT, task=self.task, obstacles=self.avoided, limits=limits, **_REACHED
            )
        step = self._tracker.step(self.goal)
        touches = step.status is Status.IN_COLLISION
        if touches != self._escapes:
            self._escapes, self._tracker = touches, None
        return step

    def _restart(self) -> None:
        self._tracker = None
        self._set_off()

    def _set_off(self) -> None:
        self.moves = self._follow != "off"
        if not self.moves:
            self.outcome, self.rates = None, ()
        self._anchor, self._error, self._ticks, self._tries_again = self.q, np.inf, 0, True


def _error(step: Step) -> float:
    """Returns the distance from the target (m, rad)."""
    return step.position_error + float(np.nan_to_num(step.rotation_error))
