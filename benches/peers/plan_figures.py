"""Figures of `planning.py`: success against time, and three plans."""

from __future__ import annotations

from pathlib import Path

import numpy as np

# Arm, scene, number, and view: elevation and azimuth (degrees), zoom.
PICTURED = (
    ("panda", "bookshelf_small", 3, 30, 60, 1.3),
    ("panda", "cage", 1, 25, 140, 1.3),
    ("ur5", "table_under_pick", 1, 15, -130, 1.7),
)


def success(rows: list[dict[str, str]], names: list[str], file: Path) -> None:
    """Fraction of the problems that are solved within a time, for each planner."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    arms, known = dict.fromkeys(row["arm"] for row in rows), {row["planner"] for row in rows}
    figure, panels = plt.subplots(1, len(arms), figsize=(5.0 * len(arms), 4.4), sharey=True, squeeze=False)
    for axes, arm in zip(panels[0], arms, strict=True):
        for i, name in enumerate(name for name in names if name in known):
            mine = [row for row in rows if (row["planner"], row["arm"]) == (name, arm)]
            times = np.sort([float(row["ms"]) for row in mine if row["kept"] == "True"])
            share = 100.0 * np.arange(len(times) + 1) / len(mine)
            width = 2.4 if i == 0 else 1.4
            axes.step([1e-3, *times, 1e4], [*share, share[-1]], where="post", linewidth=width, label=name)
        axes.set(xscale="log", xlim=(0.05, 1e4), ylim=(0, 102), xlabel="time of a call [ms]", title=arm)
        axes.grid(alpha=0.3)
    panels[0][0].set_ylabel("solved, and kept by the judge [%]")
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.tight_layout(rect=(0.0, 0.13, 1.0, 1.0))
    figure.legend(handles, labels, loc="lower center", ncols=3, fontsize="small", frameon=False)
    figure.savefig(file, dpi=110)
    plt.close(figure)


def pictures(data: Path, acceleration: float, file: Path) -> None:
    """Draws three plans: the bodies of the arm at both ends, its links at six instants, and the path of its tip."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    import beetle_ik as bik
    from beetle_ik.figures import plan_figure, shapes

    from .clear import MotionBenchArm

    figure = plt.figure(figsize=(12.0, 4.2))
    grid = figure.add_gridspec(1, len(PICTURED), left=0.01, right=0.97, bottom=0.02, top=0.92, wspace=0.08)
    for place, (name, scene, index, elevation, azimuth, zoom) in zip(grid, PICTURED, strict=True):
        arm = MotionBenchArm(data, name)
        problem = next(each for each in arm.problems() if (each["scene"], each["index"]) == (scene, index))
        plan = bik.plan_point_to_point(
            arm.robot,
            start_q=problem["start"],
            end_q=problem["goal"],
            obstacles=arm.scene(problem),
            limits=bik.Limits(acceleration=acceleration),
        )
        drawn = plan_figure.Scene(figure, place, plan)
        for share in np.linspace(0.0, 1.0, 6):
            drawn.draw_arm(share, color="#56B4E9", alpha=0.25 + 0.75 * share)
        drawn.draw_way()
        for end in (problem["start"], problem["goal"]):
            shapes.draw_bodies(drawn.axes, shapes.placed_bodies(arm.robot, end))
        drawn.axes.set_box_aspect((1, 1, 1), zoom=zoom)
        drawn.axes.set_axis_off()
        drawn.axes.view_init(elevation, azimuth)
        drawn.axes.set_title(f"{name}, {scene}: {plan.trajectory.duration:.1f} s", fontsize="medium")
    figure.savefig(file, dpi=110)
    plt.close(figure)
