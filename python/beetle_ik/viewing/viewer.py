"""The viewer as Python sees it."""

from __future__ import annotations

import atexit
import html
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, Self

from .._core import BeetleIkError, InvalidInputError, Obstacle, Robot
from ..calls.arguments import require
from ..installed.needs import library
from ..scenes import Scene, obstacles_for
from . import start
from .address import free_port
from .admission import Admission
from .arm import FOLLOWS, Arm
from .checks import configuration, inside_limits, path_points, target_poses
from .looks import drawn_looks, looks
from .page import Page
from .parts import Parts
from .recording import recording_file, take, write_recording
from .served import serve, stop
from .turns import Turns

if TYPE_CHECKING:
    import os

    import numpy as np
    import viser
    from numpy.typing import ArrayLike, NDArray

    from .._core import ModelFreeResult, Path, Plan, SelfMotion, Solution, SolutionSet, Step, TrackResult, Trajectory
    from ..mapping import ReachabilityMap
    from .arm import Follow

    Array = NDArray[np.float64]
    Shown = Trajectory | Plan | TrackResult | ModelFreeResult | Solution | SolutionSet | SelfMotion | ReachabilityMap

_NOTEBOOK_HEIGHT = 600  # pixels
_WAKE = 0.1  # s: interval of checks for Ctrl-C, which does not wake a waiting thread on Windows


class Viewer:
    """A page that shows a robot, made by `view`. The page and Python change the same state.

    It can be used from any thread, and as a context manager that closes it.

    Attributes:
        robot: the robot with the bodies and velocity limits that the viewer added.
        server: the server of viser, which takes further controls and shapes.
        url: the address of the page, with its token if other machines reach it.
    """

    def __init__(
        self,
        robot: Robot,
        q: ArrayLike | None,
        *,
        obstacles: Iterable[Obstacle] | None,
        path: Path | ArrayLike | None,
        host: str,
        port: int,
    ) -> None:
        """Serves the page; `view` describes the arguments."""
        require("robot", robot, Robot)
        seen, missing = looks(robot)
        self.robot, notes = start.shown(robot, has_meshes=bool(seen))
        if not seen:
            seen = drawn_looks(self.robot, start.middle(robot))
            notes += ["no meshes in the model: the arm is drawn along its joints"] if seen else []
        scene = obstacles_for(robot, () if obstacles is None else obstacles)
        begin = start.configuration(self.robot, scene) if q is None else inside_limits(self.robot, q)
        line = None if path is None else path_points(path)
        library("viser", "viser", "the viewer", extra="view")
        port, admission = free_port(host, port), Admission(host)
        self.server: viser.ViserServer = serve(host, port, robot.name, admission)
        self.url = admission.address(host, port)
        print(f"{'Viewer' if admission.token is None else 'Viewer, which other machines reach'}: {self.url}")
        self._arm = Arm(self.robot, begin, scene)
        self._turns = Turns(self.robot.name, self._arm)
        self._records = False
        try:
            page = Page(self.server, self._arm, self._turns.ask, start.length(self.robot))
            self._parts = Parts(page, seen, [*missing, *notes])
            if line is not None:
                self._parts.draw_path(line)
            self._turns.start(self._parts)
        except BaseException:  # Ctrl-C too
            stop(self.server)
            raise
        atexit.register(self.close)

    @property
    def q(self) -> Array:
        """The configuration shown (n,) (rad, m). Setting it puts the arm there at rest.

        The handle moves along, unless `follow` is "off".

        Raises:
            InvalidInputError: wrong shape or NaN.
            LimitError: a configuration outside the limits, unless `follow` is "off".
        """
        return self._arm.q

    @q.setter
    def q(self, q: ArrayLike) -> None:
        checked = configuration(self.robot, q) if self._arm.follow == "off" else inside_limits(self.robot, q)
        with self._turns.between():
            self._arm.put(checked)

    @property
    def target(self) -> Any:
        """The pose (4, 4) of the handle, which the arm follows. Setting a position (3,) (m) keeps the orientation.

        For a robot with several tips it is a dict from tips to poses; tips left out when it is set keep their targets.
        """
        targets = self._arm.targets
        return dict(targets) if len(targets) > 1 else targets[self.robot.tips[0]]

    @target.setter
    def target(self, target: ArrayLike | Mapping[str, ArrayLike]) -> None:
        checked = target_poses(target, self._arm.targets)
        with self._turns.between():
            self._arm.targets = checked

    @property
    def obstacles(self) -> Scene:
        """The obstacles, including those added or moved on the page."""
        return Scene(self._arm.obstacles)

    @obstacles.setter
    def obstacles(self, obstacles: Iterable[Obstacle]) -> None:
        scene = obstacles_for(self.robot, obstacles)
        with self._turns.between():
            self._arm.obstacles = scene

    @property
    def follow(self) -> Follow:
        """Mode of following the handle: "track", "solve" or "off".

        "track": as `Tracker` does. "solve": by `solve`, at once. "off": not at all; the arm moves when `q` is set, and
        the handle stays in place.
        """
        return self._arm.follow

    @follow.setter
    def follow(self, follow: Follow) -> None:
        if follow not in FOLLOWS:
            known = ", ".join(map(repr, FOLLOWS))
            raise InvalidInputError(f"follow must be one of {known}, got {follow!r:.60}")
        with self._turns.between():
            self._arm.follow = follow

    @property
    def outcome(self) -> Step | Solution | None:
        """The last `Step` or `Solution` on the way to the target; None after the arm was put somewhere."""
        return self._arm.outcome

    @property
    def moves(self) -> bool:
        """Whether the arm is moving to its target, or a motion is played back."""
        return self._turns.moves

    def show(self, result: Shown) -> None:
        """Shows a result: plays a motion, puts the arm at a solution, shows several as ghosts, or a slice of a map.

        A `Plan` brings its obstacles along, unless it has none. A map is blue where few orientations are reached, and
        orange where all are.

        Args:
            result: a `Trajectory`, `Plan`, `TrackResult`, `ModelFreeResult`, `Solution`, `SolutionSet`, `SelfMotion` or
                `ReachabilityMap`.

        Raises:
            InvalidInputError: another type, or the result of a robot with another number of joints.
        """
        with self._turns.between():
            self._parts.show(result)

    def to_python(self) -> str:
        """Returns a program that recreates the state of the page, like its button "Copy as Python".

        It makes the robot (a built-in one, otherwise a placeholder for yours), the configuration, the target and the
        obstacles, and plans from the configuration to the target. After a plan made on the page, it uses the start of
        that plan.
        """
        with self._turns.lock:
            return self._parts.program.text()

    def record(self, file: str | os.PathLike[str], frames: Iterable[float] | None = None) -> None:
        """Writes the scene and its motion to a file that plays and turns in any browser, without a server.

        `motion.html` is a page of its own, for a colleague; `motion.viser` is for a site, whose recordings share a
        player: `viewing.write_player`. Neither contains controls. The same scene gives the same recording.

        Args:
            file: the file, ending in `.html` or `.viser`.
            frames: changes the viewer and yields the time for which the state is shown (s), any number of times. Time
                passes only there: after each yield the arm has moved on by that time. None: the motion shown last, from
                start to end; without any, the scene as it is, which turns.

        Raises:
            InvalidInputError: another ending, or frames that are no seconds, or last longer than ten minutes.
            OSError: the file cannot be written.
        """
        path = recording_file(file)
        if frames is not None:
            require("frames", frames, Iterable)
        with self._turns.between():
            if self._records:
                raise BeetleIkError("record: frames must not record")
            self._records = True
            try:
                shown = self._parts.playback.frames() if frames is None else frames
                recorded = take(self.server, self._parts, shown, self._turns.pass_time)
            finally:
                self._records = False
        write_recording(path, self.robot.name, recorded)

    def on_target(self, callback: Callable[[Any], object]) -> None:
        """Registers a `callback(target)` for each new `target`, which runs in the thread of the viewer.

        The arm waits for it; its exceptions are logged and shown on the page.
        """
        if not callable(callback):
            raise InvalidInputError(f"callback must be a function of the target, got {callback!r:.60}")
        self._turns.callbacks.append(lambda: callback(self.target))

    def wait(self) -> None:
        """Waits until the viewer is closed. Ctrl-C closes it."""
        try:
            while not self._turns.closed.wait(_WAKE):
                pass
        finally:
            self.close()

    def close(self) -> None:
        """Ends the page and its threads. A closed viewer keeps its state; a second call does nothing."""
        if self._turns.end():
            atexit.unregister(self.close)
            stop(self.server)

    def _repr_html_(self) -> str:
        """Shows the page inline in a notebook."""
        place = html.escape(self.url)
        return f'<iframe src="{place}" width="100%" height="{_NOTEBOOK_HEIGHT}" style="border:0"></iframe>'

    def __repr__(self) -> str:
        """Names the robot and the address."""
        state = "closed" if self._turns.closed.is_set() else f"at {self.url}"
        return f"<Viewer of '{self.robot.name}', {state}>"

    def __enter__(self) -> Self:
        """Returns the viewer."""
        return self

    def __exit__(self, *_: object) -> None:
        """Closes the viewer."""
        self.close()
