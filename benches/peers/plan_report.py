"""Tables and figures of `planning.py`."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np

from . import plan_batches, planners
from .plan_worker import Answer
from .report import plain_section, write_table
from .sphere_judge import Verdict

COLUMNS = [
    *("planner", "arm", "problems", "claimed", "kept", "claimed, not kept", "least clearance_mm"),
    *("margin 0", "median_ms", "p95_ms", "slowest_ms", "length_rad", "length over c1eaf41", "duration_s"),
    "limits exceeded by",
]
IMPROVED_COLUMNS = ["arm", "problems", "max_time", "at most 1.05 of 5 s", "duration over 5 s, median", "slowest_s"]
PROBLEM_COLUMNS = [
    *("planner", "arm", "scene", "index", "claimed", "kept", "ms", "margin 0", "clearance_mm", "off ends", "outside"),
    *("length", "duration_s", "speed", "acceleration"),
]
ROUNDING = 1e-6  # of a limit
BUDGETS = {planners.BeetleIk.name: "none", planners.Within1Second.name: "1", planners.Within5Seconds.name: "5"}
NEAR = 1.05  # times the duration that 5 s find
FIRST = planners.BeetleIk.name
BATCH = (
    "`plan_batch` takes {one core, ms a problem} ms a problem of the {arm} on one core and "
    "{two cores, ms a problem} ms on two: a gain of {gain}, where two empty loops gain {gain of two empty loops}."
)
BEGIN, END = "<!-- written by benches/planning.py -->", "<!-- end -->"
OURS = (planners.BeetleIk, planners.BeetleIkTravel, planners.Within5Milliseconds)
OTHERS = (planners.Old, planners.OldCapsules, planners.RoboPlan, planners.MpLib)
IMPROVING = (planners.Within1Second, planners.Within5Seconds)
# Arm, scene, number, and how it is seen: elevation and azimuth (degrees), zoom.
PICTURED = (
    ("panda", "bookshelf_small", 3, 30, 60, 1.3),
    ("panda", "cage", 1, 25, 140, 1.3),
    ("ur5", "table_under_pick", 1, 15, -130, 1.7),
)


@dataclass(frozen=True)
class Result:
    """One planner on one problem; `verdict` None where it claims no plan."""

    planner: str
    arm: str
    problem: dict[str, Any]
    answer: Answer
    verdict: Verdict | None

    @property
    def key(self) -> tuple[str, int]:
        """Which problem of the arm it is."""
        return self.problem["scene"], self.problem["index"]

    @property
    def kept(self) -> bool:
        """Whether the problem is solved."""
        return self.verdict is not None and self.verdict.kept

    @property
    def milliseconds(self) -> float:
        """The time of the call."""
        return 1e3 * self.answer.seconds


def write(out: Path, results: list[Result], batches: list[list[str]]) -> None:
    """Writes all tables, and every single result."""
    lines, improved = summary(results), improvement(results)
    write_table(out / "planning.csv", COLUMNS, lines)
    write_table(out / "planning_problems.csv", PROBLEM_COLUMNS, [problem_line(each) for each in results])
    text = plain_section("Plans among obstacles, MotionBenchMaker", COLUMNS, lines)
    if improved:
        write_table(out / "planning_improved.csv", IMPROVED_COLUMNS, improved)
        text += "\n" + plain_section("Durations with a budget of time", IMPROVED_COLUMNS, improved)
    if batches:
        write_table(out / "planning_batch.csv", plan_batches.COLUMNS, batches)
        text += "\n" + plain_section("Batches", plan_batches.COLUMNS, batches)
    (out / "planning.md").write_text(text, encoding="utf-8")
    success_figure(results, out / "planning_success.png")
    print(text)


def problem_line(result: Result) -> list[str]:
    """One planner on one problem."""
    verdict, problem = result.verdict, result.problem
    line = [result.planner, result.arm, problem["scene"], str(problem["index"]), str(result.answer.claimed)]
    line += [str(result.kept), f"{result.milliseconds:.4g}", str(result.answer.margin_0)]
    if verdict is None:
        return line + [""] * 7
    figures = [1e3 * verdict.clearance, verdict.off_ends, verdict.outside, verdict.length, result.answer.duration]
    return line + [f"{figure:.4g}" for figure in (*figures, verdict.speed, verdict.acceleration)]


def summary(results: list[Result]) -> list[list[str]]:
    """A line for each planner and arm; times of all calls, lengths and durations of what is kept."""
    grouped: dict[tuple[str, str], list[Result]] = {}
    for result in results:
        if result.planner not in {each.name for each in IMPROVING}:
            grouped.setdefault((result.planner, result.arm), []).append(result)
    order = [planner.name for planner in (*OURS, *OTHERS)]
    return [
        summary_line(mine, grouped.get((planners.Old.name, arm), []))
        for (_, arm), mine in sorted(grouped.items(), key=lambda item: order.index(item[0][0]))
    ]


def summary_line(mine: list[Result], old: list[Result]) -> list[str]:
    """The figures of one planner on one arm, compared with those of the earlier one."""
    verdicts = [each.verdict for each in mine if each.verdict is not None]
    kept = [each for each in mine if each.kept]
    of_old = {each.key: each.verdict.length for each in old if each.kept}
    times = np.sort([each.milliseconds for each in mine])
    least = min((verdict.clearance for verdict in verdicts), default=np.nan)
    ratios = [each.verdict.length / of_old[each.key] for each in kept if each.key in of_old]
    rates = [rate for verdict in verdicts for rate in (verdict.speed, verdict.acceleration)]
    excess = max(rates, default=0.0) - 1.0
    return [
        *(mine[0].planner, mine[0].arm, str(len(mine)), str(len(verdicts)), str(len(kept))),
        *(str(len(verdicts) - len(kept)), digits(1e3 * least), str(sum(each.answer.margin_0 for each in mine))),
        *map(digits, (np.median(times), np.quantile(times, 0.95), times[-1])),
        *(digits(np.median(values)) if values else "-" for values in ([each.verdict.length for each in kept], ratios)),
        digits(np.median([each.answer.duration for each in kept])) if kept else "-",
        f"{100 * excess:.2g} %" if excess > ROUNDING else "-",
    ]


def digits(value: float) -> str:
    """Three digits, without an exponent."""
    return f"{float(f'{value:.3g}'):g}"


def improvement(results: list[Result]) -> list[list[str]]:
    """How long the motions of the first plan and of 1 s are, compared with those of 5 s, where all are kept."""
    lines = []
    kept = {(each.arm, each.planner, each.key): each for each in results if each.kept and each.planner in BUDGETS}
    for arm in dict.fromkeys(arm for arm, *_ in kept):
        for planner, budget in BUDGETS.items():
            pairs = [
                (each, best)
                for (of, by, key), each in kept.items()
                if (of, by) == (arm, planner) and (best := kept.get((arm, planners.Within5Seconds.name, key)))
            ]
            if pairs:
                ratios = np.array([each.answer.duration / best.answer.duration for each, best in pairs])
                share, slowest = (
                    f"{(ratios <= NEAR).sum()} of {len(ratios)}",
                    max(each.answer.wall for each, _ in pairs),
                )
                lines.append([arm, str(len(pairs)), budget, share, f"{np.median(ratios):.3g}", f"{slowest:.4g}"])
    return lines


def success_figure(results: list[Result], file: Path) -> None:
    """The share of the problems that are solved within a time, for each planner."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    shown = [each for each in results if each.planner in {planner.name for planner in (*OURS, *OTHERS)}]
    arms, names = (list(dict.fromkeys(getattr(each, field) for each in shown)) for field in ("arm", "planner"))
    figure, panels = plt.subplots(1, len(arms), figsize=(5.0 * len(arms), 4.4), sharey=True, squeeze=False)
    for axes, arm in zip(panels[0], arms, strict=True):
        for i, name in enumerate(names):
            mine = [each for each in shown if (each.planner, each.arm) == (name, arm)]
            times = np.sort([each.milliseconds for each in mine if each.kept])
            share = 100.0 * np.arange(1, len(times) + 1) / len(mine)
            axes.step(np.append(times, 1e4), np.append(share, share[-1:]), where="post", color=f"C{i}", label=name)
        axes.set(xscale="log", xlim=(0.1, 1e4), ylim=(0, 102), xlabel="time of a call [ms]", title=arm)
        axes.grid(alpha=0.3)
    panels[0][0].set_ylabel("solved, and kept by the judge [%]")
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.tight_layout(rect=(0.0, 0.12, 1.0, 1.0))
    figure.legend(handles, labels, loc="lower center", ncols=3, fontsize="small", frameon=False)
    figure.savefig(file, dpi=150)
    plt.close(figure)


def publish(docs: Path, results: list[Result], batches: list[list[str]], data: Path, acceleration: float) -> None:
    """Brings the site up to date: tables, paragraph and pictures."""
    lines = summary(results)
    write_table(docs / "planning.csv", COLUMNS, lines)
    write_table(docs / "planning_improved.csv", IMPROVED_COLUMNS, improvement(results))
    write_table(docs / "planning_batch.csv", plan_batches.COLUMNS, batches)
    success_figure(results, docs / "images" / "planning_success.png")
    pictures(data, acceleration, docs / "images" / "planning_scenes.png")
    page = docs / "planning.md"
    page.write_text(with_paragraph(page.read_text(encoding="utf-8"), paragraph(docs)), encoding="utf-8")


def with_paragraph(page: str, text: str) -> str:
    """The page with another text between the two marks."""
    before, rest = page.split(BEGIN)
    return f"{before}{BEGIN}\n\n{text}\n\n{END}{rest.split(END)[1]}"


def table(docs: Path, name: str) -> list[dict[str, str]]:
    """A table of the site."""
    with (docs / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def paragraph(docs: Path) -> str:
    """What the tables of the site say, in words."""
    rows = {(row["planner"], row["arm"]): row for row in table(docs, "planning.csv")}
    arms = list(dict.fromkeys(arm for _, arm in rows))

    def each(planner: str, say: str) -> str:
        return " and ".join(say.format(**rows[planner, arm]) for arm in arms)

    solved = "{kept} of {problems}"
    times = "{median_ms} ms ({p95_ms} ms)"
    sentences = [
        f"In the order {' and '.join(arms)}: beetle-ik solves {each(FIRST, solved)} problems, and keeps "
        f"{each(FIRST, '{kept} of the {claimed}')} motions that it calls clear.",
        f"The median of a call (95th percentile) is {each(FIRST, times)}, "
        f"the slowest takes {each(FIRST, '{slowest_ms} ms')}.",
        f"With `max_time=0.005` it solves {each(planners.Within5Milliseconds.name, solved)}.",
    ]
    others = [each.name for each in OTHERS if (each.name, arms[0]) in rows]
    sentences += [f"{other} keeps {each(other, '{kept} of {claimed}')} in {each(other, times)}." for other in others]
    sentences += [BATCH.format(**row) for row in table(docs, "planning_batch.csv")]
    return fill(" ".join(sentences), 160, break_on_hyphens=False)


def pictures(data: Path, acceleration: float, file: Path) -> None:
    """Draws three plans: the bodies of the arm at both ends, its links at six instants, and the path of its tip."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    import beetle_ik as bik
    from beetle_ik import _plan_figure, _shapes

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
        drawn = _plan_figure.Scene(figure, place, plan)
        for share in np.linspace(0.0, 1.0, 6):
            drawn.draw_arm(share, color="#56B4E9", alpha=0.25 + 0.75 * share)
        drawn.draw_way()
        for end in (problem["start"], problem["goal"]):
            _shapes.draw_bodies(drawn.axes, _shapes.placed_bodies(arm.robot, end))
        drawn.axes.set_box_aspect((1, 1, 1), zoom=zoom)
        drawn.axes.set_axis_off()
        drawn.axes.view_init(elevation, azimuth)
        drawn.axes.set_title(f"{name}, {scene}: {plan.trajectory.duration:.1f} s", fontsize="medium")
    figure.savefig(file, dpi=110)
    plt.close(figure)
