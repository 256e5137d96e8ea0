"""Figures of tracked paths: with a model, and without."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from ..calls.text import counted
from .joints import ROW_HEIGHT, draw_joints, legend_columns
from .shapes import draw_in_space
from .style import BLUE, FORBIDDEN, GREEN, ORANGE, VERMILION, line, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from .._core import ModelFreeResult, Robot, TrackResult

# Colours of several tips, and of pairs of tips.
_TIPS = (BLUE, GREEN, ORANGE)
_VELOCITY_PANELS_A_ROW = 7
_VELOCITY_ROW_HEIGHT = 2.0
_HEADROOM = 1.15  # height of a panel over the height of its data
_FAR_LIMIT = 3.0  # a limit beyond this multiple of the velocities is written instead of drawn


def draw(result: TrackResult) -> Figure:
    """Draws a tracked path: tip and target in space, errors, joint positions, evaluations, velocities with limits."""
    panels = [_draw_position_error, _draw_joint_positions, _draw_evaluations]
    if np.isfinite(result.rotation_error).any():
        panels.insert(1, _draw_rotation_error)
    velocity_rows = -(-result.robot.dof // _VELOCITY_PANELS_A_ROW)
    heights = [ROW_HEIGHT * len(panels), _VELOCITY_ROW_HEIGHT * velocity_rows]
    figure = new_figure(13.0, sum(heights) + 0.3)
    figure.suptitle(f"{result.robot.name}, {counted(len(result.time) - 1, 'step')} of {result.time[1]:g} s")
    above, below = np.asarray(figure.subfigures(2, 1, height_ratios=heights))
    grid = above.add_gridspec(len(panels), 2, width_ratios=[1.0, 1.25])
    draw_space = _draw_space if len(result.robot.tips) == 1 else _draw_space_of_tips
    draw_space(above.add_subplot(grid[:, 0], projection="3d"), result)
    for row, draw_panel in enumerate(panels):
        axes = above.add_subplot(grid[row, 1])
        draw_panel(axes, result)
        axes.set_xlim(result.time[0], result.time[-1])
        axes.tick_params(labelbottom=row == len(panels) - 1)
    axes.set_xlabel("time [s]")
    above.align_ylabels()
    _draw_velocities(below, result, velocity_rows)
    return figure


def draw_model_free(result: ModelFreeResult) -> Figure:
    """Draws a path tracked without a model: tip and target in space, errors, joint positions, measurements."""
    names = [f"joint {j + 1}" for j in range(result.q.shape[1])]
    oriented = bool(np.isfinite(result.rotation_error).any())
    rows = 4 if oriented else 3
    figure = new_figure(13.0, rows * ROW_HEIGHT + 0.3)
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
    draw_joints(joints, result.time, result.q, names)
    joints.set_ylabel("joint position [rad, m]")
    joints.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), ncols=legend_columns(names))
    measurements.step(result.time, result.step_evaluations, where="mid", color=GREEN)
    measurements.set_ylim(bottom=0)
    measurements.set(ylabel="measurements per step", xlabel="time [s]")
    figure.align_ylabels()
    return figure


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
    draw_joints(axes, result.time, result.q, names)
    axes.set_ylabel("joint position [rad]" if _all_turn(result.robot) else "joint position [rad, m]")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), ncols=legend_columns(names))


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


def _highest(values: NDArray[np.float64]) -> float:
    """Returns the largest finite magnitude, or 1 if all values are zero, so that axes keep a height."""
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0)) or 1.0


def _all_turn(robot: Robot) -> bool:
    return "prismatic" not in robot.joint_kinds
