"""Figures of results. Each function returns a matplotlib Figure and never shows it.

`figure.savefig("result.png")` writes it, `matplotlib.pyplot.show()` opens a window, and a notebook displays it.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core, _plan_figure
from ._arguments import require
from ._shapes import draw_bodies, draw_in_space, joints_to_tip, link_poses, moved, placed_bodies
from ._style import BLUE, FORBIDDEN, GREEN, LINKS, ORANGE, VERMILION, line, new_figure, style
from ._surface import Surface, draw_surfaces
from ._text import counted

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped, unused-ignore]
    from numpy.typing import ArrayLike, NDArray

    from ._core import Limits, ModelFreeResult, Obstacle, Plan, Robot, TrackResult, Trajectory

__all__ = ["animation", "model_free", "plan", "robot", "saturation", "track", "trajectory"]

_ROW_HEIGHT = 2.4  # inches per panel over time
# Colours of several tips, and of pairs of tips.
_TIPS = (BLUE, GREEN, ORANGE)
_VELOCITY_PANELS_A_ROW = 7
_VELOCITY_ROW_HEIGHT = 2.0
_HEADROOM = 1.15  # height of a panel over the height of its data
_FAR_LIMIT = 3.0  # a limit beyond this multiple of the velocities is written instead of drawn
_LEGEND_ROWS = 10
_TRAJECTORY_SAMPLES = 2001
_ABOVE = 1000  # layer above everything else


def robot(
    robot: Robot,
    q: ArrayLike,
    *,
    obstacles: Iterable[Obstacle] | None = None,
    bodies: bool = True,
    meshes: bool = True,
) -> Figure:
    """Draws the robot at configuration `q` (n,): its links, tool, tip, bodies and `obstacles`.

    Links are drawn with their meshes; links without meshes are drawn along the joints, in the colours of the maker if
    the robot is built in.

    Args:
        robot: the robot.
        q: joint positions (n,) (rad, m).
        obstacles: obstacles in the frame of the robot's base.
        bodies: whether to draw the bodies of the links, translucent.
        meshes: whether to draw the links as solids, from `robot.collision_meshes()` or along the joints; with at most
            about 30,000 triangles, larger meshes are coarsened. False: a stick figure.
    """
    require("robot", robot, _core.Robot)
    require("bodies", bodies, bool)
    require("meshes", meshes, bool)
    obstacles = () if obstacles is None else obstacles
    require("obstacles", obstacles, Iterable)
    obstacles = list(obstacles)
    for i, obstacle in enumerate(obstacles):
        require(f"obstacles[{i}]", obstacle, _core.Obstacle)
    corners = joints_to_tip(robot, q)
    surfaces = _mesh_surfaces(robot, q) if meshes else []
    translucent = placed_bodies(robot, q) if bodies else []
    with style():
        figure = new_figure(6.0, 6.0)
        axes = figure.add_subplot(projection="3d")
        flange = len(robot.link_names) - 1 if len(robot.tips) == 1 else len(corners) - 1
        tips = robot.fk(q).reshape(-1, 4, 4)[:, :3, 3]
        _draw_stick(axes, corners, flange, tips, inside=bool(surfaces))
        draw_surfaces(axes, surfaces)
        draw_bodies(axes, translucent)
        solid = [triangles.reshape(-1, 3) for triangles in (*(s.triangles for s in surfaces), *translucent)]
        extent = [np.stack((points.min(axis=0), points.max(axis=0))) for points in (corners, *solid)]
        draw_in_space(axes, np.vstack(extent if surfaces else [corners]), obstacles)
        axes.set_title(f"{robot.name}, {counted(robot.dof, 'joint')}")
        axes.legend(loc="upper left")
    return figure


def _mesh_surfaces(robot: Robot, q: ArrayLike) -> list[Surface]:
    """Returns the meshes of the links at `q` (n,), in alternating colours; solids along the joints without meshes."""
    poses = link_poses(robot, q)
    colors = dict(zip(poses, itertools.cycle(LINKS), strict=False))
    meshes = robot.collision_meshes()
    if not meshes:
        from ._solids import solids  # keeps the import of the package quick

        drawn = solids(robot, np.asarray(q, dtype=float))
        return [Surface(moved(solid.triangles, poses[solid.link]), solid.color) for solid in drawn]
    return [Surface(moved(mesh.triangles, poses[link]), colors[link]) for link, mesh in meshes]


def _draw_stick(
    axes: Axes3D, corners: NDArray[np.float64], flange: int, tips: NDArray[np.float64], *, inside: bool
) -> None:
    """Draws the links from joint to joint, the tool and the tips (k, 3); if `inside` meshes, tool and tips alone."""
    if not inside:
        axes.plot(*corners[: flange + 1].T, color=BLUE, linewidth=3, marker="o", markersize=6, label="links")
    if len(corners) > flange + 1:
        axes.plot(*corners[flange:].T, color=ORANGE, linewidth=3, label="tool")
    above = {"zorder": _ABOVE} if inside else {}
    axes.plot(*tips.T, color=VERMILION, marker="o", markersize=8, linestyle="none", label="tip", **above)


def track(result: TrackResult) -> Figure:
    """Draws a tracked path: tip and target in space, errors, joint positions, evaluations, velocities with limits."""
    require("result", result, _core.TrackResult)
    panels = [_draw_position_error, _draw_joint_positions, _draw_evaluations]
    if np.isfinite(result.rotation_error).any():
        panels.insert(1, _draw_rotation_error)
    velocity_rows = -(-result.robot.dof // _VELOCITY_PANELS_A_ROW)
    heights = [_ROW_HEIGHT * len(panels), _VELOCITY_ROW_HEIGHT * velocity_rows]
    with style():
        figure = new_figure(13.0, sum(heights) + 0.3)
        figure.suptitle(f"{result.robot.name}, {counted(len(result.time) - 1, 'step')} of {result.time[1]:g} s")
        above, below = np.asarray(figure.subfigures(2, 1, height_ratios=heights))
        grid = above.add_gridspec(len(panels), 2, width_ratios=[1.0, 1.25])
        draw_space = _draw_space if len(result.robot.tips) == 1 else _draw_space_of_tips
        draw_space(above.add_subplot(grid[:, 0], projection="3d"), result)
        for row, draw in enumerate(panels):
            axes = above.add_subplot(grid[row, 1])
            draw(axes, result)
            axes.set_xlim(result.time[0], result.time[-1])
            axes.tick_params(labelbottom=row == len(panels) - 1)
        axes.set_xlabel("time [s]")
        above.align_ylabels()
        _draw_velocities(below, result, velocity_rows)
    return figure


def model_free(result: ModelFreeResult) -> Figure:
    """Draws a path tracked without a model: tip and target in space, errors, joint positions, measurements."""
    require("result", result, _core.ModelFreeResult)
    names = [f"joint {j + 1}" for j in range(result.q.shape[1])]
    oriented = bool(np.isfinite(result.rotation_error).any())
    rows = 4 if oriented else 3
    with style():
        figure = new_figure(13.0, rows * _ROW_HEIGHT + 0.3)
        steps = f"{counted(len(result) - 1, 'step')} of {result.time[1]:g} s" if len(result) > 1 else "no step"
        figure.suptitle(f"without a model, {steps}")
        grid = figure.add_gridspec(rows, 2, width_ratios=[1.0, 1.25])
        _draw_space(figure.add_subplot(grid[:, 0], projection="3d"), result)
        if oriented:
            rotation = figure.add_subplot(grid[1, 1])
            _draw_error(rotation, result.time, result.rotation_error, result.rotation_tolerance)
            rotation.set_ylabel("rotation error [rad]")
        error, joints, measurements = (figure.add_subplot(grid[row, 1]) for row in (0, rows - 2, rows - 1))
        _draw_error(error, result.time, result.position_error, result.position_tolerance)
        error.set_ylabel("measured error [m]")
        _draw_joints(joints, result.time, result.q, names)
        joints.set_ylabel("joint position [rad, m]")
        joints.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), ncols=_legend_columns(names))
        measurements.step(result.time, result.step_evaluations, where="mid", color=GREEN)
        measurements.set_ylim(bottom=0)
        measurements.set(ylabel="measurements per step", xlabel="time [s]")
        figure.align_ylabels()
    return figure


def plan(plan: Plan) -> Figure:
    """Draws a planned motion: the arm along its path, the search history, and the joints over time."""
    require("plan", plan, _core.Plan)
    with style():
        figure = new_figure(13.0, 3 * _ROW_HEIGHT + 0.4)
        _plan_figure.draw(figure, plan)
    return figure


def animation(result: Plan | TrackResult) -> FuncAnimation:
    """Animates the arm in real time: `bik.plot.animation(plan).save("plan.gif", writer="pillow")`."""
    require("result", result, _core.Plan, _core.TrackResult)
    with style():
        figure = new_figure(5.0, 5.0)
        return _plan_figure.animate(figure, result).animation(figure)


def trajectory(trajectory: Trajectory) -> Figure:
    """Draws position, velocity and, unless the segments are straight, acceleration of each joint over time."""
    require("trajectory", trajectory, _core.Trajectory)
    curved = trajectory.coefficients.shape[2] > 2
    labels = ["position [rad, m]", "velocity [rad/s, m/s]", "acceleration [rad/s², m/s²]"][: 3 if curved else 2]
    time = np.linspace(trajectory.time[0], trajectory.time[-1], _TRAJECTORY_SAMPLES)
    with style():
        figure = new_figure(9.0, _ROW_HEIGHT * len(labels) + 0.6)
        panels = figure.subplots(len(labels), 1, sharex=True)
        for axes, label, values in zip(panels, labels, trajectory.at(time), strict=False):
            _draw_joints(axes, time, values, trajectory.joint_names)
            axes.set_ylabel(label)
        panels[-1].set_xlabel("time [s]")
        columns = _legend_columns(trajectory.joint_names)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside right upper", ncols=columns)
    return figure


def saturation(trajectory: Trajectory, limits: Limits) -> Figure:
    """Draws velocity, acceleration and jerk of each joint as fractions of their limits.

    In a time-optimal motion some joint is at 1 at any time. `limits` are constant, as for `time_optimal`.
    """
    require("trajectory", trajectory, _core.Trajectory)
    require("limits", limits, _core.Limits)
    time = np.linspace(trajectory.time[0], trajectory.time[-1], _TRAJECTORY_SAMPLES)
    _, velocity, acceleration = trajectory.at(time)
    shares = {
        name: np.abs(values) / np.broadcast_to(np.asarray(limit, dtype=float), values.shape)
        for name, values, limit in (
            ("velocity", velocity, limits.velocity),
            ("acceleration", acceleration, limits.acceleration),
            ("jerk", _slopes(time, acceleration), limits.jerk),
        )
        if limit is not None
    }
    with style():
        figure = new_figure(9.0, _ROW_HEIGHT * len(shares) + 0.6)
        panels = figure.subplots(len(shares), 1, sharex=True, squeeze=False)[:, 0]
        for axes, (name, values) in zip(panels, shares.items(), strict=True):
            axes.axhspan(1.0, 1.1, color=FORBIDDEN, linewidth=0)
            _draw_joints(axes, time, values, trajectory.joint_names)
            axes.set_ylim(0.0, 1.1)
            axes.set_ylabel(f"share of {name} limit")
        panels[-1].set_xlabel("time [s]; shaded: beyond the limit")
        columns = _legend_columns(trajectory.joint_names)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside right upper", ncols=columns)
    return figure


def _slopes(time: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns time derivatives by differences; the last one is repeated, so that each sample has one."""
    slopes = np.diff(values, axis=0) / np.diff(time)[:, None]
    return np.vstack((slopes, slopes[-1:]))


def _draw_space(axes: Any, result: TrackResult | ModelFreeResult) -> None:
    _draw_way(axes, result.position, result.reference, BLUE, "tip")
    axes.plot(*result.position[:1].T, color=BLUE, marker="o", linestyle="none", label="start")
    draw_in_space(axes, np.vstack((result.reference, result.position)))
    axes.set_title("path of the tip")
    axes.legend(loc="upper left")


def _draw_space_of_tips(axes: Any, result: TrackResult) -> None:
    """Draws the path of each tip that has a target, without pairs: their frame is another tip."""
    positions, references = result.positions, result.references
    tips = [key for key in positions if isinstance(key, str)]
    if not tips:
        axes.set_axis_off()
        axes.set_title("poses of one tip as seen from another")
        return
    for tip, color in zip(tips, itertools.cycle(_TIPS), strict=False):
        _draw_way(axes, positions[tip], references[tip], color, tip)
    draw_in_space(axes, np.vstack([way[tip] for way in (positions, references) for tip in tips]))
    axes.set_title("paths of the tips")
    axes.legend(loc="upper left")


def _draw_way(axes: Any, position: NDArray[np.float64], reference: NDArray[np.float64], color: str, name: str) -> None:
    label = "target" if name == "tip" else f"target of {name}"
    axes.plot(*reference.T, color=VERMILION, linewidth=4, alpha=0.45, label=label)
    axes.plot(*position.T, color=color, linewidth=1.2, label=name)


def _draw_position_error(axes: Axes, result: TrackResult) -> None:
    _draw_errors(axes, result, 0, result.position_error, result.position_tolerance)
    axes.set_ylabel("position error [m]")


def _draw_rotation_error(axes: Axes, result: TrackResult) -> None:
    _draw_errors(axes, result, 1, result.rotation_error, result.rotation_tolerance)
    axes.set_ylabel("rotation error [rad]")


def _draw_errors(axes: Axes, result: TrackResult, component: int, error: NDArray[np.float64], tolerance: float) -> None:
    """Draws the error of the tip or, with several tips or pairs, each error."""
    errors = result.errors
    if len(result.robot.tips) == 1:
        _draw_error(axes, result.time, error, tolerance)
        return
    for (key, each), color in zip(errors.items(), itertools.cycle(_TIPS), strict=False):
        label = key if isinstance(key, str) else f"{key[1]} seen from {key[0]}"
        axes.semilogy(result.time, each[component], color=color, label=label)
    axes.axhline(tolerance, color=VERMILION, linestyle="--", label="tolerance")
    axes.legend(loc="best")


def _draw_error(axes: Axes, time: NDArray[np.float64], error: NDArray[np.float64], tolerance: float) -> None:
    axes.semilogy(time, error, color=BLUE)
    axes.axhline(tolerance, color=VERMILION, linestyle="--", label="tolerance")
    axes.legend(loc="best")


def _draw_joint_positions(axes: Axes, result: TrackResult) -> None:
    names = result.robot.joint_names
    _draw_joints(axes, result.time, result.q, names)
    axes.set_ylabel("joint position [rad]" if _all_turn(result.robot) else "joint position [rad, m]")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), ncols=_legend_columns(names))


def _draw_evaluations(axes: Axes, result: TrackResult) -> None:
    axes.step(result.time[1:], result.step_evaluations[1:], where="mid", color=GREEN)
    axes.set_ylim(bottom=0)
    axes.set_ylabel("evaluations per step")


def _draw_velocities(figure: Any, result: TrackResult, rows: int) -> None:
    """Draws one small panel per joint, scaled to the velocities; a limit far beyond them is written, not drawn."""
    names = result.robot.joint_names
    panels = figure.subplots(rows, min(len(names), _VELOCITY_PANELS_A_ROW), sharex=True, sharey=True, squeeze=False)
    time, velocity, limit = result.time[1:], result.qd[1:], result.velocity_limit[1:]
    fastest = _highest(velocity)
    highest = _highest(limit) if np.isfinite(limit).any() else fastest
    top = _HEADROOM * (highest if highest <= _FAR_LIMIT * fastest else fastest)
    for j, axes in enumerate(panels.flat):
        if j >= len(names):
            axes.set_visible(False)
            continue
        bound = np.minimum(limit[:, j], 2.0 * top)  # an infinite limit shades nothing in view
        axes.fill_between(time, bound, 2.0 * top, color=FORBIDDEN, linewidth=0)
        axes.fill_between(time, -bound, -2.0 * top, color=FORBIDDEN, linewidth=0)
        axes.plot(time, velocity[:, j], color=line(j)["color"])
        axes.set_title(names[j])
        lowest = float(limit[:, j].min())
        if top < lowest < np.inf:
            axes.text(0.97, 0.97, f"limit {lowest:.3g}", transform=axes.transAxes, ha="right", va="top")
        axes.set_ylim(-top, top)
    unit = "rad/s" if _all_turn(result.robot) else "rad/s, m/s"
    figure.supylabel(f"velocity [{unit}]")
    figure.supxlabel("time [s]; shaded: beyond the velocity limit")


def _draw_joints(axes: Axes, time: NDArray[np.float64], values: NDArray[np.float64], names: list[str]) -> None:
    for j, name in enumerate(names):
        axes.plot(time, values[:, j], label=name, **line(j))


def _legend_columns(names: list[str]) -> int:
    return -(-len(names) // _LEGEND_ROWS)


def _highest(values: NDArray[np.float64]) -> float:
    """Returns the largest finite magnitude, or 1 if all values are zero, so that axes keep a height."""
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0)) or 1.0


def _all_turn(robot: Robot) -> bool:
    return "prismatic" not in robot.joint_kinds
