"""Playback of a motion: time bar, trace of the tip, joint velocities."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..figures.style import BLUE, PALETTE, rgb
from .page import set_value

if TYPE_CHECKING:
    import viser
    from numpy.typing import NDArray

    from .._core import Trajectory
    from .page import Page

_SAMPLES = 400  # samples of the trace and the plot
_STEP = 0.01  # s: step of the time bar
_TRACE = 3.0  # pixels: width of the trace
_PASSED = 12  # configurations along a motion that set the view
_FRAME = 1.0 / 30.0  # s: frame of a recording
_REST = 0.7  # s: rest at the end of a recording, before it begins again
_ASPECT = 1.5  # width over height of the plot


class Playback:
    """A trajectory and a time on it. It plays, once or repeatedly, until someone stops it or takes the handle."""

    def __init__(self, page: Page) -> None:
        """Adds the controls, hidden until there is a motion."""
        self._page = page
        self._motion: Trajectory | None = None
        self._playing = False
        self._drawn: list[viser.SceneNodeHandle | viser.GuiUplotHandle] = []
        gui = page.server.gui
        self._folder = gui.add_folder("Motion", visible=False)
        with self._folder:
            self._bar = gui.add_slider("time [s]", min=0.0, max=1.0, step=_STEP, initial_value=0.0)
            self._button = gui.add_button("Play")
            self._repeat = gui.add_checkbox("repeat", initial_value=True)
            self._facts = gui.add_html("")
        page.on_input(self._bar, lambda: self._jump(self._bar.value))
        page.on_input(self._button, lambda: self._play(not self._playing))
        self._time = 0.0
        self._left = (page.arm.q, page.arm.targets)
        """Configuration and targets that playback left; other values mean that someone has taken over."""

    def show(self, motion: Trajectory, *, repeat: bool = True, clearance: float = math.nan) -> None:
        """Shows a trajectory in place of the previous one, and plays it once or repeatedly.

        `clearance` is the smallest distance (m) on the way; NaN if it is not known.
        """
        set_value(self._repeat, repeat)
        for handle in self._drawn:
            handle.remove()
        self._motion, self._time = motion, 0.0
        self._bar.max = max(round(motion.duration + 0.5 * _STEP, 2), _STEP)
        self._folder.visible = True
        times = np.linspace(0.0, motion.duration, _SAMPLES)
        q, qd, _ = motion.at(times)
        points = self._page.arm.robot.fk(q).reshape(len(q), -1, 4, 4)[..., :3, 3]
        self._facts.content = _facts(motion.duration, points, clearance)
        self._drawn = [self._trace(points), self._plot(times, qd)]
        self._play(True)

    def advance(self, elapsed: float) -> bool:
        """Advances the motion by a time (s); returns whether it goes on."""
        arm = self._page.arm
        if not self._playing or self._motion is None:
            return False
        if arm.q is not self._left[0] or arm.targets is not self._left[1]:
            self._play(False)  # someone has taken over
            return False
        self._time += elapsed
        if self._time >= self._motion.duration:
            self._play(bool(self._repeat.value))
            self._time = 0.0 if self._playing else self._motion.duration
        self._put()
        set_value(self._bar, round(min(self._time, self._bar.max), 2))
        return self._playing

    def shows(self, motion: Trajectory) -> bool:
        """Whether the arm is still where this motion put it."""
        return self._motion is motion and self._page.arm.q is self._left[0]

    def passed(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns configurations (k, n) along the motion; `q` (n,) if there is none."""
        return q[None] if self._motion is None else self._motion.at(np.linspace(0.0, self._motion.duration, _PASSED))[0]

    def frames(self) -> Iterator[float]:
        """Moves the arm along the motion, if there is one, and yields the duration of each frame (s).

        It ends with a rest, and restores the previous state.
        """
        if self._motion is None:
            return
        arm, end = self._page.arm, self._motion.duration
        taken_over = not self.shows(self._motion)
        before = (arm.q, arm.targets, self._time, self._playing)
        for time in np.arange(0.0, end, _FRAME).tolist():
            self._jump(time)
            yield min(_FRAME, end - time)
        self._jump(end)
        yield _REST
        self._jump(before[2])
        if taken_over:
            arm.put(before[0])
            arm.targets = before[1]
        else:
            self._play(before[3])

    def _play(self, playing: bool) -> None:
        self._playing = playing
        self._button.label = "Pause" if playing else "Play"
        if playing and self._motion is not None:
            self._time = 0.0 if self._time >= self._motion.duration else self._time
            self._put()

    def _jump(self, time: float) -> None:
        self._play(False)
        self._time = time
        self._put()

    def _put(self) -> None:
        arm = self._page.arm
        if self._motion is not None:
            arm.put(*self._motion.at(self._time))
            self._left = (arm.q, arm.targets)

    def _trace(self, points: NDArray[np.float64]) -> viser.LineSegmentsHandle:
        """Draws the paths of the tips, points (k, tips, 3)."""
        segments = np.stack((points[:-1], points[1:]), axis=2).reshape(-1, 2, 3)
        return self._page.server.scene.add_line_segments(
            "/trace", segments, rgb(BLUE), thickness=_TRACE, thickness_units="screen"
        )

    def _plot(self, times: NDArray[np.float64], qd: NDArray[np.float64]) -> viser.GuiUplotHandle:
        from viser import uplot

        names = self._page.arm.robot.joint_names
        series = [uplot.Series(label=name, stroke=PALETTE[j % len(PALETTE)], width=1.5) for j, name in enumerate(names)]
        with self._folder:
            return self._page.server.gui.add_uplot(
                (times, *np.ascontiguousarray(qd.T)), (uplot.Series(label="t [s]"), *series),
                title="joint velocities [rad/s, m/s]", scales={"x": uplot.Scale(time=False)}, aspect=_ASPECT,
            )  # fmt: skip


def _facts(duration: float, points: NDArray[np.float64], clearance: float) -> str:
    """Returns duration, longest way of a tip (points (k, tips, 3)) and clearance of a motion, as HTML."""
    length = np.linalg.norm(np.diff(points, axis=0), axis=-1).sum(axis=0).max()
    facts = [f"{duration:.2f} s", f"the tip moves {length:.3f} m"]
    if math.isfinite(clearance):
        facts.append(f"clearance {1e3 * clearance:.1f} mm at least")
    return f"<p data-beetle-ik='motion' style='padding:0 1em;font-size:0.85em'>{', '.join(facts)}</p>"
