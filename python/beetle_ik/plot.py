"""Figures of results. Each function returns a matplotlib Figure and never shows it.

`figure.savefig("result.png")` writes it, `matplotlib.pyplot.show()` opens a window, and a notebook displays it.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from . import _core
from .calls.arguments import require
from .calls.text import counted
from .figures import calibration_figure, plan_figure, track_figure
from .figures.joints import ROW_HEIGHT, draw_joints, draw_torques, legend_columns
from .figures.shapes import draw_bodies, draw_in_space, joints_to_tip, link_poses, moved, placed_bodies
from .figures.style import BLUE, FORBIDDEN, GREEN, LINKS, ORANGE, VERMILION, new_figure, style
from .figures.surface import Surface, draw_surfaces

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped, unused-ignore]
    from numpy.typing import ArrayLike, NDArray

    from ._core import Calibration, Limits, ModelFreeResult, Obstacle, Plan, Robot, TrackResult, Trajectory

__all__ = ["animation", "calibration", "model_free", "plan", "robot", "saturation", "track", "trajectory"]

# Colours of several tips, and of pairs of tips.
_TIPS = (BLUE, GREEN, ORANGE)
_VELOCITY_PANELS_A_ROW = 7
_VELOCITYROW_HEIGHT = 2.0
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
        from .figures.solids import solids  # keeps the import of the package quick

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
    with style():
        return track_figure.draw(result)


def model_free(result: ModelFreeResult) -> Figure:
    """Draws a path tracked without a model: tip and target in space, errors, joint positions, measurements."""
    require("result", result, _core.ModelFreeResult)
    with style():
        return track_figure.draw_model_free(result)


def plan(plan: Plan) -> Figure:
    """Draws a planned motion: the arm along its path, the search history, joints and speeds of the tip over time.

    The torques of the joints are below, with their limits, if the robot has dynamics.
    """
    require("plan", plan, _core.Plan)
    with style():
        figure = new_figure(13.0, plan_figure.rows(plan) * ROW_HEIGHT * 0.9 + 0.4)
        plan_figure.draw(figure, plan)
    return figure


def animation(result: Plan | TrackResult) -> FuncAnimation:
    """Animates the arm in real time: `bik.plot.animation(plan).save("plan.gif", writer="pillow")`."""
    require("result", result, _core.Plan, _core.TrackResult)
    with style():
        figure = new_figure(5.0, 5.0)
        return plan_figure.animate(figure, result).animation(figure)


def trajectory(trajectory: Trajectory, *, robot: Robot | None = None) -> Figure:
    """Draws position, velocity and, unless the segments are straight, acceleration of each joint over time.

    With a `robot` the torques that cause the motion are below, with their limits.
    """
    require("trajectory", trajectory, _core.Trajectory)
    curved = trajectory.coefficients.shape[2] > 2
    labels = ["position [rad, m]", "velocity [rad/s, m/s]", "acceleration [rad/s², m/s²]"][: 3 if curved else 2]
    time = np.linspace(trajectory.time[0], trajectory.time[-1], _TRAJECTORY_SAMPLES)
    torques = None
    if robot is not None:
        require("robot", robot, _core.Robot)
        torques = trajectory.torques(robot, time)
    with style():
        rows = len(labels) + (torques is not None)
        figure = new_figure(9.0, ROW_HEIGHT * rows + 0.6)
        panels = figure.subplots(rows, 1, sharex=True)
        for axes, label, values in zip(panels, labels, trajectory.at(time), strict=False):
            draw_joints(axes, time, values, trajectory.joint_names)
            axes.set_ylabel(label)
        if robot is not None and torques is not None:
            draw_torques(panels[-1], time, torques, robot)
        panels[-1].set_xlabel("time [s]")
        columns = legend_columns(trajectory.joint_names)
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
        figure = new_figure(9.0, ROW_HEIGHT * len(shares) + 0.6)
        panels = figure.subplots(len(shares), 1, sharex=True, squeeze=False)[:, 0]
        for axes, (name, values) in zip(panels, shares.items(), strict=True):
            axes.axhspan(1.0, 1.1, color=FORBIDDEN, linewidth=0)
            draw_joints(axes, time, values, trajectory.joint_names)
            axes.set_ylim(0.0, 1.1)
            axes.set_ylabel(f"share of {name} limit")
        panels[-1].set_xlabel("time [s]; shaded: beyond the limit")
        columns = legend_columns(trajectory.joint_names)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside right upper", ncols=columns)
    return figure


def _slopes(time: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns time derivatives by differences; the last one is repeated, so that each sample has one."""
    slopes = np.diff(values, axis=0) / np.diff(time)[:, None]
    return np.vstack((slopes, slopes[-1:]))


def calibration(result: Calibration) -> Figure:
    """Draws the errors of a calibration before and after, by measurement and as a distribution."""
    require("result", result, _core.Calibration)
    return calibration_figure.draw(result)
