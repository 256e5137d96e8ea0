"""The parts of the page together."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import InvalidInputError, Plan, SelfMotion, TrackResult
from ..figures.style import BLACK, ORANGE, rgb
from ..mapping import ReachabilityMap
from .arm import DT
from .camera import Camera
from .checks import in_joint_order, motion_of, postures_of
from .files import Program, SceneFiles
from .handle import Handles
from .joints import Joints
from .obstacles import Obstacles
from .planning import Planning
from .playback import Playback
from .postures import Postures
from .reach import Reach
from .report import Report
from .surfaces import Links

if TYPE_CHECKING:
    import viser
    from numpy.typing import NDArray

    from .looks import Look
    from .page import Page

    Array = NDArray[np.float64]

_CELLS, _SECTIONS = "#CDD1D6", "#A9AFB6"  # colours of the floor
_LARGE = 2.0  # m: floors of larger robots have larger cells
_REFERENCE = 2.0  # pixels
_BESIDE = 101  # points of a way beside the path
_SLOW = 0.1  # s: interval of text and sliders during a motion, which the page has to lay out


class Parts:
    """All parts of the page, and their common actions."""

    def __init__(self, page: Page, looks: list[Look], notes: list[str]) -> None:
        """Fills the page with the `looks` of the links and `notes`, sentences about the robot."""
        self._page = page
        self._breaks: list[viser.SceneNodeHandle] = []
        scene, gui = page.server.scene, page.server.gui
        self._links = Links(scene, page.arm.robot, looks)
        low, high = self._links.bounds(page.arm.q)
        size = max(page.scale, float(np.linalg.norm(high - low)))
        self._camera = Camera(page.server, low, high, size)
        gui.configure_theme(show_share_button=False)  # it would publish the page
        floor = (0.0, 0.0, min(0.0, float(low[2])))  # the base may be at a waist
        cell = 0.1 if size < _LARGE else 0.5
        scene.add_grid(
            "/floor", 4 * size, 4 * size, cell_size=cell, section_size=5 * cell, position=floor,
            cell_color=rgb(_CELLS), section_color=rgb(_SECTIONS), fade_distance=8 * size,
        )  # fmt: skip
        self.report = Report(page, notes)
        self.playback = Playback(page)
        self._reach = Reach(page)
        tabs = gui.add_tab_group()
        with tabs.add_tab("Target"):
            handles = Handles(page)
            planning = Planning(page, self.playback)
            self.program = Program(page, planning)
        with tabs.add_tab("Joints"):
            joints = Joints(page)
        with tabs.add_tab("Obstacles"):
            obstacles = Obstacles(page)
            SceneFiles(page)
            bodies = gui.add_checkbox("bodies that are kept clear", False, visible=self._links.has_covers)
            page.on_input(bodies, lambda: self._links.show_bodies(bodies.value))
        with tabs.add_tab("Postures"):
            self._postures = Postures(page, self._links)
        self._quick = (handles, obstacles, self._postures)
        self._with_handles = (handles, obstacles)
        self._slow = (joints, self.report)
        self._due = 0.0
        self._left_over = 0.0  # s
        self.refresh()

    def advance(self, elapsed: float) -> bool:
        """Moves the arm on by a tick, `elapsed` (s) after the last one; returns whether it still moves."""
        return self.playback.advance(elapsed) or self._page.arm.advance()

    def pass_time(self, seconds: float) -> bool:
        """Moves the arm on by ticks, for `seconds` in all; returns whether it still moves."""
        moves, self._left_over = self._page.arm.moves, self._left_over + seconds
        while self._left_over > 0.5 * DT:
            moves, self._left_over = self.advance(DT), self._left_over - DT
        return moves

    @contextmanager
    def posed(self) -> Iterator[None]:
        """Hides the handles, and moves the camera near arm, motion and map, for a recording."""
        passed = self.playback.passed(self._page.arm.q)
        boxes = [*(self._links.bounds(q) for q in passed), *self._reach.bounds, *self._obstacles_nearby()]
        try:
            for part in self._with_handles:
                part.show_handles(False)
            with self._camera.recording(np.array(boxes)):
                yield
        finally:
            for part in self._with_handles:
                part.show_handles(True)

    def _obstacles_nearby(self) -> Iterator[tuple[Array, Array]]:
        """Yields least and greatest coordinates (3,) of obstacles no larger than the arm, which excludes floors."""
        for obstacle in self._page.arm.obstacles:
            low, high = obstacle.triangles.min(axis=(0, 1)), obstacle.triangles.max(axis=(0, 1))
            if np.abs((low, high)).max() < self._page.scale:
                yield low, high

    def refresh(self, *, moving: bool = False) -> None:
        """Shows the state of the arm."""
        with self._page.server.atomic():
            self._links.place(self._page.arm.q)
            for part in self._quick:
                part.refresh()
            if not moving or time.monotonic() >= self._due:
                self._due = time.monotonic() + _SLOW
                for each in self._slow:
                    each.refresh()

    def draw_path(self, points: Array) -> None:
        """Draws a line through points (k, 3), in place of the previous one."""
        segments = np.stack((points[:-1], points[1:]), axis=1)
        scene = self._page.server.scene
        scene.add_line_segments("/path", segments, rgb(BLACK), thickness=_REFERENCE, thickness_units="screen")

    def show(self, result: Any) -> None:
        """Shows a result of this library."""
        if isinstance(result, ReachabilityMap):
            self._reach.show(result)
            return
        motion = motion_of(result)
        if motion is not None and len(motion.joint_names) == self._page.arm.robot.dof:
            motion = in_joint_order(self._page.arm.robot, motion)
        self._require_fitting(postures_of(result) if motion is None else motion.q)
        if motion is None:
            self._show_postures(result)
            return
        if isinstance(result, Plan) and result.obstacles:
            self._page.arm.obstacles = list(result.obstacles)
        reference = result.reference if isinstance(result, Plan | TrackResult) else None
        if reference is not None:
            self.draw_path(reference)
        self.playback.show(motion)
        self._draw_breaks(result if isinstance(result, Plan) else None)

    def _draw_breaks(self, plan: Plan | None) -> None:
        """Draws the ways of the tip beside its path, each with its reason, in place of earlier ones."""
        scene = self._page.server.scene
        while self._breaks:
            self._breaks.pop().remove()
        if plan is None:
            return
        for i, each in enumerate(plan.breaks):
            way = plan.robot.fk(plan.trajectory.at(np.linspace(each.start, each.end, _BESIDE))[0])[:, :3, 3]
            segments = np.stack((way[:-1], way[1:]), axis=1)
            name = f"/breaks/{i}"
            color = rgb(ORANGE)
            lines = scene.add_line_segments(name, segments, color, thickness=_REFERENCE, thickness_units="screen")
            scene.add_label(f"{name}/reason", f"break {i}: {each.reason}", position=tuple(way[0]))
            self._breaks.append(lines)

    def _show_postures(self, result: Any) -> None:
        postures = postures_of(result)
        if isinstance(result, SelfMotion):
            self._postures.show_curve(postures)
        elif len(postures) != 1:
            self._postures.show_ghosts(postures, result.message)
        if len(postures):
            self._page.arm.put(self._page.arm.robot.clip(postures[0]))

    def _require_fitting(self, q: Array) -> None:
        robot = self._page.arm.robot
        if q.shape[1] != robot.dof:
            raise InvalidInputError(f"result has {q.shape[1]} joints, and robot '{robot.name}' has {robot.dof}")
