"""Figure and animation of a planned motion: the arm along its path, the search history, joints and tips over time."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from .frames import Frames
from .joints import draw_joints, draw_torques
from .shapes import draw_from_above, draw_in_space, joints_to_tip
from .style import BLACK, BLUE, GREEN, ORANGE, SKY, VERMILION
from .tip_speed import draw_tip_speeds

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from .._core import Plan, TrackResult

_ROWS = 4  # panels over time without torques
_SAMPLES = 801
_SNAPSHOTS = 6
_BESIDE = 101  # points of the way of the tip at a break
_FLAT = 1e-9  # m
_FEW = 60  # a path of at most this many points gets a marker on each
_FRAMES_A_SECOND = 15
_PAUSE = 10  # frames at the end
_TITLE_WIDTH = 120  # letters a line


class Scene:
    """The arm and the path of its tip, in 2-D axes if the motion stays in a horizontal plane, else in 3-D axes."""

    def __init__(self, figure: Any, place: Any, plan: Plan | TrackResult) -> None:
        """Adds the axes at `place`, a cell of a grid."""
        self._plan = plan
        self._obstacles = getattr(plan, "obstacles", [])
        time = np.linspace(0.0, plan.trajectory.duration, _SAMPLES)
        self._q = plan.trajectory.at(time)[0]
        self._tips = plan.robot.fk(self._q).reshape(_SAMPLES, -1, 4, 4)[:, :, :3, 3]
        self._corners = np.array([self._origins(q) for q in self._q[:: _SAMPLES // 40]])
        self._flat = bool(np.ptp(self._corners[..., 2]) < _FLAT)
        self.axes = figure.add_subplot(place, projection=None if self._flat else "3d")

    def draw_way(self) -> None:
        """Draws the obstacles, the path of the tip with its start and end, and the reference path."""
        if self._plan.reference is not None:
            points = np.asarray(self._plan.reference)
            few = {"marker": "x", "markersize": 4} if len(points) <= _FEW else {}
            self._plot(points, color=VERMILION, linewidth=0.8, label="path to follow", **few)
        for i in range(self._tips.shape[1]):
            self._plot(self._tips[:, i], color=BLUE, label="tip" if i == 0 else None)
        for i, each in enumerate(getattr(self._plan, "breaks", [])):
            beside = self._plan.robot.fk(self._plan.trajectory.at(np.linspace(each.start, each.end, _BESIDE))[0])
            style = {"color": ORANGE, "linewidth": 2.5, "linestyle": ":"}
            self._plot(beside[:, :3, 3], label="beside the path" if i == 0 else None, **style)
        self._plot(self._tips[0], color=GREEN, marker="o", linestyle="none", label="start")
        self._plot(self._tips[-1], color=BLACK, marker="o", linestyle="none", label="end")
        self._scale()

    def draw_arm(self, share: float, **style: Any) -> Any:
        """Draws the arm at this fraction of the duration."""
        return self._plot(self._origins(self._at(share)), marker="o", markersize=3, **style)

    def move_arm(self, drawn: Any, share: float) -> None:
        """Moves a drawn arm to its configuration at this fraction of the duration."""
        corners = self._origins(self._at(share)).T
        if self._flat:
            drawn.set_data(corners[0], corners[1])
        else:
            drawn.set_data_3d(*corners)

    def _at(self, share: float) -> NDArray[np.float64]:
        return np.asarray(self._plan.trajectory.at(share * self._plan.trajectory.duration)[0])

    def _origins(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        return joints_to_tip(self._plan.robot, q)

    def _plot(self, points: NDArray[np.float64], **style: Any) -> Any:
        return self.axes.plot(*points.T[: 2 if self._flat else 3], **style)[0]

    def _scale(self) -> None:
        if self._flat:
            draw_from_above(self.axes, self._obstacles)
            # Covers the whole motion: between its snapshots the arm may leave their region.
            self.axes.update_datalim(self._corners.reshape(-1, 3)[:, :2])
            self.axes.autoscale_view()
            self.axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
            return
        draw_in_space(self.axes, self._corners.reshape(-1, 3), self._obstacles)


def rows(plan: Plan) -> int:
    """Returns the number of panels over time."""
    return _ROWS + plan.robot.has_dynamics


def draw(figure: Figure, plan: Plan) -> None:
    """Draws the arm along its path and the search history, if any (left), and joints, tip speed and torques (right)."""
    halves = figure.add_gridspec(1, 2, width_ratios=[1.0, 1.15])
    left, right = (figure.add_subfigure(halves[0, i]) for i in range(2))  # each has its own margins
    grid = left.add_gridspec(_ROWS, 1)
    searched = len(plan.history) > 1
    scene = Scene(left, grid[: _ROWS - 1 if searched else _ROWS, 0], plan)
    for i in range(_SNAPSHOTS):
        share = i / (_SNAPSHOTS - 1)
        label = "arm" if i == _SNAPSHOTS - 1 else None
        scene.draw_arm(share, color=SKY, alpha=0.25 + 0.75 * share, label=label)
    scene.draw_way()
    scene.axes.legend(loc="upper right", bbox_to_anchor=(-0.12, 1.0), fontsize="small")
    if searched:
        _draw_search(left.add_subplot(grid[_ROWS - 1, 0]), plan)
    time = np.linspace(0.0, plan.trajectory.duration, _SAMPLES)
    labels = ("position [rad, m]", "velocity [rad/s, m/s]", "acceleration [rad/s², m/s²]")
    panels = right.subplots(rows(plan), 1)
    for axes, label, values in zip(panels, labels, plan.trajectory.at(time), strict=False):
        draw_joints(axes, time, values, plan.trajectory.joint_names)
        axes.set_ylabel(label)
    draw_tip_speeds(panels[_ROWS - 1], plan, _SAMPLES)
    if plan.robot.has_dynamics:
        draw_torques(panels[-1], time, plan.torques(time), plan.robot)
    for axes in panels:
        axes.set_xlim(0.0, plan.trajectory.duration)
        for each in plan.breaks:
            axes.axvspan(each.start, each.end, color=ORANGE, alpha=0.15, linewidth=0.0)
    panels[-1].set_xlabel("time [s]")
    panels[0].legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize="small")
    figure.suptitle(fill(f"{plan.robot.name}: {plan.message}", _TITLE_WIDTH))


def _draw_search(axes: Axes, plan: Plan) -> None:
    evaluations, cost = plan.history.T
    steps = np.append(evaluations, max(plan.evaluations, 1))
    axes.step(steps, np.append(cost, cost[-1:]), where="post", color=BLUE)
    axes.set(xlabel="evaluations", ylabel="best cost so far", yscale="log" if (cost > 0).all() else "linear")


def animate(figure: Figure, plan: Plan | TrackResult) -> Frames:
    """Returns the frames of the moving arm, in real time."""
    scene = Scene(figure, figure.add_gridspec(1, 1)[0], plan)
    scene.draw_arm(0.0, color=SKY, alpha=0.4, label="arm at the start")
    scene.draw_arm(1.0, color=SKY, alpha=0.4)
    scene.draw_way()
    arm = scene.draw_arm(0.0, color=VERMILION, linewidth=2.5, label="arm")
    scene.axes.legend(loc="upper left", fontsize="small")
    moving = max(2, round(plan.trajectory.duration * _FRAMES_A_SECOND))

    def show(frame: int) -> None:
        scene.move_arm(arm, min(frame / (moving - 1), 1.0))

    return Frames(moving=arm, show=show, count=moving + _PAUSE, rate=_FRAMES_A_SECOND)
